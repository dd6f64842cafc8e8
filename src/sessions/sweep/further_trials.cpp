#include "further_trials.hpp"

#include <optional>
#include <utility>

#include "rift/sweep/run/beside_table.hpp"

namespace rift::sessions {

namespace {

constexpr size_t kPaths = 0;  // that are kept of further trials: no page shows them

}  // namespace

FurtherTrials::FurtherTrials(sweep::Evaluator& evaluator, int jobs, const SweepObserver& observer,
                             const GoOn& go_on, sweep::Journal& journal,
                             std::function<void(sweep::Journal&)> tick)
    : observer_(observer),
      runner_([&evaluator](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
              [&evaluator](const sweep::TrialRequest& trial) {
                return sweep::kBesideTable + evaluator.KeyOf(trial);
              },
              &journal, jobs, evaluator.experiment().run,
              {[this](const sweep::TrialRow& row, bool from_journal) {
                 if (progress_) progress_->Seen(row, from_journal);
               },
               [this, &go_on, &journal, tick = std::move(tick)] {
                 if (progress_) progress_->Tick();
                 tick(journal);
                 return go_on();
               },
               [&evaluator](sweep::TrialRow& row) { evaluator.NameSides(row); }},
              kPaths) {
  evaluator.LoadLogs();  // workers are copies of what is there when they start
}

std::vector<sweep::TrialRow> FurtherTrials::Run(std::vector<sweep::TrialRequest> requests) {
  if (bring_ && !runner_.HasAll(requests)) {
    if (!std::exchange(bring_, nullptr)()) throw Stopped{};
  }
  std::optional<std::vector<sweep::TrialRow>> rows = runner_.Run(std::move(requests));
  if (!rows) throw Stopped{};
  return *std::move(rows);
}

void FurtherTrials::Begin(int most) { progress_ = observer_.begin(SweepSize{.most = most}); }

void FurtherTrials::End() {
  progress_->End("done");
  progress_.reset();
}

}  // namespace rift::sessions
