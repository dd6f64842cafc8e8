// Tags of every family: their cells, how well they are measured, and what is taken for one.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "vision/ray_renderer.hpp"
#include "vision/rendered_tags.hpp"

namespace rift::vision {
namespace {

using test::HungCamera;
using test::RayRenderer;
using test::RayTag;

constexpr std::array<TagFamily, 4> kFamilies{TagFamily::k36h11, TagFamily::k25h9, TagFamily::k16h5,
                                             TagFamily::kStandard41h12};
constexpr double kHeight_m = 0.95, kTagHeight_m = 0.03, kFocal_px = 550.0, kFrame_s = 1.0 / 30.0;

/// So large that its square has so many pixels straight below the camera.
double SizeOf_m(double side_px) { return side_px * (kHeight_m - kTagHeight_m) / kFocal_px; }

/// On a disc that leaves its print the margin that the authors' robot leaves.
double DiscOf_m(TagFamily family, double size_m) {
  return 0.82 * size_m * ShapeOf(family).cells / ShapeOf(family).square;
}

TagOptions OptionsOf(TagFamily family, double size_m, int id = 0) {
  TagOptions options;
  options.family = family;
  options.size_m = size_m;
  options.id = id;
  return options;
}

TEST_CASE("Every family has libapriltag's cells, bits and ids") {
  for (const TagFamily family : kFamilies) {
    INFO(NameOf(family));
    const TagShape shape = ShapeOf(family);
    for (const int id : {0, 7, shape.ids - 1}) {
      const auto [library, picture] = test::LibraryTagOf(family, id);
      CHECK(library->name == std::string(NameOf(family)));
      CHECK(static_cast<int>(library->ncodes) == shape.ids);
      CHECK(static_cast<int>(library->nbits) == shape.bits);
      REQUIRE(library->total_width == shape.cells);
      CHECK(library->width_at_border == shape.square);
      CHECK(library->reversed_border == shape.is_white_square);
      const TagCells cells = CellsOfTag(id, family);
      int bits = 0, wrong = 0;
      for (int row = 0; row < shape.cells; ++row) {
        for (int column = 0; column < shape.cells; ++column) {
          bits += cells.is_bit[row][column];
          wrong +=
              cells.is_white[row][column] != (picture->buf[row * picture->stride + column] > 127);
        }
      }
      CHECK(bits == shape.bits);
      CHECK(wrong == 0);
    }
    CHECK_THROWS_WITH(CellsOfTag(shape.ids, family),
                      "tag id " + std::to_string(shape.ids) + ": the family " +
                          std::string(NameOf(family)) + " has the ids 0 to " +
                          std::to_string(shape.ids - 1));
    CHECK_THROWS(CellsOfTag(-1, family));
  }
}

struct Errors {
  std::vector<double> off_m, yaw_rad;
  int unseen = 0, frames = 0;
  double in_sigmas2 = 0.0;

  void Add(const RayTag& truth, const std::optional<Sighting>& seen) {
    ++frames;
    if (!seen) {
      ++unseen;
      return;
    }
    const Eigen::Vector2d off =
        seen->map_from_tag.translation().head<2>() - Eigen::Vector2d(truth.x_m, truth.y_m);
    off_m.push_back(off.norm());
    yaw_rad.push_back(std::abs(geometry::WrapToPi(seen->Planar().yaw_rad - truth.yaw_rad)));
    in_sigmas2 += off.dot(seen->covariance.topLeftCorner<2, 2>().inverse() * off) / 2.0;
  }
  double Off_m() const { return statistics::Quantile(off_m, 0.95); }
  double Yaw_deg() const { return geometry::DegFromRad(statistics::Quantile(yaw_rad, 0.95)); }
  double SigmaRatio() const { return std::sqrt(in_sigmas2 / static_cast<double>(off_m.size())); }
};

/// Places around the picture's middle, each searched from nothing.
Errors RaysOf(TagFamily family, double side_px, int count) {
  const CameraModel camera = HungCamera(kHeight_m, 0.0, kFocal_px);
  RayRenderer renderer(camera);
  const double size_m = SizeOf_m(side_px);
  std::mt19937_64 random(static_cast<unsigned>(side_px));
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const int id = 3;
  TagTracker tracker(camera, OptionsOf(family, size_m, id));
  Errors errors;
  while (errors.frames < count) {
    const RayTag tag{.x_m = 0.3 * u(random),
                     .y_m = 0.2 * u(random),
                     .yaw_rad = M_PI * u(random),
                     .size_m = size_m,
                     .disc_radius_m = DiscOf_m(family, size_m),
                     .id = id,
                     .family = family};
    Frame frame = renderer.Render({tag});
    tracker.Forget();
    std::optional<Sighting> seen;
    for (int attempt = 0; attempt < 3 && !seen; ++attempt) {
      frame.captured_s = errors.frames + attempt * kFrame_s;
      seen = tracker.Track(frame).sighting;
    }
    errors.Add(tag, seen);
  }
  return errors;
}

TEST_CASE("Tags of every family are measured as well as tag36h11 from 20 to 60 px") {
  for (const double side_px : {20.0, 35.0, 60.0}) {
    std::optional<Errors> standard;  // tag36h11, the first
    for (const TagFamily family : kFamilies) {
      const Errors errors = RaysOf(family, side_px, 30);
      if (!standard) standard = errors;
      INFO(NameOf(family) << " of " << side_px << " px: p95 " << 1e3 * errors.Off_m()
                          << " mm, yaw p95 " << errors.Yaw_deg() << " deg, error over sigma "
                          << errors.SigmaRatio() << "; tag36h11 " << 1e3 * standard->Off_m()
                          << " mm, " << standard->Yaw_deg() << " deg");
      CHECK(errors.unseen == 0);
      // What sequences_test.cpp asks of tag36h11 wherever it has 20 px.
      CHECK(errors.Off_m() < 0.3e-3);
      CHECK(errors.Yaw_deg() < 0.2);
      CHECK(errors.SigmaRatio() > 0.5);
      CHECK(errors.SigmaRatio() < 1.6);
    }
  }
}

TEST_CASE("A tag is never taken for one of another family") {
  const CameraModel camera = HungCamera(kHeight_m, 0.0, kFocal_px);
  RayRenderer renderer(camera);
  std::mt19937_64 random(5);
  for (int round = 0; round < 5; ++round) {
    std::vector<RayTag> tags;
    std::map<TagFamily, std::multiset<int>> shown;
    for (int i = 0; i < 12; ++i) {
      const TagFamily family = kFamilies.at(static_cast<std::size_t>(i) % 4);
      const int id = static_cast<int>(random() % static_cast<unsigned>(ShapeOf(family).ids));
      const double size_m = SizeOf_m(40.0);
      tags.push_back({.x_m = -0.45 + 0.3 * (i % 4),
                      .y_m = -0.25 + 0.25 * static_cast<int>(i / 4),
                      .yaw_rad = 0.1 * static_cast<double>(random() % 63),
                      .size_m = size_m,
                      .disc_radius_m = DiscOf_m(family, size_m),
                      .id = id,
                      .family = family});
      shown[family].insert(id);
    }
    const Frame frame = renderer.Render(tags);
    for (const TagFamily family : kFamilies) {
      INFO("round " << round << ", " << NameOf(family));
      std::multiset<int> found;
      for (const TagDetection& tag : FindTags(frame, 1, OptionsOf(family, 0.05))) {
        found.insert(tag.id);
      }
      CHECK(found == shown[family]);
    }
  }
}

/// Pictures without a tag: noise of every grain, with blotches and squares in it.
GreyPatch NoisePicture(unsigned seed) {
  cv::RNG random(seed + 1);
  cv::Mat1f picture(480, 640);
  random.fill(picture, cv::RNG::NORMAL, 0.0, 1.0);
  const double grain_px = 0.5 + 0.5 * (seed % 12);
  cv::GaussianBlur(picture, picture, {}, grain_px);
  cv::Scalar mean, scatter;
  cv::meanStdDev(picture, mean, scatter);
  picture = 120.0 + (picture - mean[0]) * (60.0 / scatter[0]);
  for (int i = 0; i < 60; ++i) {
    const int side = random.uniform(8, 60);
    const cv::RotatedRect box(cv::Point2f(random.uniform(0.F, 640.F), random.uniform(0.F, 480.F)),
                              cv::Size2f(static_cast<float>(side), static_cast<float>(side)),
                              random.uniform(0.F, 90.F));
    cv::Point2f corners[4];
    box.points(corners);
    std::vector<cv::Point> outline(corners, corners + 4);
    // Half of them as dark frames on paper with noise within, as a tag is.
    cv::fillConvexPoly(picture, outline, random.uniform(0.0, 255.0), cv::LINE_AA);
    if (i % 2 != 0) continue;
    const int cells = random.uniform(3, 7);
    const auto side_cells = static_cast<float>(cells + 2);
    const cv::Point2f along = (corners[1] - corners[0]) / side_cells;
    const cv::Point2f across = (corners[2] - corners[1]) / side_cells;
    cv::fillConvexPoly(picture, outline, 20.0, cv::LINE_AA);
    for (int k = 0; k < cells * cells; ++k) {
      if (random.uniform(0, 2) == 0) continue;
      const cv::Point2f at = corners[0] + along * (1.F + static_cast<float>(k % cells)) +
                             across * (1.F + static_cast<float>(k / cells));  // NOLINT: whole rows
      const std::vector<cv::Point> cell{at, at + along, at + along + across, at + across};
      cv::fillConvexPoly(picture, cell, 230.0, cv::LINE_AA);
    }
  }
  cv::Mat1b grey;
  picture.convertTo(grey, CV_8U);
  GreyPatch patch{{0, 0, 640, 480}, {}};
  patch.pixels.assign(grey.datastart, grey.dataend);
  return patch;
}

Frame FrameOf(const GreyPatch& patch, double captured_s) {
  Frame frame;
  frame.width_px = patch.region.width_px;
  frame.height_px = patch.region.height_px;
  frame.bytes.assign(patch.pixels.begin(), patch.pixels.end());
  frame.captured_s = captured_s;
  return frame;
}

TEST_CASE("Pictures without a tag hold no robot, and of tag16h5 a false tag in a hundred") {
  constexpr int kPictures = 100;  // 3000 framed squares with random cells
  CameraModel camera = HungCamera(1.9, 0.0, 400.0);
  camera.width_px = 640;
  camera.height_px = 480;
  camera.k(0, 2) = 320.0;
  camera.k(1, 2) = 240.0;
  camera.distortion.assign(5, 0.0);
  std::vector<Frame> frames;
  for (int i = 0; i < kPictures; ++i) {
    frames.push_back(FrameOf(NoisePicture(static_cast<unsigned>(i)), i));
  }
  for (const TagFamily family : kFamilies) {
    const TagOptions options = OptionsOf(family, 0.1);
    std::vector<int> further;
    for (int id = 1; id < std::min(ShapeOf(family).ids, 30); ++id) further.push_back(id);
    TagTracker tracker(camera, options, {}, further);
    // Of 36 bits and more not one square in a hundred thousand is taken for a tag: a few pictures
    // show all that many would.
    const int bits = ShapeOf(family).bits;
    const int shown = bits >= 36 ? 8 : bits >= 20 ? 25 : kPictures;
    int found = 0, sightings = 0;
    for (int i = 0; i < shown; ++i) {
      const Frame& frame = frames[static_cast<std::size_t>(i)];
      found += static_cast<int>(FindTags(frame, 1, options).size());
      tracker.Forget();
      for (const TrackResult& result : tracker.TrackAll(frame)) {
        sightings += result.sighting.has_value();
      }
    }
    INFO(NameOf(family) << " in " << shown << " pictures: found " << found << ", tracked "
                        << sightings);
    CHECK(sightings == 0);
    CHECK(found <= (family == TagFamily::k16h5 ? 2 : 0));
  }
}

TEST_CASE("Corrected bits make tags of noise, of tag16h5 one in every picture") {
  TagDetector none(1, 0, 5, TagFamily::k16h5), two(1, 2, 5, TagFamily::k16h5);
  std::size_t exact = 0, corrected = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const GreyPatch patch = NoisePicture(seed);
    exact += none.Detect(patch).size();
    corrected += two.Detect(patch).size();
  }
  INFO(exact << " exact, " << corrected << " corrected");
  CHECK(corrected > 20);
  CHECK(20 * exact < corrected);
}

TEST_CASE("rift's own camera shows every family as the rays do") {
  const CameraModel camera = test::PaperCamera(0.72);
  for (const TagFamily family : kFamilies) {
    SyntheticCameraOptions look;
    look.tag_family = family;
    look.tag_id = 11;
    look.body_radius_m = DiscOf_m(family, look.tag_size_m);
    SyntheticCamera pictures(camera, look);
    TagTracker tracker(camera, OptionsOf(family, look.tag_size_m, 11));
    std::mt19937_64 generator(2);
    for (int i = 0; i < 12; ++i) {
      const RobotMotion robot = test::RobotAt(0.03 * i - 0.18, 0.02 * i - 0.1, 0.55 * i);
      Frame frame = pictures.Render(robot, PixelFormat::kGrey, generator);
      frame.captured_s = i;
      tracker.Forget();
      const auto seen = tracker.Track(frame).sighting;
      INFO(NameOf(family) << " at " << i);
      REQUIRE(seen);
      CHECK((seen->map_from_tag.translation() - robot.world_from_tag.translation()).norm() <
            0.3e-3);
      CHECK(seen->hamming == 0);
    }
  }
}

TEST_CASE("A driving robot with a tag of any family is followed by its edges") {
  const CameraModel camera = test::PaperCamera(0.72);
  for (const TagFamily family : kFamilies) {
    SyntheticCameraOptions look;
    look.tag_family = family;
    look.body_radius_m = DiscOf_m(family, look.tag_size_m);
    SyntheticCamera pictures(camera, look);
    TagTracker tracker(camera, OptionsOf(family, look.tag_size_m));
    std::mt19937_64 generator(2);
    for (int i = 0; i < 10; ++i) {
      Frame frame =
          pictures.Render(test::RobotAt(0.01 * i, 0.0, 0.05 * i), PixelFormat::kGrey, generator);
      frame.captured_s = i * kFrame_s;
      const auto seen = tracker.Track(frame).sighting;
      INFO(NameOf(family) << " at " << i);
      REQUIRE(seen);
      if (i > 2) CHECK(seen->mode == TrackMode::kEdges);
    }
  }
}

TEST_CASE("Of tag16h5 no bit is corrected unless asked for, and a family bounds the id") {
  CHECK(OptionsOf(TagFamily::k36h11, 0.05).MaxHamming() == 1);
  CHECK(OptionsOf(TagFamily::k16h5, 0.05).MaxHamming() == 0);
  TagOptions options = OptionsOf(TagFamily::k16h5, 0.05, 29);
  options.max_hamming = 2;
  CHECK(options.MaxHamming() == 2);
  CHECK_NOTHROW(options.Check());
  options.id = 30;
  CHECK_THROWS_WITH(options.Check(), "tag id 30: the family tag16h5 has the ids 0 to 29");
  CHECK_THROWS_WITH(RequireTagId(-1, TagFamily::k16h5), Catch::Contains("tag id -1"));
}

TEST_CASE("Tags of few bits are believed with a margin alone, those of 36 without one") {
  for (const TagFamily family : kFamilies) {
    INFO(NameOf(family));
    const TagCells cells = CellsOfTag(5, family);
    const int side_px = 8 * (cells.shape.cells + 2);  // a cell of white around what is printed
    cv::Mat1b picture(side_px, side_px, std::uint8_t{200});
    for (int row = 0; row < cells.shape.cells; ++row) {
      for (int column = 0; column < cells.shape.cells; ++column) {
        const int grey = cells.is_white[row][column] ? 200 : 40;
        picture(cv::Rect(8 * (column + 1), 8 * (row + 1), 8, 8)).setTo(grey);
      }
    }
    Frame frame{.width_px = side_px, .height_px = side_px};
    frame.bytes.assign(picture.datastart, picture.dataend);
    TagOptions options = OptionsOf(family, 0.05);
    REQUIRE(FindTags(frame, 1, options).size() == 1);
    options.min_margin = 1000.0;
    CHECK(FindTags(frame, 1, options).size() == (cells.shape.bits < 36 ? 0U : 1U));
  }
}

}  // namespace
}  // namespace rift::vision
