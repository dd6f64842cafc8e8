#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

class PageServer;

/// The report of a sweep that still runs, at a local address: the page of the trials so far, drawn
/// anew every few seconds and less often where drawing takes long.
class LivePage {
 public:
  LivePage(const std::filesystem::path& folder, sweep::Evaluator& evaluator);
  /// Removes what only the running sweep needs.
  ~LivePage();
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  /// Where it is.
  const std::string& Url() const;
  void Seen(const sweep::TrialRow& row) { rows_.push_back(row); }
  /// Draws when it is time to; cheap otherwise.
  void Tick();
  /// report.html is written: from now on it is what is served. Where somebody watches, waits for a
  /// moment until the browser has it.
  void End();

 private:
  using Clock = std::chrono::steady_clock;

  std::filesystem::path file_;
  sweep::Evaluator& evaluator_;
  std::vector<sweep::TrialRow> rows_;
  size_t drawn_ = 0;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
  std::unique_ptr<PageServer> server_;
};

}  // namespace rift::sessions
