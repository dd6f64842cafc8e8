#include "stream_camera.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "rift/statistics/descriptive.hpp"
#include "rift/vision/camera/steady_now.hpp"

namespace rift::twin {
namespace {

constexpr double kPoll_s = 0.001;
constexpr double kLate_s = 0.020;  // a picture that late is left out, as a camera drops it

double ThreadCpu_s() {
  timespec spent{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

trajectory::StampedPose RowOf(const vision::RobotMotion& tag, const simulation::TruePose& pose) {
  const Eigen::Vector3d at = tag.world_from_tag.translation();
  return {.t_s = pose.t_s,
          .x_m = at.x(),
          .y_m = at.y(),
          .z_m = at.z(),
          .roll_rad = pose.roll_rad,
          .pitch_rad = pose.pitch_rad,
          .yaw_rad = pose.yaw_rad};
}

}  // namespace

double HoldBack_s(const simulation::MocapOptions& mocap, const TwinOptions& options) {
  return 0.5 * mocap.exposure_s + std::max(0.0, mocap.processing_s - options.host_share_s);
}

StreamCamera::StreamCamera(const TwinSetup& setup, vision::SyntheticCamera pictures,
                           const TruePath& path, MjpegServer& server,
                           const std::atomic<double>& epoch_s)
    : mocap_(setup.simulation.mocap),
      fps_(setup.twin.fps),
      hold_back_s_(HoldBack_s(setup.simulation.mocap, setup.twin)),
      pictures_(std::move(pictures)),
      path_(path),
      server_(server),
      epoch_s_(epoch_s),
      generator_(setup.seed),
      thread_([this](const std::stop_token& stop) {
        try {
          Run(stop);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          failure_ = std::current_exception();
        }
      }) {}

StreamCamera::~StreamCamera() = default;

double StreamCamera::Now_s() const { return vision::SteadyNow_s() - epoch_s_; }

void StreamCamera::Run(const std::stop_token& stop) {
  std::int64_t next = 0;
  while (!stop.stop_requested()) {
    const double now_s = Now_s();
    PublishDue(now_s);
    const double captured_s = static_cast<double>(next) / fps_;
    if (server_.Clients() == 0 || now_s - captured_s > 1.0 / fps_ + kLate_s) {
      next = static_cast<std::int64_t>(std::ceil(now_s * fps_));
    } else if (path_.Newest_s() >= captured_s) {
      Take(captured_s);
      ++next;
      continue;
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(kPoll_s));
  }
}

void StreamCamera::Take(double captured_s) {
  const double before_s = ThreadCpu_s();
  const TruePath::Moment moment = path_.At(captured_s);
  const vision::RobotMotion tag = TagOf(moment, mocap_);
  vision::Frame picture = pictures_.Render(tag, vision::PixelFormat::kJpeg, generator_);
  waiting_.push({captured_s + hold_back_s_, std::move(picture.bytes)});
  tag_.poses.push_back(RowOf(tag, moment.pose));
  cpu_s_ += ThreadCpu_s() - before_s;
}

void StreamCamera::PublishDue(double now_s) {
  for (; !waiting_.empty() && waiting_.front().due_s <= now_s; waiting_.pop()) {
    late_s_.push_back(now_s - waiting_.front().due_s);
    server_.Publish(std::move(waiting_.front().jpeg));
  }
}

void StreamCamera::RethrowFailure() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void StreamCamera::Finish(TwinRun& run) {
  thread_.request_stop();
  thread_.join();
  RethrowFailure();
  run.pictures = tag_.poses.size();
  if (run.pictures > 0) run.picture_cpu_s = cpu_s_ / static_cast<double>(run.pictures);
  if (!late_s_.empty()) run.picture_late_p99_s = statistics::Quantile(late_s_, 0.99);
  run.tag = std::move(tag_);
}

}  // namespace rift::twin
