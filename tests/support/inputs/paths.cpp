#include "support/inputs/paths.hpp"

#include <cmath>
#include <string_view>

namespace rift::test {

trajectory::Trajectory StraightPath(double length_m, int rows) {
  trajectory::Trajectory path;
  for (int i = 0; i < rows; ++i) {
    const double x_m = length_m * i / (rows - 1);
    path.poses.push_back({.t_s = x_m, .x_m = x_m, .yaw_rad = 0.0});
  }
  return path;
}

trajectory::Trajectory RandomPath(std::mt19937_64& generator, int rows) {
  std::exponential_distribution<double> step_m(100.0);
  std::normal_distribution<double> turn_rad(0.0, 0.2);
  trajectory::Trajectory path;
  trajectory::StampedPose pose{
      .t_s = 3.0, .x_m = step_m(generator), .yaw_rad = turn_rad(generator)};
  for (int i = 0; i < rows; ++i) {
    path.poses.push_back(pose);
    const double distance_m = step_m(generator);
    pose.t_s += 0.05;
    pose.yaw_rad += turn_rad(generator);
    pose.x_m += distance_m * std::cos(pose.yaw_rad);
    pose.y_m += distance_m * std::sin(pose.yaw_rad);
  }
  return path;
}

trajectory::Trajectory Moved(trajectory::Trajectory path, const geometry::Pose2& b_from_a) {
  for (trajectory::StampedPose& pose : path.poses) {
    const geometry::Pose2 moved = b_from_a * pose.Planar();
    pose.x_m = moved.x_m;
    pose.y_m = moved.y_m;
    pose.yaw_rad = moved.yaw_rad;
  }
  return path;
}

std::string Damaged(std::string text, std::mt19937_64& generator) {
  constexpr std::string_view kLikely = "0123456789.-+eE, \n";
  const bool any_byte = generator() % 2 == 0, cut = generator() % 4 == 0;
  for (size_t k = 1 + generator() % 3; k > 0; --k) {
    text[generator() % text.size()] =
        any_byte ? static_cast<char>(generator() % 256) : kLikely[generator() % kLikely.size()];
  }
  if (cut) text.resize(generator() % text.size() + 1);
  return text;
}

}  // namespace rift::test
