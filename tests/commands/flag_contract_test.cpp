// Each flag that the help of a command names, on a command line of its own: the exit code it ends
// with, and something that is there with the flag and not without. A new flag without a row fails.
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>

#include "support/flag_contract.hpp"
#include "support/inputs/png_bytes.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using test::CheckFlags;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

const std::string kWaypoints =
    "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n";

/// More than the bytes that are taken of a YAML file (docs/limits.md).
const std::string kPadding = "# " + std::string(1'100'000, '-') + "\n";

void Need(const std::vector<std::string>& words) {
  const test::ProcessResult result = RunRift(words);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
}

TEST_CASE("Each flag of rift itself does what its row says") {
  CheckFlags("", [](const TemporaryFolder&) {},
             {{"--help", "", "-", 0, "out Usage: rift [OPTIONS] SUBCOMMAND"},
              {"--version", "", "-", 0, "out commit: "}});
}

TEST_CASE("Each flag of rift gap does what its row says") {
  const std::string logs =
      "%data/example/simulator.csv %data/example/robot1.csv %data/example/robot2.csv";
  const std::string json = logs + " --json -";
  const std::string own = "@own.csv @own2.csv --json -", named = "t=time,x=px,y=py";
  const std::string runs = "@lap1 @lap2 --json -", odometry = runs + " --odometry";
  const auto prepare = [](const TemporaryFolder& folder) {
    for (const std::string n : {"", "2"}) {
      WriteText(folder / ("own" + n + ".csv"),
                "time,px,py\n0,0,0\n1,100,10" + n + "\n2,200,0\n3,300,0\n");
    }
    WriteText(folder / "metres.csv", "t_s,x_m,y_m\n0,0,0\n1,0.1,0\n2,0.3,0\n");
    WriteText(folder / "there.json", "x");
    WriteText(folder / "lap.yaml", "include: " + test::SourceDir() +
                                       "/configs/encoders.yaml\nprogram: {power: 0.5, laps: 1}\n");
    WriteText(folder / "long.yaml",
              "include: " + folder / "lap.yaml" + "\nprogram: {segments: [{straight_m: 3}]}\n");
    Need({"simulate", folder / "lap.yaml", "--out", folder / "lap1"});
    Need({"simulate", folder / "lap.yaml", "--out", folder / "lap2", "--seed", "2"});
  };
  CheckFlags(
      "gap", prepare,
      {{"--help", "", "-", 0, "out Usage: rift gap"},
       {"--samples", "50", json, 0, "json /definition/samples 50"},
       {"--skip-start", "0.1", json, 0, "changes /trials/0/gap_m"},
       {"--dimension", "xyz", json, 0, "changes /trials/0/gap_m"},
       {"--align", "start", json, 0, "changes /trials/0/gap_m"},
       {"--threshold", "0.03", json, 0, "json /trials/1/falsified true"},
       {"--trim-standstill", "", json, 0, "changes /trials/0/gap_m"},
       {"--standstill-radius", "0.2", json + " --trim-standstill", 0, "changes /trials/0/gap_m"},
       {"--share", "0.6", json + " --threshold 0.01", 0, "changes /repeats/share"},
       {"--confidence", "0.6", json, 0, "changes /repeats/share_high"},
       {"--tag-offset", "0.03", json, 0, "changes /trials/0/gap_m"},
       {"--sim-format", "tum", json, 2, "err simulator.csv"},
       {"--real-format", "webots", json, 2, "err robot1.csv"},
       {"--columns", named, own, 0, "out \"gap_m\""},
       {"--units", "mm", own + " --columns " + named, 0, "changes /trials/0/gap_m"},
       {"--sim-columns", named, "@own.csv @metres.csv --json -", 0, "out \"gap_m\""},
       {"--sim-units", "mm", "@own.csv @metres.csv --json - --sim-columns " + named, 0,
        "changes /trials/0/gap_m"},
       {"--real-columns", named, "@metres.csv @own.csv --json -", 0, "out \"gap_m\""},
       {"--real-units", "mm", "@metres.csv @own.csv --json - --real-columns " + named, 0,
        "changes /trials/0/gap_m"},
       {"--sim-repeats", "%data/example/robot1.csv", json, 0, "json /likeness/sims 2"},
       {"--json", "@gap.json", logs, 0, "file gap.json \"gap_m\""},
       {"--profile", "@profile.csv", logs, 0, "file profile.csv u,"},
       {"--figure", "@gap.svg", logs, 0, "file gap.svg </svg>"},
       {"--exit-code", "", logs + " --threshold 0.03", 1, "exit"},
       {"--force", "", logs + " --json @there.json", 0, "file there.json \"gap_m\""},
       {"--odometry", "", runs, 0, "json /runs/0/did_move true"},
       {"--program", "@lap.yaml", runs, 0, "json /runs/0/did_move true"},
       {"--calibrate-odometry", "", odometry + " --window 0.3", 0, "json /calibration/runs 2"},
       {"--slip-bins", "5", odometry, 0, "changes /runs/0/slip/u/0"},
       {"--moved-share", "0.9", runs + " --program @long.yaml", 0, "json /runs/0/did_move false"},
       {"--tag-ahead", "0.05", odometry, 0, "changes /runs/0/deviation_m"},
       {"--window", "0.3", odometry + " --calibrate-odometry", 0, "json /calibration/runs 2"},
       {"--large-inputs", "", logs + " --samples 1000001", 0, "no-err --large-inputs lifts"}});
}

TEST_CASE("Each flag of rift simulate does what its row says") {
  const test::QuickGnuplot gnuplot;
  const test::Environment display("DISPLAY", "");
  const std::string run = "@task.yaml --out @run";
  const auto prepare = [](const TemporaryFolder& folder) {
    WriteText(folder / "task.yaml", kWaypoints);
    WriteText(folder / "out.yaml", kWaypoints + "trial: {arena: {x_max_m: 0.1}}\n");
    WriteText(folder / "grid.yaml",
              kWaypoints + "reference: {kind: path}\nspace: {v_min: [0.2]}\n");
    WriteText(folder / "large.yaml", kWaypoints + kPadding);
    WriteText(folder / "there.csv", "x");
    Need({"sweep", folder / "grid.yaml", "--out", folder / "swept", "--quiet"});
  };
  CheckFlags(
      "simulate", prepare,
      {{"--help", "", "-", 0, "out Usage: rift simulate"},
       {"--set", "control.v_min=0.2", run, 0, "differs run/trajectory.csv"},
       {"--start", "0,0.01,5", run, 0, "differs run/trajectory.csv"},
       {"--seed", "7", run + " --set simulation.motor.mismatch_spread=0.1", 0,
        "differs run/trajectory.csv"},
       {"--out", "@log.csv @task.yaml", "-", 0, "file log.csv t_s,"},
       {"--force", "", "@task.yaml --out @there.csv", 0, "file there.csv t_s,"},
       {"--any-waypoints", "", "@out.yaml --out @run", 1, "file run/trajectory.csv"},
       {"--tum", "@log.tum", run, 0, "file log.tum"},
       {"--mcap", "@log.mcap", run, 0, "file log.mcap MCAP"},
       {"--replay", "@swept 1", "--out @run", 0, "err to the last bit as in the table"},
       {"--figure", "@run.svg", run, 0, "file run.svg </svg>"},
       {"--video", "@run.mp4", run, 0, "file run.mp4 ftyp"},
       {"--view", "", run, 0, "err note: --view shows nothing: no window: DISPLAY is not set"},
       {"--twin", "", run, 0,
        "test The twin is seen to drive as it is told and to stop after the last command"},
       {"--keys", "", "", 0, "out control.v_min:"},
       {"--json", "", run, 0, "json /outcome \"reached\""},
       {"--large-inputs", "", "@large.yaml --out @run", 0, "no-err --large-inputs lifts"}});
}

TEST_CASE("Each flag of rift sweep does what its row says") {
  const test::QuickGnuplot gnuplot;
  const std::string grid = "@grid.yaml --out @out", search = "@search.yaml --out @out --json";
  const std::string change = "--compare @swept @other";
  const auto prepare = [](const TemporaryFolder& folder) {
    const std::string task = kWaypoints + "gap: {threshold_m: 0.001}\nreference: {kind: path}\n";
    WriteText(folder / "grid.yaml", task + "space: {control.v_min: [0.14, 0.2]}\n");
    WriteText(folder / "out.yaml",
              kWaypoints + "trial: {arena: {x_max_m: 0.1}}\nspace: {control.v_min: [0.14]}\n");
    WriteText(folder / "search.yaml",
              task +
                  "goal: falsify\nsearch: {budget: 40}\nfalsify: {until: budget}\n"
                  "space: {control.v_min: {min: 0.14, max: 0.2}}\n");
    WriteText(folder / "large.yaml", task + "space: {control.v_min: [0.14]}\n" + kPadding);
    Need({"sweep", folder / "grid.yaml", "--out", folder / "swept", "--quiet"});
    Need({"sweep", folder / "grid.yaml", "--out", folder / "other", "--quiet", "--set",
          "simulation.motor.mismatch=0.1"});
  };
  CheckFlags(
      "sweep", prepare,
      {{"--help", "", "-", 0, "out Usage: rift sweep"},
       {"--set", "gap.skip_start=0.5", grid, 0, "differs out/table.csv"},
       {"--out", "@out @grid.yaml", "-", 0, "file out/table.csv"},
       {"--budget", "3", search, 0, "json /falsification/evaluations 3"},
       {"--seconds", "0.001", search, 0, "changes /falsification/evaluations"},
       {"--jobs", "1", grid, 0, "test A sweep gives the same bytes for one worker and for two"},
       {"--fresh", "", "@grid.yaml --out @other", 0, "exit"},
       {"--force", "", "@grid.yaml --out @other", 0, "exit"},
       {"--any-waypoints", "", "@out.yaml --out @out", 1, "file out/table.csv left_arena"},
       {"--status", "@swept", "", 0, "out grid: done"},
       {"--compare", "@swept @other", "", 0, "out gap"},
       {"--page", "@change.html", change, 0, "file change.html <html"},
       {"--engine", "", "", 0,
        "test A grid in shards gives the files of a local run, byte for byte"},
       {"--partition", "", "", 0,
        "test What a cluster wants of its jobs stands in the arguments and the script of an array"},
       {"--shards", "", "", 0,
        "test A grid in shards gives the files of a local run, byte for byte"},
       {"--shard", "", "", 0, "test A shard that is there already is not computed again"},
       {"--copy-every", "", "", 0, "test Wrong input: rift sweep"},
       {"--suggest", "2", grid, 0, "file out/suggested.yaml control.v_min"},
       {"--shrink", "worst", grid, 0, "file out/shrunk.json"},
       {"--rare-event", "", "", 0,
        "test A rare event is estimated over the space with an interval"},
       {"--keys", "", "", 0, "out search.budget:"},
       {"--brief", "", grid, 0, "out what fails:"},
       {"--quiet", "", grid, 0, "no-err report: "},
       {"--json-progress", "", grid, 0, "err {\"state\":\"done\",\"done\":2,"},
       {"--json", "", grid, 0, "json /n 2"},
       {"--write-robot", "", "", 0,
        "test A calibration finds the mismatch and its robot file is used as an include"},
       {"--serve", "", "", 0,
        "test A sweep shows its report growing at an address of this machine alone"},
       {"--exit-code", "", grid, 1, "exit"},
       {"--large-inputs", "", "@large.yaml --out @out", 0, "no-err --large-inputs lifts"}});
}

// A robot on a recording: what needs a live one is held to its effect in tests/drive.
TEST_CASE("Each flag of rift drive does what its row says") {
  const std::string absent =
      " --port @gone --camera x --calibration %data/camera/camera.yaml "
      "--yes --out @run";
  const auto prepare = [](const TemporaryFolder& folder) {
    WriteText(folder / "far.yaml", kWaypoints + "trial: {arena: {x_max_m: 0.1}}\n");
    WriteText(folder / "large.yaml", kWaypoints + kPadding);
  };
  CheckFlags(
      "drive", prepare,
      {{"--help", "", "-", 0, "out Usage: rift drive"},
       {"--set", "control.v_mni=1", "@far.yaml" + absent, 2, "err did you mean 'control.v_min'"},
       {"--port", "", "", 0, "test Ping tells how the link is and which keys it sets"},
       {"--camera", "", "", 0,
        "test A device is asked for the size of its calibration as in tracking"},
       {"--calibration", "", "", 0,
        "test A device is asked for the size of its calibration as in tracking"},
       {"--moved", "", "", 0,
        "test How far the reference tags may lie off before a drive is an option of it"},
       {"--out", "", "", 0,
        "test How far the reference tags may lie off before a drive is an option of it"},
       {"--tum", "", "", 0,
        "test A simulated run and a drive are copied for evo and for Foxglove alike"},
       {"--mcap", "", "", 0,
        "test A simulated run and a drive are copied for evo and for Foxglove alike"},
       {"--view", "", "", 0,
        "test A camera that goes away in the middle stops the robot even without a display"},
       {"--yes", "", "", 0,
        "test Nobody to press a key and no yes is refused before the port is opened"},
       {"--countdown", "", "", 0,
        "test Ctrl-C in the countdown ends the drive before anything moves"},
       {"--any-start", "", "", 0, "test With any start a robot that is far off is warned of once"},
       {"--any-waypoints", "", "@far.yaml" + absent, 3, "err there is no serial port"},
       {"--ping", "", "", 0, "test Ping tells how the link is and which keys it sets"},
       {"--dry-run", "", "", 0,
        "test A dry run of the binary decides and the robot stands where it stood"},
       {"--seconds", "", "", 0,
        "test A dry run of the binary decides and the robot stands where it stood"},
       {"--repeat", "", "", 0,
        "test Repeats are driven into numbered folders and a sweep reads them"},
       {"--grid", "", "", 0,
        "test A grid driven on twins and killed in the middle goes on and ends with its report"},
       {"--identify", "", "", 0,
        "test An identification on the twin leaves a fit that the next command makes"},
       {"--suggested", "", "", 0,
        "test Suggested experiments are driven on twins and the sweep says what they confirmed"},
       {"--before-each", "", "", 0,
        "test Repeats are driven into numbered folders and a sweep reads them"},
       {"--json", "", "", 0, "test Ping tells how the link is and which keys it sets"},
       {"--replay", "", "", 0,
        "test A killed drive leaves its rows, which rift gap and a replay read"},
       {"--video", "", "", 0,
        "test A killed drive leaves its rows, which rift gap and a replay read"},
       {"--force", "", "", 0,
        "test A simulated run and a drive are copied for evo and for Foxglove alike"},
       {"--keys", "", "", 0, "out hardware.line.baud:"},
       {"--large-inputs", "", "@large.yaml" + absent, 3, "err there is no serial port"}});
}

/// A camera's recording of eight pictures, and a calibration that a world frame may be written to.
void PrepareTracking(const TemporaryFolder& folder) {
  const fs::path data = test::SourceDir() + "/data/camera";
  fs::create_directory(folder / "frames");
  fs::create_directory(folder / "one");
  // Small: a search for a board that is not there takes long.
  WriteText(folder / "one/000.png", test::RampPng(200));
  for (int i = 0; i < 8; ++i) {
    const std::string name = "frames/00" + std::to_string(i) + ".jpg";
    fs::copy(data / name, folder / name);
  }
  for (const char* name : {"camera.yaml", "tags.yaml", "waypoints.yaml"}) {
    fs::copy(data / name, folder / name);
  }
  WriteText(folder / "there.csv", "x");
  WriteText(folder / "times.txt", "0\n0.1\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n");
  WriteText(folder / "large.yaml", kPadding);
  // The same camera, moved by some millimetres since its reference tags were seen.
  Need({"track", "--camera", folder / "frames/*.jpg", "--fps", "15", "--calibration",
        folder / "camera.yaml", "--out", folder / "seen.csv", "--world", folder / "tags.yaml"});
  std::string moved = test::ReadFile(folder / "camera.yaml");
  for (const char* digits : {"u_px: 134", "u_px: 760", "u_px: 844", "u_px: 235"}) {
    moved.at(moved.find(digits) + 8) += 1;
  }
  WriteText(folder / "moved.yaml", moved);
  fs::copy(data / "camera.yaml", folder / "camera.yaml", fs::copy_options::overwrite_existing);
}

TEST_CASE("Each flag of rift track does what its row says") {
  const std::string film = "--camera @frames/*.jpg --fps 15 ", to = "--out @log.csv",
                    lens = "--calibration @camera.yaml ", track = film + lens + to,
                    tags = track + " --world @tags.yaml",
                    moved = film + "--calibration @moved.yaml " + to + " --check-every 0.1",
                    boards = "--calibrate --out @c.yaml --board 5x4 --images @one";
  CheckFlags(
      "track", PrepareTracking,
      {{"--help", "", "-", 0, "out Usage: rift track"},
       {"--set", "track.tag.id=7", track, 1, "no-file log.csv"},
       {"--camera", "@frames/*.jpg --fps 15 " + lens + to, "-", 0, "file log.csv t_s,"},
       {"--calibration", "@camera.yaml " + film + to, "-", 0, "file log.csv t_s,"},
       {"--out", "@log.csv " + film + lens, "-", 0, "file log.csv t_s,"},
       {"--tum", "@log.tum", track, 0, "file log.tum"},
       {"--mcap", "@log.mcap", track, 0, "file log.mcap MCAP"},
       {"--force", "", film + lens + "--out @there.csv", 0, "file there.csv t_s,"},
       {"--id", "7", track, 1, "no-file log.csv"},
       {"--tag-height", "0.1", track, 0, "differs log.csv"},
       {"--times", "@times.txt", track, 0, "differs log.csv"},
       {"--fps", "15", "--camera @frames/*.jpg " + lens + to, 0, "differs log.csv"},
       {"--duration", "0", track, 1, "no-file log.csv"},
       {"--world", "@tags.yaml", track, 0, "differs camera.yaml"},
       {"--check", "", "", 0,
        "test What precision to expect is said before anything is driven, as a map and as JSON"},
       {"--print-tag", "@tag.svg", "", 0, "file tag.svg <svg"},
       {"--print-board", "@board.svg", "", 0, "file board.svg <svg"},
       {"--view", "", "", 0, "test Without a display the view says so and the tracking goes on"},
       {"--path", "@none.yaml", track, 2, "err none.yaml"},
       {"--record-waypoints", "", "", 0,
        "test Waypoints clicked in the window drive the simulator as they are"},
       {"--world-average", "0", track + " --force --world first", 0, "exit"},
       {"--world-patience", "", "", 0,
        "test How long the tags that set the frame are looked for is an option of a tracking"},
       {"--world-decimate", "4", tags, 0, "differs camera.yaml"},
       {"--world-limit", "0.00001", tags, 2, "err limit 0.01 mm"},
       {"--world-scale", "0.01", tags + " --set track.tag.size_m=0.049", 2, "err the robot's tag"},
       {"--check-every", "0.1", tags, 0, "file-changes log.run.json /reference_tags_off_m"},
       {"--check-decimate", "1", tags + " --check-every 0.1", 0,
        "file-changes log.run.json /reference_tags_off_m"},
       {"--moved", "0.0001", moved, 0, "err moved"},
       {"--give-up", "", "", 0,
        "test A camera that fails ends the tracking with its state and exit code 3"},
       {"--calibrate", "", "--out @c.yaml --board 5x4 --images @one", 1, "out verdict: refuse"},
       {"--board", "5x4", "--calibrate --out @c.yaml --images @one", 1, "err 5 x 4 inner"},
       {"--square", "", "", 0,
        "test A camera is calibrated from a folder of pictures and from a recording of them"},
       {"--images", "@one", "--calibrate --out @c.yaml", 1, "err 000.png: no chessboard"},
       {"--picture", "@seen.png", boards, 1, "file seen.png PNG"},
       {"--keys", "", "", 0, "out track.tag.id:"},
       {"--large-inputs", "", "@large.yaml " + track, 0, "no-err --large-inputs lifts"}});
}

TEST_CASE("How long the tags that set the frame are looked for is an option of a tracking") {
  const TemporaryFolder folder;
  PrepareTracking(folder);
  WriteText(folder / "unseen.yaml",
            "tags:\n- {id: 96, x_m: -0.2, y_m: -0.2}\n- {id: 97, x_m: 0.2, y_m: -0.2}\n"
            "- {id: 98, x_m: 0.2, y_m: 0.2}\n- {id: 99, x_m: -0.2, y_m: 0.2}\n");
  // A live camera: a recording ends before any patience does.
  const test::Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const test::Environment jpegs("RIFT_SHIM_JPEGS", folder / "frames");
  const auto begun = std::chrono::steady_clock::now();
  const test::ProcessResult result =
      RunRift({"track", "--camera", "/dev/video0", "--calibration", folder / "camera.yaml", "--out",
               folder / "log.csv", "--set", "track.capture.silent_s=60", "--world",
               folder / "unseen.yaml", "--world-patience", "0.3"});
  INFO(result.err);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Catch::Contains("0 of 4 are seen"));
  // Less than the 20 s of the default, however busy the machine.
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(19));
}

}  // namespace
}  // namespace rift
