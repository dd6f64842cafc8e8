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

double StandingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const MovingRange moving = FindMoving(poses, radius_m);
  return trajectory::ArcLength_m(poses.first(moving.first + 1)) +
         trajectory::ArcLength_m(poses.subspan(moving.last));
}

}  // namespace rift::gap
