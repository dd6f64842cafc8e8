#include <cmath>

#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::vision {

geometry::Pose2 Sighting::Planar() const {
  const Eigen::Vector3d forward = map_from_tag.linear().col(0);
  return {map_from_tag.translation().x(), map_from_tag.translation().y(),
          std::atan2(forward.y(), forward.x())};
}

}  // namespace rift::vision
