#include "rift/sweep/explain/failing_region.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace rift::sweep {
namespace {

const experiment::Parameter kSurface{.key = "surface", .levels = {{"ice", {}}, {"rock", {}}}};
const experiment::Parameter kSpeed{.key = "speed", .levels = {{"1", 1.0}, {"2", 2.0}, {"3", 3.0}}};
const experiment::Parameter kRange{.key = "range", .min = 10.0, .max = 34.0};

TrialRow Row(experiment::Theta theta, bool falsified) {
  TrialRow row{.theta = std::move(theta), .falsified = falsified};
  return row;
}

TEST_CASE("Over two lists each pair of values is a cell with the share of its own trials") {
  SweepResult result;
  result.parameters = {kSurface, kSpeed};
  const auto add = [&](int surface, int speed, bool falsified) {
    result.rows.push_back(Row(
        {kSurface.levels[static_cast<size_t>(surface)], kSpeed.levels[static_cast<size_t>(speed)]},
        falsified));
  };
  add(0, 2, true);
  add(0, 2, false);
  add(0, 2, false);
  add(1, 0, true);
  add(1, 0, true);
  add(1, 2, false);
  result.rows[5].status = TrialStatus::kCrashed;  // tells nothing
  const FailingRegion region = MapFailures(result, {1, 0});
  CHECK(region.x_parameter == 1);
  CHECK(region.y_parameter == 0);
  CHECK_FALSE(region.is_smoothed);
  REQUIRE(region.cells.size() == 6);  // x runs first
  const int trials[] = {0, 0, 3, 2, 0, 0};
  const double shares[] = {NAN, NAN, 1.0 / 3.0, 1.0, NAN, NAN};
  for (size_t i = 0; i < 6; ++i) {
    const RegionCell& cell = region.cells[i];
    INFO(i);
    CHECK(cell.x == kSpeed.levels[i % 3].text);
    CHECK(cell.y == kSurface.levels[i / 3].text);
    CHECK(cell.x_low == static_cast<double>(i % 3));
    CHECK(cell.x_high == static_cast<double>(i % 3) + 1.0);
    CHECK(cell.y_low == static_cast<double>(i / 3));
    CHECK(cell.y_high == static_cast<double>(i / 3) + 1.0);
    CHECK(cell.trials == trials[i]);
    if (trials[i] == 0) {
      CHECK(std::isnan(cell.share));
    } else {
      CHECK(cell.share == Approx(shares[i]));
    }
  }
}

TEST_CASE("Lists whose pairs of values are more than a map can show give no cells") {
  const auto cells_of = [](int columns, int lines) {
    SweepResult result;
    for (const auto& [key, count] : {std::pair{"p", columns}, std::pair{"q", lines}}) {
      result.parameters.push_back({.key = key});
      for (int i = 0; i < count; ++i) {
        result.parameters.back().levels.push_back({std::to_string(i), i});
      }
    }
    result.rows.push_back(
        Row({result.parameters[0].levels[0], result.parameters[1].levels[0]}, true));
    return MapFailures(result, {0, 1}).cells.size();
  };
  CHECK(cells_of(40, 40) == 1600);
  CHECK(cells_of(1601, 1) == 0);
  CHECK(cells_of(70000, 70000) == 0);  // their number does not fit into 32 bits
}

TEST_CASE("A range is cut into 24 patches that count the twelve nearest settings") {
  SweepResult result;
  result.parameters = {kRange, kSurface};
  for (int i = 0; i < 48; ++i) {
    const double value = 10.25 + 0.5 * i;
    for (const experiment::ParameterValue& surface : kSurface.levels) {
      result.rows.push_back(
          Row({{std::to_string(value), value}, surface}, value > 22.0 && surface.text == "ice"));
    }
  }
  const FailingRegion region = MapFailures(result, {0, 1});
  CHECK(region.is_smoothed);
  REQUIRE(region.cells.size() == 48);
  CHECK(region.cells[0].x == "10 to 11");
  CHECK(region.cells[0].x_low == 10.0);
  CHECK(region.cells[0].x_high == 11.0);
  CHECK(region.cells[23].x == "33 to 34");
  CHECK(region.cells[23].y == "ice");
  CHECK(region.cells[24].y == "rock");
  CHECK(region.cells[24].y_low == 1.0);
  for (const RegionCell& cell : region.cells) CHECK(cell.trials == 12);
  CHECK(region.cells[2].share == 0.0);
  CHECK(region.cells[21].share == 1.0);
  CHECK(region.cells[45].share == 0.0);  // on rock nothing fails
  // By symmetry the patches beside the bound mirror each other.
  CHECK(region.cells[11].share + region.cells[12].share == Approx(1.0));
  CHECK(region.cells[11].share < 0.5);
  result.rows.resize(5);
  const FailingRegion few = MapFailures(result, {0, 1});
  CHECK(few.nearest == 1);
  for (int i = 0; i < 48; ++i) {
    CHECK(few.cells[i].trials == (i % 24 == 0 ? 2 : 1));  // two are as near to the first patch
  }
}

TEST_CASE("Of few settings a patch counts a third at least one, so that not all are alike") {
  const auto map_of = [](int settings) {
    SweepResult result;
    result.parameters = {kRange, {.key = "other", .min = 0.0, .max = 1.0}};
    for (int i = 0; i < settings; ++i) {
      const double value = 10.0 + 24.0 * (i + 0.5) / settings;
      result.rows.push_back(Row({{std::to_string(value), value}, {"0.5", 0.5}}, value > 22.0));
    }
    return MapFailures(result, {0, 1});
  };
  for (const auto& [settings, nearest] :
       {std::pair{2, 1}, {5, 1}, {6, 2}, {8, 2}, {12, 4}, {35, 11}, {36, 12}, {90, 12}}) {
    INFO(settings);
    const FailingRegion region = map_of(settings);
    CHECK(region.nearest == nearest);
    CHECK(region.cells.front().share == 0.0);
    CHECK(region.cells.back().share == 1.0);
  }
}

TEST_CASE("Another value of a list is never counted for a patch, on either side") {
  SweepResult result;
  result.parameters = {kRange, kSurface};
  for (int i = 0; i < 20; ++i) {
    result.rows.push_back(Row({{"22", 22.0 + 0.1 * i}, kSurface.levels[1]}, true));
  }
  const FailingRegion across = MapFailures(result, {0, 1}), down = MapFailures(result, {1, 0});
  for (int i = 0; i < 24; ++i) {
    CHECK(across.cells[i].trials == 0);
    CHECK(std::isnan(across.cells[i].share));
    CHECK(across.cells[24 + i].share == 1.0);
    CHECK(down.cells[2 * i].trials == 0);
    CHECK(down.cells[2 * i + 1].share == 1.0);
  }
}

TEST_CASE("Patches of a narrow range have names that differ") {
  SweepResult result;
  result.parameters = {{.key = "ratio", .min = 0.99, .max = 1.01}, kSurface};
  const std::vector<RegionCell> cells = MapFailures(result, {0, 1}).cells;
  std::set<std::string> names;
  for (int i = 0; i < 24; ++i) names.insert(cells[i].x);
  CHECK(names.size() == 24);
  CHECK(cells[0].x == "0.99 to 0.99083");
  CHECK(cells[23].x == "1.0092 to 1.01");
  // As many digits as the end needs that is further from 0.
  const auto first_name = [&result](double min, double max) {
    result.parameters[0].min = min;
    result.parameters[0].max = max;
    return MapFailures(result, {0, 1}).cells[0].x;
  };
  CHECK(first_name(80.0, 100.0) == "80 to 80.83");
  CHECK(first_name(-100.0, -80.0) == "-100 to -99.17");
}

TEST_CASE("A range that is even in its logarithm is cut so, and settings are as near as by it") {
  SweepResult result;
  result.parameters = {{.key = "gain", .min = 1e-4, .max = 1.0, .is_logarithmic = true}, kSurface};
  for (int i = 0; i < 48; ++i) {
    const double value = std::pow(10.0, -4.0 + 4.0 * (i + 0.5) / 48.0);
    for (const experiment::ParameterValue& surface : kSurface.levels) {
      result.rows.push_back(Row({{std::to_string(value), value}, surface}, value < 0.01));
    }
  }
  const std::vector<RegionCell> cells = MapFailures(result, {0, 1}).cells;
  REQUIRE(cells.size() == 48);
  CHECK(cells[0].x_low == 1e-4);
  CHECK(cells[0].x_high == Approx(1e-4 * std::pow(1e4, 1.0 / 24.0)));
  CHECK(cells[0].x == "0.0001 to 0.000147");
  CHECK(cells[12].x_low == Approx(0.01));
  CHECK(cells[23].x_high == Approx(1.0));
  CHECK(cells[23].x == "0.681 to 1");
  CHECK(cells[2].share == 1.0);
  CHECK(cells[8].share == 1.0);
  CHECK(cells[15].share == 0.0);
  CHECK(cells[11].share + cells[12].share == Approx(1.0));
  const std::vector<RegionCell> down = MapFailures(result, {1, 0}).cells;
  CHECK(down[0].y_high == cells[0].x_high);
  // A narrow one: names that differ.
  result.parameters[0].min = 0.99;
  result.parameters[0].max = 1.01;
  std::set<std::string> names;
  for (const RegionCell& cell : MapFailures(result, {0, 1}).cells) names.insert(cell.x);
  CHECK(names.size() == 24);
}

TEST_CASE("Either side may be the range, and either may be missing") {
  SweepResult result;
  result.parameters = {kRange, kSurface};
  result.rows = {Row({{"12", 12.0}, kSurface.levels[0]}, true)};
  CHECK(MapFailures(result, {1, 0}).is_smoothed);
  CHECK(MapFailures(result, {1, 0}).cells.size() == 48);
  CHECK(MapFailures(result, {1, 0}).cells[1].x == "rock");
  CHECK(MapFailures(result, {-1, 0}).cells.empty());
  CHECK(MapFailures(result, {0, -1}).cells.empty());
  CHECK(MapFailures(result, {0, -1}).x_parameter == -1);
}

TEST_CASE("The most influential parameters have the largest shares and vary") {
  SweepResult result;
  result.parameters = {kSurface, {.key = "one", .levels = {{"1", 1.0}}}, kSpeed, kRange};
  Effects effects;
  CHECK(MostInfluential(result, effects) == std::array<int, 2>{0, 2});  // in their order
  effects.parameters = {{.parameter = 3, .share = 0.5}, {.parameter = 2, .share = 0.3}};
  CHECK(MostInfluential(result, effects) == std::array<int, 2>{3, 2});
  effects.parameters[1].share = gap::kNotComputed;
  CHECK(MostInfluential(result, effects) == std::array<int, 2>{3, 0});
  result.parameters = {kSurface, {.key = "one", .levels = {{"1", 1.0}}}};
  CHECK(MostInfluential(result, {}) == std::array<int, 2>{-1, -1});
  result.parameters = {kSurface};
  CHECK(MostInfluential(result, {}) == std::array<int, 2>{-1, -1});
}

TEST_CASE("Repeats of one setting near a range are one place, whatever came out of them") {
  SweepResult result;
  result.parameters = {kRange, kSurface};
  const auto add = [&](double value, int trials, int failing) {
    for (int i = 0; i < trials; ++i) {
      result.rows.push_back(Row({{std::to_string(value), value}, kSurface.levels[0]}, i < failing));
    }
  };
  add(22.0, 100, 30);
  for (int i = 0; i < 12; ++i) add(10.0 + 0.1 * i, 1, 0);
  const FailingRegion region = MapFailures(result, {0, 1});
  CHECK(region.nearest == 2);
  CHECK(region.cells[0].trials == 3);  // two are as near as the second
  CHECK(region.cells[0].share == 0.0);
  CHECK(region.cells[12].trials == 101);  // with the nearest of the others
  CHECK(region.cells[12].share == Approx(0.3 / 2));
}

TEST_CASE("Settings that are as near as the twelfth count, on both sides") {
  SweepResult result;
  result.parameters = {kRange, kSurface};
  for (int i = -1; i <= 1; i += 2) {  // seven below and seven above the patch in the middle
    for (int k = 0; k < 7; ++k) {
      const double value = 22.5 + i * (1.0 + k);
      result.rows.push_back(Row({{std::to_string(value), value}, kSurface.levels[0]}, i > 0));
    }
  }
  for (int i = 0; i < 60; ++i) {  // of another value, so that a third of each half is twelve
    result.rows.push_back(
        Row({{std::to_string(11 + i), 11.0 + 0.3 * i}, kSurface.levels[1]}, true));
  }
  // Six pairs are twelve; one that stands in the middle makes the sixth pair the twelfth and
  // thirteenth.
  CHECK(MapFailures(result, {0, 1}).cells[12].trials == 12);
  CHECK(MapFailures(result, {0, 1}).cells[12].share == Approx(0.5));
  result.rows.push_back(Row({{"22.5", 22.5}, kSurface.levels[0]}, true));
  CHECK(MapFailures(result, {0, 1}).cells[12].trials == 13);
  CHECK(MapFailures(result, {0, 1}).cells[12].share == Approx(7.0 / 13.0));
}

TEST_CASE("Of more than 4000 trials a sample is counted, of whatever order") {
  SweepResult result;
  result.parameters = {kSurface, kSpeed};
  result.rows.assign(4000, Row({kSurface.levels[0], kSpeed.levels[0]}, false));
  for (size_t i = 1; i < 4000; i += 2) result.rows[i].falsified = true;
  const RegionCell all = MapFailures(result, {0, 1}).cells[0];
  CHECK(all.trials == 4000);
  CHECK(all.share == 0.5);
  for (int i = 0; i < 4000; ++i) result.rows.push_back(result.rows[i]);
  const RegionCell half = MapFailures(result, {0, 1}).cells[0];
  CHECK(half.trials == 4000);
  CHECK(half.share == Approx(0.5).margin(0.04));  // every second one of these fails
}

}  // namespace
}  // namespace rift::sweep
