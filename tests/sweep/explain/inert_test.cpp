#include "rift/sweep/explain/inert.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

#include "rift/sweep/explain/anatomy.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

using Catch::Matchers::Contains;

/// v_max 0.3, 0.4, 0.5 on two surfaces, 4 trials; the path depends on the surface and on whether
/// v_max is above 0.35; the controller asks for 0.39.
SweepResult Table() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.01);
  SweepResult result;
  result.parameters = {
      {.key = "surface", .levels = {{"ice", {}}, {"rock", {}}}},
      {.key = "control.v_max", .levels = {{"0.3", 0.3}, {"0.4", 0.4}, {"0.5", 0.5}}}};
  for (const experiment::ParameterValue& surface : result.parameters[0].levels) {
    for (const experiment::ParameterValue& v_max : result.parameters[1].levels) {
      for (const char* trial : {"1", "2", "3", "4"}) {
        TrialRow row;
        row.theta = {surface, v_max};
        row.trial = trial;
        row.comparison.gap_m = (surface.text == "ice" ? 0.03 : 0.06) + normal(random);
        row.evidence.fingerprint = (surface.text == "ice" ? 10 : 20) + (*v_max.number > 0.35);
        trial::LimitCounts& limits = row.evidence.candidate_limits.emplace();
        limits.decisions = 60;
        limits.v_max = *v_max.number < 0.39 ? 1 : 0;
        limits.largest_raw_v = 0.39;
        result.rows.push_back(row);
      }
    }
  }
  Summarise(result);
  return result;
}

TEST_CASE("A limit that never binds is named with the most it was asked for") {
  const SweepResult result = Table();
  const std::vector<Inertness> inert = FindInert(result, MeasureEffects(result));
  REQUIRE(inert.size() == 2);
  CHECK(inert[0].is_detected);
  CHECK_FALSE(inert[0].IsInert());
  CHECK(inert[1].IsInert());
  CHECK_FALSE(inert[1].NeverChangedAPath());
  REQUIRE(inert[1].pairs.size() == 2);
  CHECK(inert[1].pairs[0].identical == 0);
  CHECK(inert[1].pairs[1].identical == 8);
  REQUIRE(inert[1].sentences.size() == 3);
  CHECK_THAT(inert[1].sentences[2],
             Contains("m between two values of v_max would have been seen with "
                      "80 % probability"));
  CHECK(inert[1].sentences[0] ==
        "with v_max 0.4 and 0.5 the candidate drove the same path to the last bit in all 8 pairs "
        "of trials");
  CHECK(inert[1].sentences[1] ==
        "v_max 0.4 and 0.5 never bound: the candidate's controller asked for 0.39 and 0.39 at "
        "most; 0.3 bound in 8 of 480 decisions of 8 runs");
}

TEST_CASE("Values with the same paths are told in one sentence, and none of a single pair") {
  SweepResult result = Table();
  experiment::Theta& levels = result.parameters[1].levels;
  for (const char* text : {"0.6", "0.7", "0.8", "0.9"}) levels.push_back({text, std::stod(text)});
  const std::vector<TrialRow> rows = result.rows;
  for (const TrialRow& row : rows) {
    if (row.theta[1].text != "0.5") continue;
    for (size_t i = 3; i < levels.size(); ++i) {
      const bool is_single = i == 6 && (row.trial != "1" || row.theta[0].text != "ice");
      if (is_single) continue;
      TrialRow more = row;
      more.theta[1] = levels[i];
      if (i > 4) more.evidence.fingerprint += 100;  // 0.8 and 0.9 drive another path
      result.rows.push_back(more);
    }
  }
  Summarise(result);
  const Inertness v_max = FindInert(result, MeasureEffects(result))[1];
  REQUIRE(v_max.pairs.size() == 6);
  CHECK(v_max.pairs[5].compared == 1);
  CHECK(v_max.pairs[5].identical == 1);
  int sentences = 0;
  for (const std::string& sentence : v_max.sentences) {
    sentences += sentence.find("to the last bit") != sentence.npos;
  }
  CHECK(sentences == 1);
  CHECK(v_max.sentences[0] ==
        "with v_max 0.4, 0.5, 0.6 and 0.7 the candidate drove the same path to the last bit in all "
        "24 pairs of trials");
}

TEST_CASE("Copies of trials make no smaller difference detectable") {
  SweepResult once;
  once.parameters = {
      {.key = "surface", .levels = {{"ice", {}}, {"rock", {}}}},
      {.key = "control.v_max", .levels = {{"0.3", 0.3}, {"0.4", 0.4}, {"0.5", 0.5}}}};
  SweepResult copied = once;
  std::uint64_t path = 0;
  for (const experiment::ParameterValue& surface : once.parameters[0].levels) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      TrialRow row;
      row.trial = std::to_string(seed);
      row.seed = seed;
      row.comparison.gap_m = 0.03 + 0.004 * std::sin(12.9 * static_cast<double>(++path));
      row.evidence.fingerprint = path;
      for (const experiment::ParameterValue& v_max : once.parameters[1].levels) {
        row.theta = {surface, v_max};
        if (v_max.text == "0.3") once.rows.push_back(row);
        copied.rows.push_back(row);
      }
    }
  }
  Summarise(once);
  Summarise(copied);
  const double of_once_m = FindInert(once, MeasureEffects(once))[0].smallest_detectable_m;
  CHECK(of_once_m > 0.0);
  CHECK(FindInert(copied, MeasureEffects(copied))[0].smallest_detectable_m == Approx(of_once_m));
}

TEST_CASE("A difference beyond all gaps is said to be out of reach of the trials") {
  SweepResult result = Table();
  // Two trials a setting that differ by more than the settings do: a large residual.
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].comparison.gap_m = i % 2 == 0 ? 0.04 : 0.05;
  }
  result.rows.resize(6);
  Summarise(result);
  const Inertness inert = FindInert(result, MeasureEffects(result))[1];
  REQUIRE_FALSE(inert.sentences.empty());
  CHECK_THAT(inert.sentences.back(),
             Contains("too few to show a difference between two values of v_max: all gaps lie "
                      "within 0.0100 m, and only one of "));
}

TEST_CASE("A parameter that never changed a path is inert to the last bit") {
  SweepResult result = Table();
  for (TrialRow& row : result.rows) row.evidence.fingerprint = row.theta[0].text == "ice" ? 1 : 2;
  const Inertness inert = FindInert(result, MeasureEffects(result))[1];
  CHECK(inert.NeverChangedAPath());
  CHECK_THAT(inert.sentences[0], Contains("never changed the candidate's path: in all 16 pairs"));
  // A robot that stood still is lost or not: that is another end of one path.
  for (TrialRow& row : result.rows) {
    if (*row.theta[1].number > 0.35) row.status = TrialStatus::kLost;
  }
  CHECK_FALSE(FindInert(result, MeasureEffects(result))[1].NeverChangedAPath());
}

TEST_CASE("A path keeps its fingerprint with its clock and loses it with one bit") {
  const trajectory::Trajectory path = test::StraightPath(0.7, 40);
  trajectory::Trajectory later = path, moved = path;
  for (trajectory::StampedPose& pose : later.poses) pose.t_s += 3.0;
  moved.poses[20].y_m = std::nextafter(moved.poses[20].y_m, 1.0);
  CHECK(Fingerprint(path) == Fingerprint(later));
  CHECK(Fingerprint(path) != Fingerprint(moved));
  CHECK(Fingerprint(path) != 0);
  CHECK(Fingerprint({}) == 0);
}

TEST_CASE("The controller is rebuilt from a log with targets and from no other") {
  trajectory::Trajectory log = test::StraightPath(0.4, 41);
  for (trajectory::StampedPose& pose : log.poses) pose.yaw_rad = 0.0;
  CHECK_FALSE(RebuildLimits(log, {}).has_value());
  for (trajectory::StampedPose& pose : log.poses) {
    pose.target_x_m = pose.x_m < 0.15 ? 0.2 : 0.4;
    pose.target_y_m = 0.0;
  }
  const auto limits = RebuildLimits(log, {.v_max = 0.35});
  REQUIRE(limits.has_value());
  CHECK(limits->decisions > 20);
  CHECK(limits->largest_raw_v > 0.2);
  CHECK(limits->v_max > 0);  // the kick of each leg
}

TEST_CASE("The parts of the gap add up and the noise floor bounds what can be removed") {
  SweepResult result = Table();
  for (TrialRow& row : result.rows) {
    row.comparison.start_aligned_gap_m = row.comparison.gap_m - 0.01;
    row.comparison.shape_gap_m = row.comparison.gap_m - 0.015;
    row.comparison.frechet_m = row.comparison.gap_m - 0.002;
    row.comparison.equal_time_m = row.comparison.gap_m + 0.05;
  }
  Summarise(result);
  for (SettingResult& setting : result.settings) setting.noise_floor_m = 0.02;
  const Anatomy anatomy = Dissect(result);
  CHECK(anatomy.gap_m.n == 6);
  CHECK(anatomy.start_m.mean == Approx(0.01));
  CHECK(anatomy.frame_m.mean == Approx(0.005));
  CHECK(anatomy.start_m.mean + anatomy.frame_m.mean + anatomy.shape_m.mean ==
        Approx(anatomy.gap_m.mean));
  CHECK(anatomy.removable_m.mean == Approx(anatomy.gap_m.mean - 0.02));
  CHECK(IsClear(anatomy.start_m));
  CHECK(anatomy.timing_m.mean == Approx(0.05));
}

/// One surface, `levels` of a limit of the controller, two trials; every path is its own.
SweepResult Limits(const std::string& key, const std::vector<double>& levels) {
  SweepResult result;
  result.parameters = {{.key = key}};
  std::uint64_t path = 1;
  for (const double level : levels) {
    result.parameters[0].levels.push_back(experiment::NumberValue(level));
    for (const char* trial : {"1", "2"}) {
      TrialRow row{.theta = {experiment::NumberValue(level)}, .trial = trial};
      row.comparison.gap_m = 0.01 * static_cast<double>(path % 3);
      row.evidence.fingerprint = path++;
      result.rows.push_back(row);
    }
  }
  return result;
}

TEST_CASE("Each limit is told by its own count, by what it cuts, and for the side that it is of") {
  struct Limit {
    const char* key;
    size_t trial::LimitCounts::*bound;
    double trial::LimitCounts::*largest;
  };
  const Limit limits[] = {
      {"control.v_max", &trial::LimitCounts::v_max, &trial::LimitCounts::largest_raw_v},
      {"control.cruise_speed", &trial::LimitCounts::cruise_cap, &trial::LimitCounts::largest_raw_v},
      {"control.w_max", &trial::LimitCounts::w_max, &trial::LimitCounts::largest_raw_w}};
  for (const Limit& limit : limits) {
    for (const bool is_candidate : {true, false}) {
      INFO(limit.key << (is_candidate ? " candidate" : " reference"));
      SweepResult result = Limits(limit.key, {0.2, 0.6});
      for (size_t i = 0; i < 4; ++i) {
        TrialEvidence& evidence = result.rows[i].evidence;
        trial::LimitCounts& counts =
            (is_candidate ? evidence.candidate_limits : evidence.reference_limits).emplace();
        counts.decisions = 10 + i;
        counts.v_max = counts.cruise_cap = counts.w_max = 0;
        counts.*limit.bound = i == 1 ? 4 : 0;
        counts.largest_raw_v = counts.largest_raw_w = 0.9;
        counts.*limit.largest = 0.3 + 0.01 * static_cast<double>(i);
      }
      Summarise(result);
      const Inertness inert = FindInert(result, {})[0];
      const auto& uses = is_candidate ? inert.candidate_limit : inert.reference_limit;
      CHECK((is_candidate ? inert.reference_limit : inert.candidate_limit).empty());
      REQUIRE(uses.size() == 2);
      CHECK(uses[0].level == "0.2");
      CHECK(uses[0].value == 0.2);
      CHECK(uses[0].runs == 2);
      CHECK(uses[0].runs_bound == 1);
      CHECK(uses[0].decisions == 21);
      CHECK(uses[0].bound == 4);
      CHECK(uses[0].largest_raw == Approx(0.31));
      CHECK(uses[1].decisions == 25);
      CHECK(uses[1].runs_bound == 0);
      CHECK(uses[1].largest_raw == Approx(0.33));
      REQUIRE(inert.sentences.size() == 1);
      const std::string name = result.parameters[0].Name();
      CHECK(inert.sentences[0] ==
            name + " 0.6 never bound: the " + (is_candidate ? "candidate" : "reference") +
                "'s controller asked for 0.33 at most; 0.2 bound in 4 of 21 decisions of 2 runs");
      CHECK(inert.is_explained);
      CHECK(inert.IsInert());
    }
  }
}

TEST_CASE("A limit that always bound, or of which nothing is known, explains nothing") {
  SweepResult result = Limits("control.v_max", {0.2, 0.6});
  CHECK(FindInert(result, {})[0].sentences.empty());
  CHECK_FALSE(FindInert(result, {})[0].IsInert());
  for (TrialRow& row : result.rows) row.evidence.candidate_limits.emplace().v_max = 1;
  CHECK(FindInert(result, {})[0].sentences.empty());
  CHECK(FindInert(result, {})[0].candidate_limit.size() == 2);
  result = Limits("control.v_min", {0.2, 0.6});  // a lower limit
  for (TrialRow& row : result.rows) row.evidence.candidate_limits.emplace().v_max = 0;
  CHECK(FindInert(result, {})[0].candidate_limit.empty());
}

TEST_CASE("Pairs are of neighbouring values with everything else equal, and a path each") {
  SweepResult result = Limits("x", {1.0, 2.0, 3.0});
  result.rows[1].evidence.fingerprint = result.rows[3].evidence.fingerprint;  // trial 2 of 1 and 2
  result.rows[0].evidence.fingerprint = result.rows[4].evidence.fingerprint;  // of 1 and 3
  result.rows[5].evidence.fingerprint = 0;
  const Inertness inert = FindInert(result, {})[0];
  REQUIRE(inert.pairs.size() == 2);
  CHECK(inert.pairs[0].a == "1");
  CHECK(inert.pairs[0].b == "2");
  CHECK(inert.pairs[0].compared == 2);
  CHECK(inert.pairs[0].identical == 1);
  CHECK(inert.pairs[1].compared == 1);
  CHECK(inert.pairs[1].identical == 0);
  CHECK(inert.compared == 3);
  CHECK(inert.identical == 1);
  CHECK_FALSE(inert.NeverChangedAPath());
}

TEST_CASE("A single pair that is the same is told as such, and of many values the first five") {
  SweepResult one = Limits("x", {1.0, 2.0});
  one.rows.erase(one.rows.begin() + 1);
  one.rows.pop_back();
  one.rows[1].evidence.fingerprint = one.rows[0].evidence.fingerprint;
  CHECK(FindInert(one, {})[0].sentences.at(0) ==
        "x did not change the candidate's path in the one pair of trials that differ in it alone: "
        "the two are the same to the last bit");
  for (const int values : {6, 7, 9}) {
    std::vector<double> levels;
    for (int i = 1; i <= values + 1; ++i) levels.push_back(i);
    SweepResult result = Limits("x", levels);
    for (const TrialRow& row : std::vector<TrialRow>(result.rows)) {
      result.rows.push_back(row);
      result.rows.back().trial += "'";
    }
    for (size_t i = 0; i < result.rows.size(); ++i) {  // all but the last value drive one path
      if (*result.rows[i].theta[0].number <= values) result.rows[i].evidence.fingerprint = 77;
    }
    const std::string names = values == 6   ? "1, 2, 3, 4, 5 and 6"
                              : values == 7 ? "1, 2, 3, 4, 5 and 2 more"
                                            : "1, 2, 3, 4, 5 and 4 more";
    CHECK(FindInert(result, {})[0].sentences.at(0) ==
          "with x " + names + " the candidate drove the same path to the last bit in all " +
              std::to_string(4 * (values - 1)) + " pairs of trials");
  }
}

TEST_CASE("Groups of equal values are told apart, and two equal paths alone are no group") {
  SweepResult result = Limits("x", {1.0, 2.0, 3.0, 4.0, 5.0});
  for (const TrialRow& row : std::vector<TrialRow>(result.rows)) {
    result.rows.push_back(row);
    result.rows.back().trial += "'";
  }
  const auto paths = [&](const std::vector<std::uint64_t>& by_level) {
    for (TrialRow& row : result.rows) {
      row.evidence.fingerprint = by_level[static_cast<size_t>(*row.theta[0].number) - 1];
    }
    return FindInert(result, {})[0].sentences;
  };
  CHECK(paths({1, 1, 2, 3, 3}).at(0) ==
        "with x 1 and 2, and with 4 and 5 the candidate drove the same path to the last bit in all "
        "8 pairs of trials");
  CHECK(paths({1, 2, 3, 4, 5}).empty());
  std::erase_if(result.rows, [](const TrialRow& row) { return row.trial == "2'"; });
  CHECK(paths({1, 1, 2, 3, 4}).at(0) ==
        "with x 1 and 2 the candidate drove the same path to the last bit in all 3 pairs of "
        "trials");
  std::erase_if(result.rows, [](const TrialRow& row) { return row.trial.size() > 1; });
  CHECK(paths({1, 1, 2, 3, 4}).empty());  // two pairs
}

}  // namespace
}  // namespace rift::sweep
