#include "view/painter.hpp"

#include <catch2/catch.hpp>
#include <opencv2/imgproc.hpp>

#include "rift/geometry/pose2.hpp"
#include "rift/view/film.hpp"
#include "view/pen.hpp"
#include "view/synthetic_run.hpp"

namespace rift::view {
namespace {

using synthetic::StraightRun;

constexpr double kNear_px = 2.0;

cv::Mat Pixels(const cv::Mat& picture, const cv::Rect& part, const cv::Scalar& wanted) {
  cv::Mat found;
  cv::inRange(picture(part), wanted, wanted, found);
  return found;
}

// Mean position of the pixels of a colour in a part of the picture.
cv::Point2d Centre(const cv::Mat& picture, const cv::Rect& part, const cv::Scalar& wanted) {
  const cv::Moments moments = cv::moments(Pixels(picture, part, wanted), true);
  REQUIRE(moments.m00 > 0.0);
  return {part.x + moments.m10 / moments.m00, part.y + moments.m01 / moments.m00};
}

struct Shot {
  Film film;
  Painter painter;
  cv::Mat picture;

  explicit Shot(const Run& run, size_t index = 30)
      : film(MakeFilm(run)), painter(film.fixed, {1280, 720}) {
    picture = painter.Paint(film.scenes.at(index));
  }
};

TEST_CASE("The green outline lies around the true position in both views") {
  const Shot shot(StraightRun());
  const Scene& scene = shot.film.scenes[30];
  const Layout& layout = shot.painter.layout();
  const cv::Rect around =
      cv::boundingRect(Pixels(shot.picture, layout.top, colour::kGreen)) + layout.top.tl();
  const cv::Point2d expected = layout.TopPixel(scene.world_from_robot.Position());
  CHECK((around.tl() + around.br()).x / 2.0 == Approx(expected.x).margin(kNear_px));
  CHECK((around.tl() + around.br()).y / 2.0 == Approx(expected.y).margin(kNear_px));
  CHECK(around.width == Approx(2.0 * 0.0484 * layout.px_per_m).margin(2.0 * kNear_px));
  const cv::Rect beside =
      cv::boundingRect(Pixels(shot.picture, layout.side, colour::kGreen)) + layout.side.tl();
  CHECK((beside.tl() + beside.br()).x / 2.0 == Approx(expected.x).margin(kNear_px));
  const double middle_m = scene.z_m + shot.film.fixed.body.chassis_bottom_m +
                          shot.film.fixed.body.chassis_height_m / 2.0;
  CHECK((beside.tl() + beside.br()).y / 2.0 ==
        Approx(layout.SidePixel(0.0, middle_m).y).margin(kNear_px));
}

TEST_CASE("The red arrow points along the heading") {
  const double yaw_rad = geometry::RadFromDeg(GENERATE(0.0, 50.0, 130.0, -90.0));
  Run run = StraightRun(yaw_rad);
  run.logged.poses.resize(1);  // no trail beside the arrow
  const Shot shot(run);
  const Layout& layout = shot.painter.layout();
  const Eigen::Vector2d at_m = shot.film.scenes[30].world_from_robot.Position();
  const double reach_px = 2.0 * 0.0484 * layout.px_per_m;
  const cv::Point2d at = layout.TopPixel(at_m);
  const cv::Rect around(cvRound(at.x - reach_px), cvRound(at.y - reach_px), cvRound(2 * reach_px),
                        cvRound(2 * reach_px));
  const cv::Point2d arrow = Centre(shot.picture, around & layout.top, colour::kRed) - at;
  const double error_rad = geometry::WrapToPi(std::atan2(-arrow.y, arrow.x) - yaw_rad);
  CHECK(std::abs(geometry::DegFromRad(error_rad)) < 3.0);
}

TEST_CASE("The side view shows the pitch") {
  Run run = StraightRun();
  run.logged = {};
  for (auto& pose : run.truth.poses) pose.pitch_rad = geometry::RadFromDeg(13.8);
  const Shot shot(run);
  const Layout& layout = shot.painter.layout();
  const Scene& scene = shot.film.scenes[30];
  const cv::Point2d axle = layout.SidePixel(scene.world_from_robot.x_m, scene.z_m);
  const cv::Point2d arrow = Centre(shot.picture, layout.side, colour::kRed) - axle;
  CHECK(arrow.x > 0.0);
  CHECK(geometry::DegFromRad(std::atan2(arrow.y, arrow.x)) == Approx(13.8).margin(2.0));
}

TEST_CASE("Waypoints are yellow where they lie") {
  const Shot shot(StraightRun());
  for (const geometry::NamedPoint& place : shot.film.fixed.waypoints) {
    INFO(place.name);
    const cv::Point at = shot.painter.layout().TopPixel(place.p_in_world_m);
    const cv::Vec3b pixel = shot.picture.at<cv::Vec3b>(at + cv::Point(4, 0));
    CHECK(cv::Scalar(pixel[0], pixel[1], pixel[2]) == colour::kYellow);
  }
}

TEST_CASE("The trail is red up to now and not beyond") {
  const Shot shot(StraightRun());
  const auto red_at = [&](double x_m) {
    const cv::Point at = shot.painter.layout().TopPixel({x_m, 0.0});
    const cv::Rect around(at.x - 1, at.y - 1, 3, 3);
    return cv::countNonZero(Pixels(shot.picture, around, colour::kRed)) > 0;
  };
  CHECK(red_at(0.05));
  CHECK(red_at(0.10));
  CHECK_FALSE(red_at(0.35));
}

TEST_CASE("The reference path is black") {
  Run run = StraightRun();
  run.reference_m = {{0.0, -0.1}, {0.4, -0.1}};
  const Shot shot(run);
  const cv::Point at = shot.painter.layout().TopPixel({0.3, -0.1});
  CHECK(cv::countNonZero(Pixels(shot.picture, {at.x, at.y - 2, 1, 5}, colour::kBlack)) > 0);
}

TEST_CASE("The side view is filled below the ground and clear above it") {
  Run run = StraightRun();
  run.height_at = [](double x_m, double) { return x_m < 0.2 ? 0.0 : 0.03; };
  const Shot shot(run, 0);
  const auto pixel = [&](double x_m, double z_m) {
    return shot.picture.at<cv::Vec3b>(cv::Point(shot.painter.layout().SidePixel(x_m, z_m)));
  };
  const cv::Vec3b earth = pixel(0.3, 0.01);
  CHECK(pixel(0.15, -0.01) == earth);
  CHECK(pixel(0.15, 0.015) != earth);
  CHECK(pixel(0.3, 0.04) != earth);
}

TEST_CASE("Slopes and patches show from above") {
  Run run = StraightRun();
  run.patches = {{"mu 0.2", 0.1, 0.2, -0.1, 0.1}};
  run.height_at = [](double x_m, double) { return std::max(0.0, 0.5 * (x_m - 0.25)); };
  const Shot shot(run, 0);
  const auto pixel = [&](double x_m) {
    return shot.picture.at<cv::Vec3b>(cv::Point(shot.painter.layout().TopPixel({x_m, 0.07})));
  };
  CHECK(pixel(0.15) != pixel(0.22));
  CHECK(pixel(0.35) != pixel(0.22));
}

// Letters are thin and smoothed, so few of their pixels have the full colour.
int ReddishPixels(const cv::Mat& picture) {
  std::vector<cv::Mat> channels;
  cv::split(picture, channels);
  cv::Mat excess;
  cv::subtract(channels[2], cv::max(channels[0], channels[1]), excess);
  return cv::countNonZero(excess > 60);
}

TEST_CASE("The text follows the scene and a bad end is red") {
  const Shot shot(StraightRun());
  const cv::Rect panel = shot.painter.layout().panel;
  const Scene now = shot.film.scenes[30];
  Scene later = now, reached = now, fell = now;
  later.speed_mps = 0.7;
  reached.outcome = "reached";
  fell.outcome = "fell";
  const auto text = [&](const Scene& scene) { return shot.painter.Paint(scene)(panel); };
  CHECK(cv::norm(text(now), text(later), cv::NORM_INF) > 50.0);
  CHECK(ReddishPixels(text(fell)) > 10);
  CHECK(ReddishPixels(text(reached)) == 0);
}

TEST_CASE("The same scene gives the same pixels") {
  const Shot one(StraightRun()), other(StraightRun());
  CHECK(cv::norm(one.picture, other.picture, cv::NORM_INF) == 0.0);
}

TEST_CASE("Unknown values and names beyond ASCII are drawn all the same") {
  Run run = StraightRun();
  run.title = "b\xC3\xA4umchen with a title that is far too long for the column of text";
  run.logged = {};
  run.height_at = [](double x_m, double) { return x_m > 0.3 ? -HUGE_VAL : 0.0; };
  const Shot shot(run);
  CHECK(shot.picture.size() == cv::Size(1280, 720));
}

TEST_CASE("The scale is the longest round length below a quarter of the view") {
  struct Case {
    double view_m, scale_m;
  };
  for (const Case& one :
       {Case{0.79, 0.1}, {0.82, 0.2}, {1.96, 0.2}, {2.04, 0.5}, {3.92, 0.5}, {4.08, 1.0}}) {
    INFO(one.view_m << " m");
    Run run = StraightRun();
    run.truth.poses.resize(1);
    run.logged = {};
    ViewOptions options;
    options.ground_cell_m = one.view_m / 400.0;
    const double margin_m = options.margin_m + run.body.chassis_radius_m;
    // Lower than wide, and nothing near its upper edge.
    run.waypoints = {{"", {0.0, 0.0}}, {"", {one.view_m - 2.0 * margin_m, -0.4 * one.view_m}}};
    const Film film = MakeFilm(run, options);
    const Painter painter(film.fixed, {1280, 720});
    const Layout& layout = painter.layout();
    REQUIRE(layout.top.width / layout.px_per_m == Approx(one.view_m).epsilon(0.01));
    const cv::Rect row(layout.top.x + layout.top.width / 2, layout.top.y + 14, layout.top.width / 2,
                       1);
    const cv::Mat picture = painter.Paint(film.scenes[0]);
    const int right = layout.top.br().x - 12;
    int length_px = 0;
    while (length_px < row.width && picture.at<cv::Vec3b>(row.y, right - 1 - length_px)[1] < 100) {
      ++length_px;
    }
    CHECK(length_px == Approx(one.scale_m * layout.px_per_m).margin(2.0));
  }
}

TEST_CASE("Words that are too long for the column of text end within it") {
  const std::string longest(100, 'W');
  Run run = StraightRun();
  run.waypoints[1].name = "end";
  const Film film = MakeFilm(run);
  Film wordy = film;
  wordy.fixed.title = wordy.fixed.waypoints[1].name = longest;
  const Painter painter(film.fixed, {1280, 720}), of_wordy(wordy.fixed, {1280, 720});
  const cv::Rect panel = painter.layout().panel;
  REQUIRE(film.scenes[30].target == 1);
  const cv::Mat plain = painter.Paint(film.scenes[30])(panel);
  const cv::Mat full = of_wordy.Paint(film.scenes[30], {longest})(panel);
  cv::Mat differs;
  cv::extractChannel(plain != full, differs, 1);
  std::vector<cv::Point> changed;
  cv::findNonZero(differs, changed);
  const cv::Rect around = cv::boundingRect(changed);
  // Eighteen pixels are free at its left and 16 at its right, and a letter has less than 20.
  CHECK(around.x == Approx(18).margin(3.0));
  CHECK(around.br().x <= panel.width - 16);
  // The title, the waypoint and the foot each reach to the end of their room.
  int rows_at_end = 0;
  for (int top = 0; top < panel.height; top += 20) {
    const cv::Rect end(panel.width - 16 - 30, top, 30, 20);
    rows_at_end += cv::countNonZero(differs(end)) > 0;
  }
  CHECK(rows_at_end >= 3);
}

TEST_CASE("The place that the robot drives to has a ring and its name, be it the first") {
  const Shot shot(StraightRun());
  const Layout& layout = shot.painter.layout();
  Scene scene = shot.film.scenes[30];
  scene.target = -1;
  const cv::Mat none = shot.painter.Paint(scene);
  for (const int target : {0, 1}) {
    INFO(target);
    scene.target = target;
    const cv::Mat picture = shot.painter.Paint(scene);
    const cv::Point2d at = layout.TopPixel(shot.film.fixed.waypoints[target].p_in_world_m);
    // A ring of 11 px is dark above its middle.
    const cv::Point above(cvRound(at.x), cvRound(at.y) - 11);
    CHECK(picture.at<cv::Vec3b>(above)[1] < 120);
    CHECK(none.at<cv::Vec3b>(above)[1] > 150);
    CHECK(cv::norm(picture(layout.panel), none(layout.panel), cv::NORM_INF) > 50.0);
  }
}

TEST_CASE(
    "The side view is of the ground below both wheels, from the outside of one to the other") {
  // Half of a track of 83 mm and of a wheel of 6.8 mm are 44.9 mm.
  for (const double side : {1.0, -1.0}) {
    for (const auto& [from_m, to_m, is_below] :
         {std::tuple{0.041, 0.044, true}, {0.048, 0.051, false}, {0.0, 0.003, true}}) {
      Run run = StraightRun();
      run.height_at = [side = side, from_m = from_m, to_m = to_m](double, double y_m) {
        return side * y_m >= from_m && side * y_m <= to_m ? 0.03 : 0.0;
      };
      const Shot shot(run, 0);
      const auto pixel = [&](double z_m) {
        return shot.picture.at<cv::Vec3b>(cv::Point(shot.painter.layout().SidePixel(0.3, z_m)));
      };
      INFO(side << " " << from_m);
      CHECK((pixel(0.015) == pixel(-0.01)) == is_below);
    }
  }
}

TEST_CASE("Ground is pale where it is low, sandy where it is high and grey where there is none") {
  Run run = StraightRun();
  run.patches = {{"", 0.12, 0.2, -0.1, 0.1}};
  run.height_at = [](double x_m, double y_m) -> double {
    if (x_m > 0.34 && y_m > 0.06) return -HUGE_VAL;
    return x_m > 0.25 ? 0.04 : 0.0;
  };
  const Shot shot(run, 0);
  const Layout& layout = shot.painter.layout();
  const auto top = [&](double x_m, double y_m) {
    return shot.picture.at<cv::Vec3b>(cv::Point(layout.TopPixel({x_m, y_m})));
  };
  CHECK(top(0.1, 0.09) == cv::Vec3b(236, 240, 240));
  CHECK(top(0.3, -0.09) == cv::Vec3b(172, 206, 226));
  CHECK(top(0.39, 0.1) == cv::Vec3b(120, 116, 112));
  // A quarter of (240, 190, 130) over the low ground, within a frame of its own colour.
  const cv::Vec3b patch = top(0.16, 0.05);
  CHECK(patch[0] == 237);
  CHECK(std::abs(patch[1] - 227.5) <= 0.5);
  CHECK(std::abs(patch[2] - 212.5) <= 0.5);
  const cv::Point corner(layout.TopPixel({0.12, 0.1}));
  const cv::Rect around(corner.x - 3, corner.y - 3, 7, 7);
  CHECK(cv::countNonZero(Pixels(shot.picture, around, cv::Scalar(170, 120, 60))) > 4);
  CHECK(shot.picture.at<cv::Vec3b>(cv::Point(layout.SidePixel(0.1, -0.01))) ==
        cv::Vec3b(188, 208, 220));
  CHECK(shot.picture.at<cv::Vec3b>(layout.panel.br() - cv::Point(3, 3)) ==
        cv::Vec3b(238, 235, 232));
  CHECK(shot.picture.at<cv::Vec3b>(cv::Point(2, 2)) == cv::Vec3b(250, 250, 250));
  CHECK(shot.picture.at<cv::Vec3b>(layout.top.tl()) == cv::Vec3b(140, 134, 128));
  // The robot's outline, its nose, the waypoints and the ink around them.
  for (const cv::Scalar& colour : {cv::Scalar(60, 160, 40), cv::Scalar(40, 40, 215),
                                   cv::Scalar(0, 215, 255), cv::Scalar(40, 36, 32)}) {
    CHECK(cv::countNonZero(Pixels(shot.picture, layout.top, colour)) > 15);
  }
}

TEST_CASE("Letters that the font does not have are question marks, one for each") {
  const auto titled = [](const std::string& title) {
    Run run = StraightRun();
    run.title = title;
    const Shot shot(run, 0);
    return cv::Mat(shot.picture(shot.painter.layout().panel).clone());
  };
  const cv::Mat marked = titled("a?b ~c?");
  for (const std::string title : {"a\x7f"
                                  "b ~c\x1f",
                                  "a\xC3\xA4"
                                  "b ~c\xE2\x82\xAC"}) {
    CHECK(cv::norm(marked, titled(title), cv::NORM_INF) == 0.0);
  }
  CHECK(cv::norm(marked, titled("a?b?~c?"), cv::NORM_INF) > 0.0);
  CHECK(cv::norm(marked, titled("a?b ?c?"), cv::NORM_INF) > 0.0);
}

TEST_CASE("The robot, its wheels, its path and its powers have their colours") {
  Run run = StraightRun();
  run.reference_m = {{0.0, -0.1}, {0.4, -0.1}};
  const Shot shot(run);
  const Layout& layout = shot.painter.layout();
  const auto count = [&](const cv::Rect& part, const cv::Scalar& colour) {
    return cv::countNonZero(Pixels(shot.picture, part, colour));
  };
  CHECK(count(layout.side, cv::Scalar(205, 226, 205)) > 15);   // the chassis
  CHECK(count(layout.side, cv::Scalar(70, 66, 62)) > 15);      // a wheel
  CHECK(count(layout.top, cv::Scalar(0, 0, 0)) > 15);          // the path
  CHECK(count(layout.panel, cv::Scalar(214, 210, 206)) > 15);  // the bars of powers
}

TEST_CASE("Level ground is pale") {
  Run run = StraightRun();
  run.height_at = [](double, double) { return 0.01; };
  const Shot shot(run, 0);
  CHECK(shot.picture.at<cv::Vec3b>(cv::Point(shot.painter.layout().TopPixel({0.1, 0.09}))) ==
        cv::Vec3b(236, 240, 240));
}

}  // namespace
}  // namespace rift::view
