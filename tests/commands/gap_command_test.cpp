#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/inputs/paths.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using nlohmann::json;
using test::ProcessResult;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

/// Writes a straight path and one beside it; the gap between them is `offset_m`.
struct TwoLogs {
  explicit TwoLogs(double offset_m) {
    const trajectory::Trajectory path = test::StraightPath(0.7, 40);
    WriteText(sim, trajectory::WriteRift(path));
    WriteText(real, trajectory::WriteRift(test::Moved(path, {0.0, offset_m, 0.0})));
  }
  TemporaryFolder folder;
  std::string sim = folder / "sim.csv";
  std::string real = folder / "real.csv";
};

TEST_CASE("rift gap prints the definition and the gap and a verdict") {
  const TwoLogs logs(0.05);
  const ProcessResult result = RunRift({"gap", logs.sim, logs.real});
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(result.out.starts_with(
      "gap: largest distance at equal normalised arc length u over 2000 samples\n"));
  CHECK(result.out.find("mean gap: 0.0500 m") != std::string::npos);
  CHECK(result.out.find("verdict: not seen to fail (1 trial): 0 of 1 above 0.06 m") !=
        std::string::npos);
}

TEST_CASE("rift gap ends with 1 for a falsified verdict only when asked to") {
  const TwoLogs logs(0.08);
  CHECK(RunRift({"gap", logs.sim, logs.real}).exit_code == 0);
  CHECK(RunRift({"gap", logs.sim, logs.real, "--exit-code"}).exit_code == 1);
  CHECK(RunRift({"gap", logs.sim, logs.real, "--exit-code", "--threshold", "0.09"}).exit_code == 0);
}

TEST_CASE("rift gap writes its evidence as JSON with nothing else on stdout") {
  const TwoLogs logs(0.05);
  const std::string again = logs.folder / "again.csv";
  std::filesystem::copy(logs.real, again);
  const ProcessResult result =
      RunRift({"gap", logs.sim, logs.real, again, "--json", "-", "--align", "start"});
  REQUIRE(result.exit_code == 0);
  const json evidence = json::parse(result.out);
  CHECK(evidence["definition"]["samples"] == 2000);
  CHECK(evidence["definition"]["align"] == "start");
  REQUIRE(evidence["trials"].size() == 2);
  const json& trial = evidence["trials"][0];
  CHECK(trial["sim"] == logs.sim);
  CHECK(trial["real"] == logs.real);
  CHECK(trial["gap_m"].get<double>() == Approx(0.0).margin(1e-12));
  for (const char* key : {"u", "exact_gap_m", "start_offset_m", "shape_gap_m", "length_ratio",
                          "end_error_m", "frechet_m", "dtw_m", "hausdorff_m", "equal_time_m"}) {
    INFO(key);
    CHECK(trial[key].is_number());
  }
  CHECK(evidence["noise_floor_m"] == nullptr);  // the second log is a copy of the first
  CHECK(evidence["repeats"]["n"] == 1);
  CHECK_THAT(result.err, Catch::Contains(again + " has the positions of " + logs.real));
  CHECK(evidence["verdict"] == "not seen to fail");
}

TEST_CASE("rift gap reads logs longer than one look at the file and through a pipe") {
  const trajectory::Trajectory path = test::StraightPath(0.7, 20'000);
  std::string text = trajectory::WriteRift(path);
  const TwoLogs logs(0.05);
  REQUIRE(text.size() > 600'000);
  WriteText(logs.sim, text);
  const std::string long_line = "# " + std::string(600'000, '-') + "\n";
  WriteText(logs.folder / "real.tum",
            long_line + trajectory::WriteTum(test::Moved(path, {0.0, 0.05, 0.0})));
  const std::string tum = logs.folder / "real.tum";
  const ProcessResult files = RunRift({"gap", logs.sim, tum});
  CHECK(files.out.find("mean gap: 0.0500 m") != std::string::npos);
  const std::string pipe = logs.folder / "pipe.csv";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(pipe) << text; });
  const ProcessResult piped = RunRift({"gap", pipe, tum});
  writer.join();
  CHECK(piped.out.substr(piped.out.find("mean gap")) ==
        files.out.substr(files.out.find("mean gap")));
  text.insert(text.find('\n', 500'000) + 1, "spoilt\n");
  WriteText(logs.sim, text);
  const auto line = 1 + std::count(text.begin(), text.begin() + text.find("spoilt"), '\n');
  const ProcessResult spoilt = RunRift({"gap", logs.sim, tum});
  CHECK(spoilt.exit_code == 2);
  CHECK(spoilt.err.find("sim.csv:" + std::to_string(line) + ": column t_s is 'spoilt'") !=
        std::string::npos);
}

TEST_CASE("rift gap writes a profile and figures beside its text") {
  const TwoLogs logs(0.05);
  const ProcessResult result =
      RunRift({"gap", logs.sim, logs.real, "--json", logs.folder / "gap.json", "--profile",
               logs.folder / "profile.csv", "--figure", logs.folder / "gap.svg"});
  REQUIRE(result.exit_code == 0);
  CHECK_FALSE(result.out.empty());
  CHECK(json::parse(test::ReadFile(logs.folder / "gap.json"))["mean_gap_m"].get<double>() ==
        Approx(0.05));
  const std::string profile = test::ReadFile(logs.folder / "profile.csv");
  CHECK(std::count(profile.begin(), profile.end(), '\n') == 2001);
  CHECK(test::ReadFile(logs.folder / "gap.svg").find("</svg>") != std::string::npos);
}

TEST_CASE("rift gap says in one line what is wrong with its input") {
  const TwoLogs logs(0.05);
  const std::string missing = logs.folder / "none.csv", bad = logs.folder / "bad.csv",
                    authors = logs.folder / "authors.csv";
  WriteText(bad, "t_s,x_m,y_m\n0,0,0\n1,nan,0\n");
  WriteText(authors, "t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,1,0,0,0,-33,0\n");
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Case> cases{
      {{logs.sim, missing}, "rift: cannot read " + missing + ": No such file or directory\n"},
      {{logs.sim, bad}, "rift: " + bad + ":3: column x_m is 'nan': a finite number is expected\n"},
      {{logs.sim, authors, "--tag-offset", "0.03"},
       "rift: " + authors +
           ": a tag offset of 0.03 m needs the yaw, and its header does not tell degrees "
           "(tracker) from radians (webots); an angle of 33.0 looks like degrees: set "
           "--real-format\n"},
      {{logs.sim},
       "rift: REAL is required: name logs of the robot (or --odometry for the encoders of run "
       "folders)\n"},
      {{logs.sim, logs.real, "--samples", "1"},
       "rift: --samples: '1' must be a whole number in [2, 10000000]\n"},
      {{logs.sim, logs.real, "--threshold", "nan"},
       "rift: --threshold: 'nan' must be a number in [0, 1000]\n"},
      {{logs.sim, logs.real, "--figure", logs.folder / "gap.pdf"},
       "rift: --figure " + (logs.folder / "gap.pdf") + ": the name must end in .svg or .png\n"},
  };
  for (const Case& bad_call : cases) {
    std::vector<std::string> arguments{"gap"};
    arguments.insert(arguments.end(), bad_call.arguments.begin(), bad_call.arguments.end());
    const ProcessResult result = RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err == bad_call.message);
  }
}

TEST_CASE("rift gap that cannot write says so first and leaves nothing half written") {
  const TwoLogs logs(0.05);
  WriteText(logs.folder / "file", "in the way");
  const ProcessResult result =
      RunRift({"gap", logs.sim, logs.real, "--json", logs.folder / "file/gap.json"});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("there is no folder") != std::string::npos);
  size_t files = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(logs.folder.Path())) {
    ++files;
  }
  CHECK(files == 3);
}

TEST_CASE("rift gap counts a log once and writes each output to a file of its own") {
  const TwoLogs logs(0.05);
  const std::string one = logs.folder / "one.svg";
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& rule) {
    const ProcessResult result = RunRift(arguments);
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(rule) != std::string::npos);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  };
  refused({"gap", logs.sim, logs.real, logs.real}, "are one log");
  refused({"gap", logs.sim, logs.real, "--sim-repeats", logs.sim}, "are one log");
  refused({"gap", logs.sim, logs.real, "--figure", one, "--profile", one}, "another output");
  refused({"gap", logs.sim, logs.real, "--profile", "-", "--json", "-"}, "name a file");
  refused({"gap", logs.sim, logs.real, "--profile", one, "--json", logs.folder / ""},
          "is a folder");
  CHECK_FALSE(std::filesystem::exists(one));
}

TEST_CASE("An output goes through a link and is put behind what its stream holds already") {
  const TwoLogs logs(0.05);
  const std::string log = logs.folder / "log.txt", link = logs.folder / "link.csv";
  WriteText(log, "precious\n");
  const std::string command =
      std::string(test::RiftBinary()) + " gap " + logs.sim + " " + logs.real;
  REQUIRE(test::RunShell(command + " --json /dev/stdout >> " + log) == 0);
  const std::string text = test::ReadFile(log);
  CHECK(text.starts_with("precious\n{"));
  CHECK(text.find("}\ngap: largest") != std::string::npos);

  std::filesystem::create_symlink("behind.csv", link);
  REQUIRE(RunRift({"gap", logs.sim, logs.real, "--profile", link}).exit_code == 0);
  CHECK(std::filesystem::is_symlink(link));
  CHECK(test::ReadFile(logs.folder / "behind.csv").starts_with("real,u,error_m"));

  std::filesystem::create_symlink("loop.csv", logs.folder / "loop.csv");
  const ProcessResult loop =
      RunRift({"gap", logs.sim, logs.real, "--profile", logs.folder / "loop.csv"});
  CHECK(loop.exit_code == 3);
  CHECK(loop.err.find("loop.csv: Too many levels") != std::string::npos);
}

TEST_CASE("rift gap says which row has no yaw and tells the errors of the others") {
  const TwoLogs logs(0.05);
  trajectory::Trajectory real = trajectory::ReadLog(test::ReadFile(logs.real), "real").trajectory;
  real.poses[20].yaw_rad = trajectory::StampedPose::kNotLogged;
  WriteText(logs.real, trajectory::WriteRift(real));
  const ProcessResult result = RunRift({"gap", logs.sim, logs.real});
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("yaw error: 0.000 rad in the mean") != std::string::npos);
  CHECK(result.err ==
        "note: " + logs.real + ":22: has no yaw: yaw errors are told where it is logged\n");
}

TEST_CASE("A mistyped subcommand is met with the nearest one") {
  const ProcessResult result = RunRift({"gapp"});
  CHECK(result.exit_code == 2);
  CHECK(result.err == "rift: 'gapp' is no subcommand; did you mean 'gap'?\n");
  CHECK(RunRift({"--version"}).out.starts_with("rift 0."));
  CHECK(RunRift({"gap", "--help"}).out.find("Example: rift gap") != std::string::npos);
}

TEST_CASE("The README's recipe works on the recordings of this repository") {
  const std::string folder = test::SourceDir() + "/data/example/";
  const ProcessResult result =
      RunRift({"gap", folder + "simulator.csv", folder + "robot1.csv", folder + "robot2.csv"});
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(result.out.find("yaw error: ") != std::string::npos);
  CHECK(result.out.find("verdict: ") != std::string::npos);
}

TEST_CASE("The command line reproduces the published gaps") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const test::TrialPair& pair : test::PublishedPairs()) {
    const ProcessResult result = RunRift(
        {"gap", pair.webots.string(), pair.real.string(), "--skip-start", "0.1", "--tag-offset",
         "0.03", "--sim-format", "webots", "--real-format", "tracker", "--json", "-"});
    INFO(pair.real.string());
    REQUIRE(result.exit_code == 0);
    const double gap_m = json::parse(result.out)["trials"][0]["gap_m"];
    CHECK(std::abs(gap_m - pair.published_gap_m) < 1e-12);
  }
}

}  // namespace
}  // namespace rift
