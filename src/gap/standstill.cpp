#include "standstill.hpp"

namespace rift::gap {
namespace {

double Distance_m(const trajectory::StampedPose& a, const trajectory::StampedPose& b) {
  return (a.Position() - b.Position()).norm();
}

}  // namespace

MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const size_t end = poses.size() - 1;
  size_t first = 0;
  while (first < end && Distance_m(poses[first + 1], poses.front()) <= radius_m) ++first;
  size_t last = end;
  while (last > 0 && Distance_m(poses[last - 1], poses.back()) <= radius_m) --last;
  if (first >= last) return {0, end};
  return {first, last};
}

double StandstillShare(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const MovingRange moving = FindMoving(poses, radius_m);
  if (moving.first == 0 && moving.last == poses.size() - 1) return 0.0;
  const double total_m = trajectory::ArcLength_m(poses);
  if (!(total_m > 0.0)) return 0.0;
  const double driven_m =
      trajectory::ArcLength_m(poses.subspan(moving.first, moving.last - moving.first + 1));
  return 1.0 - driven_m / total_m;
}

}  // namespace rift::gap
