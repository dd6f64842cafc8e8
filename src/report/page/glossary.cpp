#include <fmt/format.h>

#include "parts.hpp"
#include "rift/experiment/words.hpp"
#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {

nlohmann::json Glossary(const sweep::SweepResult& result) {
  const double percent = 100.0 * result.judged_by.share;
  nlohmann::json words = {
      {"gap", fmt::format("{}, in metres", gap::DefinitionText(result.gap, result.tag_offset_m))},
      {"threshold",
       fmt::format("the gap above which a run fails: {} m", Number(result.gap.threshold_m))},
      {"falsified",
       fmt::format("shown to fail in more than {:g} % of its runs (falsify.share)", percent)},
      {"passed", fmt::format("shown to fail in fewer than {:g} % of its runs", percent)},
      {"not seen to fail", "no run failed, and there are too few to show that few would"},
      {"undecided",
       "some runs failed, too few to tell whether the share of failing runs is too "
       "large"},
      {"loss",
       "what a trial costs: its gap, or, where the robot did not arrive, the threshold and "
       "the way that was left, in metres"},
      {"variance",
       "how much the losses of all trials differ from each other; a parameter's share "
       "is what would be gone if it did not vary"},
      {"noise floor",
       "how far repeats of the reference are from each other: no simulator can be "
       "expected to be nearer"},
      {"95 % confidence", "an interval made in this way holds the true value 19 times of 20"},
      {"u", "how far along the path, as a share of its length: 0 at the start, 1 at the end"},
      {"start-aligned gap (m)", "the gap with the first points of both paths laid together"},
      {"shape gap (m)", "the gap after the best shift and turn: what only another shape explains"},
      {"exact gap (m)", "the largest distance over the whole lines instead of over samples"},
      {"length ratio", "length of the simulated path over that of the reference"},
      {"timed_out", "the robot did not reach the last waypoint in time"},
      {"trial", "one run of the candidate against one reference"},
      {"setting", "one value for each parameter"},
      {"candidate", "the simulator that is put to the test"},
      {"reference", "what it is held against: logs of the robot, an undisturbed run, or the path"}};
  for (const experiment::Parameter& parameter : result.parameters) {
    const std::string help = experiment::HelpOf(parameter.key);
    const std::string meaning = help.empty() ? "a parameter of the sweep" : help;
    for (const std::string& name : {parameter.Name(), experiment::LabelOf(parameter.Name())}) {
      words[name] = fmt::format("{} ({})", meaning, parameter.key);
    }
  }
  return words;
}

}  // namespace rift::report
