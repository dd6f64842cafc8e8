#include <fmt/format.h>

#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr double kPause_s = 0.5;  // between two tries

}  // namespace

void Reconnection::Works(double now_s) {
  last_s_ = now_s;
  reason_.clear();
}

void Reconnection::Broke(const std::string& reason, double now_s) {
  if (!last_s_) throw CameraError(CameraState::kUnplugged, reason);
  if (now_s - *last_s_ > limit_s_) {
    throw CameraError(CameraState::kUnplugged,
                      fmt::format("{}; it did not come back within {:g} s", reason, limit_s_));
  }
  reason_ = reason;
  next_s_ = now_s + kPause_s;
}

}  // namespace rift::vision
