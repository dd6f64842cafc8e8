#include "fresh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>

namespace rift::search {
namespace {

constexpr std::uint64_t kUnseenStream = 0x100;
/// A method that proposes so many known batches on end is stuck.
constexpr int kPatience = 20;

bool IsAmong(const std::vector<Point>& points, const Point& point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

}  // namespace

FreshOnly::FreshOnly(std::unique_ptr<Known> known, std::unique_ptr<Strategy> proposer, int batch,
                     std::uint64_t seed)
    : known_(std::move(known)),
      proposer_(std::move(proposer)),
      batch_(batch),
      random_(seed, kUnseenStream) {}

bool FreshOnly::IsExhausted() const {
  const auto& points = known_->space.Points();
  return points && known_->archive.Size() >= *points;
}

std::vector<Point> FreshOnly::Ask(int most) {
  assert(most >= 1 && asked_.empty());
  if (IsExhausted()) return {};
  Consult(std::min(most, batch_));
  if (asked_.empty()) asked_.push_back(Unseen());
  return asked_;
}

void FreshOnly::Consult(int most) {
  for (int i = 0; i < kPatience && asked_.empty(); ++i) {
    proposed_ = proposer_->Ask(most);
    if (proposed_.empty()) return;
    for (const Point& point : proposed_) {
      const bool is_new = !known_->archive.Find(point) && !IsAmong(asked_, point);
      if (is_new) asked_.push_back(point);
    }
    if (asked_.empty()) AnswerProposer();
  }
}

void FreshOnly::AnswerProposer() {
  if (proposed_.empty()) return;
  std::vector<Evaluation> answers;
  for (const Point& point : proposed_) {
    const auto index = known_->archive.Find(point);
    assert(index);
    answers.push_back(known_->archive[*index]);
  }
  proposed_.clear();
  proposer_->Tell(answers);
}

Point FreshOnly::Unseen() {
  const Space& space = known_->space;
  if (space.Points()) {
    const std::uint64_t points = *space.Points();
    std::uint64_t index = random_.Below(points);
    while (known_->archive.Find(space.AtIndex(index))) index = (index + 1) % points;
    return space.AtIndex(index);
  }
  Point point;
  do {
    Eigen::VectorXd unit(space.Size());
    for (double& u : unit) u = random_.Uniform();
    point = space.FromUnit(unit);
  } while (known_->archive.Find(point));
  return point;
}

void FreshOnly::Tell(std::span<const Evaluation> batch) {
  const bool is_answer =
      std::equal(batch.begin(), batch.end(), asked_.begin(), asked_.end(),
                 [](const Evaluation& e, const Point& p) { return e.point == p; });
  if (!is_answer) {
    throw std::invalid_argument(
        fmt::format("search: told {} evaluations that are not the {} points asked last, in order",
                    batch.size(), asked_.size()));
  }
  for (const Evaluation& evaluation : batch) known_->archive.Add(evaluation);
  asked_.clear();
  AnswerProposer();
}

}  // namespace rift::search
