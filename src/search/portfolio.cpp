#include "portfolio.hpp"

#include <algorithm>
#include <cmath>

namespace rift::search {
namespace {

/// Share of the budget for corners and space-filling points before anything adapts, and at most so
/// many points: what the others start from need not grow with a long search.
constexpr double kExploreShare = 0.2;
constexpr int kExploreMost = 100;
/// Share of the exploring points that goes to corners, where simulators often fail first.
constexpr double kCornerShare = 0.5;
/// Evaluations after which the surrogate proposes no more: its model keeps its size while the
/// others sharpen.
constexpr int kSurrogateMost = 600;
/// Share of all evaluations that polishing gets at most.
constexpr double kPolishShare = 0.1;
/// Weight of trying a method that was tried little against one that found much. UCB1 has sqrt(2)
/// for rewards anywhere in [0, 1]; most batches earn nothing here.
constexpr double kCuriosity = 0.3;
/// Share of the records that a batch leaves: a memory of about 30 batches.
constexpr double kMemory = 0.97;
/// A batch pays when one of its points is among so many best.
constexpr double kElite = 10.0;
/// Share of the later evaluations that explores on. Without, one search in five of the 3pi+ space
/// of search_study sharpened the same few rough peaks to its end.
constexpr double kExploreLater = 1.0 / 3.0;

}  // namespace

Portfolio::Portfolio(const Known& known, const SearchOptions& options, int budget,
                     std::uint64_t seed)
    : known_(known) {
  explore_ = std::min(kExploreMost, static_cast<int>(kExploreShare * budget));
  members_[kSobol] = std::make_unique<SobolSampler>(known.space, seed);
  members_[kCorners] = std::make_unique<CornerSampler>(known.space, seed);
  members_[kSurrogate] = std::make_unique<Surrogate>(known, options.surrogate, seed);
  members_[kCmaEs] = std::make_unique<Restarts>(known, options.cmaes, options.batch, seed);
  members_[kPolish] = std::make_unique<Polish>(known, options.polish, seed);
}

bool Portfolio::IsExploring() const {
  const int evaluations = static_cast<int>(known_.archive.Size());
  if (evaluations < explore_) return true;
  const double later = explored_points_ - explore_;
  return evaluations < kSurrogateMost &&
         later < kExploreLater * static_cast<double>(evaluations - explore_);
}

Portfolio::Member Portfolio::Explorer() const {
  const double corners_due = kCornerShare * static_cast<double>(known_.archive.Size());
  return corner_points_ < corners_due ? kCorners : kSobol;
}

bool Portfolio::MayPropose(Member member) const {
  const auto evaluations = static_cast<double>(known_.archive.Size());
  if (member == kSurrogate) return evaluations < kSurrogateMost;
  if (member == kPolish) return polish_points_ < kPolishShare * evaluations;
  return true;
}

Portfolio::Member Portfolio::Choose() const {
  if (IsExploring()) return Explorer();
  double all_spent = 1.0;
  for (const Member member : {kSurrogate, kCmaEs, kPolish}) all_spent += records_[member].spent;
  Member choice = kCmaEs;
  double highest = -1.0;
  for (const Member member : {kSurrogate, kCmaEs, kPolish}) {
    if (!MayPropose(member)) continue;
    const Record& record = records_[member];
    const double spent = std::max(record.spent, 1e-3);
    const double bound =
        record.gain / spent + kCuriosity * std::sqrt(std::log(1.0 + all_spent) / spent);
    if (bound > highest) {
      highest = bound;
      choice = member;
    }
  }
  return choice;
}

std::vector<Point> Portfolio::Ask(int most) {
  active_ = Choose();
  best_before_ = known_.archive.BestLoss();
  return members_[active_]->Ask(most);
}

double Portfolio::RewardOf(std::span<const Evaluation> batch) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Evaluation& evaluation : batch) {
    if (evaluation.loss < least) least = evaluation.loss;
  }
  if (least < best_before_) return 1.0;
  const std::vector<std::size_t> best = known_.archive.Best(static_cast<std::size_t>(kElite));
  double better = 0.0;
  for (const std::size_t i : best) better += known_.archive[i].loss < least;
  return 0.5 * (1.0 - better / kElite);
}

void Portfolio::Tell(std::span<const Evaluation> batch) {
  members_[active_]->Tell(batch);
  if (active_ == kCorners) corner_points_ += static_cast<double>(batch.size());
  if (active_ == kPolish) polish_points_ += static_cast<double>(batch.size());
  if (active_ == kSobol || active_ == kCorners) {
    explored_points_ += static_cast<double>(batch.size());
    return;
  }
  for (Record& record : records_) {
    record.gain *= kMemory;
    record.spent *= kMemory;
  }
  records_[active_].gain += RewardOf(batch);
  records_[active_].spent += 1.0;
}

}  // namespace rift::search
