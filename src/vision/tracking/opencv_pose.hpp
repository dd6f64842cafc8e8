#pragma once

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace rift::vision {

/// A pose as OpenCV's solvers give it, a rotation vector and a translation: camera_from_object.
inline Eigen::Isometry3d IsometryOf(const cv::Mat& turn, const cv::Mat& shift) {
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Eigen::Matrix3d linear;
  cv::cv2eigen(rotation, linear);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = linear;
  pose.translation() =
      Eigen::Vector3d(shift.at<double>(0), shift.at<double>(1), shift.at<double>(2));
  return pose;
}

}  // namespace rift::vision
