#include "count_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace rift::hardware {
namespace {

constexpr double kRest_s = 0.1;      // two readings of a slow link
constexpr std::int32_t kJitter = 1;  // of a wheel that stands on the edge of a count
constexpr double kCoasts_s = 0.5;    // against what it is told now
constexpr double kBack_m = 0.02;     // between two readings; no gear gives way so far
constexpr double kStops_s = 1.0;     // from a zero on: the longest lag of a link, and to roll out

/// Right over the end of the counters' range as well.
std::int32_t Change(std::int32_t before, std::int32_t now) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                   static_cast<std::uint32_t>(before));
}

/// Without std::abs, which the least number has none of.
bool IsJitter(std::int32_t change) { return change >= -kJitter && change <= kJitter; }

}  // namespace

void CountWatch::SeePower(Wheel& wheel, int power, double sent_s) {
  if (wheel.power > 0 || power > 0) wheel.forward_s = sent_s;
  if (wheel.power < 0 || power < 0) wheel.backward_s = sent_s;
  wheel.power = power;
  if (power != 0) {
    wheel.stands_since_s.reset();
    wheel.standing_counts.reset();
  } else if (!wheel.stands_since_s) {
    wheel.stands_since_s = sent_s;
  }
}

void CountWatch::SeeCommand(const MilliPower& power, double sent_s) {
  SeePower(left_, power.left, sent_s);
  SeePower(right_, power.right, sent_s);
}

// Not by how fast a wheel can turn: in the tenth of a second between two readings that is as far as
// a robot that has just started has come.
std::optional<std::string> CountWatch::CheckWheel(const Wheel& wheel, std::int32_t counts,
                                                  double read_s, const char* name) const {
  const std::int32_t change = Change(wheel.counts, counts);
  const double against_s = change > 0 ? wheel.backward_s : wheel.forward_s;
  const double along_s = change > 0 ? wheel.forward_s : wheel.backward_s;
  const bool is_told_against = read_s - against_s < kCoasts_s;
  // At any time since the reading before as well: readings may be far apart.
  const bool is_told_along = *read_s_ - along_s < kCoasts_s;
  if (!is_told_against || is_told_along || std::abs(m_per_count_ * change) <= kBack_m) {
    return std::nullopt;
  }
  return fmt::format(
      "the {} wheel's counts jumped by {} within {:.2f} s while it was told to go the other way: "
      "did the robot restart?",
      name, change, read_s - *read_s_);
}

std::optional<std::string> CountWatch::CheckStandingWheel(const Wheel& wheel,
                                                          const char* name) const {
  if (!wheel.standing_counts) return std::nullopt;
  const double turned_m = m_per_count_ * Change(*wheel.standing_counts, wheel.counts);
  if (std::abs(turned_m) <= kBack_m) return std::nullopt;
  return fmt::format(
      "the {} wheel turned by {:.3f} m while it was told to stand, for {:.1f} s now: a robot that "
      "does not obey, or one that is pushed",
      name, turned_m, *read_s_ - *wheel.stands_since_s);
}

std::optional<std::string> CountWatch::CheckStanding() const {
  std::optional<std::string> fault = CheckStandingWheel(left_, "left");
  return fault ? fault : CheckStandingWheel(right_, "right");
}

void CountWatch::Restart(double now_s) {
  for (Wheel* wheel : {&left_, &right_}) {
    if (wheel->stands_since_s) wheel->stands_since_s = now_s;
    wheel->standing_counts.reset();
  }
}

void CountWatch::SeeWheel(Wheel& wheel, std::int32_t counts, double read_s) {
  wheel.counts = counts;
  const bool has_stopped = wheel.stands_since_s && read_s - *wheel.stands_since_s >= kStops_s;
  if (has_stopped && !wheel.standing_counts) wheel.standing_counts = counts;
}

std::optional<std::string> CountWatch::SeeCounts(std::int32_t left, std::int32_t right,
                                                 double read_s) {
  std::optional<std::string> fault;
  if (read_s_) {
    fault = CheckWheel(left_, left, read_s, "left");
    if (!fault) fault = CheckWheel(right_, right, read_s, "right");
  }
  const bool rests = read_s_ && IsJitter(Change(left_.rest_counts, left)) &&
                     IsJitter(Change(right_.rest_counts, right));
  if (!rests) {
    moved_s_ = read_s;
    left_.rest_counts = left;
    right_.rest_counts = right;
  }
  SeeWheel(left_, left, read_s);
  SeeWheel(right_, right, read_s);
  read_s_ = read_s;
  return fault;
}

bool CountWatch::Rest() const { return read_s_ && *read_s_ - moved_s_ >= kRest_s; }

}  // namespace rift::hardware
