#include "picture_health.hpp"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <span>

#include "rift/statistics/hash.hpp"
#include "rift/vision/camera/picture.hpp"

namespace rift::vision {
namespace {

constexpr int kMostUndecodable = 5;  // in a row: single damaged pictures happen on bad cables

}  // namespace

void PictureHealth::LookForLight(const Frame& frame) {
  if (frame.arrived_s - looked_s_ < options_.look_s) return;
  looked_s_ = frame.arrived_s;
  const cv::Mat grey = GlanceAt(frame);
  if (grey.empty()) {
    if (++undecodable_ < kMostUndecodable) return;
    throw CameraError(CameraState::kWrongFormat,
                      "its pictures cannot be decoded: ask the camera for MJPEG or YUYV");
  }
  undecodable_ = 0;
  cv::Scalar mean, deviation;
  cv::meanStdDev(grey, mean, deviation);
  brightness_ = mean[0] + 3.0 * deviation[0];
}

CameraState PictureHealth::Look(const Frame& frame) {
  const std::uint64_t hash = statistics::Hash64(std::as_bytes(std::span(frame.bytes)));
  if (hash != hash_) same_since_s_ = frame.arrived_s;
  hash_ = hash;
  same_for_s_ = frame.arrived_s - same_since_s_;
  LookForLight(frame);
  if (same_for_s_ >= options_.same_s) return CameraState::kFrozen;
  return brightness_ < options_.black_level ? CameraState::kBlack : CameraState::kRunning;
}

std::string PictureHealth::Reason() const {
  if (same_for_s_ >= options_.same_s) {
    return fmt::format("the same picture for {:.1f} s: plug the camera out and in", same_for_s_);
  }
  if (brightness_ < options_.black_level) {
    return "the picture is black: lens cap, light, or exposure?";
  }
  return {};
}

}  // namespace rift::vision
