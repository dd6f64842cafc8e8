#include "sessions/drive/log.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "hardware/bench.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/drive/session.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/drive/folder.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/inputs/paper_experiment.hpp"
#include "support/processes/file_size_limit.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

using std::chrono::steady_clock;

double Since_s(steady_clock::time_point start) {
  return std::chrono::duration<double>(steady_clock::now() - start).count();
}

hardware::DriveRun DriveOnBench(const experiment::Experiment& experiment,
                                hardware::Protocol protocol, DriveLog& log) {
  hardware::Bench bench;
  bench.line_delay_s = 0.005;
  hardware::DriveTask task = DriveTaskOf(experiment);
  task.hardware.line.protocol = protocol;
  task.hardware.plain.watchdog = hardware::Watchdog::kRobot;
  return hardware::Drive({.line = bench,
                          .poses = bench,
                          .clock = bench,
                          .say = [](const auto&) {},
                          .may_arm = [] { return true; },
                          .observer = &log,
                          .threads = false},
                         task);
}

TEST_CASE("The files that grew during a drive are those of its whole record to the byte") {
  const auto protocol = GENERATE(hardware::Protocol::kFramed, hardware::Protocol::kPlain);
  const test::TemporaryFolder folder;
  const experiment::Experiment experiment = test::PaperExperiment();
  DriveLog log(WriterInto(folder.Path(), experiment));
  const hardware::DriveRun run = DriveOnBench(experiment, protocol, log);
  REQUIRE(run.trial.trajectory.poses.size() > 30);
  CHECK(CloseDrive(folder.Path(), experiment, run, log).empty());
  CHECK(files::ReadFile(folder / "trajectory.csv") == trajectory::WriteRift(run.trial.trajectory));
  CHECK(files::ReadFile(folder / "commands.csv") == report::CommandsCsv(run.trial));
  CHECK(files::ReadFile(folder / "stages.csv") == report::StagesCsv(run.evidence));
  CHECK(files::ReadFile(folder / "encoders.csv") == odometry::EncodersCsv(run.evidence.encoders));
  CHECK(files::ReadFile(folder / "summary.json") == report::DriveJson(experiment, run));
}

/// One row of each kind.
void Record(DriveLog& log, double t_s) {
  log.Row({.t_s = t_s, .x_m = t_s, .y_m = 0.0, .yaw_rad = 0.0}, std::vector<double>(4, 0.5));
  log.Sent({t_s, {0.1, 0.2}});
  const auto counts = static_cast<std::int32_t>(1000 * t_s);
  log.Recorded({{{.captured_s = t_s}}, {{t_s, {counts, counts}}}});
}

size_t Lines(const std::filesystem::path& path) {
  const std::string text = files::ReadIfThere(path).value_or("");
  return std::count(text.begin(), text.end(), '\n');
}

TEST_CASE("Rows are on disk a moment after they were recorded and the summary says interrupted") {
  const test::TemporaryFolder folder;
  DriveLog log(WriterInto(folder.Path(), test::PaperExperiment()));
  const hardware::Stopper stopper = log.Stopper();
  CHECK_FALSE(std::filesystem::exists(folder / "trajectory.csv"));  // no drive has begun
  double quickest_s = 60.0;  // a disk that others keep busy takes seconds for some of them
  for (int row = 1; row <= 3 || (quickest_s > 1.0 && row <= 30); ++row) {
    const auto start = steady_clock::now();
    Record(log, row);
    test::WaitUntil("the row is on disk", [&] {
      return Lines(folder / "trajectory.csv") == 1u + row &&
             Lines(folder / "commands.csv") == 1u + row &&
             Lines(folder / "stages.csv") == 1u + row && Lines(folder / "encoders.csv") == 1u + row;
    });
    quickest_s = std::min(quickest_s, Since_s(start));
    CHECK_FALSE(stopper());
  }
  CHECK(quickest_s < 1.0);
  const auto summary = nlohmann::json::parse(files::ReadFile(folder / "summary.json"));
  CHECK(summary["state"] == "interrupted");
  CHECK(summary["outcome"].is_null());
}

TEST_CASE("A drive that never began leaves no files of a run") {
  const test::TemporaryFolder folder;
  { const DriveLog log(WriterInto(folder.Path(), test::PaperExperiment())); }
  CHECK(std::filesystem::is_empty(folder.Path()));
}

TEST_CASE("The files are made when they are asked for, and go again when no drive follows") {
  const bool is_driven = GENERATE(false, true);
  const test::TemporaryFolder folder;
  {
    BegunFolder begun(folder.Path() / "run");
    DriveLog log(WriterInto(folder.Path() / "run", test::PaperExperiment()));
    begun.Write(test::PaperExperiment(), test::PaperCamera());
    test::WaitUntil("the files are there", [&] { return log.IsReady(); });
    CHECK_FALSE(log.Stopper()());
    for (const char* name : {"experiment.yaml", "camera.yaml", "summary.json", "trajectory.csv",
                             "commands.csv", "stages.csv", "encoders.csv"}) {
      INFO(name);
      CHECK(std::filesystem::exists(folder.Path() / "run" / name));
    }
    if (is_driven) Record(log, 1.0);
  }
  CHECK(std::filesystem::exists(folder.Path() / "run") == is_driven);
  if (is_driven) CHECK(Lines(folder / "run/trajectory.csv") == 2);
}

TEST_CASE("A file that cannot be made is told before a robot may move") {
  const test::TemporaryFolder folder;
  const std::string mine = "my own notes";
  test::WriteText(folder / "commands.csv", mine);
  {
    DriveLog log(WriterInto(folder.Path(), test::PaperExperiment()));
    const hardware::Stopper stopper = log.Stopper();
    test::WaitUntil("the drive is stopped", [&] {
      CHECK_FALSE(log.IsReady());
      return stopper().has_value();
    });
    CHECK_THAT(stopper()->second, Catch::Contains("commands.csv"));
  }
  CHECK(files::ReadFile(folder / "commands.csv") == mine);
  CHECK_FALSE(std::filesystem::exists(folder / "trajectory.csv"));
  CHECK_FALSE(std::filesystem::exists(folder / "summary.json"));
}

TEST_CASE("A folder that holds any file of a run is refused with its name and left as it is") {
  for (const char* name : {"experiment.yaml", "camera.yaml", "summary.json", "trajectory.csv",
                           "commands.csv", "stages.csv", "encoders.csv"}) {
    const test::TemporaryFolder folder;
    test::WriteText(folder / name, "mine");
    const Console quiet{.say = [](const std::string&) {},
                        .show = [](const std::string&) {},
                        .hide = [] {},
                        .ring = [] {},
                        .ask = [](const std::string&, std::string_view) { return 'q'; }};
    DriveSession session({.address = {"/dev/none", "none", folder / name}, .yes = true}, quiet);
    CHECK_THROWS_WITH(
        session.DriveInto(folder.Path(), test::PaperExperiment()),
        Catch::StartsWith(folder.Path().string() + " holds a run already, or part of one: ") &&
            Catch::Contains(name + std::string(" is there")));
    CHECK(files::ReadFile(folder / name) == "mine");
  }
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("nowhere", folder / "camera.yaml");
  CHECK_THROWS_WITH(RequireNoDrive(folder.Path()), Catch::Contains("camera.yaml is there"));
}

TEST_CASE("A folder that vanishes during a drive stops it") {
  const bool is_moved = GENERATE(false, true);
  const test::TemporaryFolder folder;
  const std::filesystem::path run = folder / "run";
  std::filesystem::create_directory(run);
  DriveLog log(WriterInto(run, test::PaperExperiment()));
  const hardware::Stopper stopper = log.Stopper();
  Record(log, 1.0);
  test::WaitUntil("the files are there", [&] { return Lines(run / "encoders.csv") == 2; });
  REQUIRE_FALSE(stopper());
  if (is_moved) {
    std::filesystem::rename(run, folder / "elsewhere");
  } else {
    std::filesystem::remove_all(run);
  }
  test::WaitUntil("the drive is stopped", [&] { return stopper().has_value(); });
  CHECK(stopper()->first == hardware::StopReason::kLogFailed);
  CHECK_THAT(stopper()->second, Catch::Contains("was removed or moved"));
  CHECK_THAT(log.Close({}), Catch::Contains("was removed or moved"));
  CHECK_FALSE(std::filesystem::exists(run));
}

TEST_CASE("A folder that vanishes before a drive stops it and is not made again") {
  const test::TemporaryFolder folder;
  DriveLog log(WriterInto(folder.Path() / "run", test::PaperExperiment()));
  const hardware::Stopper stopper = log.Stopper();
  Record(log, 1.0);
  test::WaitUntil("the drive is stopped", [&] { return stopper().has_value(); });
  CHECK_THAT(stopper()->second, Catch::Contains("before the drive began"));
  CHECK(std::filesystem::is_empty(folder.Path()));
}

TEST_CASE("A file that cannot grow stops the drive and ends with a whole row") {
  std::signal(SIGXFSZ, SIG_IGN);  // as in the program (terminal/process_start.hpp)
  const test::TemporaryFolder folder;
  DriveLog log(WriterInto(folder.Path(), test::PaperExperiment()));
  const hardware::Stopper stopper = log.Stopper();
  {
    const test::FileSizeLimit limit(1000);
    double t_s = 0.0;
    test::WaitUntil("the drive is stopped", [&] {
      Record(log, t_s += 0.001);
      return stopper().has_value();
    });
  }
  CHECK(stopper()->first == hardware::StopReason::kLogFailed);
  CHECK_THAT(stopper()->second,
             Catch::Contains("cannot write") && Catch::Contains("File too large"));
  CHECK_FALSE(log.Close({}).empty());
  for (const char* name : {"trajectory.csv", "commands.csv", "stages.csv", "encoders.csv"}) {
    CHECK_THAT(files::ReadFile(folder / name), Catch::EndsWith("\n"));
  }
}

TEST_CASE("A disk that hangs stops the drive after four seconds and nobody waits for it") {
  std::promise<void> answer;
  const std::shared_future<void> disk = answer.get_future().share();
  std::string failure;
  {
    const auto is_hanging = std::make_shared<std::atomic<bool>>(false);  // the thread outlives this
    DriveLog log([disk, is_hanging](const DriveRows& rows, std::atomic<unsigned>&) {
      if (rows.trajectory.empty()) return;
      *is_hanging = true;
      disk.wait();
    });
    const hardware::Stopper stopper = log.Stopper();
    Record(log, 1.0);
    test::WaitUntil("the disk hangs", [&] { return is_hanging->load(); });
    const auto start = steady_clock::now();
    double longest_s = 0.0;
    int asked = 0;
    std::optional<std::pair<hardware::StopReason, std::string>> stop;
    test::WaitUntil("the drive is stopped", [&] {
      const auto before = steady_clock::now();
      Record(log, 2.0);
      longest_s = std::max(longest_s, Since_s(before));
      std::this_thread::sleep_for(std::chrono::milliseconds(51));
      ++asked;
      stop = stopper();
      return stop.has_value();
    });
    CHECK(Since_s(start) > 3.9);
    // A turn counts for a twentieth of a second at most; the first one has none before it.
    CHECK(asked >= 81);
    CHECK(asked <= 82);
    CHECK(longest_s < 2.0);  // it waits for no disk
    CHECK(stop->first == hardware::StopReason::kLogFailed);
    CHECK_THAT(stop->second, Catch::Contains("has not been written for 4.0 s"));
    failure = log.Close({});
  }
  CHECK(failure == "its disk has not answered for 5 s");
  answer.set_value();
}

TEST_CASE("A process that stood still itself does not blame the disk") {
  std::promise<void> answer;
  const std::shared_future<void> disk = answer.get_future().share();
  DriveLog log([disk](const DriveRows&, std::atomic<unsigned>&) { disk.wait(); });
  const hardware::Stopper stopper = log.Stopper();
  CHECK_FALSE(stopper());
  std::this_thread::sleep_for(std::chrono::milliseconds(4500));
  CHECK_FALSE(stopper());
  answer.set_value();
}

}  // namespace
}  // namespace rift::sessions
