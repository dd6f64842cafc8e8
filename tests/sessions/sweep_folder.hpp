#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/run.hpp"

namespace rift::sessions {

/// What a sweep told whoever started it, and when it is asked to end.
struct SweepTold {
  SweepSize size;
  int trials = 0;
  int from_journal = 0;
  int ticks = 0;
  std::vector<std::string> ends{};
  std::vector<std::string> lines{};  ///< notes, then warnings as they came
  int stops_after = 1'000'000;       ///< trials

  std::string Text() const {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
};

class SweepCounter final : public TrialProgress {
 public:
  explicit SweepCounter(SweepTold& told) : told_(told) {}

  void Seen(const sweep::TrialRow&, bool from_journal) override {
    ++told_.trials;
    told_.from_journal += from_journal;
  }
  void Warn(const std::string& line) override { told_.lines.push_back(line); }
  void Tick() override { ++told_.ticks; }
  void Tick(const sweep::ReferenceProgress&) override { ++told_.ticks; }
  void End(const std::string& state) override { told_.ends.push_back(state); }

 private:
  SweepTold& told_;
};

inline SweepObserver ObserverOf(SweepTold& told) {
  return {.say = [&told](const std::string& line) { told.lines.push_back(line); },
          .begin =
              [&told](const SweepSize& size) {
                told.size = size;
                return std::make_unique<SweepCounter>(told);
              },
          .shards = [](const sweep::ShardCounts&) {},
          .watch_for_stop = [&told] { return [&told] { return told.trials < told.stops_after; }; }};
}

inline sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string&) {}};
}

/// A quarter of a metre and its space; other lines of the file behind it.
inline experiment::Experiment LoadText(const std::string& text,
                                       const std::vector<std::string>& overrides = {}) {
  return experiment::LoadExperiment("sweep.yaml", overrides,
                                    [text](const std::string&) { return text; });
}

inline const std::string kShortWay =
    "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n";

/// Two surfaces, two trials of each, held against the way itself.
inline experiment::Experiment SmallGrid(const std::vector<std::string>& overrides = {}) {
  return LoadText(kShortWay +
                      "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 2}\n"
                      "space: {surface: [ground, parchment]}\n",
                  overrides);
}

/// Runs a sweep into a folder and saves its table and summary there.
inline std::optional<sweep::SweepResult> SweepInto(const std::filesystem::path& out,
                                                   const experiment::Experiment& experiment,
                                                   SweepTold& told, int jobs = 1) {
  std::filesystem::create_directories(out);
  sweep::Evaluator evaluator(experiment, "sweep.yaml", FileInputs());
  auto result = RunSweep(evaluator, {.out = out, .jobs = jobs}, ObserverOf(told));
  if (result) SaveResult(out, evaluator, *result);
  return result;
}

}  // namespace rift::sessions
