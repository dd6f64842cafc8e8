// How many columns a model of effects may have, and what it says where they are too many.
#include "sweep/explain/expansion.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "rift/sweep/explain/effects.hpp"
#include "sweep/explain/effect_rows.hpp"

namespace rift::sweep {
namespace {

TEST_CASE("What goes with parameters that cannot be told apart is said from a tenth on") {
  // a and b are always changed together, and c by itself; of the variance a and b have that share.
  const auto note = [](double share) {
    SweepResult result;
    for (const char* key : {"a", "b", "c"}) {
      result.parameters.push_back({.key = key, .levels = {{"0", 0.0}, {"1", 1.0}}});
    }
    for (const size_t ab : {0, 1}) {
      for (const size_t c : {0, 1}) {
        for (const double off_m : {-1e-6, 1e-6}) {
          const auto& levels = result.parameters[0].levels;
          const double gap_m = 0.1 * (std::sqrt(share) * static_cast<double>(ab) +
                                      std::sqrt(1.0 - share) * static_cast<double>(c));
          result.rows.push_back(Row({levels[ab], levels[ab], levels[c]}, gap_m + off_m));
        }
      }
    }
    const Effects found = MeasureEffects(result);
    CHECK(found.degree == 1);
    CHECK(found.predicted == -1.0);  // nothing is, with one column too many
    REQUIRE(found.parameters.size() == 3);
    CHECK(found.parameters[0].name == "c");
    CHECK(found.parameters[0].share == Approx(1.0 - share));
    CHECK(std::isnan(found.parameters[1].share));
    CHECK(std::isnan(found.parameters[2].share));
    return found.note.substr(found.note.rfind("; ") + 2);
  };
  CHECK(note(0.15) ==
        "15 % goes with parameters that were changed together and cannot be told apart between "
        "them");
  CHECK(note(0.095) == "with so little, the shares say what it saw and not what is");
}

TEST_CASE("A plain model has at most 300 columns, one for each value of a list") {
  const auto terms = [](int levels) {
    SweepResult result;
    result.parameters = {{.key = "a"}};
    for (int i = 0; i < levels + 2; ++i) {
      const experiment::ParameterValue value = experiment::NumberValue(i % levels);
      if (i < levels) result.parameters[0].levels.push_back(value);
      result.rows.push_back(Row({value}, 0.01 * (i % 7)));
    }
    return BestExpansion(result, Observe(result, 1000), {.most_terms = 9, .most_degree = 1})
        .terms.size();
  };
  CHECK(terms(300) == 300);
  CHECK(terms(301) == 0);
}

TEST_CASE("Of losses that do not vary no model predicts any") {
  SweepResult result;
  result.parameters = {{.key = "a", .min = 0.0, .max = 1.0}};
  for (int i = 0; i < 9; ++i) {
    result.rows.push_back(Row({experiment::NumberValue(0.125 * i)}, 0.25));
  }
  const Expansion found =
      BestExpansion(result, Observe(result, 1000), {.most_terms = 9, .most_degree = 3});
  CHECK(found.degree == 1);
  CHECK(found.predicted == -1.0);
}

}  // namespace
}  // namespace rift::sweep
