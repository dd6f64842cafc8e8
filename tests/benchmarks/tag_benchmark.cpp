// Compressed 1080p frames to poses, as ratios from one run: every frame goes through all pipelines
// in turn, and a counter is the ratio of the medians.
//   BM_Tracking      paper_over_tracking: the paper's pipeline over a tracked frame
//   BM_Acquisition   paper_over_acquisition: the same over a frame searched from nothing
//   BM_Rendering     a frame of the synthetic camera, JPEG included
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <ctime>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>
#include <vector>

#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "support/inputs/paper_camera.hpp"

namespace rift::vision {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

/// The robot on a circle at 0.3 m/s: seen all over the picture's middle, always moving and turning.
RobotMotion OnCircle(double t_s) {
  constexpr double kRadius_m = 0.25;
  const double angle = 0.3 / kRadius_m * t_s;
  RobotMotion motion;
  motion.world_from_tag.linear() =
      Eigen::AngleAxisd(angle + std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.world_from_tag.translation() =
      Eigen::Vector3d(kRadius_m * std::cos(angle), 0.08 + kRadius_m * std::sin(angle), 0.03);
  return motion;
}

/// At 0.72 m the tag is 75 px wide.
SyntheticCamera Camera() { return {test::PaperCamera(0.72), {}}; }

std::vector<Frame> Recording(int frames) {
  SyntheticCamera camera = Camera();
  std::mt19937_64 generator(1);
  std::vector<Frame> recording;
  for (int i = 0; i < frames; ++i) {
    recording.push_back(camera.Render(OnCircle(0.5 * i), PixelFormat::kJpeg, generator));
    // Each place is followed by the same place a frame later, so that there is a motion to predict.
    for (int k = 1; k < 3; ++k) {
      recording.push_back(
          camera.Render(OnCircle(0.5 * i + k * kFrame_s), PixelFormat::kJpeg, generator));
    }
    for (int k = 0; k < 3; ++k) recording[3 * i + k].captured_s = i + k * kFrame_s;
  }
  return recording;
}

/// The authors' way: every frame is decoded in colour, undistorted and searched at full size.
class PaperPipeline {
 public:
  explicit PaperPipeline(const CameraModel& camera) : detector_(1, 2) {
    cv::setNumThreads(1);
    cv::Mat k;
    cv::eigen2cv(camera.k, k);
    cv::initUndistortRectifyMap(k, camera.distortion, cv::noArray(), k,
                                {camera.width_px, camera.height_px}, CV_16SC2, map_x_, map_y_);
  }
  bool Finds(const Frame& frame) {
    const cv::Mat picture = cv::imdecode(frame.bytes, cv::IMREAD_COLOR);
    cv::Mat straight, grey;
    cv::remap(picture, straight, map_x_, map_y_, cv::INTER_LINEAR);
    cv::cvtColor(straight, grey, cv::COLOR_BGR2GRAY);
    const GreyPatch patch{{0, 0, grey.cols, grey.rows}, {grey.datastart, grey.dataend}};
    return !detector_.Detect(patch).empty();
  }

 private:
  TagDetector detector_;
  cv::Mat map_x_, map_y_;
};

class Times {
 public:
  /// Of this thread alone, so that other work on the machine counts little.
  static double ThreadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  template <class Work>
  void Add(Work&& work) {
    const double begin_s = ThreadSeconds();
    if (!work()) throw std::runtime_error("a pipeline lost the tag");
    seconds_.push_back(ThreadSeconds() - begin_s);
  }
  double Median_ms() {
    std::nth_element(seconds_.begin(), seconds_.begin() + seconds_.size() / 2, seconds_.end());
    return 1e3 * seconds_[seconds_.size() / 2];
  }

 private:
  std::vector<double> seconds_;
};

void BM_Tracking(benchmark::State& state) {
  const std::vector<Frame> recording = Recording(20);
  const CameraModel camera = test::PaperCamera(0.72);
  PaperPipeline paper(camera);
  Times paper_times, tracking;
  for (auto _ : state) {
    TagTracker tracker(camera, {});
    for (std::size_t i = 0; i < recording.size(); ++i) {
      if (i % 3 != 2) {
        tracker.Track(recording[i]);
        continue;
      }
      tracking.Add([&] {
        const TrackResult result = tracker.Track(recording[i]);
        return result.sighting && result.sighting->mode == TrackMode::kEdges;
      });
      paper_times.Add([&] { return paper.Finds(recording[i]); });
    }
  }
  state.counters["paper_ms"] = paper_times.Median_ms();
  state.counters["tracking_ms"] = tracking.Median_ms();
  state.counters["paper_over_tracking"] = paper_times.Median_ms() / tracking.Median_ms();
}

void BM_Acquisition(benchmark::State& state) {
  const std::vector<Frame> recording = Recording(20);
  const CameraModel camera = test::PaperCamera(0.72);
  PaperPipeline paper(camera);
  Times paper_times, acquisition;
  TagTracker tracker(camera, {});
  for (auto _ : state) {
    for (std::size_t i = 0; i < recording.size(); i += 3) {
      acquisition.Add([&] {
        tracker.Forget();
        return tracker.Track(recording[i]).sighting.has_value();
      });
      paper_times.Add([&] { return paper.Finds(recording[i]); });
    }
  }
  state.counters["paper_ms"] = paper_times.Median_ms();
  state.counters["acquisition_ms"] = acquisition.Median_ms();
  state.counters["paper_over_acquisition"] = paper_times.Median_ms() / acquisition.Median_ms();
}

void BM_Rendering(benchmark::State& state) {
  SyntheticCamera camera = Camera();
  std::mt19937_64 generator(1);
  double t_s = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera.Render(OnCircle(t_s), PixelFormat::kJpeg, generator));
    t_s += kFrame_s;
  }
}

BENCHMARK(BM_Tracking)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(BM_Acquisition)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(BM_Rendering)->Unit(benchmark::kMillisecond)->MinTime(3.0);

}  // namespace
}  // namespace rift::vision

BENCHMARK_MAIN();
