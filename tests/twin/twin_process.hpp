#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/processes/process.hpp"
#include "support/processes/running_rift.hpp"
#include "support/tree.hpp"

namespace rift::test {

/// `rift simulate --twin` at work.
class TwinProcess {
 public:
  explicit TwinProcess(const std::vector<std::string>& more = {}) : rift_(Words(more)) {
    rift_.WaitUntil("the twin says where it is",
                    [this] { return rift_.Out().find('\n') != std::string::npos; });
    const std::string said = rift_.Out();
    address_ = nlohmann::json::parse(said.substr(0, said.find('\n')));
  }

  std::string Folder() const { return folder_ / "run"; }
  std::string Get(const char* key) const { return address_.at(key).get<std::string>(); }
  void Signal(int signal) const { rift_.Signal(signal); }
  /// Waits for its end.
  int ExitCode() { return rift_.Wait().exit_code; }

 private:
  std::vector<std::string> Words(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"simulate", SourceDir() + "/configs/twin.yaml", "--twin",
                                   "--out", Folder()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  TemporaryFolder folder_;
  RunningRift rift_;
  nlohmann::json address_;
};

}  // namespace rift::test
