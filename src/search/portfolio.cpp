#include "portfolio.hpp"

#include <algorithm>
#include <cmath>

namespace rift::search {
namespace {

/// Points before anything adapts: so many, so many more for each axis, and at most this share of
/// the budget. One in eight is a corner, where simulators often fail first; many of them tell the
/// models little of what lies between.
constexpr int kDesignLeast = 8;
constexpr int kDesignPerAxis = 2;
constexpr double kDesignShare = 0.25;
constexpr double kCornerShare = 0.125;
/// Where an axis is a category or whole, corners go on after the design: this share of so many
/// first evaluations. Ranges end where somebody expects trouble, and no model leads from one
/// category to the corners of another.
constexpr double kCornerShareMixed = 0.4, kCornersUntil = 300.0;
constexpr int kCornersAtOnce = 8;
/// Share of all points that lie anywhere while the learners gain, those of the design counted, and
/// of the points after the design while they do not: less where every axis is continuous, since
/// there a run of the local model from another start is worth more than points alone.
constexpr double kAnywhereGaining = 0.15;
constexpr double kAnywhereStuck = 0.3, kAnywhereStuckMixed = 0.6;
/// Share of the evaluations from so many on that are of differential evolution at least, where
/// every axis is continuous: among many minima its population is slow to pay, and ahead in the end.
constexpr double kEvolutionShare = 0.4, kEvolutionFrom = 500.0;
/// Evaluations after which the surrogate proposes no more: its model keeps its size while the
/// others sharpen.
constexpr int kSurrogateMost = 600;
/// Weight of trying a method that was tried little against one that found much. UCB1 has sqrt(2)
/// for rewards anywhere in [0, 1]; most batches earn nothing here.
constexpr double kCuriosity = 0.3;
/// Evaluations that count as one batch in the records.
constexpr double kBatch = 8.0;
/// A better point of a member that asks for one at a time pays as so much of a batch: among
/// categories only a new best, since a local run's points are among the best wherever it creeps.
constexpr double kLeastPaid = 1.0;
/// Share of the records that a batch leaves: a memory of about 30 batches.
constexpr double kMemory = 0.97;
/// A batch pays when one of its points is among so many best.
constexpr double kElite = 10.0;
/// What two members have earned before they began, and in how many batches. Where every axis is
/// continuous the local model goes first, since where the loss is smooth it needs a third of the
/// evaluations of the others, and where it is not, these few are soon spent; controlled random
/// search goes last. Among categories and integers the local model goes last: it sees one setting
/// of them at a time.
constexpr Portfolio::Record kOfLocalModel{1.5, 0.5}, kOfCrs{0.0, 1.0};
constexpr Portfolio::Record kOfLocalModelMixed{0.1, 0.5};
/// Share of the progress that an evaluation leaves, and the least gain that is any, as a share of
/// how far the best point is from the median one: a loss sharpened in its sixth digit is no nearer
/// to a failure.
constexpr double kProgressMemory = 0.96;
constexpr double kLeastGain = 2e-3;

}  // namespace

Portfolio::Portfolio(const Known& known, const SearchOptions& options, int budget,
                     std::uint64_t seed)
    : known_(known),
      is_continuous_(known.space.DiscreteAxes().empty()),
      corners_(known.space.Corners()),
      design_(std::min(kDesignLeast + kDesignPerAxis * known.space.Size(),
                       static_cast<int>(kDesignShare * budget))) {
  members_[kSobol] = std::make_unique<SobolSampler>(known.space, seed);
  members_[kCorners] = std::make_unique<CornerSampler>(known.space, seed);
  members_[kSurrogate] = std::make_unique<Surrogate>(known, seed);
  members_[kCmaEs] = std::make_unique<Restarts>(known, options.batch, seed);
  members_[kLocalModel] = std::make_unique<LocalModel>(known, seed);
  members_[kEvolution] = std::make_unique<DifferentialEvolution>(known, seed);
  members_[kCrs] = std::make_unique<ControlledRandomSearch>(known, seed);
  auto fit = std::make_unique<QuadraticFit>(known);
  fit_ = fit.get();
  members_[kFit] = std::move(fit);
  records_[kLocalModel] = is_continuous_ ? kOfLocalModel : kOfLocalModelMixed;
  if (is_continuous_) records_[kCrs] = kOfCrs;
}

bool Portfolio::IsDesign() const { return static_cast<int>(known_.archive.Size()) < design_; }

double Portfolio::DueAnywhere(double total) const {
  if (progress_ > kLeastGain) return kAnywhereGaining * total;
  const double stuck = is_continuous_ ? kAnywhereStuck : kAnywhereStuckMixed;
  return (1.0 - kCornerShare) * design_ + stuck * (total - design_);
}

bool Portfolio::MayPropose(Member member) const {
  return member != kSurrogate || known_.archive.Size() < static_cast<std::size_t>(kSurrogateMost);
}

Portfolio::Member Portfolio::Choose() const {
  const auto evaluations = static_cast<double>(known_.archive.Size());
  if (IsDesign()) return corner_points_ < kCornerShare * evaluations ? kCorners : kSobol;
  const double corners_due =
      std::min(kCornerShareMixed * std::min(evaluations, kCornersUntil), corners_);
  if (!is_continuous_ && corner_points_ < corners_due) return kCorners;
  if (anywhere_points_ < DueAnywhere(evaluations)) return kSobol;
  const bool is_evolution_due =
      is_continuous_ && evolution_points_ < kEvolutionShare * (evaluations - kEvolutionFrom);
  if (is_evolution_due) return kEvolution;
  double all_spent = 1.0;
  for (const Member member : kLearners) all_spent += records_[member].spent;
  Member choice = kCmaEs;
  double highest = -1.0;
  for (const Member member : kLearners) {
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
  active_ = !IsDesign() && fit_->IsDue() ? kFit : Choose();
  best_before_ = known_.archive.BestLoss();
  const bool is_corner_batch = active_ == kCorners && !IsDesign();
  std::vector<Point> points =
      members_[active_]->Ask(is_corner_batch ? std::min(most, kCornersAtOnce) : most);
  proposed_ = points.size();
  if (active_ == kSobol || active_ == kCorners) return points;
  // A member that asks for few points leaves room for those that are due anywhere.
  const auto before = static_cast<double>(known_.archive.Size());
  const double due = DueAnywhere(before + static_cast<double>(points.size())) - anywhere_points_;
  for (int i = 0; i < static_cast<int>(due) && static_cast<int>(points.size()) < most; ++i) {
    points.push_back(members_[kSobol]->Ask(1).front());
  }
  return points;
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

void Portfolio::NoteProgress(std::span<const Evaluation> batch) {
  double least = best_before_;
  for (const Evaluation& evaluation : batch) {
    if (evaluation.loss < least) least = evaluation.loss;
  }
  const std::size_t half = known_.archive.Size() / 2;
  const double median = known_.archive[known_.archive.Best(half + 1).back()].loss;
  const double spread = median - least;
  const bool has_spread = std::isfinite(spread) && spread > 0.0 && std::isfinite(best_before_);
  const double gain = has_spread ? (best_before_ - least) / spread : 0.0;
  const double kept = std::pow(kProgressMemory, static_cast<double>(batch.size()));
  progress_ = kept * progress_ + gain;
}

void Portfolio::Tell(std::span<const Evaluation> batch) {
  const std::span<const Evaluation> own = batch.first(proposed_);
  members_[active_]->Tell(own);
  if (active_ == kCorners) {
    corner_points_ += static_cast<double>(own.size());
    return;
  }
  anywhere_points_ +=
      static_cast<double>(active_ == kSobol ? batch.size() : batch.size() - own.size());
  if (active_ == kSobol) return;
  if (active_ == kEvolution) evolution_points_ += static_cast<double>(own.size());
  NoteProgress(own);
  const double spent = static_cast<double>(own.size()) / kBatch;
  for (Record& record : records_) {
    record.gain *= std::pow(kMemory, spent);
    record.spent *= std::pow(kMemory, spent);
  }
  const double reward = RewardOf(own);
  const bool pays_whole = is_continuous_ || reward == 1.0;
  records_[active_].gain += reward * (pays_whole ? std::max(spent, kLeastPaid) : spent);
  records_[active_].spent += spent;
}

}  // namespace rift::search
