// What is read inside of a fitted square, and when a measurement of it is believed.
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/vision/camera/picture_reader.hpp"
#include "vision/small_recording.hpp"
#include "vision/tracking/edge_fit.hpp"
#include "vision/tracking/motion_guess.hpp"
#include "vision/tracking/tag_meter.hpp"

namespace rift::vision {
namespace {

constexpr int kCell_px = 6;

/// A tag as it is printed, its cells six pixels each, in the upper left of a picture.
GreyPatch Drawn(const TagCells& cells, int black, int white) {
  const int side_px = cells.shape.cells * kCell_px;
  GreyPatch patch{{0, 0, side_px, side_px}, {}};
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      patch.pixels.push_back(
          static_cast<std::uint8_t>(cells.is_white[y / kCell_px][x / kCell_px] ? white : black));
    }
  }
  return patch;
}

/// The square of the tag in that picture, as one that was fitted.
FittedSquare SquareOf(const CameraModel& camera, const TagShape& shape, int black, int white) {
  const double low = shape.Around() * kCell_px - 0.5, high = low + shape.square * kCell_px;
  FittedSquare square{.pixels = {{{low, high}, {high, high}, {high, low}, {low, low}}}};
  const std::vector<Eigen::Vector2d> rays =
      RaysFromPixels(camera, {square.pixels.begin(), square.pixels.end()});
  std::copy(rays.begin(), rays.end(), square.corners.rays.begin());
  square.black_grey = black;
  square.white_grey = white;
  return square;
}

TEST_CASE("Cells that are wrong are counted, and the margin is that of the bits") {
  const CameraModel camera = test::SmallCamera();
  for (const TagFamily family : {TagFamily::k36h11, TagFamily::k16h5, TagFamily::kStandard41h12}) {
    INFO(NameOf(family));
    const TagCells cells = CellsOfTag(3, family);
    const GreyPatch patch = Drawn(cells, 40, 200);
    const FittedSquare square = SquareOf(camera, cells.shape, 40, 200);
    ReadBits read = CompareBits(camera, patch, square, cells);
    CHECK(read.wrong == 0);
    CHECK(read.margin == Approx(80.0));
    // Each bit that should be another is one wrong cell; the margin stays.
    TagCells other = cells;
    int changed = 0;
    for (int row = 0; row < cells.shape.cells; ++row) {
      for (int column = 0; column < cells.shape.cells; ++column) {
        if (!cells.is_bit[row][column] || (row + column) % 3 != 0) continue;
        other.is_white[row][column] = !other.is_white[row][column];
        ++changed;
      }
    }
    read = CompareBits(camera, patch, square, other);
    CHECK(read.wrong == changed);
    CHECK(read.margin == Approx(80.0));
    // A threshold elsewhere brings the bits of one colour nearer.
    const FittedSquare dim = SquareOf(camera, cells.shape, 40, 120);
    int white = 0;
    for (int row = 0; row < cells.shape.cells; ++row) {
      for (int column = 0; column < cells.shape.cells; ++column) {
        white += cells.is_bit[row][column] && cells.is_white[row][column];
      }
    }
    const double share = static_cast<double>(white) / cells.shape.bits;
    CHECK(CompareBits(camera, patch, dim, cells).margin ==
          Approx(share * 120.0 + (1.0 - share) * 40.0));
  }
}

TEST_CASE("A cell beyond the picture is a wrong one and adds nothing to the margin") {
  const CameraModel camera = test::SmallCamera();
  const TagCells cells = CellsOfTag(3, TagFamily::kStandard41h12);
  GreyPatch patch = Drawn(cells, 40, 200);
  patch.region.height_px -= kCell_px;  // its lowest row of cells, nine bits
  patch.pixels.resize(static_cast<std::size_t>(patch.region.width_px) * patch.region.height_px);
  const ReadBits read = CompareBits(camera, patch, SquareOf(camera, cells.shape, 40, 200), cells);
  CHECK(read.wrong == 9);
  CHECK(read.margin == Approx(80.0 * 32.0 / 41.0));
}

/// A picture of the robot with its tag, without noise.
struct Shot {
  explicit Shot(double exposure = 1.0, double z_m = 0.03)
      : robot(test::RobotAt(0.02, 0.01, 0.3, z_m)),
        renderer(camera,
                 {.grain_grey = 0.0, .falloff = 0.0, .exposure = exposure, .noise_grey = 0.0}) {
    std::mt19937_64 random(1);
    patch = *PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, random));
  }
  TrackResult Measure(const TagOptions& options, int id = 0) const {
    return TagMeter(camera, options)
        .Measure(patch, test::TrueCorners(camera, robot), CellsOfTag(id), TrackMode::kRegion,
                 std::nullopt);
  }

  CameraModel camera = test::SmallCamera();
  RobotMotion robot;
  SyntheticCamera renderer;
  GreyPatch patch;
};

TEST_CASE("A measurement is believed up to the limits of its bits, its fit and its contrast") {
  const Shot shot;
  const TrackResult seen = shot.Measure({});
  REQUIRE(seen.sighting);
  const Sighting& s = *seen.sighting;
  CHECK((s.mode == TrackMode::kRegion && s.hamming == 0 && s.in_world && s.is_on_floor));
  CHECK(s.Planar().x_m == Approx(0.02).margin(2e-4));
  CHECK(s.map_from_tag.translation().z() == Approx(0.03).margin(1e-4));
  CHECK(s.decision_margin > 60.0);
  CHECK(s.other_reprojection_px >= 0.0);
  TagOptions options;
  options.min_margin = s.decision_margin;
  CHECK(shot.Measure(options).sighting);
  options.min_margin = std::nextafter(s.decision_margin, 1000.0);
  CHECK(shot.Measure(options).miss == Miss::kDoubtfulBits);
  options = {};
  options.max_fit_px = std::max(s.edge_px, s.reprojection_px);
  CHECK(shot.Measure(options).sighting);
  options.max_fit_px = 0.99 * s.reprojection_px;
  CHECK(shot.Measure(options).miss ==
        (s.edge_px > options.max_fit_px ? Miss::kNoEdges : Miss::kNoPose));
  options.max_fit_px = 0.99 * s.edge_px;
  CHECK(shot.Measure(options).miss == Miss::kNoEdges);
  CHECK(shot.Measure({}, 7).miss == Miss::kDoubtfulBits);
  options = {};
  options.least_contrast = 180;  // of 28 and 215
  CHECK(shot.Measure(options).sighting);
  options.least_contrast = 190;
  CHECK(shot.Measure(options).miss == Miss::kNoEdges);
}

TEST_CASE("A wrong cell is counted and put up with as far as is asked") {
  Shot shot;
  const TagCorners corners = test::TrueCorners(shot.camera, shot.robot);
  const TagCells cells = CellsOfTag(0);
  // The middle of the cell right of and above the tag's middle.
  const Eigen::Vector2d right = (corners[1] - corners[0]) / 8.0,
                        up = (corners[3] - corners[0]) / 8.0;
  const Eigen::Vector2d middle = corners[0] + 4.5 * right + 4.5 * up;
  const bool is_white = cells.is_white[cells.shape.cells - 1 - 5][5];
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      const auto at = static_cast<std::size_t>(std::lround(middle.y()) + y) * 640 +
                      static_cast<std::size_t>(std::lround(middle.x()) + x);
      shot.patch.pixels[at] = is_white ? 28 : 215;
    }
  }
  const TrackResult seen = shot.Measure({});
  REQUIRE(seen.sighting);
  CHECK(seen.sighting->hamming == 1);
  CHECK(shot.Measure({.max_hamming = 0}).miss == Miss::kDoubtfulBits);
}

TEST_CASE("A tag above the floor is left free, unless the picture is too bright to tell its size") {
  // 5 mm of 0.57 m move the corners of 51 px by a quarter of a pixel: far more than is put up with
  // is 3 cm.
  const Shot high(1.0, 0.06);
  TrackResult seen = high.Measure({});
  REQUIRE(seen.sighting);
  CHECK_FALSE(seen.sighting->is_on_floor);
  CHECK(seen.sighting->map_from_tag.translation().z() == Approx(0.06).margin(3e-3));
  TagOptions lenient;
  lenient.off_floor_share = 0.5;
  lenient.max_fit_px = 10.0;
  seen = high.Measure(lenient);
  REQUIRE(seen.sighting);
  CHECK(seen.sighting->is_on_floor);
  CHECK(seen.sighting->map_from_tag.translation().z() == Approx(0.03).margin(1e-3));
  lenient.max_fit_px = 0.6;  // held there its corners are some pixels off
  CHECK(high.Measure(lenient).miss == Miss::kNoPose);
  TagOptions free;
  free.ground = Ground::kFree;
  seen = Shot().Measure(free);
  REQUIRE(seen.sighting);
  CHECK_FALSE(seen.sighting->is_on_floor);
  const Shot bright(1.16, 0.045);  // white is 249 grey values
  seen = bright.Measure({.max_fit_px = 5.0});
  REQUIRE(seen.sighting);
  CHECK(seen.sighting->is_on_floor);
  const Shot dimmer(1.1, 0.045);  // 237
  seen = dimmer.Measure({.max_fit_px = 5.0});
  REQUIRE(seen.sighting);
  CHECK_FALSE(seen.sighting->is_on_floor);
}

TEST_CASE("On the floor is what is off it by twice a lens error, or by a share of the tag's side") {
  const Shot high(1.0, 0.036);  // 6 mm above where the tag should be
  const auto measure = [&](const TagOptions& options) { return *high.Measure(options).sighting; };
  for (const bool by_share : {false, true}) {
    for (const double of_limit : {0.96, 1.04}) {
      TagOptions options{.lens_sigma_px = 0.01, .max_fit_px = 5.0};
      for (int round = 0; round < 12; ++round) {  // the error is weighed where the tag is held
        TagOptions held = options, free = options;
        held.off_floor_share = 10.0;
        free.ground = Ground::kFree;
        const Sighting on_floor = measure(held);
        REQUIRE(on_floor.is_on_floor);
        const double off_px = std::sqrt(std::pow(on_floor.reprojection_px, 2) -
                                        std::pow(measure(free).reprojection_px, 2));
        REQUIRE(off_px > 0.1);
        if (!by_share) options.lens_sigma_px = 0.5 * of_limit * off_px;
        options.off_floor_share = by_share ? of_limit * off_px / Side_px(on_floor.corners) : 0.0;
      }
      CHECK(measure(options).is_on_floor == (of_limit > 1.0));
    }
  }
}

TEST_CASE("A lens that throws corners far out of the picture gives no square, and takes no room") {
  const Shot shot;
  CameraModel camera = shot.camera;
  camera.k(0, 0) = camera.k(1, 1) = 4.2;  // millimetres for pixels
  camera.distortion = {-0.18, 0.06, 0.0008, -0.0005, 0.0};
  const TagOptions options;
  const auto fit = [&](const CameraModel& by, const TagCorners& guess) {
    return FitSquare(by, shot.patch, guess, CellsOfTag(0).shape, options.least_contrast, {});
  };
  const TagCorners corners = test::TrueCorners(shot.camera, shot.robot);
  CHECK(fit(shot.camera, corners));
  CHECK_FALSE(fit(camera, corners));
  TagCorners far = corners;
  far[2] = {1e15, 1e15};
  CHECK_FALSE(fit(shot.camera, far));
}

/// A tag of so many pixels below the camera, without noise, and where its corners are.
struct Small {
  explicit Small(double side_px, double yaw_rad = 0.3, double lean_rad = 0.0)
      : robot(test::RobotAt(0.021, 0.013, yaw_rad)) {
    robot.world_from_tag.linear() *=
        Eigen::AngleAxisd(lean_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    SyntheticCameraOptions look{.grain_grey = 0.0, .falloff = 0.0, .noise_grey = 0.0};
    size_m = look.tag_size_m = side_px * 0.57 / 610.0;
    std::mt19937_64 random(1);
    patch = *PictureReader().Read(
        SyntheticCamera(camera, look).Render(robot, PixelFormat::kGrey, random));
    corners = test::TrueCorners(camera, robot, size_m);
  }
  std::optional<FittedSquare> Fit(const Eigen::Vector2d& off_px = {0.0, 0.0}) const {
    TagCorners guess = corners;
    for (Eigen::Vector2d& corner : guess) corner += off_px;
    return FitSquare(camera, patch, guess, ShapeOf(TagFamily::k36h11), 30.0, {});
  }

  CameraModel camera = test::SmallCamera();
  RobotMotion robot;
  double size_m = 0.0;
  GreyPatch patch;
  TagCorners corners;
};

TEST_CASE("A square whose cells have fewer than two pixels is not measured") {
  CHECK(Small(17.5).Fit());
  CHECK_FALSE(Small(15.7).Fit());
}

TEST_CASE("A guess that is off by less than half a cell to any side leads to the corners") {
  const Small tag(48.0);  // cells of 6 px
  for (const Eigen::Vector2d& off_px :
       {Eigen::Vector2d(2.8, 0.0), {-2.8, 0.0}, {0.0, 2.8}, {0.0, -2.8}, {2.0, -2.0}}) {
    INFO(off_px.transpose());
    const auto square = tag.Fit(off_px);
    REQUIRE(square);
    for (int i = 0; i < 4; ++i) CHECK((square->pixels[i] - tag.corners[i]).norm() < 0.03);
    CHECK(square->black_grey == Approx(28.0).margin(2.0));
    CHECK(square->white_grey == Approx(215.0).margin(2.0));
  }
}

TEST_CASE("Edges are found 0.85 of a cell from the guess, on either side, and not at 1.2") {
  const Small tag(48.0);
  const Eigen::Vector2d along = (tag.corners[1] - tag.corners[0]).normalized();
  const double cell_px = (tag.corners[1] - tag.corners[0]).norm() / 8.0;
  const auto is_found = [&](double cells) {
    const auto square = tag.Fit(cells * cell_px * along);
    bool is_there = square.has_value();
    for (int i = 0; i < 4 && is_there; ++i) {
      is_there = (square->pixels[i] - tag.corners[i]).norm() < 0.05;
    }
    return is_there;
  };
  for (const double side : {1.0, -1.0}) {
    CHECK(is_found(side * 0.85));
    CHECK_FALSE(is_found(side * 1.2));
  }
}

TEST_CASE("The corners of a small tag are not all off together by where they were looked for") {
  for (const double yaw_rad : {0.0, 0.3, 0.7}) {
    const Small tag(27.0, yaw_rad);
    const auto there = tag.Fit();
    REQUIRE(there);
    for (const Eigen::Vector2d& off_px : {Eigen::Vector2d(1.2, 0.0), {-1.2, 0.0}, {0.0, 1.2}}) {
      const auto square = tag.Fit(off_px);
      REQUIRE(square);
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (int i = 0; i < 4; ++i) mean += 0.25 * (square->pixels[i] - there->pixels[i]);
      INFO(yaw_rad << " " << off_px.transpose() << ": " << mean.transpose());
      CHECK(mean.norm() < 0.05);
    }
  }
}

TEST_CASE("The error of a square is the RMS distance of the points from its edges") {
  // Edges that go to and fro by 0.3 px every six pixels.
  constexpr double kLow = 20.0, kHigh = 100.0, kOff = 0.3;
  const auto wave = [&](int at) { return at / 6 % 2 == 0 ? kOff : -kOff; };
  const auto within = [](double pixel, double low, double high) {
    return std::clamp(pixel + 0.5 - low, 0.0, 1.0) * std::clamp(high - pixel + 0.5, 0.0, 1.0);
  };
  GreyPatch patch{{0, 0, 120, 120}, {}};
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double black =
          within(x, kLow + wave(y), kHigh + wave(y)) * within(y, kLow + wave(x), kHigh + wave(x));
      patch.pixels.push_back(static_cast<std::uint8_t>(std::lround(220.0 - 200.0 * black)));
    }
  }
  const TagCorners corners{{{kLow, kHigh}, {kHigh, kHigh}, {kHigh, kLow}, {kLow, kLow}}};
  const auto square =
      FitSquare(test::SmallCamera(), patch, corners, ShapeOf(TagFamily::k36h11), 30.0, {});
  REQUIRE(square);
  // Where it turns, a point lies between.
  CHECK(square->rms_px > 0.8 * kOff);
  CHECK(square->rms_px <= 1.01 * kOff);
}

TEST_CASE("Without a world frame the normal that was seen last tells which way a tag leans") {
  CameraModel camera = test::SmallCamera();
  const Small tag(40.0, 0.3, 0.2);
  camera.world.reset();
  // A lens so bad that corners do not tell.
  const TagOptions options{.size_m = tag.size_m, .lens_sigma_px = 2.0};
  const auto square = tag.Fit();
  REQUIRE(square);
  const auto poses = SolveTagPoses(camera, square->corners, tag.size_m);
  REQUIRE((poses && poses->other));
  REQUIRE(
      (poses->best.camera_from_tag.linear().col(2) - poses->other->camera_from_tag.linear().col(2))
          .norm() > 0.1);
  const TagMeter meter(camera, options);
  for (const TagPose& pose : {poses->best, *poses->other}) {
    const Eigen::Vector3d normal = pose.camera_from_tag.linear().col(2);
    const auto seen =
        meter.Measure(tag.patch, tag.corners, CellsOfTag(0), TrackMode::kEdges, normal).sighting;
    REQUIRE(seen);
    CHECK((seen->camera_from_tag.linear().col(2) - normal).norm() < 1e-6);
    CHECK(seen->reprojection_px == Approx(pose.reprojection_px));
    CHECK(seen->other_reprojection_px == Approx(poses->other->reprojection_px));
  }
}

TEST_CASE("The covariance of a pose is in the axes of the map, however the camera looks") {
  Small tag(48.0);
  // The world turned about the camera: what is seen stays the same.
  const auto seen_with = [&](const Eigen::Matrix3d& turn) {
    CameraModel camera = tag.camera;
    camera.world->origin = kFirstPoseOrigin;  // no floor that it is held to
    camera.world->world_from_camera =
        Eigen::Isometry3d(Eigen::Matrix4d(Eigen::Affine3d(turn).matrix())) *
        tag.camera.world->world_from_camera;
    const auto seen = TagMeter(camera, {.size_m = tag.size_m})
                          .Measure(tag.patch, tag.corners, CellsOfTag(0), TrackMode::kEdges, {});
    REQUIRE(seen.sighting);
    return *seen.sighting;
  };
  const Sighting plain = seen_with(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Sighting turned = seen_with(turn);
  for (const int first : {0, 3}) {
    for (const int second : {0, 3}) {
      const Eigen::Matrix3d expected =
          turn * plain.covariance.block<3, 3>(first, second) * turn.transpose();
      CHECK((turned.covariance.block<3, 3>(first, second) - expected).norm() <
            1e-6 * expected.norm());
    }
  }
  CHECK((turned.map_from_tag.translation() - turn * plain.map_from_tag.translation()).norm() <
        1e-9);
}

TEST_CASE("A cell as grey as the threshold is neither black nor white") {
  const CameraModel camera = test::SmallCamera();
  const TagCells cells = CellsOfTag(3);
  const ReadBits read =
      CompareBits(camera, Drawn(cells, 0, 0), SquareOf(camera, cells.shape, 0, 0), cells);
  CHECK(read.wrong == 8 * 8);
  CHECK(read.margin == 0.0);
}

}  // namespace
}  // namespace rift::vision
