// What each strategy promises of its points, and the very points it proposed when that was
// approved.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "rift/search/options.hpp"
#include "search/samplers.hpp"
#include "search/surrogate.hpp"
#include "support/pinned.hpp"

namespace rift::search {
namespace {

const std::vector<Axis> kUnlike{{"a", AxisKind::kContinuous, -2.0, 3.0},
                                {"b", AxisKind::kContinuous, 10.0, 12.0},
                                {"n", AxisKind::kInteger, -3, 7},
                                {"w", AxisKind::kCategorical, 0, 2}};

/// Of all axes something else: no exchange of axes, signs or levels leaves it as it is.
double Skewed(const Point& p) {
  const double a = p[0] - 1.3, b = p[1] - 10.4, n = p[2] - 4.0;
  if (std::sin(37.0 * p[0] + p[1]) > 0.93) return std::numeric_limits<double>::quiet_NaN();
  return a * a + 3.0 * b * b + 0.8 * a * b + 0.05 * n * n + 0.4 * std::abs(p[3] - 1.0) +
         0.1 * std::sin(5.0 * a);
}

std::vector<Evaluation> Run(Method method, int budget, std::uint64_t seed,
                            const std::vector<Axis>& axes,
                            const std::function<double(const Point&)>& loss, int of_batch = 8) {
  SearchOptions options;
  options.strategy = method;
  options.batch = of_batch;
  const auto strategy = MakeStrategy(options, axes, budget, seed);
  std::vector<Evaluation> all;
  while (static_cast<int>(all.size()) < budget) {
    std::vector<Evaluation> batch;
    for (const Point& p : strategy->Ask(budget - static_cast<int>(all.size()))) {
      batch.push_back({p, loss(p)});
    }
    if (batch.empty()) break;
    strategy->Tell(batch);
    all.insert(all.end(), batch.begin(), batch.end());
  }
  return all;
}

TEST_CASE("Every strategy proposes the points that were approved, to six digits") {
  constexpr auto kNames = EnumNames(Method{});
  std::string text;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto method = static_cast<Method>(i);
    const int budget = method == Method::kPortfolio ? 260 : 120;
    const std::vector<Evaluation> all = Run(method, budget, 5, kUnlike, Skewed);
    text += fmt::format("{}\n", kNames[i]);
    for (std::size_t k = 0; k < all.size(); k += k < 24 ? 1 : 7) {
      const Point& p = all[k].point;
      text += fmt::format("  {}: {:.6g} {:.6g} {} {} > {:.6g}\n", k, p[0], p[1], p[2], p[3],
                          all[k].loss);
    }
  }
  // Which methods go first depends on every axis, the first one too.
  const std::vector<Axis> category_first{kUnlike[3], kUnlike[0], kUnlike[1]};
  const auto loss = [](const Point& p) { return Skewed({p[1], p[2], 4.0, p[0]}); };
  text += "portfolio, category first\n";
  for (const Evaluation& one : Run(Method::kPortfolio, 80, 5, category_first, loss)) {
    const Point& p = one.point;
    text += fmt::format("  {} {:.6g} {:.6g} > {:.6g}\n", p[0], p[1], p[2], one.loss);
  }
  CHECK(test::DifferenceFromPinned("search/proposals.txt", text) == "");
}

/// Every `every`th point of a search, and its last.
std::string Sampled(const std::string& name, Method method, int budget, int every,
                    const std::vector<Axis>& axes, const std::function<double(const Point&)>& loss,
                    int of_batch = 8) {
  std::string text = name + "\n";
  const std::vector<Evaluation> all = Run(method, budget, 5, axes, loss, of_batch);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool is_shown = (k + 1) % static_cast<std::size_t>(every) == 0 || k + 1 == all.size();
    if (!is_shown) continue;
    text += fmt::format("  {}:", k);
    for (const double value : all[k].point) text += fmt::format(" {:.5g}", value);
    text += fmt::format(" > {:.5g}\n", all[k].loss);
  }
  return text;
}

TEST_CASE("Long searches, with restarts and what goes beyond them, propose what was approved") {
  const std::vector<Axis> two{kUnlike[0], kUnlike[1]};
  const auto ridge = [](const Point& p) {
    const double a = p[0] - 1.3, b = p[1] - 10.4;
    return std::abs(a + 2.0 * b) + 0.3 * std::abs(a);
  };
  const auto waves = [](const Point& p) {
    return std::sin(7.0 * p[0]) + std::cos(11.0 * p[1]) + 0.1 * std::pow(p[0] - 1.0, 2);
  };
  const std::vector<Axis> words{{"u", AxisKind::kCategorical, 0, 6},
                                {"v", AxisKind::kCategorical, 0, 4},
                                {"n", AxisKind::kInteger, -8, 8}};
  const auto of_words = [](const Point& p) {
    return std::abs(p[0] - 4.0) + 2.0 * (p[1] == 3.0 ? 0.0 : 1.0) + 0.05 * p[2] * p[2] +
           (p[0] == 1.0 && p[2] == 5.0 ? -4.0 : 0.0);
  };
  std::string text;
  for (const Method method : {Method::kCmaEs, Method::kEvolution, Method::kCrs, Method::kBobyqa}) {
    const std::string name(EnumNames(Method{})[static_cast<std::size_t>(method)]);
    // A local model runs over all its losses again for each point.
    const int budget = method == Method::kBobyqa ? 200 : 600;
    text += Sampled(name + ", a ridge", method, budget, 40, two, ridge);
    text += Sampled(name + ", waves", method, budget, 40, two, waves);
    text += Sampled(name + ", words", method, 200, 20, words, of_words);
    text += Sampled(name + ", unlike axes", method, budget, 40, kUnlike, Skewed);
  }
  text += Sampled("surrogate, waves", Method::kSurrogate, 160, 20, two, waves);
  text += Sampled("surrogate, words", Method::kSurrogate, 120, 20, words, of_words);
  text += Sampled("portfolio, waves", Method::kPortfolio, 680, 40, two, waves);
  text += Sampled("portfolio, a ridge", Method::kPortfolio, 250, 25, two, ridge);
  text += Sampled("portfolio, words", Method::kPortfolio, 300, 25, words, of_words);
  text += Sampled("portfolio, unlike axes", Method::kPortfolio, 400, 50, kUnlike, Skewed);
  CHECK(test::DifferenceFromPinned("search/long_searches.txt", text) == "");
}

TEST_CASE(
    "Searches of odd spaces, in small batches and with losses that are none, are as approved") {
  const Axis fixed{"f", AxisKind::kContinuous, 2.5, 2.5}, one{"o", AxisKind::kInteger, 4, 4};
  const std::vector<std::pair<std::string, std::vector<Axis>>> spaces{
      {"one range", {kUnlike[0]}},
      {"no width, one choice", {fixed, kUnlike[0], one, kUnlike[1]}},
      {"numbers and words", {kUnlike[2], {"m", AxisKind::kInteger, 0, 40}, kUnlike[3]}},
      {"huge", {{"h", AxisKind::kContinuous, -1e308, 1e308}, kUnlike[1], kUnlike[2]}}};
  const auto loss = [](const Point& p) {
    double sum = 0.0, product = 1.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double off = std::tanh(0.2 * p[i]) - 0.2 * static_cast<double>(i + 1);
      sum += off * off * static_cast<double>(i + 1);
      product *= off;
    }
    if (std::sin(40.0 * sum) > 0.9) return std::numeric_limits<double>::infinity();
    return sum + 0.5 * product - (sum < 0.1 ? 1e120 * (0.1 - sum) : 0.0);
  };
  constexpr auto kNames = EnumNames(Method{});
  std::string text;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    for (const auto& [name, axes] : spaces) {
      text += Sampled(fmt::format("{}, {}", kNames[i], name), static_cast<Method>(i), 100, 9, axes,
                      loss, 3);
    }
  }
  CHECK(test::DifferenceFromPinned("search/odd_spaces.txt", text) == "");
}

TEST_CASE("Each axis of a Latin hypercube has one point in each stratum, and axes are unrelated") {
  const std::vector<Axis> axes{{"a", AxisKind::kContinuous, 0.0, 1.0},
                               {"b", AxisKind::kContinuous, 0.0, 1.0},
                               {"c", AxisKind::kContinuous, 0.0, 1.0}};
  constexpr int kPoints = 64;
  const auto all = Run(Method::kLatinHypercube, kPoints, 3, axes, [](const Point&) { return 0.0; });
  REQUIRE(all.size() == kPoints);
  for (int axis = 0; axis < 3; ++axis) {
    std::set<int> strata;
    for (const Evaluation& one : all) {
      strata.insert(static_cast<int>(one.point[axis] * kPoints));
      const int other = (axis + 1) % 3;
      CHECK(one.point[axis] != one.point[other]);
    }
    CHECK(strata.size() == kPoints);
  }
  for (const auto& [i, k] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    double sum = 0.0;
    for (const Evaluation& one : all) sum += (one.point[i] - 0.5) * (one.point[k] - 0.5);
    CHECK(std::abs(sum / kPoints * 12.0) < 0.4);  // correlation; 1 on a diagonal
  }
}

TEST_CASE("Projections of random and Sobol points fill every axis and every pair of axes evenly") {
  const std::vector<Axis> axes(4, {"a", AxisKind::kContinuous, 0.0, 1.0});
  for (const Method method : {Method::kRandom, Method::kSobol}) {
    const auto all = Run(method, 1024, 7, axes, [](const Point&) { return 0.0; });
    const double slack = method == Method::kSobol ? 0.13 : 0.45;
    for (int i = 0; i < 4; ++i) {
      for (int k = i + 1; k < 4; ++k) {
        std::array<int, 16> cells{};
        for (const Evaluation& one : all) {
          ++cells[4 * static_cast<size_t>(4.0 * one.point[i]) +
                  static_cast<size_t>(4.0 * one.point[k])];
        }
        const auto [least, most] = std::minmax_element(cells.begin(), cells.end());
        CHECK(*least > 64 * (1.0 - slack));
        CHECK(*most < 64 * (1.0 + slack));
      }
    }
  }
}

TEST_CASE("Corners lie on the bounds and all of them are visited before anything else") {
  const std::vector<Axis> axes(kUnlike);
  const auto all = Run(Method::kCorners, 30, 2, axes, Skewed);
  std::set<Point> corners;
  for (std::size_t i = 0; i < 24; ++i) {  // 2 x 2 x 2 bounds x 3 words
    for (int axis = 0; axis < 3; ++axis) {
      CHECK((all[i].point[axis] == axes[axis].min || all[i].point[axis] == axes[axis].max));
    }
    corners.insert(all[i].point);
  }
  CHECK(corners.size() == 24);
  CHECK(std::any_of(all.begin() + 24, all.end(), [](const Evaluation& one) {
    return one.point[0] != -2.0 && one.point[0] != 3.0;
  }));
}

TEST_CASE("Kriging knows the surface where it was told and is unsure elsewhere") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}, {"w", AxisKind::kCategorical, 0, 1}});
  Eigen::MatrixXd points(24, 2);
  Eigen::VectorXd values(24);
  for (int i = 0; i < 24; ++i) {
    points(i, 0) = (i / 2) / 22.0;  // the left half of the axis
    points(i, 1) = i % 2 == 0 ? 0.25 : 0.75;
    values[i] = std::sin(9.0 * points(i, 0)) + (i % 2 == 0 ? -0.6 : 0.6);
  }
  Kriging model(space);
  statistics::Random random(1, 1);
  model.Fit(points, values, 30, random);
  const Kriging::Prediction there = model.Predict(points);
  CHECK((there.mean - values).cwiseAbs().maxCoeff() < 0.05);
  Eigen::MatrixXd between(2, 2), far(2, 2);
  between << 0.21, 0.25, 0.21, 0.75;
  far << 0.95, 0.25, 0.95, 0.75;
  const Kriging::Prediction near_them = model.Predict(between), off = model.Predict(far);
  CHECK(near_them.mean[0] == Approx(std::sin(9.0 * 0.21) - 0.6).margin(0.05));
  CHECK(near_them.mean[1] == Approx(std::sin(9.0 * 0.21) + 0.6).margin(0.05));
  for (int i = 0; i < 2; ++i) {
    CHECK(off.variance[i] > 20.0 * near_them.variance[i]);
    CHECK(near_them.variance[i] > 0.5 * there.variance.minCoeff());
  }
  // Far from all data the variance is the signal's own.
  CHECK(off.variance[0] < 4.0 * values.squaredNorm() / 24.0);
  const Eigen::VectorXd at = points.row(0);
  const Eigen::VectorXd correlation = model.Correlation(points, at);
  CHECK(correlation[0] == Approx(1.0));
  CHECK(correlation[2] < 1.0);
  CHECK(correlation[22] < correlation[2]);
  CHECK(correlation[1] < correlation[0]);
}

TEST_CASE("Every strategy that learns comes nearer to the minimum than random points") {
  const std::vector<Axis> axes{{"a", AxisKind::kContinuous, -2.0, 3.0},
                               {"b", AxisKind::kContinuous, 10.0, 12.0},
                               {"c", AxisKind::kContinuous, 0.0, 1.0}};
  const auto loss = [](const Point& p) {
    const double a = (p[0] - 1.3) / 5.0, b = (p[1] - 10.4) / 2.0, c = p[2] - 0.83;
    return a * a + 2.0 * b * b + 4.0 * c * c + a * b;
  };
  const auto best = [&](Method method) {
    double least = 1e9;
    for (const Evaluation& one : Run(method, 150, 4, axes, loss)) least = std::min(least, one.loss);
    return least;
  };
  const double random = best(Method::kRandom);
  CHECK(best(Method::kSurrogate) < 0.05 * random);
  CHECK(best(Method::kCmaEs) < 0.3 * random);
  CHECK(best(Method::kBobyqa) < 0.01 * random);
  CHECK(best(Method::kEvolution) < random);
  CHECK(best(Method::kCrs) < 0.3 * random);
  CHECK(best(Method::kPortfolio) < 0.1 * random);
}

TEST_CASE("Controlled random search keeps to the category and the corner where losses are least") {
  const std::vector<Axis> axes{{"a", AxisKind::kContinuous, 0.0, 1.0},
                               {"b", AxisKind::kContinuous, 0.0, 1.0},
                               {"w", AxisKind::kCategorical, 0, 4}};
  const auto all = Run(Method::kCrs, 300, 6, axes, [](const Point& p) {
    return 2.0 - p[0] - p[1] + (p[2] == 2.0 ? 0.0 : 1.0);
  });
  int of_category = 0, at_bounds = 0;
  for (std::size_t i = 200; i < all.size(); ++i) {
    of_category += all[i].point[2] == 2.0;
    at_bounds += all[i].point[0] == 1.0 || all[i].point[1] == 1.0;
  }
  CHECK(of_category > 80);  // 20 of random ones
  CHECK(at_bounds > 40);    // none of random ones
}

TEST_CASE("The portfolio never gives up interior points, whatever the others gain") {
  const std::vector<Axis> axes{{"a", AxisKind::kContinuous, 0.0, 1.0},
                               {"b", AxisKind::kContinuous, 0.0, 1.0}};
  double least = 0.0;  // every point of one corner is better than all before
  const auto all = Run(Method::kPortfolio, 600, 8, axes, [&](const Point& p) {
    return p[0] < 0.3 && p[1] < 0.3 ? least -= 1.0 : p[0] + p[1];
  });
  int far = 0;  // nearly half the space, where nothing is gained
  for (std::size_t i = 300; i < all.size(); ++i) {
    far +=
        all[i].point[0] + all[i].point[1] > 1.0 && all[i].point[0] < 1.0 && all[i].point[1] < 1.0;
  }
  // Of 300 points a share of 0.15 anywhere, and no more while the others gain.
  CHECK(far >= 15);
  CHECK(far <= 40);
}

}  // namespace
}  // namespace rift::search
