// What rift track refuses before it opens a camera: each part of each rule by itself.
#include "commands/track/request.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "support/processes/process.hpp"

namespace rift::commands {
namespace {

using Catch::Matchers::Contains;
using Change = std::function<void(TrackRequest&)>;

/// Of a kind that is taken as it is.
struct Asked {
  test::TemporaryFolder folder;
  TrackRequest request;

  explicit Asked(const Change& kind) {
    test::WriteText(folder / "camera.yaml", "x");
    test::WriteText(folder / "task.yaml", "x");
    kind(request);
    InFolder();
    CHECK_NOTHROW(request.Check());
  }
  /// @ is the folder.
  void InFolder() {
    for (std::string* name :
         {&request.out, &request.job.calibration, &request.job.world, &request.experiment,
          &request.images, &request.picture, &request.print_tag, &request.print_board,
          &request.copies.tum, &request.copies.mcap, &request.job.times}) {
      if (name->starts_with("@")) *name = folder / name->substr(1);
    }
    request.job.log = request.out;
  }
  void Refuses(const std::string& words, const Change& change) {
    const TrackRequest before = request;
    change(request);
    InFolder();
    INFO(words);
    CHECK_THROWS_WITH(request.Check(), Contains(words));
    request = before;
  }
};

void Tracking(TrackRequest& request) {
  request.job.camera = "/dev/video0";
  request.job.calibration = "@camera.yaml";
  request.out = "@log.csv";
}

TEST_CASE("Tracking needs a camera, its calibration and a log or a world frame to set") {
  Asked asked(Tracking);
  asked.Refuses("--camera is missing", [](TrackRequest& r) { r.job.camera.clear(); });
  asked.Refuses("--calibration is missing", [](TrackRequest& r) { r.job.calibration.clear(); });
  asked.Refuses("--out LOG.csv is missing", [](TrackRequest& r) { r.out.clear(); });
  asked.Refuses("belong to --calibrate", [](TrackRequest& r) { r.images = "@photos"; });
  asked.Refuses("belong to --calibrate", [](TrackRequest& r) { r.picture = "@p.png"; });
  Asked frame([](TrackRequest& r) {
    Tracking(r);
    r.out.clear();
    r.job.world = "first";
  });
}

TEST_CASE("A log of tracking replaces neither the experiment nor the times it reads") {
  Asked asked([](TrackRequest& r) {
    Tracking(r);
    r.experiment = "@task.yaml";
    r.job.times = "@times.txt";
    r.job.force = true;
  });
  asked.Refuses("is an input", [](TrackRequest& r) { r.out = "@task.yaml"; });
  asked.Refuses("is an input", [](TrackRequest& r) { r.out = "@times.txt"; });
  asked.Refuses("is an input", [](TrackRequest& r) { r.out = "@camera.yaml"; });
  asked.Refuses("another output", [](TrackRequest& r) { r.copies.tum = "@log.csv"; });
  asked.Refuses("another output", [](TrackRequest& r) { r.copies.mcap = "@log.csv"; });
}

TEST_CASE("Copies are of a log of one robot that is written to a file") {
  for (std::string LogCopies::*copy : {&LogCopies::tum, &LogCopies::mcap}) {
    Asked asked([copy](TrackRequest& r) {
      Tracking(r);
      r.job.ids = {3};
      r.copies.*copy = "@copy";
    });
    asked.Refuses("are copies of a log", [](TrackRequest& r) { r.check = true; });
    asked.Refuses("are copies of a log", [](TrackRequest& r) { r.calibrate = true; });
    asked.Refuses("are copies of a log", [](TrackRequest& r) { r.out.clear(); });
    asked.Refuses("are copies of a log", [](TrackRequest& r) { r.out = "-"; });
    asked.Refuses("hold one robot", [](TrackRequest& r) { r.job.ids = {3, 4}; });
  }
}

TEST_CASE("Each of several robots has a tag of its own") {
  Asked asked([](TrackRequest& r) {
    Tracking(r);
    r.job.ids = {3, 4, 5};
  });
  asked.Refuses("--id: 4 is named twice", [](TrackRequest& r) { r.job.ids = {3, 4, 4}; });
  asked.Refuses("--id: 3 is named twice", [](TrackRequest& r) { r.job.ids = {3, 4, 3}; });
}

TEST_CASE("The picture of a calibration is a PNG or JPEG before any is taken") {
  Asked asked([](TrackRequest& r) {
    r.calibrate = true;
    r.images = "@photos";
    r.out = "@cam.yaml";
  });
  for (const char* name : {"@seen.pdf", "@seen", "@seen.pngg", "@png"}) {
    asked.Refuses("give it a name that ends in .png or .jpg",
                  [name](TrackRequest& r) { r.picture = name; });
  }
  for (const char* name : {"@seen.png", "@seen.JPG", "@seen.jpeg"}) {
    asked.request.picture = name;
    asked.InFolder();
    CHECK_NOTHROW(asked.request.Check());
  }
}

TEST_CASE("A check of precision is of one camera that is not opened, and replaces no input") {
  Asked asked([](TrackRequest& r) {
    r.check = true;
    r.experiment = "@task.yaml";
    r.job.calibration = "@camera.yaml";
    r.out = "@map.json";
  });
  asked.Refuses("exclude each other", [](TrackRequest& r) { r.calibrate = true; });
  asked.Refuses("--check is about one camera", [](TrackRequest& r) { r.job.calibration.clear(); });
  const std::string opens = "--check opens no camera";
  asked.Refuses(opens, [](TrackRequest& r) { r.job.camera = "/dev/video0"; });
  asked.Refuses(opens, [](TrackRequest& r) { r.job.world = "first"; });
  asked.Refuses(opens, [](TrackRequest& r) { r.job.view = true; });
  asked.Refuses("belong to --calibrate", [](TrackRequest& r) { r.images = "@photos"; });
  asked.Refuses("belong to --calibrate", [](TrackRequest& r) { r.picture = "@p.png"; });
  asked.Refuses("is an input", [](TrackRequest& r) { r.out = "@camera.yaml"; });
  asked.Refuses("is an input", [](TrackRequest& r) { r.out = "@task.yaml"; });
  test::WriteText(asked.folder / "map.json", "x");
  asked.Refuses("is there already", [](TrackRequest&) {});
  asked.request.job.force = true;
  CHECK_NOTHROW(asked.request.Check());
  asked.request.out.clear();
  CHECK_NOTHROW(asked.request.Check());
}

TEST_CASE("A sheet to print is one tag or one board in an SVG, and nothing else is done") {
  for (std::string TrackRequest::*sheet : {&TrackRequest::print_tag, &TrackRequest::print_board}) {
    Asked asked([sheet](TrackRequest& r) { r.*sheet = "@sheet.svg"; });
    const std::string alone = "write a sheet and nothing else";
    asked.Refuses(alone, [](TrackRequest& r) { r.check = true; });
    asked.Refuses(alone, [](TrackRequest& r) { r.calibrate = true; });
    asked.Refuses(alone, [](TrackRequest& r) { r.job.camera = "/dev/video0"; });
    asked.Refuses(alone, [](TrackRequest& r) { r.out = "@log.csv"; });
    asked.Refuses("ends in .svg", [sheet](TrackRequest& r) { r.*sheet = "@sheet.png"; });
    asked.Refuses("exclude each other", [](TrackRequest& r) {
      r.print_tag = "@a.svg";
      r.print_board = "@b.svg";
    });
    asked.Refuses("--print-tag makes one tag", [](TrackRequest& r) { r.job.ids = {3, 4}; });
    test::WriteText(asked.folder / "sheet.svg", "x");
    asked.Refuses("is there already", [](TrackRequest&) {});
    asked.request.job.force = true;
    CHECK_NOTHROW(asked.request.Check());
    asked.request.job.ids = {3};  // a single tag may be said
    CHECK_NOTHROW(asked.request.Check());
  }
}

TEST_CASE("A calibration is of photographs or of a camera, and its picture lies beside it") {
  Asked photographs([](TrackRequest& r) {
    r.calibrate = true;
    r.images = "@photos";
    r.out = "@new.yaml";
  });
  photographs.Refuses("wants either", [](TrackRequest& r) { r.job.camera = "/dev/video0"; });
  photographs.Refuses("wants either", [](TrackRequest& r) { r.images.clear(); });
  photographs.Refuses("--view shows a camera", [](TrackRequest& r) { r.job.view = true; });
  photographs.Refuses("--out CAM.yaml is missing", [](TrackRequest& r) { r.out.clear(); });
  photographs.Refuses("another output", [](TrackRequest& r) { r.picture = "@new.yaml"; });
  CHECK(PictureOf(photographs.request) == photographs.folder / "new.png");
  test::WriteText(photographs.folder / "new.png", "x");
  photographs.Refuses("new.png is there already", [](TrackRequest&) {});
  photographs.request.picture = photographs.folder / "other.png";
  CHECK(PictureOf(photographs.request) == photographs.folder / "other.png");
  CHECK_NOTHROW(photographs.request.Check());
  Asked camera([](TrackRequest& r) {
    r.calibrate = true;
    r.job.camera = "/dev/video0";
    r.job.view = true;
    r.out = "@new.yaml";
  });
}

}  // namespace
}  // namespace rift::commands
