#include "rift/sessions/sweep/live_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "page_evidence.hpp"
#include "page_server.hpp"
#include "rift/files/files.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sessions {
namespace {

constexpr std::chrono::milliseconds kLeastPause{2500};
constexpr int kDrawingShare = 10;  ///< at most a tenth of the time goes into pages
/// Above that many trials a page that is drawn again and again would hold up the sweep.
constexpr size_t kMostRows = 20'000;
constexpr int kLastLook_ms = 6000;  ///< the page asks for itself every 3 s

/// The page of the trials so far, without figures.
std::string RunningReport(const sweep::SweepResult& result, sweep::Evaluator& evaluator) {
  report::PageEvidence evidence = EvidenceFor(result, evaluator, nullptr);
  evidence.running =
      fmt::format("{} trials so far, {} of them failed", result.rows.size(), result.all.failures);
  return report::RenderPage(result, sweep::Explain(result), evidence);
}

}  // namespace

LivePage::LivePage(const std::filesystem::path& folder, sweep::Evaluator& evaluator)
    : file_(folder / kLivePageName),
      evaluator_(evaluator),
      server_(std::make_unique<PageServer>(
          std::vector<std::filesystem::path>{file_, folder / "report.html"})) {
  // An earlier report is not that of the running sweep.
  files::WriteFile(file_,
                   "<!DOCTYPE html><meta charset=utf-8><meta http-equiv=refresh content=1>"
                   "<title>rift</title><p>The first trials are running.");
}

LivePage::~LivePage() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

const std::string& LivePage::Url() const { return server_->Url(); }

void LivePage::Tick() {
  server_->NoteRequests();
  if (rows_.size() == drawn_ || rows_.size() > kMostRows || Clock::now() < next_) return;
  const Clock::time_point begun = Clock::now();
  sweep::SweepResult result = sweep::EmptyResult(evaluator_.experiment());
  result.rows = rows_;
  sweep::Summarise(result);
  drawn_ = rows_.size();
  files::WriteFile(file_, RunningReport(result, evaluator_));
  const auto took = Clock::now() - begun;
  next_ = Clock::now() + std::max<Clock::duration>(kLeastPause, kDrawingShare * took);
}

void LivePage::End() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  if (server_->IsWatched()) server_->WaitForLast(kLastLook_ms);
}

}  // namespace rift::sessions
