// Every key of an experiment with its type, range and default, pinned (tests/pinned/schema.txt): a
// change is a difference that somebody reads. What the paper says is named here beside it.

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "rift/experiment/experiment.hpp"
#include "rift/yaml/describe.hpp"
#include "support/pinned.hpp"

namespace rift::experiment {
namespace {

TEST_CASE("Keys and ranges and defaults of the schema are those that were approved") {
  std::string text;
  for (const yaml::KeyInfo& key : yaml::Describe<Experiment>()) {
    text += fmt::format("{} | {} | {} | {}\n", key.key, key.type, key.default_text, key.help);
  }
  CHECK(test::DifferenceFromPinned("schema.txt", text) == "");
}

TEST_CASE("Defaults are the paper's where the paper has them") {
  const Experiment experiment;
  CHECK(experiment.gap.samples == 2000);      // section 3.1
  CHECK(experiment.gap.threshold_m == 0.06);  // section 6.1
  CHECK(experiment.gap.skip_start == 0.0);    // the definition; the published numbers leave out 0.1
  CHECK(experiment.gap.align == gap::Align::kNone);
  const Space paper = PaperSpace();  // section 5.1
  REQUIRE(paper.parameters.size() == 3);
  for (const Parameter& parameter : paper.parameters) {
    std::string levels;
    for (const ParameterValue& level : parameter.levels) levels += level.text + " ";
    if (parameter.Name() == "v_min") CHECK(levels == "0.15 0.20 ");
    if (parameter.Name() == "v_max") CHECK(levels == "0.30 0.40 0.50 ");
  }
}

}  // namespace
}  // namespace rift::experiment
