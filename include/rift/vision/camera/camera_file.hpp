#pragma once

#include <string>
#include <string_view>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// A camera's calibration, in any of these layouts (unknown keys are the business of others):
///   ROS       camera_info: image_width, image_height, camera_name, camera_matrix and
///             distortion_coefficients as {rows, cols, data}, distortion_model; ours has in
///             addition `calibration` and `world_frame`, the latter strict; or its message:
///             width, height, K, D
///   OpenCV    FileStorage: the same keys with !!opencv-matrix; fisheye_model
///   authors'  camera_matrix and dist_coeff (or dist_coeffs, dist, K, D, mtx) as nested lists;
///             without a size: width_px and height_px stay 0
/// Throws Error with file:line:column, key and rule.
CameraModel ReadCamera(std::string_view text, const std::string& source);

/// The ROS layout with our blocks, which cv::FileStorage reads as well (its matrices by
/// `file["camera_matrix"] >> mat`). `comment`: lines that begin with '#', put at the head. Reading
/// it gives the same camera to the last bit.
std::string WriteCamera(const CameraModel& camera, const std::string& comment = {});

/// The comment lines at the head of a camera file, where people wrote what they know of the camera.
std::string CommentOfCamera(std::string_view text);

}  // namespace rift::vision
