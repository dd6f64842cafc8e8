#include "rift/hardware/camera_poses.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <condition_variable>
#include <functional>

#include "support/until.hpp"

namespace rift::hardware {
namespace {

/// What the test and the camera's thread share.
struct Stage {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<vision::Frame> frame;
  vision::CaptureStatus status{.state = vision::CameraState::kRunning};
  int asked = 0;  ///< how often the status was

  void Put(double captured_s, std::vector<std::uint8_t> bytes = {}) {
    const std::lock_guard lock(mutex);
    frame = vision::Frame{
        .captured_s = captured_s, .arrived_s = captured_s + 0.004, .bytes = std::move(bytes)};
    ++status.delivered;
    changed.notify_all();
  }
  void Become(vision::CameraState state, const std::string& reason) {
    const std::lock_guard lock(mutex);
    status.state = state;
    status.reason = reason;
  }
  int Asked() {
    const std::lock_guard lock(mutex);
    return asked;
  }
};

class StagedCapture : public vision::Capture {
 public:
  explicit StagedCapture(std::shared_ptr<Stage> stage) : stage_(std::move(stage)) {}
  std::optional<vision::Frame> Next(double timeout_s) override {
    std::unique_lock lock(stage_->mutex);
    stage_->changed.wait_for(lock, std::chrono::duration<double>(timeout_s),
                             [this] { return stage_->frame.has_value(); });
    return std::exchange(stage_->frame, std::nullopt);
  }
  vision::CaptureStatus Status() const override {
    const std::lock_guard lock(stage_->mutex);
    ++stage_->asked;
    return stage_->status;
  }
  bool IsRecording() const override { return false; }

 private:
  std::shared_ptr<Stage> stage_;
};

vision::TrackResult LeaningTag(const vision::Frame& frame) {
  vision::Sighting sighting;
  sighting.captured_s = frame.captured_s;
  sighting.in_world = true;
  sighting.map_from_tag = Eigen::Translation3d(0.3, -0.2, 0.03) *
                          Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX());
  return {.sighting = sighting};
}

struct Scene {
  explicit Scene(CameraPoses::FindTag find_tag)
      : poses(std::make_unique<StagedCapture>(stage), std::move(find_tag), clock) {}

  /// The news once they are so.
  PoseNews NewsWhen(const std::function<bool(const PoseNews&)>& is_so) {
    PoseNews news;
    test::WaitUntil("the news are so", [&] {
      news = poses.Newest();
      return is_so(news);
    });
    return news;
  }

  std::shared_ptr<Stage> stage = std::make_shared<Stage>();
  SteadyClock clock;
  CameraPoses poses;
};

TEST_CASE("A sighting becomes a pose on the floor with the times of its picture") {
  Scene scene(LeaningTag);
  CHECK_FALSE(scene.poses.Newest().newest);
  const double captured_s = scene.clock.Now_s();
  scene.stage->Put(captured_s);
  const PoseNews news = scene.NewsWhen([](const PoseNews& n) { return n.newest.has_value(); });
  REQUIRE(news.newest);
  const trial::PoseMeasurement& pose = news.newest->measured;
  CHECK(pose.captured_s == captured_s);
  CHECK(news.newest->arrived_s == captured_s + 0.004);
  CHECK(news.newest->ready_s >= captured_s);
  CHECK(news.looked_s == captured_s);
  CHECK(pose.world_from_robot.x_m == Approx(0.3));
  CHECK(pose.world_from_robot.y_m == Approx(-0.2));
  CHECK(pose.world_from_robot.yaw_rad == Approx(2.0));
  CHECK(pose.z_m == Approx(0.03));
  CHECK(pose.roll_rad == Approx(-0.1));
  CHECK(pose.pitch_rad == Approx(0.2));
  CHECK(scene.poses.Seen().frame->captured_s == captured_s);
}

TEST_CASE("A picture without a tag leaves the last pose and tells that somebody looked") {
  bool is_hidden = false;
  Scene scene([&is_hidden](const vision::Frame& frame) {
    return is_hidden ? vision::TrackResult{.miss = vision::Miss::kNoTag} : LeaningTag(frame);
  });
  scene.stage->Put(1.0);
  scene.NewsWhen([](const PoseNews& n) { return n.looked_s == 1.0; });
  is_hidden = true;
  scene.stage->Put(2.0);
  const PoseNews news = scene.NewsWhen([](const PoseNews& n) { return n.looked_s == 2.0; });
  CHECK(news.looked_s == 2.0);
  REQUIRE(news.newest);
  CHECK(news.newest->measured.captured_s == 1.0);
}

TEST_CASE(
    "Pictures whose corners stay within four thousandths of a pixel repeat the first of them") {
  std::atomic<double> off_px = 0.0;
  std::atomic<bool> is_second_axis = false;
  Scene scene([&](const vision::Frame& frame) {
    vision::TrackResult found = LeaningTag(frame);
    for (Eigen::Vector2d& corner : found.sighting->corners) corner = {100.0, 200.0};
    Eigen::Vector2d& last = found.sighting->corners.back();
    (is_second_axis ? last.y() : last.x()) += off_px;
    return found;
  });
  const auto repeats_since_s = [&](double at_s, double by_px) {
    off_px = off_px + by_px;
    scene.stage->Put(at_s);
    return scene.NewsWhen([&](const PoseNews& n) { return n.looked_s == at_s; }).repeats_since_s;
  };
  for (const bool is_y : {false, true}) {
    const double t_s = is_y ? 10.0 : 0.0;
    is_second_axis = is_y;
    CHECK_FALSE(repeats_since_s(t_s + 1.0, 5.0));
    CHECK(repeats_since_s(t_s + 2.0, 0.0039) == t_s + 1.0);
    CHECK(repeats_since_s(t_s + 3.0, -0.0039) == t_s + 1.0);  // since the first, not the last
    CHECK_FALSE(repeats_since_s(t_s + 4.0, 0.0041));
    CHECK_FALSE(repeats_since_s(t_s + 5.0, -0.0041));
    CHECK(repeats_since_s(t_s + 6.0, 0.0) == t_s + 5.0);
  }
}

TEST_CASE("Pictures of the same bytes repeat the first of them whatever is found in them") {
  std::atomic<double> off_px = 0.0;
  Scene scene([&](const vision::Frame& frame) {
    vision::TrackResult found = LeaningTag(frame);
    for (Eigen::Vector2d& corner : found.sighting->corners) corner = {100.0 + off_px, 200.0};
    off_px = off_px + 1.0;
    return found;
  });
  const auto repeats_since_s = [&](double at_s, std::vector<std::uint8_t> bytes) {
    scene.stage->Put(at_s, std::move(bytes));
    return scene.NewsWhen([&](const PoseNews& n) { return n.looked_s == at_s; }).repeats_since_s;
  };
  CHECK_FALSE(repeats_since_s(1.0, {1, 2, 3}));
  CHECK(repeats_since_s(2.0, {1, 2, 3}) == 1.0);
  CHECK(repeats_since_s(3.0, {1, 2, 3}) == 1.0);
  CHECK_FALSE(repeats_since_s(4.0, {1, 2, 4}));
  CHECK_FALSE(repeats_since_s(5.0, {1, 2}));
}

TEST_CASE("Only a tag that is surely the robot's is a pose, and its absence repeats nothing") {
  std::atomic<vision::TrackState> state = vision::TrackState::kTracked;
  std::atomic<bool> is_hidden = false;
  Scene scene([&](const vision::Frame& frame) {
    vision::TrackResult found = is_hidden ? vision::TrackResult{} : LeaningTag(frame);
    if (found.sighting) found.sighting->state = state;
    return found;
  });
  double t_s = 1.0;
  const auto look = [&] {
    scene.stage->Put(++t_s);
    return scene.NewsWhen([&](const PoseNews& n) { return n.looked_s == t_s; });
  };
  CHECK(look().newest->measured.captured_s == 2.0);
  for (const vision::TrackState other :
       {vision::TrackState::kPredicted, vision::TrackState::kAmbiguous,
        vision::TrackState::kLost}) {
    state = other;
    CHECK(look().newest->measured.captured_s == 2.0);
  }
  state = vision::TrackState::kTracked;
  CHECK(look().newest->measured.captured_s == 6.0);
  is_hidden = true;
  CHECK_FALSE(look().repeats_since_s);
  is_hidden = false;
  CHECK_FALSE(look().repeats_since_s);
  CHECK(look().repeats_since_s == 8.0);
}

TEST_CASE("A state from which no picture comes back is a fault, and each other one is none") {
  struct Case {
    vision::CameraState state;
    bool has_spoken, is_fault;
  };
  const std::vector<Case> cases{{vision::CameraState::kOpening, false, false},
                                {vision::CameraState::kRunning, true, false},
                                {vision::CameraState::kFrozen, false, true},
                                {vision::CameraState::kFrozen, true, false},
                                {vision::CameraState::kBlack, true, false},
                                {vision::CameraState::kReconnecting, true, true},
                                {vision::CameraState::kReconnecting, false, true},
                                {vision::CameraState::kEnded, true, true}};
  std::vector<std::unique_ptr<Scene>> scenes;  // at the same time, since each waits for pictures
  std::vector<int> before;
  for (const Case& one : cases) {
    scenes.push_back(std::make_unique<Scene>(LeaningTag));
    if (one.has_spoken) {
      scenes.back()->stage->Put(1.0);
      scenes.back()->NewsWhen([](const PoseNews& n) { return n.newest.has_value(); });
    }
    scenes.back()->stage->Become(one.state, "why");
    before.push_back(scenes.back()->stage->Asked());
  }
  for (size_t i = 0; i < cases.size(); ++i) {
    test::WaitUntil("the state was seen",
                    [&] { return scenes[i]->stage->Asked() >= before[i] + 2; });
    INFO(static_cast<int>(cases[i].state) << " " << cases[i].has_spoken);
    CHECK(scenes[i]->poses.Newest().fault.has_value() == cases[i].is_fault);
  }
}

TEST_CASE("A camera that will give no more pictures is a fault and one that pauses is none") {
  Scene scene(LeaningTag);
  scene.stage->Put(1.0);
  scene.NewsWhen([](const PoseNews& n) { return n.newest.has_value(); });
  scene.stage->Become(vision::CameraState::kFrozen, "no picture for 0.6 s");
  // Asked for the second time, the camera's thread has told what came of the first.
  const int before = scene.stage->Asked();
  test::WaitUntil("the state was seen", [&] { return scene.stage->Asked() >= before + 2; });
  CHECK_FALSE(scene.poses.Newest().fault);
  scene.stage->Become(vision::CameraState::kUnplugged, "the device is gone");
  const PoseNews news = scene.NewsWhen([](const PoseNews& n) { return n.fault.has_value(); });
  CHECK(news.fault == "the camera is unplugged: the device is gone");
}

TEST_CASE("A camera that never gave a picture is a fault") {
  Scene scene(LeaningTag);
  scene.stage->Become(vision::CameraState::kFrozen, "no first picture within 5.0 s");
  CHECK(scene.NewsWhen([](const PoseNews& n) { return n.fault.has_value(); }).fault);
}

TEST_CASE("A tracker that throws is a fault with its words") {
  Scene scene([](const vision::Frame&) -> vision::TrackResult {
    throw std::runtime_error("out of memory");
  });
  scene.stage->Put(1.0);
  CHECK(scene.NewsWhen([](const PoseNews& n) { return n.fault.has_value(); }).fault ==
        "out of memory");
}

}  // namespace
}  // namespace rift::hardware
