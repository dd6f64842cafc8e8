#include "backlog_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rift::hardware {
namespace {

constexpr double kStands = 0.7;  // of the way unseen: the pose stands, which others judge
// Commands tell a robot's way no better: its battery, its load.
constexpr double kCommandsOff = 0.2;

}  // namespace

void BacklogCheck::SeePicture(double t_s) {
  pictures_s_.push_back(t_s);
  while (pictures_s_.front() < t_s - kKept_s) pictures_s_.pop_front();
}

void BacklogCheck::LearnPeriod() {
  constexpr size_t kFewest = 10;
  constexpr double kPause = 3.0;  // of the median: the tag was not seen meanwhile
  std::vector<double> periods_s;
  for (size_t i = 1; i < pictures_s_.size(); ++i)
    periods_s.push_back(pictures_s_[i] - pictures_s_[i - 1]);
  if (periods_s.size() < kFewest) return;
  std::sort(periods_s.begin(), periods_s.end());
  const double longest_s = kPause * periods_s[periods_s.size() / 2];
  double sum_s = 0.0;
  int count = 0;
  for (const double period_s : periods_s) {
    if (period_s > longest_s) break;
    sum_s += period_s;
    ++count;
  }
  period_s_ = sum_s / count;
}

BacklogCheck::Behind BacklogCheck::BehindIn(double Step::*part) const {
  const auto rolls = [part](const Motion& m) { return std::abs(m.rolled.*part) > kRolls_m; };
  const auto last = std::find_if(motions_.rbegin(), motions_.rend(), rolls);
  Behind found;
  if (last == motions_.rend()) return found;
  const double side = last->rolled.*part > 0.0 ? 1.0 : -1.0;
  int pictures = 0;
  for (auto motion = motions_.rbegin(); motion != motions_.rend(); ++motion) {
    const double rolled_m = side * motion->rolled.*part;
    if (rolls(*motion) && rolled_m < 0.0) break;
    found.way_m += rolled_m;
    found.behind_m += rolled_m - side * motion->seen.*part;
    found.elapsed_s += motion->elapsed_s;
    if (rolls(*motion)) found.moving_s += motion->elapsed_s;
    ++pictures;
  }
  if (period_s_) found.missing_s = found.elapsed_s - pictures * *period_s_;
  return found;
}

std::optional<std::string> BacklogCheck::Check(const Motion& motion, bool is_measured,
                                               bool is_latency_known) {
  motions_.push_back(motion);
  double kept_s = 0.0;
  for (const Motion& kept : motions_) kept_s += kept.elapsed_s;
  for (; kept_s > kKept_s; motions_.pop_front()) kept_s -= motions_.front().elapsed_s;

  const Behind forward = BehindIn(&Step::forward_m), turn = BehindIn(&Step::turn_m);
  const bool is_forward = forward.way_m >= turn.way_m;
  const Behind& most = is_forward ? forward : turn;
  if (most.moving_s <= 0.0 || most.behind_m > kStands * most.way_m) return std::nullopt;
  const double most_s = options_.max_latency_s;
  // Where the latency is not known the pose is late from the start, and twice so after a reversal.
  const double allowed_s = is_latency_known ? most_s : 2.0 * most_s;
  const double allowed_m = options_.still_m + allowed_s * most.way_m / most.moving_s;
  const double unsure_m = is_measured ? 0.0 : kCommandsOff * most.way_m;
  const bool is_behind = most.behind_m - unsure_m > allowed_m;
  if (is_behind && most.missing_s > most_s) {
    return fmt::format(
        "the pose fell {:.3f} m behind the wheels within {:.1f} s, in which {:.2f} s of pictures "
        "did "
        "not come, and the limit is {:.2f} s: something between camera and rift holds pictures "
        "back",
        most.behind_m, most.elapsed_s, most.missing_s, most_s);
  }
  if (is_measured && is_forward && most.behind_m - options_.slip_share * most.way_m > allowed_m) {
    return fmt::format(
        "the pose fell {:.3f} m behind the wheels within {:.1f} s, in which they rolled {:.3f} m: "
        "pictures that come later and later, or wheels that slip",
        most.behind_m, most.elapsed_s, most.way_m);
  }
  return std::nullopt;
}

}  // namespace rift::hardware
