#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// Which of the tags of one id is the robot's. The robot is the one that can have got there since
/// it was last seen; others of its id that were seen beside it are rivals and are remembered. A
/// choice is ambiguous from the moment when there was another one, or when nothing but a tag out of
/// the robot's reach was seen, until the rivals are refuted: not seen for `doubt_s`, or seen at
/// rest while the chosen tag drove away. A rival that drives while the chosen tag rests is chosen.
class RobotChoice {
 public:
  explicit RobotChoice(const TagOptions& options) : options_(options) {}

  struct Verdict {
    std::optional<std::size_t> robot;  ///< index of the candidate; none: not among them
    bool is_ambiguous = false;
  };
  /// p_in_map: what was seen of the id in one picture, the best first, metres in one frame.
  /// is_whole: the whole picture was searched, so that what is not among them is not there.
  Verdict Choose(double t_s, const std::vector<Eigen::Vector3d>& p_in_map, bool is_whole);

  bool IsInDoubt() const { return doubt_since_s_.has_value(); }
  /// Tags of this id at the last search of the whole picture, the robot's included.
  int Tags() const { return tags_; }
  void Forget();

 private:
  struct Rival {
    Eigen::Vector3d first_in_map, p_in_map;
    double seen_s;
  };

  double Reach_m(double since_s) const;
  bool IsRival(const Eigen::Vector3d& p_in_map) const;
  std::optional<std::size_t> Best(double t_s, const std::vector<Eigen::Vector3d>& p_in_map);
  void NoteRivals(double t_s, std::vector<Eigen::Vector3d> seen_in_map);
  void Doubt(double t_s, const Eigen::Vector3d& robot_in_map);
  std::optional<std::size_t> Mover(double t_s, const std::vector<Eigen::Vector3d>& p_in_map);
  void Resolve(double t_s);

  TagOptions options_;
  std::optional<Eigen::Vector3d> robot_in_map_;
  double robot_s_ = 0.0;
  std::vector<Rival> rivals_;
  std::optional<double> doubt_since_s_;
  Eigen::Vector3d doubt_in_map_ = Eigen::Vector3d::Zero();
  int tags_ = 1;
};

}  // namespace rift::vision
