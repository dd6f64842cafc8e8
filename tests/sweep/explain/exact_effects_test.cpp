// Effects of small tables, each number and sentence worked out by hand.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rift/sweep/explain/effects.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "sweep/explain/effect_rows.hpp"
#include "sweep/explain/expansion.hpp"

namespace rift::sweep {
namespace {

/// One list of three words; four trials each at these means, +-0.01 and +-0.02 about them.
SweepResult OneWay(double a_m, double b_m, double c_m) {
  SweepResult result;
  result.parameters = {{.key = "x.word", .levels = {{"a", {}}, {"b", {}}, {"c", {}}}},
                       {.key = "same", .levels = {{"1", 1.0}, {"2", 2.0}}}};
  const double means_m[] = {a_m, b_m, c_m};
  for (size_t level = 0; level < 3; ++level) {
    for (const double off_m : {-0.02, -0.01, 0.01, 0.02}) {
      result.rows.push_back(
          Row({result.parameters[0].levels[level], {"1", 1.0}}, means_m[level] + off_m));
    }
  }
  return result;
}

TEST_CASE("Of one list the effect is the one-way analysis of variance") {
  const Effects found = MeasureEffects(OneWay(0.1, 0.2, 0.3));
  const double within = 3.0 * 2.0 * (0.0001 + 0.0004), between = 4.0 * 2.0 * 0.01,
               mse = within / 9.0, f = between / 2.0 / mse;
  CHECK(found.trials == 12);
  CHECK(found.degree == 1);
  CHECK(found.residual_df == 9.0);
  CHECK(found.residual_sd_m == Approx(std::sqrt(mse)));
  CHECK(found.explained == Approx(between / (between + within)));
  // Left out, a trial is predicted by the three others: its error is four thirds as large.
  CHECK(found.predicted == Approx(1.0 - within * 16.0 / 9.0 / (between + within)));
  REQUIRE(found.parameters.size() == 1);  // the other was not varied
  const ParameterEffect& word = found.parameters[0];
  CHECK(word.parameter == 0);
  CHECK(word.name == "word");
  CHECK(word.df == 2.0);
  CHECK(word.share == Approx((between - 2.0 * mse) / (between + within + mse)));
  CHECK(word.alone == Approx(word.share));
  CHECK(word.together.empty());
  CHECK(word.p < 1e-6);
  CHECK(f == Approx(120.0));
  // At noncentralities of 65.967 and 517.19 a noncentral F(2, 9) lies below 120 with 97.5 and
  // 2.5 %, by its series; with twelve trials they are shares of lambda / (lambda + 11).
  CHECK(word.share_low == Approx(65.96719904 / (65.96719904 + 11.0)).epsilon(1e-5));
  CHECK(word.share_high == Approx(517.1923294 / (517.1923294 + 11.0)).epsilon(1e-5));
  CHECK(word.IsSeen());
  CHECK(found.Of(0) == &found.parameters[0]);
  CHECK(found.Of(1) == nullptr);
}

TEST_CASE("The p-value is that of the F test, and an effect by chance is clipped at zero") {
  // F(2, 9) = 4.2565 is the 5 % point of the tables.
  const double within = 3.0 * 2.0 * (0.0001 + 0.0004), mse = within / 9.0;
  const double step_m = std::sqrt(4.2565 * 2.0 * mse / 8.0);
  const Effects found = MeasureEffects(OneWay(0.2 - step_m, 0.2, 0.2 + step_m));
  CHECK(found.parameters[0].p == Approx(0.05).margin(1e-4));
  const Effects none = MeasureEffects(OneWay(0.2, 0.2, 0.2));
  CHECK(none.parameters[0].share == 0.0);
  CHECK(none.parameters[0].share_low == 0.0);
  CHECK(none.parameters[0].p == Approx(1.0));
  CHECK_FALSE(none.parameters[0].IsSeen());
  CHECK(none.predicted < 0.0);
}

TEST_CASE("What is seen and what is not is said with its interval, and of which model") {
  const Effects seen = MeasureEffects(OneWay(0.1, 0.2, 0.3));
  CHECK(
      seen.parameters[0].sentence.starts_with("word: 95 % of the loss's variance goes with it ("));
  CHECK(seen.parameters[0].sentence.ends_with(" % with 95 % confidence)"));
  CHECK(seen.note ==
        "from a model of degree 1 through 12 trials, which explains 96 % of the variance and "
        "predicts 94 % of that of a trial left out");
  const Effects none = MeasureEffects(OneWay(0.2, 0.2, 0.2));
  CHECK(none.parameters[0].sentence.starts_with("word: no effect seen; at most "));
  CHECK(none.note ==
        "from a model of degree 1 through 12 trials, which explains 0 % of the variance and "
        "predicts 0 % of that of a trial left out; with so little, the shares say what it saw and "
        "not what is");
  const auto is_little = [](double step_m) {
    return MeasureEffects(OneWay(0.2 - step_m, 0.2, 0.2 + step_m)).note.find("with so little") !=
           std::string::npos;
  };
  CHECK(is_little(0.0301));  // predicts 48 %
  CHECK_FALSE(is_little(0.0318));
}

TEST_CASE("Two lists that act together say with whom, and how much each does alone") {
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"0", 0.0}, {"1", 1.0}}},
                       {.key = "b", .levels = {{"0", 0.0}, {"1", 1.0}}},
                       {.key = "c", .levels = {{"0", 0.0}, {"1", 1.0}}}};
  int k = 0;
  for (int a : {0, 1}) {
    for (int b : {0, 1}) {
      for (int c : {0, 1}) {
        for (const double off_m : {-0.001, 0.001}) {
          const double gap_m = 0.1 + 0.02 * a + (a == b ? 0.03 : -0.03) + off_m;
          result.rows.push_back(Row({result.parameters[0].levels[static_cast<size_t>(a)],
                                     result.parameters[1].levels[static_cast<size_t>(b)],
                                     result.parameters[2].levels[static_cast<size_t>(c)]},
                                    gap_m + 1e-6 * k++));
        }
      }
    }
  }
  const Effects found = MeasureEffects(result);
  REQUIRE(found.parameters.size() == 3);
  CHECK(found.parameters[0].name == "a");  // 16 (0.01^2 + 0.03^2) of 16 (0.001 + 1e-6)
  CHECK(found.parameters[0].share == Approx(0.999).margin(2e-3));
  CHECK(found.parameters[0].alone == Approx(0.1).margin(2e-3));
  CHECK(found.parameters[0].together == std::vector<std::string>{"b"});
  CHECK(found.parameters[1].name == "b");
  CHECK(found.parameters[1].share == Approx(0.9).margin(2e-3));
  CHECK(found.parameters[1].alone == Approx(0.0).margin(2e-3));
  CHECK(found.parameters[1].together == std::vector<std::string>{"a"});
  CHECK_FALSE(found.parameters[2].IsSeen());
  CHECK(found.parameters[2].together.empty());
  CHECK(
      found.parameters[0].sentence.ends_with(", 10 % with it alone and the rest together with b"));
}

TEST_CASE("A model that leaves nothing says all with certainty") {
  SweepResult result;
  result.parameters = {{.key = "word", .levels = {{"a", {}}, {"b", {}}, {"c", {}}}},
                       {.key = "idle", .levels = {{"x", {}}, {"y", {}}}}};
  for (size_t level = 0; level < 3; ++level) {
    for (size_t other = 0; other < 2; ++other) {
      for (int i = 0; i < 2; ++i) {
        result.rows.push_back(
            Row({result.parameters[0].levels[level], result.parameters[1].levels[other]},
                0.1 * static_cast<double>(level * level)));
      }
    }
  }
  const Effects found = MeasureEffects(result);
  CHECK(found.explained == 1.0);
  CHECK(found.predicted == Approx(1.0));
  CHECK(found.residual_sd_m == 0.0);
  REQUIRE(found.parameters.size() == 2);
  const ParameterEffect &word = found.parameters[0], &idle = found.parameters[1];
  CHECK(word.name == "word");
  CHECK(word.share == Approx(1.0));
  CHECK(word.share_low == word.share);
  CHECK(word.share_high == word.share);
  CHECK(word.p == 0.0);
  CHECK(idle.share == Approx(0.0).margin(1e-9));
  CHECK(idle.p == 1.0);
}

/// Evenly over a range, as many trials as asked for.
template <class Loss>
SweepResult Ranged(int n, double min, double max, bool is_logarithmic, const Loss& loss) {
  SweepResult result;
  result.parameters = {{.key = "x", .min = min, .max = max, .is_logarithmic = is_logarithmic}};
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) / n;
    const double x = is_logarithmic ? min * std::pow(max / min, u) : min + u * (max - min);
    result.rows.push_back(Row({{std::to_string(x), x}}, loss(x) + (i % 2 == 0 ? 1e-4 : -1e-4)));
  }
  return result;
}

TEST_CASE("A straight line, a parabola and a logarithm are models of their own degree") {
  const auto degree = [](const SweepResult& result) {
    const Effects found = MeasureEffects(result);
    CHECK(found.predicted > 0.99);
    return found.degree;
  };
  CHECK(degree(Ranged(30, 2.0, 4.0, false, [](double x) { return 0.1 * x; })) == 1);
  CHECK(degree(Ranged(30, 2.0, 4.0, false, [](double x) { return std::pow(x - 2.7, 2); })) == 2);
  CHECK(degree(Ranged(30, 2.0, 4.0, false, [](double x) { return std::pow(x - 3.0, 3); })) == 3);
  CHECK(degree(Ranged(30, 1.0, 100.0, true, [](double x) { return 0.1 * std::log(x); })) == 1);
  CHECK(degree(Ranged(30, 1.0, 100.0, false, [](double x) { return 0.1 * std::log(x); })) > 2);
}

TEST_CASE("Columns of a range are orthonormal polynomials, and of a list orthonormal contrasts") {
  SweepResult range = Ranged(2000, -3.0, 5.0, false, [](double x) { return x; });
  const Observations data = Observe(range, 5000);
  const Expansion expansion = BestExpansion(range, data, {.most_terms = 9, .most_degree = 1});
  REQUIRE(expansion.terms.size() == 2);
  CHECK(expansion.terms[0] == Orders{0});
  CHECK(expansion.terms[1] == Orders{1});
  const Eigen::MatrixXd products =
      expansion.design.transpose() * expansion.design / double(expansion.design.rows());
  CHECK((products - Eigen::MatrixXd::Identity(2, 2)).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(expansion.design(0, 1) == Approx(-std::sqrt(3.0)).epsilon(1e-2));
  CHECK(expansion.design(1999, 1) == Approx(std::sqrt(3.0)).epsilon(1e-2));
  SweepResult list = OneWay(0.1, 0.2, 0.3);
  const Observations words = Observe(list, 100);
  const Expansion contrasts = BestExpansion(list, words, {});
  REQUIRE(contrasts.design.cols() == 3);
  const Eigen::MatrixXd squares = contrasts.design.transpose() * contrasts.design / 12.0;
  CHECK((squares - Eigen::MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("A sample of a grid that is too large holds every level of its parameters") {
  SweepResult result;
  result.parameters = {{.key = "slow"}, {.key = "fast"}};
  for (int slow = 0; slow < 50; ++slow) {
    for (const double fast : {0.3, 0.5}) {  // every second row has the same one
      result.parameters[0].levels.push_back(experiment::NumberValue(slow));
      TrialRow row{.theta = {experiment::NumberValue(slow), experiment::NumberValue(fast)}};
      row.comparison.gap_m = 0.1 * fast;
      result.rows.push_back(row);
    }
  }
  result.parameters[1].levels = {experiment::NumberValue(0.3), experiment::NumberValue(0.5)};
  for (const int most : {99, 60, 50, 34}) {
    const Observations data = Observe(result, most);
    CHECK(data.rows.size() == static_cast<size_t>(most));
    CHECK(data.parameters == std::vector<int>{0, 1});
  }
}

TEST_CASE("Of too many trials a sample is looked at, and identical ones once") {
  SweepResult result = Ranged(100, 0.0, 1.0, false, [](double x) { return x; });
  CHECK(Observe(result, 100).rows.size() == 100);
  CHECK(Observe(result, 200).rows.size() == 100);
  const Observations half = Observe(result, 50);
  CHECK(half.rows.size() == 50);
  CHECK(std::is_sorted(half.rows.begin(), half.rows.end()));
  CHECK(std::adjacent_find(half.rows.begin(), half.rows.end()) == half.rows.end());
  CHECK(Observe(result, 99).rows.size() == 99);
  result.rows[3].status = TrialStatus::kCrashed;
  result.rows[4].evidence.fingerprint = result.rows[5].evidence.fingerprint = 9;
  result.rows[5].comparison.gap_m = result.rows[4].comparison.gap_m;
  const Observations told = Observe(result, 100);
  CHECK(told.rows.size() == 98);
  CHECK(told.losses_m[3] == result.rows[4].comparison.gap_m);
  CHECK(told.rows[4] == &result.rows[6]);
  CHECK(told.parameters == std::vector<int>{0});
}

TEST_CASE("A model has two trials a column at least, and two degrees of freedom left when plain") {
  const auto trials_for = [](int n, const EffectOptions& options = {}) {
    return MeasureEffects(Ranged(n, 0.0, 1.0, false, [](double x) { return std::sin(9.0 * x); }),
                          options)
        .degree;
  };
  CHECK(trials_for(3) == 0);
  CHECK(trials_for(4) >= 1);
  CHECK(trials_for(40, {.most_degree = 2}) <= 2);
  CHECK(trials_for(40, {.most_terms = 3}) <= 2);  // 1, x, x^2
  CHECK(trials_for(40) > 2);
  CHECK(trials_for(9) <= 3);
}

TEST_CASE("The least detectable difference shrinks with trials, and grows with power and scatter") {
  const double base = SmallestDetectable({10, 10}, 1.0, 18.0, 0.8);
  // Two means of ten trials each, 5 % and 80 %: 1.3249 standard deviations (tables of Cohen).
  CHECK(base == Approx(1.325).margin(0.01));
  CHECK(SmallestDetectable({10, 10}, 2.0, 18.0, 0.8) == Approx(2.0 * base));
  CHECK(SmallestDetectable({40, 40}, 1.0, 78.0, 0.8) < 0.6 * base);
  CHECK(SmallestDetectable({10, 10}, 1.0, 18.0, 0.9) > base);
  CHECK(SmallestDetectable({5, 20}, 1.0, 23.0, 0.8) > SmallestDetectable({12, 13}, 1.0, 23.0, 0.8));
  CHECK(std::isnan(SmallestDetectable({10, 10}, 1.0, 0.5, 0.8)));
  CHECK(std::isfinite(SmallestDetectable({2, 2}, 1.0, 1.0, 0.8)));
  CHECK(std::isnan(SmallestDetectable({10, 0}, 1.0, 8.0, 0.8)));
  CHECK(std::isnan(SmallestDetectable({}, 1.0, 8.0, 0.8)));
}

TEST_CASE("Parameters that were changed together are not told apart, and it is said") {
  SweepResult result;
  result.parameters = {{.key = "a", .min = 0.0, .max = 1.0}, {.key = "b", .min = 0.0, .max = 1.0}};
  for (int i = 0; i < 40; ++i) {
    const double x = (i + 0.5) / 40.0;
    result.rows.push_back(Row({{std::to_string(x), x}, {std::to_string(x), x}},
                              0.1 * x + (i % 2 == 0 ? 1e-3 : -1e-3)));
  }
  const Effects found = MeasureEffects(result);
  if (found.degree == 0) {
    CHECK_FALSE(found.note.empty());
  } else {
    CHECK(found.note.find("goes with parameters that were changed together and cannot be told "
                          "apart between them") != std::string::npos);
  }
  for (const ParameterEffect& one : found.parameters) {
    CHECK_FALSE(one.IsSeen());
    CHECK(one.sentence == one.name + ": its effect cannot be told from that of the others");
  }
}

TEST_CASE("Means closer together than chance lays them bound an effect no better than chance") {
  // Equal means of forty trials each: an F of 0, at which the interval would be nothing.
  SweepResult result = OneWay(0.2, 0.2, 0.2);
  const std::vector<TrialRow> rows = result.rows;
  for (int i = 1; i < 10; ++i) result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  const Effects equal = MeasureEffects(result);
  REQUIRE(equal.Of(0) != nullptr);
  CHECK(equal.Of(0)->share == 0.0);
  CHECK(equal.Of(0)->share_low == 0.0);
  // At a noncentrality of 9.848738 a noncentral F(2, 117) lies below 1 with 2.5 %, by its series.
  CHECK(equal.Of(0)->share_high == Approx(9.848738 / (9.848738 + 119.0)).epsilon(1e-5));
}

TEST_CASE("Repeats that a search spent on one setting do not outweigh the others") {
  SweepResult result;
  result.parameters = {{.key = "a", .min = 0.0, .max = 1.0}, {.key = "b", .min = 0.0, .max = 1.0}};
  for (int i = 0; i < 40; ++i) {
    const double a = (i + 0.5) / 40.0, b = std::fmod(7.3 * a, 1.0);
    for (int repeat = 0; repeat < (i == 25 ? 100 : 1); ++repeat) {
      result.rows.push_back(Row({{std::to_string(a), a}, {std::to_string(b), b}},
                                0.1 * a + 0.002 * std::sin(12.9 * i + 78.2 * repeat)));
    }
  }
  result.falsification = Falsification{};
  const Effects found = MeasureEffects(result);
  REQUIRE(found.Of(0) != nullptr);
  CHECK(found.Of(0)->share > 0.9);
  CHECK(found.trials == 40);
  CHECK(found.note.find("through 40 trials (the first of each setting), which") !=
        std::string::npos);
  CHECK(found.note.find("changed together") == std::string::npos);
  result.falsification.reset();
  CHECK(MeasureEffects(result).note.find(
            "through 41 trials (of each setting the first 2), which") != std::string::npos);
}

TEST_CASE("Of a grid's setting twice as many trials are looked at as the median one has") {
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"1", 1.0}, {"2", 2.0}, {"3", 3.0}, {"4", 4.0}}}};
  const auto add = [&result](size_t level, int repeats) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      result.rows.push_back(Row({result.parameters[0].levels[level]}, 0.01 + 0.001 * repeat));
    }
  };
  add(0, 1);
  add(1, 2);
  add(2, 4);
  CHECK(Observe(result, 100).rows.size() == 7);
  CHECK(Observe(result, 100).most_of_setting == 0);
  add(3, 9);
  const Observations data = Observe(result, 100);
  CHECK(data.rows.size() == 11);  // 1, 2, 4 and 4: the median one has 2
  CHECK(data.most_of_setting == 4);
  CHECK(data.rows.back() == &result.rows[10]);
}

TEST_CASE("Of a search with two settings both weigh alike, however often one was repeated") {
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"1", 1.0}, {"2", 2.0}}}};
  const bool is_first_repeated = GENERATE(true, false);
  for (size_t level = 0; level < 2; ++level) {
    for (int repeat = 0; repeat < ((level == 0) == is_first_repeated ? 100 : 1); ++repeat) {
      result.rows.push_back(Row({result.parameters[0].levels[level]}, 0.01 + 0.001 * repeat));
    }
  }
  const auto trials_of = [](const Observations& data, const std::string& level) {
    return std::count_if(data.rows.begin(), data.rows.end(),
                         [&](const TrialRow* row) { return row->theta[0].text == level; });
  };
  result.falsification = Falsification{};
  const Observations data = Observe(result, 1000);
  CHECK(data.most_of_setting == 1);
  CHECK(trials_of(data, "1") == 1);
  CHECK(trials_of(data, "2") == 1);
  result.falsification.reset();
  const Observations of_grid = Observe(result, 1000);
  CHECK(trials_of(of_grid, is_first_repeated ? "1" : "2") == 2);
  CHECK(trials_of(of_grid, is_first_repeated ? "2" : "1") == 1);
}

TEST_CASE("What chance explains is not said of parameters that were changed together") {
  // Two lists over an even grid of two repeats each, and one trial that went astray: its rows and
  // columns explain 27 %, which is what three columns explain of such noise.
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"1", 1.0}, {"2", 2.0}, {"3", 3.0}}},
                       {.key = "b", .levels = {{"1", 1.0}, {"2", 2.0}}}};
  for (const experiment::ParameterValue& a : result.parameters[0].levels) {
    for (const experiment::ParameterValue& b : result.parameters[1].levels) {
      for (int repeat = 0; repeat < 2; ++repeat) result.rows.push_back(Row({a, b}, 0.04));
    }
  }
  result.rows.back().comparison.gap_m = 0.32;
  const Effects found = MeasureEffects(result);
  CHECK(found.explained == Approx(3.0 / 11.0));
  CHECK(found.note.find("changed together") == std::string::npos);
}

TEST_CASE("Settings that all drove the same runs tell that no parameter did anything") {
  SweepResult result;
  result.parameters = {{.key = "a", .min = 0.0, .max = 1.0}};
  for (const double a : {0.1, 0.4, 0.9}) {
    TrialRow row = Row({{std::to_string(a), a}}, 0.02);
    row.trial = "1";
    row.seed = 1;
    row.evidence.fingerprint = 7;
    result.rows.push_back(row);
  }
  const auto note = [&result] {
    Summarise(result);
    return MeasureEffects(result).note;
  };
  const std::string same =
      "no parameter that was varied did anything: trials with the same random numbers are the same "
      "to the last bit at every setting that was tried";
  CHECK(note() == same);
  result.rows[1].evidence.fingerprint = 8;
  CHECK(note() == "too few trials that tell to say what matters");
  result.rows.resize(1);
  CHECK(note().empty());
  TrialRow other = result.rows[0];
  other.theta = {{"0.9", 0.9}};
  other.status = TrialStatus::kCrashed;  // of that setting no trial tells
  result.rows.push_back(other);
  CHECK(note().empty());
  result.rows[1].status = TrialStatus::kOk;
  CHECK(note() == same);
  // Beside a range a list is told with it.
  const std::vector<experiment::Parameter> range = result.parameters;
  result.parameters.push_back({.key = "b", .levels = {{"x", {}}, {"y", {}}}});
  result.rows.push_back(result.rows[1]);
  for (TrialRow& row : result.rows) row.theta.push_back({"x", {}});
  result.rows[2].theta[1] = {"y", {}};
  CHECK(note() == same);
  result.parameters = range;
  result.rows.pop_back();
  for (TrialRow& row : result.rows) row.theta.pop_back();
  result.parameters[0].levels = {{"0.1", 0.1}, {"0.9", 0.9}};  // said where lists are looked at
  CHECK(note().empty());
}

}  // namespace
}  // namespace rift::sweep
