#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rift/vision/calibration/live_views.hpp"
#include "support/mirror.hpp"

namespace rift::vision {
namespace {

constexpr int kWidth_px = 1000, kHeight_px = 400;
const Board kBoard{.columns = 5, .rows = 3, .square_m = 0.03};

/// Corners on an even grid within the parallelogram from `at` along `right` and `down`.
BoardView ViewAt(const Eigen::Vector2d& at, const Eigen::Vector2d& right,
                 const Eigen::Vector2d& down) {
  BoardView view{.width_px = kWidth_px, .height_px = kHeight_px};
  for (int row = 0; row < kBoard.rows; ++row) {
    for (int column = 0; column < kBoard.columns; ++column) {
      view.corners.emplace_back(at + right * column / (kBoard.columns - 1.0) +
                                down * row / (kBoard.rows - 1.0));
    }
  }
  return view;
}

TEST_CASE("The place of a flat board is its middle's share of the room it has, and its size") {
  // 160 by 40 px: as large as a square of 80.
  const ViewPlace place = PlaceOf(ViewAt({100.0, 200.0}, {160.0, 0.0}, {0.0, 40.0}), kBoard);
  CHECK(place.x == Approx((180.0 - 40.0) / (1000.0 - 80.0)));
  CHECK(place.y == Approx((220.0 - 40.0) / (400.0 - 80.0)));
  CHECK(place.size == Approx(80.0 / std::sqrt(1000.0 * 400.0)));
  CHECK(place.skew == Approx(0.0).margin(1e-9));
}

TEST_CASE("A board that reaches over the edge of the picture is at that edge") {
  CHECK(PlaceOf(ViewAt({-150.0, 100.0}, {160.0, 0.0}, {0.0, 40.0}), kBoard).x == 0.0);
  CHECK(PlaceOf(ViewAt({990.0, 100.0}, {160.0, 0.0}, {0.0, 40.0}), kBoard).x == 1.0);
  CHECK(PlaceOf(ViewAt({100.0, -35.0}, {160.0, 0.0}, {0.0, 40.0}), kBoard).y == 0.0);
  CHECK(PlaceOf(ViewAt({100.0, 395.0}, {160.0, 0.0}, {0.0, 40.0}), kBoard).y == 1.0);
}

TEST_CASE("The skew of a board is twice how far its upper right corner is from a right angle") {
  test::OnBothSides("acute", "obtuse", [](const test::Side& side) {
    const double lean_rad = side.IsFirst() ? 0.2 : -0.2;
    const Eigen::Vector2d down(40.0 * std::tan(lean_rad), 40.0);
    CHECK(PlaceOf(ViewAt({300.0, 200.0}, {160.0, 0.0}, down), kBoard).skew == Approx(0.4));
  });
  CHECK(PlaceOf(ViewAt({300.0, 200.0}, {160.0, 0.0}, {80.0, 40.0}), kBoard).skew == 1.0);
}

ViewResult Used(const BoardView& view) { return {.view = view, .used = true}; }

TEST_CASE("Coverage is how far the views span, size and skew from none at all") {
  std::vector<ViewResult> views;
  CHECK(CoverageOf(views, kBoard).size == 0.0);
  CHECK(CoverageOf(views, kBoard).picture == 0.0);
  views.push_back(Used(ViewAt({100.0, 200.0}, {160.0, 0.0}, {0.0, 40.0})));
  const ViewPlace first = PlaceOf(views[0].view, kBoard);
  Coverage covered = CoverageOf(views, kBoard);
  CHECK(covered.x == 0.0);
  CHECK(covered.y == 0.0);
  CHECK(covered.size == Approx(first.size / 0.4));
  CHECK(covered.skew == Approx(0.0).margin(1e-9));
  views.push_back(Used(ViewAt({500.0, 120.0}, {160.0, 0.0}, {4.0, 40.0})));
  views.push_back({.view = ViewAt({700.0, 0.0}, {300.0, 0.0}, {150.0, 300.0}), .used = false});
  covered = CoverageOf(views, kBoard);
  const ViewPlace second = PlaceOf(views[1].view, kBoard);
  CHECK(covered.x == Approx((second.x - first.x) / 0.7));
  CHECK(covered.y == Approx((first.y - second.y) / 0.7));
  CHECK(covered.skew == Approx(second.skew / 0.5));
}

TEST_CASE("The picture is covered by the cells of eight by six that hold a corner") {
  // Columns 100, 300, ... 900 px are cells 0, 2, 4, 5, 7 of 125 px; rows 20, 120, 220: 0, 1, 3.
  const BoardView view = ViewAt({100.0, 20.0}, {800.0, 0.0}, {0.0, 200.0});
  std::set<int> columns, rows;
  for (const Eigen::Vector2d& corner : view.corners) {
    columns.insert(static_cast<int>(corner.x() / 125.0));
    rows.insert(static_cast<int>(corner.y() * 6.0 / 400.0));
  }
  REQUIRE((columns.size() == 5 && rows.size() == 3));
  CHECK(CoverageOf({Used(view)}, kBoard).picture == Approx(15.0 / 48.0));
  CHECK(CoverageOf({Used(view), Used(view)}, kBoard).picture == Approx(15.0 / 48.0));
}

/// A board as somebody holds it who does what the advice says.
BoardView Held(const ViewPlace& place) {
  const auto outline = OutlineAt(place, kBoard, kWidth_px, kHeight_px);
  BoardView view = ViewAt(outline[0], outline[1] - outline[0], outline[3] - outline[0]);
  return view;
}

TEST_CASE("Where a flat board is drawn it is at the place that was asked for") {
  for (const double x : {0.3, 0.5, 0.7}) {
    for (const double y : {0.45, 0.5, 0.55}) {
      const ViewPlace place = PlaceOf(Held({x, y, 0.25, 0.0}), kBoard);
      CHECK(place.x == Approx(x));
      CHECK(place.y == Approx(y));
      CHECK(place.size == Approx(0.25));
      CHECK(place.skew == Approx(0.0).margin(1e-9));
    }
  }
}

TEST_CASE("A board is drawn wholly in the picture with the squares around its corners") {
  test::OnBothSides("left and up", "right and down", [](const test::Side& side) {
    const double end = side.IsFirst() ? 0.0 : 1.0;
    for (const double skew : {0.0, 0.6}) {
      const ViewPlace place{end, end, 0.25, skew};
      const BoardView view = Held(place);
      double least_x = 1e9, most_x = -1e9, least_y = 1e9, most_y = -1e9;
      for (const Eigen::Vector2d& corner : view.corners) {
        least_x = std::min(least_x, corner.x());
        most_x = std::max(most_x, corner.x());
        least_y = std::min(least_y, corner.y());
        most_y = std::max(most_y, corner.y());
      }
      // The board of 5 by 3 corners has an aspect of 4 to 2.
      const double side_px = 0.25 * std::sqrt(1.0 * kWidth_px * kHeight_px);
      const double square_px = side_px * std::sqrt(2.0) / 4.0;
      CHECK((side.IsFirst() ? least_x : kWidth_px - most_x) == Approx(1.2 * square_px));
      CHECK((side.IsFirst() ? least_y : kHeight_px - most_y) == Approx(1.2 * square_px));
      if (skew == 0.0) CHECK(most_x - least_x == Approx(4.0 * square_px));
      if (skew == 0.0) CHECK(most_y - least_y == Approx(2.0 * square_px));
    }
  });
}

TEST_CASE("A tilted board is drawn short across its diagonal and as large as it is asked for") {
  const BoardView view = Held({0.5, 0.5, 0.25, 0.6});
  const ViewPlace place = PlaceOf(view, kBoard);
  CHECK(place.size == Approx(0.25));
  CHECK(place.skew > 0.3);
  const auto outline = OutlineAt({0.5, 0.5, 0.25, 0.6}, kBoard, kWidth_px, kHeight_px);
  const auto flat = OutlineAt({0.5, 0.5, 0.25, 0.0}, kBoard, kWidth_px, kHeight_px);
  const Eigen::Vector2d along = Eigen::Vector2d(1.0, 1.0).normalized(),
                        across(along.y(), -along.x());
  const double shortened = std::cos(40.0 * M_PI / 180.0);
  const auto ratio = [&](const Eigen::Vector2d& axis) {
    return (outline[2] - outline[0]).dot(axis) / (flat[2] - flat[0]).dot(axis);
  };
  CHECK(ratio(across) / ratio(along) == Approx(shortened));
}

TEST_CASE("A board is drawn tilted from a skew of three tenths on, by as much whatever the skew") {
  const auto drawn = [](double skew) {
    return OutlineAt({0.5, 0.5, 0.25, skew}, kBoard, kWidth_px, kHeight_px);
  };
  CHECK((drawn(0.29) == drawn(0.0)));
  CHECK((drawn(0.31) == drawn(0.6)));
  CHECK((drawn(0.31) != drawn(0.0)));
}

TEST_CASE("Who does what is said next covers everything, and then nothing is said") {
  std::vector<ViewResult> views;
  std::vector<std::string> texts;
  for (NextView next = NextViewFor(views, kBoard, 0.7); !next.text.empty();
       next = NextViewFor(views, kBoard, 0.7)) {
    REQUIRE(views.size() < 12);
    texts.push_back(next.text);
    const bool is_left = next.place.x<0.33, is_right = next.place.x> 0.67;
    CHECK((next.text.find("left") != std::string::npos) == is_left);
    CHECK((next.text.find("right") != std::string::npos) == is_right);
    CHECK((next.text.find("upper") != std::string::npos) == (next.place.y < 0.33));
    CHECK((next.text.find("lower") != std::string::npos) == (next.place.y > 0.67));
    CHECK((next.text.find("near, so that") != std::string::npos) == (next.place.size > 0.4));
    CHECK((next.text.find("tilted") != std::string::npos) == (next.place.skew > 0.3));
    views.push_back(Used(Held(next.place)));
  }
  CHECK(texts.front() ==
        "hold the board at the upper left corner of the picture, near, so that it fills half of "
        "the picture, tilted by 40 degrees, one corner nearer than the opposite one");
  const Coverage covered = CoverageOf(views, kBoard);
  CHECK(std::min({covered.x, covered.y, covered.size, covered.skew}) >= 0.7);
  CHECK(NextViewFor(views, kBoard, 1.01).text != "");
}

TEST_CASE("Where the board goes next is a corner, an edge or the middle of the picture") {
  std::vector<ViewResult> views;
  std::set<std::string> kinds;
  for (int i = 0; i < 40; ++i) {
    const NextView next = NextViewFor(views, kBoard, 1.01);
    const bool is_beside = std::abs(next.place.x - 0.5) > 0.2,
               is_above = std::abs(next.place.y - 0.5) > 0.2;
    const std::string kind = is_beside && is_above   ? "corner of"
                             : is_beside || is_above ? "edge of"
                                                     : "in the middle of";
    INFO(next.text);
    for (const char* other : {"corner of", "edge of", "in the middle of"}) {
      CHECK((next.text.find(other + std::string(" the picture")) != std::string::npos) ==
            (other == kind));
    }
    kinds.insert(kind);
    views.push_back(Used(Held(next.place)));
  }
  CHECK(kinds.size() >= 2);
}

TEST_CASE("Views that were not used do not keep the next one from being asked for") {
  std::vector<ViewResult> views;
  for (const double end : {0.0, 1.0}) {
    views.push_back({.view = Held({end, end, 0.5, 0.6}), .used = false});
  }
  CHECK_FALSE(NextViewFor(views, kBoard, 0.5).text.empty());
}

TEST_CASE("The next place is where the coverage grows most, and of equals the one farthest off") {
  const auto next = [](const std::vector<ViewPlace>& taken, double enough = 0.7) {
    std::vector<ViewResult> views;
    for (const ViewPlace& place : taken) views.push_back(Used(Held(place)));
    return NextViewFor(views, kBoard, enough).place;
  };
  const auto is = [](const ViewPlace& a, const ViewPlace& b) {
    return a.x == b.x && a.y == b.y && a.size == b.size && a.skew == b.skew;
  };
  CHECK(is(next({}), {0.05, 0.05, 0.5, 0.6}));
  // Far and tilted there is one: the opposite corner, near and flat.
  CHECK(is(next({{0.05, 0.05, 0.25, 0.6}}), {0.95, 0.95, 0.5, 0.05}));
  CHECK(is(next({{0.95, 0.95, 0.25, 0.6}}), {0.05, 0.05, 0.5, 0.05}));
  CHECK(is(next({{0.05, 0.95, 0.25, 0.6}}), {0.95, 0.05, 0.5, 0.05}));
  // Where only tilt is missing it is asked for away from what there is.
  const ViewPlace tilted = next({{0.05, 0.05, 0.5, 0.05}, {0.95, 0.95, 0.5, 0.05}});
  CHECK(tilted.skew == 0.6);
  CHECK(tilted.size == 0.25);
  CHECK(std::abs(tilted.x - tilted.y) == Approx(0.9));
  const ViewPlace nearer = next({{0.05, 0.95, 0.25, 0.6}, {0.95, 0.05, 0.25, 0.6}});
  CHECK(nearer.size == 0.5);
  CHECK(nearer.skew == 0.05);
  CHECK(std::abs(nearer.x - nearer.y) < 0.5);
}

TEST_CASE("A way is told from the first step that is worth it, in each direction") {
  const ViewPlace now{0.5, 0.5, 0.4, 0.2};
  CHECK(WayTo(now, {0.5 + 0.199, 0.5 - 0.199, 0.4 + 0.069, 0.29}).empty());
  CHECK(WayTo(now, {0.5 - 0.199, 0.5 + 0.199, 0.4 - 0.069, 0.0}).empty());
  CHECK(WayTo(now, {0.71, 0.5, 0.4, 0.2}) == "move it right in the picture");
  CHECK(WayTo(now, {0.29, 0.5, 0.4, 0.2}) == "move it left in the picture");
  CHECK(WayTo(now, {0.5, 0.71, 0.4, 0.2}) == "move it down in the picture");
  CHECK(WayTo(now, {0.5, 0.29, 0.4, 0.2}) == "move it up in the picture");
  CHECK(WayTo(now, {0.71, 0.29, 0.471, 0.2}) ==
        "move it right and up in the picture, bring it nearer");
  CHECK(WayTo(now, {0.5, 0.5, 0.329, 0.2}) == "take it farther away");
  CHECK(WayTo(now, {0.5, 0.5, 0.4, 0.31}) ==
        "tilt it by 40 degrees, one corner nearer than the opposite one");
  const ViewPlace tilted{0.5, 0.5, 0.4, 0.31};
  CHECK(WayTo(tilted, {0.5, 0.5, 0.4, 0.6}).empty());
  CHECK(WayTo(tilted, {0.5, 0.5, 0.4, 0.29}) == "turn it to face the camera");
}

TEST_CASE("A board as large as the picture is wanted in its middle") {
  const auto outline = OutlineAt({0.05, 0.95, 1.6, 0.0}, kBoard, kWidth_px, kHeight_px);
  const Eigen::Vector2d middle = (outline[0] + outline[2]) / 2.0;
  CHECK(middle.x() == Approx(500.0));
  CHECK(middle.y() == Approx(200.0));
}

TEST_CASE("What is covered in the picture's width, or in its height, is asked for in the other") {
  const auto next = [](const std::vector<ViewPlace>& taken) {
    std::vector<ViewResult> views;
    for (const ViewPlace& place : taken) views.push_back(Used(Held(place)));
    return NextViewFor(views, kBoard, 0.7);
  };
  const ViewPlace near_in_middle{0.5, 0.5, 0.5, 0.6};
  const NextView higher = next({near_in_middle, {0.05, 0.5, 0.25, 0.6}, {0.95, 0.5, 0.25, 0.6}});
  CHECK_FALSE(higher.text.empty());
  CHECK(std::abs(higher.place.y - 0.5) == Approx(0.45));
  const NextView aside = next({near_in_middle, {0.5, 0.05, 0.25, 0.6}, {0.5, 0.95, 0.25, 0.6}});
  CHECK_FALSE(aside.text.empty());
  CHECK(std::abs(aside.place.x - 0.5) == Approx(0.45));
}

}  // namespace
}  // namespace rift::vision
