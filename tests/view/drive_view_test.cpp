#include "rift/view/drive_view.hpp"

#include <catch2/catch.hpp>

namespace rift::view {
namespace {

TEST_CASE("Any key in the window stops a robot under way, before that the keys that give up") {
  const TrackInput none, space{.any_key = true}, quit{.quit = true, .any_key = true},
      closed{.quit = true, .closed = true};
  CHECK(WishOf(none, false) == DriveWish::kGoOn);
  CHECK(WishOf(none, true) == DriveWish::kGoOn);
  CHECK(WishOf(space, false) == DriveWish::kGoOn);
  CHECK(WishOf(space, true) == DriveWish::kStopByKey);
  for (const bool is_started : {false, true}) {
    CHECK(WishOf(quit, is_started) == DriveWish::kStopByKey);
    CHECK(WishOf(closed, is_started) == DriveWish::kStopByClosing);
  }
}

}  // namespace
}  // namespace rift::view
