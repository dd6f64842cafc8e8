// The world frame from clicked points, as far as no window is opened for them.
#include "rift/view/world_clicks.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "rift/view/window.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/processes/environment.hpp"
#include "support/tree.hpp"

namespace rift::view {
namespace {

/// Sets a frame by clicks on the pictures of a recording.
vision::WorldFrame Click(const std::vector<vision::FloorMark>& points) {
  vision::CameraSession session(test::SourceDir() + "/data/camera/frames/*.jpg",
                                test::PaperCamera(), {.fps = 15.0}, {});
  const vision::SessionOptions options;
  return WorldFromClicks({session, options, [] { return false; }}, points);
}

TEST_CASE("Without a display points cannot be clicked, and that is said with its reason") {
  const test::Environment display("DISPLAY", "");
  const std::vector<vision::FloorMark> points{{.name = "a", .x_m = 0.0, .y_m = 0.0},
                                              {.name = "b", .x_m = 1.0, .y_m = 0.0},
                                              {.name = "c", .x_m = 1.0, .y_m = 0.5},
                                              {.name = "d", .x_m = 0.0, .y_m = 0.5}};
  CHECK_THROWS_AS(Click(points), std::runtime_error);
  CHECK_THROWS_WITH(Click(points), MissingDisplay() + ": points cannot be clicked, use tags");
}

TEST_CASE("Points that make no frame are refused before a window is looked for, by their x and y") {
  const test::Environment display("DISPLAY", "");
  std::vector<vision::FloorMark> points(4);
  for (const bool is_along_x : {true, false}) {
    for (int i = 0; i < 4; ++i) {
      (is_along_x ? points[i].x_m : points[i].y_m) = 0.5 * i;
      (is_along_x ? points[i].y_m : points[i].x_m) = 0.25;
    }
    CHECK_THROWS_AS(Click(points), std::invalid_argument);
    CHECK_THROWS_WITH(Click(points), Catch::Contains("these lie on a line"));
  }
  points[2].x_m += 0.3;
  CHECK_THROWS_AS(Click(points), std::runtime_error);
  points.pop_back();
  CHECK_THROWS_WITH(Click(points), Catch::Contains("needs 4 points that are seen, there are 3"));
}

}  // namespace
}  // namespace rift::view
