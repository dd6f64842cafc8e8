// Charts and text of a program's runs beside values that are chosen.

#include <catch2/catch.hpp>
#include <cmath>

#include "report/page/parts.hpp"
#include "report/synthetic_sweep.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/report/text/text.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

/// Two surfaces beside two speeds, with a cell for each pair.
struct Programs {
  Programs() {
    result.parameters = {{"terrain.surface", {synthetic::Word("ice"), synthetic::Word("mat")}},
                         {"program.v", {synthetic::Numeric("0.1"), synthetic::Numeric("0.2")}}};
    for (const auto& surface : result.parameters[0].levels) {
      for (const auto& v : result.parameters[1].levels) {
        sweep::ProgramCell cell{.theta = {surface, v}};
        const double n = static_cast<double>(cells.size());
        cell.measures = {.runs = 5, .moved = 4};
        cell.measures.deviation_m = 0.01 + 0.02 * n;
        cell.measures.spread_m = 0.005 + 0.001 * n;
        cell.measures.drift_per_m = 0.03 + 0.01 * n;
        cells.push_back(cell);
      }
    }
  }
  json Values(size_t chart) const {
    return ProgramCharts(result, cells).at(chart).spec["data"][0]["values"];
  }
  json Signal(size_t chart, const std::string& name) const {
    const std::vector<PageChart> charts = ProgramCharts(result, cells);
    for (const json& signal : charts.at(chart).spec["signals"]) {
      if (signal["name"] == name) return signal["value"];
    }
    return nullptr;
  }

  sweep::SweepResult result;
  std::vector<sweep::ProgramCell> cells;
};

TEST_CASE("Cells of a program lie by surface and speed, with their measure, unit and runs") {
  const Programs programs;
  REQUIRE(ProgramCharts(programs.result, programs.cells).size() == 3);
  const json values = programs.Values(0);
  REQUIRE(values.size() == 4);
  CHECK(values[1]["column"] == "ice");
  CHECK(values[1]["line"] == "0.2");
  CHECK(values[1]["value"].get<double>() == Approx(0.03));
  CHECK(values[1]["word"] == "");
  CHECK(values[1]["tip"]["distance (m)"] == "0.03");
  CHECK(values[1]["tip"]["runs that moved"] == "4 of 5");
  CHECK(values[2]["column"] == "mat");
  CHECK(values[2]["line"] == "0.1");
  CHECK(programs.Values(1)[3]["value"].get<double>() == Approx(0.008));
  CHECK(programs.Values(2)[3]["value"].get<double>() == Approx(6.0));  // per cent
  CHECK(programs.Values(2)[3]["tip"]["drift (%)"] == "6");
  // Letters turn dark at six tenths of the range.
  CHECK(programs.Signal(0, "middle").get<double>() == Approx(0.01 + 0.6 * 0.06));
  CHECK(programs.Signal(0, "x_title") == "surface");
  CHECK(programs.Signal(0, "y_title") == "v");
  CHECK(programs.Signal(0, "legend_title") == "distance (m)");
  CHECK(ProgramCharts(programs.result, programs.cells)[0].spec["height"] == 92);
  CHECK(ProgramCharts(programs.result, {}).empty());
}

TEST_CASE("A program over one parameter has one line of cells") {
  Programs programs;
  programs.result.parameters.pop_back();
  programs.cells.resize(3);
  for (size_t i = 0; i < programs.cells.size(); ++i) {
    programs.cells[i].theta = {synthetic::Word(std::string(1, static_cast<char>('a' + i)))};
  }
  CHECK(ProgramCharts(programs.result, programs.cells)[0].spec["height"] == 46);
  CHECK(programs.Values(0)[2]["line"] == "all");
  CHECK(programs.Values(0)[2]["column"] == "c");
}

TEST_CASE("A cell whose robot never moved or that has no run says so and has no value") {
  Programs programs;
  programs.cells[0].measures.moved = 0;
  programs.cells[3].measures = {};
  const json values = programs.Values(0);
  CHECK(values[0]["word"] == "did not move");
  CHECK(values[0]["value"].is_null());
  CHECK(values[0]["tip"]["distance (m)"] == "did not move");
  CHECK(values[3]["word"] == "no run");
  CHECK(values[3]["value"].is_null());
  CHECK(programs.Signal(0, "middle").get<double>() == Approx(0.03 + 0.6 * 0.02));
}

TEST_CASE("A cell whose measure is not known says so where it moved") {
  Programs programs;
  programs.cells[1].measures.drift_per_m = NAN;
  const json values = programs.Values(2);
  CHECK(values[1]["value"].is_null());
  CHECK(values[1]["word"] == "");
  CHECK(values[1]["tip"]["drift (%)"] == "not known");
  CHECK(values[3]["tip"]["drift (%)"] == "6");
}

TEST_CASE("Slip is drawn for each wheel in per cent, without what is not known or did not move") {
  Programs programs;
  programs.cells[1].measures.slip = {{0.25, 0.1, -0.2}, {0.75, NAN, 0.3}};
  programs.cells[2].measures.slip = {{0.5, 0.9, 0.9}};
  programs.cells[2].measures.moved = 0;
  const auto charts = ProgramCharts(programs.result, programs.cells);
  REQUIRE(charts.size() == 5);
  CHECK(charts[3].title == "Slip of the left wheel along the program");
  CHECK(charts[4].title == "Slip of the right wheel along the program");
  const json left = programs.Values(3), right = programs.Values(4);
  REQUIRE(left.size() == 1);
  CHECK(left[0]["x"] == 0.25);
  CHECK(left[0]["y"].get<double>() == Approx(10.0));
  CHECK(left[0]["tip"]["slip"] == "10.0 %");
  REQUIRE(right.size() == 2);
  CHECK(right[0]["y"].get<double>() == Approx(-20.0));
  CHECK(right[1]["y"].get<double>() == Approx(30.0));
  CHECK(right[1]["x"] == 0.75);
  CHECK(programs.Signal(4, "y_title") == "slip, right wheel (%)");
}

TEST_CASE("What does not move, or is not known, hides no slip behind it") {
  Programs programs;
  programs.cells[0].measures.moved = 0;
  programs.cells[0].measures.slip = {{0.25, 0.4, 0.4}};
  programs.cells[1].measures.slip = {{0.25, NAN, 0.1}, {0.75, 0.2, NAN}, {0.9, 0.3, 0.3}};
  const json left = programs.Values(3), right = programs.Values(4);
  REQUIRE(left.size() == 2);
  CHECK(left[0]["x"] == 0.75);
  CHECK(left[0]["y"].get<double>() == Approx(20.0));
  REQUIRE(right.size() == 2);
  CHECK(right[1]["x"] == 0.9);
}

TEST_CASE("Of a run that only turns no way is told, and what odometry and camera say is") {
  odometry::OdometryResult result;
  result.runs = {{"spin",
                  {.length_m = 0.001,
                   .end_error_m = 0.002,
                   .odometry_gap_m = 0.003,
                   .yaw_drift_rad = geometry::RadFromDeg(1.5)}}};
  result.cell = odometry::CellMeasures{.runs = 2, .moved = 2};
  const std::string text = OdometryText(result);
  INFO(text);
  CHECK(text.find("camera from program   end 0.0020 m\n") != std::string::npos);
  CHECK(text.find("odometry from camera  largest 0.0030 m, turned +1.50 deg more\n") !=
        std::string::npos);
  CHECK(text.find("2 of 2 runs of one program moved\n") != std::string::npos);
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find("distance from it") == std::string::npos);
}

TEST_CASE("Of a program over one parameter each table has one line, below the values in order") {
  Programs programs;
  programs.result.parameters.pop_back();
  programs.cells.resize(3);
  for (size_t i = 0; i < 3; ++i) {
    programs.cells[i].theta = {synthetic::Word(std::string(i + 1, static_cast<char>('a' + i)))};
    programs.cells[i].measures.slip_left = 0.01 * static_cast<double>(i + 1);
    programs.cells[i].measures.slip_right = -0.02;
  }
  programs.cells[1].measures.moved = 0;
  const std::string text = ProgramText(programs.result.parameters, programs.cells);
  INFO(text);
  CHECK(text.find("\nmean distance from the programmed path (m)\n"
                  "          a            bb     ccc\n"
                  "all  0.0100  did not move  0.0500\n") != std::string::npos);
  CHECK(text.find("\nspread of the repeats (m)\n"
                  "          a            bb     ccc\n"
                  "all  0.0050  did not move  0.0070\n") != std::string::npos);
  CHECK(text.find("\ndrift of the odometry (% of the way)\n"
                  "       a            bb  ccc\n"
                  "all  3.0  did not move  5.0\n") != std::string::npos);
  CHECK(text.find("\nslip of the left wheel (%)\n"
                  "       a            bb  ccc\n"
                  "all  1.0  did not move  3.0\n") != std::string::npos);
  CHECK(text.find("\nslip of the right wheel (%)\n"
                  "        a            bb   ccc\n"
                  "all  -2.0  did not move  -2.0\n") != std::string::npos);
  programs.cells[0].measures = {};
  programs.cells[2].measures.spread_m = NAN;
  const std::string bare = ProgramText(programs.result.parameters, programs.cells);
  INFO(bare);
  CHECK(bare.find("\nspread of the repeats (m)\n"
                  "          a            bb  ccc\n"
                  "all  no run  did not move    -\n") != std::string::npos);
  CHECK(ProgramText({}, programs.cells).empty());
  CHECK(ProgramText(programs.result.parameters, {}).empty());
}

}  // namespace
}  // namespace rift::report
