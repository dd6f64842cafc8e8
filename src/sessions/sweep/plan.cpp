#include "rift/sessions/sweep/plan.hpp"

#include <fmt/format.h>

#include "rift/experiment/task.hpp"
#include "rift/sweep/falsify/verdict.hpp"

namespace rift::sessions {
namespace {

bool LacksSpace(const experiment::Experiment& experiment) {
  return experiment.candidate.kind == experiment::CandidateKind::kSimulation &&
         experiment.space.parameters.empty();
}

}  // namespace

experiment::Experiment PlanSweep(experiment::Experiment loaded) {
  if (LacksSpace(loaded)) loaded.space = experiment::PaperSpace();
  return loaded;
}

void NotePlan(const experiment::Experiment& loaded, const std::string& file,
              const std::function<void(const std::string&)>& say) {
  if (LacksSpace(loaded)) {
    say(fmt::format("note: {} names no space: the paper's grid of surface, v_min and v_max", file));
  }
  for (const std::string& note : experiment::TaskNotes(loaded, file)) say(note);
  if (loaded.candidate.kind == experiment::CandidateKind::kSimulation) {
    const auto warning = simulation::TiltWarning(loaded.simulation.body);
    if (warning) say("warning: " + *warning);
    if (const auto line = experiment::FullLineNote(loaded)) say(*line);
    if (const auto host = experiment::IdleHostNote(loaded)) say(*host);
  }
  if (loaded.goal != experiment::Goal::kFalsify) return;
  const int needed = sweep::TrialsToFalsify(loaded.falsify, loaded.search.budget);
  if (loaded.falsify.most_repeats >= needed) return;
  say(fmt::format(
      "note: falsify.most_repeats is {}, and it takes {} failing trials to falsify the first of {} "
      "settings at {:g} % confidence: settings that fail may stay undecided",
      loaded.falsify.most_repeats, needed, loaded.search.budget,
      100.0 * loaded.falsify.confidence));
}

}  // namespace rift::sessions
