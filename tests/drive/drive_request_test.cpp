// What rift drive refuses before it opens a port: each part of each rule by itself.
#include "commands/drive/request.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

#include "support/processes/process.hpp"

namespace rift::commands {
namespace {

using Catch::Matchers::Contains;
using Change = std::function<void(DriveRequest&)>;

DriveRequest OneDrive() {
  DriveRequest request;
  request.experiment = "task.yaml";
  request.setup.address = {"/dev/rfcomm0", "/dev/video0", "camera.yaml"};
  return request;
}

void Refused(const DriveRequest& request, const std::string& words, const Change& change) {
  DriveRequest changed = request;
  change(changed);
  INFO(words);
  CHECK_THROWS_WITH(changed.Check(), Contains(words));
}

void Taken(const DriveRequest& request, const Change& change) {
  DriveRequest changed = request;
  change(changed);
  CHECK_NOTHROW(changed.Check());
}

TEST_CASE("A drive needs its task, its port, its camera and the calibration") {
  const DriveRequest drive = OneDrive();
  Taken(drive, [](DriveRequest&) {});
  Refused(drive, "EXPERIMENT is missing", [](DriveRequest& r) { r.experiment.clear(); });
  Refused(drive, "--port is missing", [](DriveRequest& r) { r.setup.address.port.clear(); });
  Refused(drive, "--camera is missing", [](DriveRequest& r) { r.setup.address.camera.clear(); });
  Refused(drive, "--calibration is missing",
          [](DriveRequest& r) { r.setup.address.calibration.clear(); });
  Refused(drive, "--set changes an experiment", [](DriveRequest& r) {
    r.experiment.clear();
    r.overrides = {"control.v_min=0.2"};
  });
  Taken(drive, [](DriveRequest& r) {
    r.experiment.clear();
    r.overrides = {"control.v_min=0.2"};
    r.series.suggested = "out";  // whose experiment it is
  });
}

TEST_CASE("The program before each drive of a series may tell port, camera and calibration") {
  DriveRequest series = OneDrive();
  series.setup.address = {};
  series.series.before_each = "scene";
  const std::vector<Change> kinds{[](DriveRequest& r) { r.series.repeat = 2; },
                                  [](DriveRequest& r) { r.series.grid = true; },
                                  [](DriveRequest& r) { r.series.identify = true; },
                                  [](DriveRequest& r) { r.series.suggested = "out"; }};
  for (const Change& kind : kinds) {
    Taken(series, kind);
    Refused(series, "--port is missing", [&](DriveRequest& r) {
      kind(r);
      r.series.before_each.clear();
    });
    Refused(series, "is blank: name the program", [&](DriveRequest& r) {
      kind(r);
      r.series.before_each = "  ";
    });
  }
  series.setup.address = OneDrive().setup.address;
  Refused(series, "--before-each goes with", [](DriveRequest&) {});
}

TEST_CASE("A ping needs its port alone, and an identification two drives") {
  DriveRequest ping;
  ping.ping = true;
  ping.setup.address.port = "/dev/rfcomm0";
  Taken(ping, [](DriveRequest&) {});
  Refused(ping, "--port is missing", [](DriveRequest& r) { r.setup.address.port.clear(); });
  Refused(ping, "--set changes an experiment", [](DriveRequest& r) { r.overrides = {"a=b"}; });
  DriveRequest identify = OneDrive();
  identify.series.identify = true;
  Taken(identify, [](DriveRequest&) {});
  Taken(identify, [](DriveRequest& r) { r.series.repeat = 2; });
  Refused(identify, "at least 2 drives", [](DriveRequest& r) { r.series.repeat = 1; });
}

TEST_CASE("Copies are of one drive's log, and force is for them and for a film") {
  const test::TemporaryFolder folder;
  for (std::string LogCopies::*copy : {&LogCopies::tum, &LogCopies::mcap}) {
    DriveRequest copied = OneDrive();
    copied.copies.*copy = folder / "copy";
    Taken(copied, [](DriveRequest&) {});
    Taken(copied, [](DriveRequest& r) { r.force = true; });
    Refused(copied, "are copies of one drive's log", [](DriveRequest& r) { r.ping = true; });
    Refused(copied, "are copies of one drive's log", [](DriveRequest& r) { r.series.repeat = 2; });
    test::WriteText(folder / "there", "x");
    Refused(copied, "there is there already",
            [&](DriveRequest& r) { r.copies.*copy = folder / "there"; });
    Taken(copied, [&](DriveRequest& r) {
      r.copies.*copy = folder / "there";
      r.force = true;
    });
  }
  Refused(OneDrive(), "--force is for", [](DriveRequest& r) { r.force = true; });
}

TEST_CASE("A drive that is shown again needs nothing of a robot, and its film a name of its own") {
  const test::TemporaryFolder folder;
  DriveRequest shown;
  shown.replay = folder.Path().string();
  shown.video = folder / "film.mp4";
  Taken(shown, [](DriveRequest&) {});
  Taken(shown, [](DriveRequest& r) { r.force = true; });
  Taken(shown, [](DriveRequest& r) { r.video.clear(); });
  Refused(shown, "must end in .mp4", [&](DriveRequest& r) { r.video = folder / "film.avi"; });
  Refused(shown, "another output", [](DriveRequest& r) { r.copies.tum = r.video; });
  test::WriteText(folder / "film.mp4", "x");
  Refused(shown, "is there already", [](DriveRequest&) {});
  Taken(shown, [](DriveRequest& r) { r.force = true; });
}

TEST_CASE("A drive goes into a folder, neither a file nor stdout") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "file", "x");
  for (const std::string& out : {folder / "file", std::string("-"), folder / "log.csv"}) {
    Refused(OneDrive(), "a drive is a folder", [&](DriveRequest& r) { r.out = out; });
  }
  Taken(OneDrive(), [&](DriveRequest& r) { r.out = folder / "new"; });
}

TEST_CASE("A command is parted into words at its blanks and no shell reads them") {
  CHECK(WordsOf("twin --set 'a b' $HOME") ==
        std::vector<std::string>{"twin", "--set", "a b", "$HOME"});
}

}  // namespace
}  // namespace rift::commands
