#include <catch2/catch.hpp>

#include "vision/camera/sources.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

std::string WhyItEnded(Reconnection& connection, const std::string& reason, double now_s) {
  try {
    connection.Broke(reason, now_s);
  } catch (const CameraError& error) {
    CHECK(error.state == CameraState::kUnplugged);
    return error.what();
  }
  return "";
}

TEST_CASE("A connection that never gave a picture is not made again") {
  Reconnection connection(10.0);
  CHECK(WhyItEnded(connection, "no route", 100.0) == "no route");
}

TEST_CASE("A connection that broke is tried again after half a second until its limit") {
  Reconnection connection(10.0);
  connection.Works(100.0);
  CHECK(connection.Interruption().empty());
  CHECK(WhyItEnded(connection, "reset by peer", 100.2).empty());
  CHECK(connection.Interruption() == "reset by peer");
  CHECK_FALSE(connection.IsDue(100.69));
  CHECK(connection.IsDue(100.7));
  connection.Tries();
  connection.Tries();
  CHECK(connection.Count() == 2);
  CHECK(WhyItEnded(connection, "refused", 110.0).empty());  // exactly as long as is put up with
  CHECK(WhyItEnded(connection, "refused", 110.1) == "refused; it did not come back within 10 s");
}

TEST_CASE("A picture begins the limit anew and ends the interruption") {
  Reconnection connection(2.0);
  connection.Works(10.0);
  CHECK(WhyItEnded(connection, "reset", 11.0).empty());
  connection.Works(11.5);
  CHECK(connection.Interruption().empty());
  CHECK(WhyItEnded(connection, "reset", 13.4).empty());
  CHECK_FALSE(WhyItEnded(connection, "reset", 13.6).empty());
}

}  // namespace
}  // namespace rift::vision
