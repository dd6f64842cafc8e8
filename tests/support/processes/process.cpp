#include "support/processes/process.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "support/processes/running_rift.hpp"

namespace rift::test {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "rift_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void WriteText(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

ProcessResult RunRift(const std::vector<std::string>& arguments, const std::string& redirection) {
  return RunningRift(arguments, redirection).Wait();
}

}  // namespace rift::test
