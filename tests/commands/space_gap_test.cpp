// Gaps in space (dimension xyz) through the binary: an arm's or a drone's logs.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

/// A climbing turn, `lifted_m` above where it should be: TUM, or a CSV of its own in millimetres.
std::string ClimbTum(double lifted_m) {
  std::string text;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.05 * i;
    text += fmt::format("{} {} {} {} 0 0 0 1\n", t, std::cos(0.4 * t), std::sin(0.4 * t),
                        0.1 * t + lifted_m);
  }
  return text;
}

std::string ClimbCsv(double lifted_m) {
  std::string text = "stamp,px,py,height\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 0.05 * i;
    text += fmt::format("{},{},{},{}\n", t, 1e3 * std::cos(0.4 * t), 1e3 * std::sin(0.4 * t),
                        1e3 * (0.1 * t + lifted_m));
  }
  return text;
}

const std::string kColumns = "t=stamp,x=px,y=py,z=height";

TEST_CASE("rift gap measures a TUM against a CSV log in space") {
  const TemporaryFolder folder;
  const std::string sim = folder / "arm.tum", real = folder / "real.csv";
  WriteText(sim, ClimbTum(0.0));
  WriteText(real, ClimbCsv(0.05));
  const std::vector<std::string> arguments{
      "gap",    sim, real,        "--real-columns",      kColumns, "--real-units", "mm",
      "--json", "-", "--profile", folder / "profile.csv"};
  std::vector<std::string> space = arguments;
  space.insert(space.end(), {"--dimension", "xyz"});
  const ProcessResult result = RunRift(space);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  const json evidence = json::parse(result.out);
  CHECK(evidence["definition"]["dimension"] == "xyz");
  CHECK(evidence["definition"]["text"].get<std::string>().starts_with(
      "largest distance in x, y and z at equal normalised arc length u"));
  const json& trial = evidence["trials"][0];
  CHECK(trial["gap_m"].get<double>() == Approx(0.05));
  CHECK(trial["sim_length_m"].get<double>() == Approx(9.95 * std::hypot(0.4, 0.1)).epsilon(1e-4));
  CHECK(trial["shape_gap_m"].get<double>() < 1e-6);
  CHECK(trial["real_from_sim"]["z_m"].get<double>() == Approx(0.05));
  CHECK(trial["real_from_sim"]["qw"].get<double>() == Approx(1.0));
  const std::string profile = ReadFile(folder / "profile.csv");
  CHECK(profile.starts_with(
      "real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m,sim_z_m,real_z_m\n"
      "1,0,0.05"));

  std::vector<std::string> plane = arguments;
  plane.push_back("--force");
  const json planar = json::parse(RunRift(plane).out);
  CHECK(planar["trials"][0]["gap_m"].get<double>() < 1e-9);
  CHECK(planar["trials"][0]["real_from_sim"].contains("yaw_rad"));
}

TEST_CASE("rift gap in space says what a log without heights needs, in one line") {
  const TemporaryFolder folder;
  const std::string sim = folder / "arm.tum";
  WriteText(sim, ClimbTum(0.0));
  const auto refusal = [&](const std::string& text, std::vector<std::string> more = {}) {
    const std::string real = folder / "real.csv";
    WriteText(real, text);
    std::vector<std::string> arguments{"gap", sim, real, "--dimension", "xyz"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    return result.err;
  };
  const std::string flat = "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,1,0,0\n2,2,0,0\n";
  CHECK(refusal(flat).find("real.csv: the pose at 0 s has no height z, and a gap in space "
                           "(dimension xyz) needs it: log z_m, or name its column: "
                           "--real-columns t=...,x=...,y=...,z=..., or leave dimension at xy") !=
        std::string::npos);
  const std::string authors = "t,x,y,z\n0,0,0,1\n1,1,0,1\n2,2,0,1\n";
  CHECK(refusal(authors).find("name its format, tracker or webots") != std::string::npos);
  CHECK(refusal(ClimbTum(0.1), {"--align", "se2"}).find("use se3") != std::string::npos);
  CHECK(refusal(ClimbTum(0.1), {"--tag-offset", "0.03"}).find("leave --tag-offset out") !=
        std::string::npos);
  CHECK(refusal(ClimbTum(0.1), {"--sim-repeats", sim}).find("likeness") != std::string::npos);
}

TEST_CASE("A path straight up is one in space and none in the plane") {
  const TemporaryFolder folder;
  std::string up = "t_s,x_m,y_m,z_m\n", beside = up;
  for (int i = 0; i < 20; ++i) {
    up += fmt::format("{},0,0,{}\n", 0.1 * i, 0.1 * i);
    beside += fmt::format("{},0.02,0,{}\n", 0.1 * i, 0.1 * i);
  }
  WriteText(folder / "up.csv", up);
  WriteText(folder / "beside.csv", beside);
  const ProcessResult space =
      RunRift({"gap", folder / "up.csv", folder / "beside.csv", "--dimension", "xyz"});
  INFO(space.err);
  CHECK(space.exit_code == 0);
  CHECK(space.out.find("mean gap: 0.0200 m") != std::string::npos);
  CHECK(RunRift({"gap", folder / "up.csv", folder / "beside.csv"}).err.find("never moved") !=
        std::string::npos);
}

/// A program that copies a log, chosen by {lift}, held against three logs of the robot.
struct Bench {
  Bench() {
    WriteText(folder / "copy.py", "import shutil, sys; shutil.copy(sys.argv[1], sys.argv[2])\n");
    WriteText(folder / "sim_low.csv", ClimbTum(0.0));
    WriteText(folder / "sim_high.csv", ClimbTum(0.2));
    for (const int k : {1, 2, 3}) {
      WriteText(folder / fmt::format("robot_{}.csv", k), ClimbCsv(0.01 * k));
    }
  }
  ProcessResult Sweep(const std::string& candidate, const std::string& dimension,
                      const std::string& jobs) {
    WriteText(folder / "sweep.yaml",
              "candidate: " + candidate +
                  "\nreference: {kind: logs, path: 'robot_{trial}.csv', trials: 3,\n"
                  "            columns: '" +
                  kColumns + "', units: mm}\ngap: {dimension: " + dimension +
                  "}\nlikeness: {shuffles: 19}\nspace: {lift: [low, high]}\n");
    return RunRift(
        {"sweep", folder / "sweep.yaml", "--out", folder / "out", "--jobs", jobs, "--force"});
  }
  std::string Program() const {
    return "{kind: program, run: [python3, copy.py, '{folder}/../" +
           folder.Path().filename().string() + "/sim_{lift}.csv', '{out}']}";
  }
  json Summary() const { return json::parse(ReadFile(fs::path(folder / "out") / "summary.json")); }

  test::QuickGnuplot gnuplot;
  TemporaryFolder folder;
};

TEST_CASE("A sweep of a program and one of recorded logs fail by height in space alone") {
  Bench bench;
  for (const std::string& candidate :
       {bench.Program(), std::string("{kind: logs, path: 'sim_{lift}.csv'}")}) {
    const ProcessResult space = bench.Sweep(candidate, "xyz", "2");
    INFO(space.err);
    REQUIRE(space.exit_code == 0);
    const json summary = bench.Summary();
    CHECK(summary["definition"]["dimension"] == "xyz");
    CHECK(summary["n"] == 6);
    CHECK(summary["failures"] == 3);  // lifted by 0.2 m less 0.01 to 0.03 m
    CHECK(summary["mean_gap_m"].get<double>() == Approx((0.02 + 0.18) / 2.0));
    const std::string bytes = ReadFile(fs::path(bench.folder / "out") / "summary.json");
    REQUIRE(bench.Sweep(candidate, "xyz", "1").exit_code == 0);
    CHECK(ReadFile(fs::path(bench.folder / "out") / "summary.json") == bytes);
    REQUIRE(bench.Sweep(candidate, "xy", "2").exit_code == 0);
    CHECK(bench.Summary()["failures"] == 0);
  }
}

TEST_CASE("A sweep in space says which trials lack heights, and refuses a robot on a floor") {
  Bench bench;
  WriteText(bench.folder / "sim_high.csv", "t_s,x_m,y_m\n0,0,0\n1,1,0\n2,2,0\n");
  REQUIRE(bench.Sweep(bench.Program(), "xyz", "2").exit_code == 0);
  CHECK(bench.Summary()["not_ok"] == 3);
  const std::string table = ReadFile(fs::path(bench.folder / "out") / "table.csv");
  CHECK(table.find("has no height z") != std::string::npos);
  CHECK(table.find("--set candidate.columns=") != std::string::npos);
  WriteText(bench.folder / "driven.yaml",
            "include: " + test::SourceDir() +
                "/configs/waypoints/paper.yaml\ngap: {dimension: xyz}\n"
                "reference: {kind: logs, path: 'robot_{trial}.csv', trials: 3}\n"
                "space: {control.v_max: [0.2]}\n");
  const ProcessResult driven =
      RunRift({"sweep", bench.folder / "driven.yaml", "--out", bench.folder / "driven"});
  CHECK(driven.exit_code == 2);
  CHECK(driven.err.find("gap.dimension is xyz, and candidate.kind is simulation") !=
        std::string::npos);
  WriteText(bench.folder / "path.yaml",
            "candidate: {kind: logs, path: 'sim_{lift}.csv'}\ngap: {dimension: xyz}\n"
            "waypoints: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]\nspace: {lift: [low]}\n");
  const ProcessResult path =
      RunRift({"sweep", bench.folder / "path.yaml", "--out", bench.folder / "path"});
  CHECK(path.exit_code == 2);
  CHECK(path.err.find("gap.dimension is xyz, and reference.kind is path, whose waypoints have no "
                      "height: use logs or a program") != std::string::npos);
}

}  // namespace
}  // namespace rift
