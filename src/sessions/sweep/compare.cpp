#include "rift/sessions/sweep/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// What makes rows of two tables comparable, by the beginning of the keys.
constexpr std::string_view kSame[] = {"waypoints", "program",        "space",         "objective",
                                      "gap.",      "reference.kind", "falsify.count."};
/// What says nothing of a trial.
constexpr std::string_view kFree[] = {"name", "run.", "search.", "twin."};

template <size_t N>
bool BeginsWithOne(const std::string& key, const std::string_view (&beginnings)[N]) {
  return std::any_of(std::begin(beginnings), std::end(beginnings),
                     [&](std::string_view beginning) { return key.starts_with(beginning); });
}

struct Loaded {
  experiment::Experiment experiment;
  sweep::TabledSweep sweep;
};

/// Verdicts by the setting as summary.json writes it.
std::map<std::string, std::string> Verdicts(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  std::map<std::string, std::string> verdicts;
  try {
    const ordered_json summary = ordered_json::parse(files::ReadFile(file));
    for (const ordered_json& setting : summary.at("settings")) {
      verdicts[setting.at("theta").dump()] = setting.at("verdict");
    }
  } catch (const ordered_json::exception&) {
    throw std::invalid_argument(
        fmt::format("{}: it is damaged, or of another version of rift: give the command of the "
                    "sweep again, which writes it anew",
                    file.string()));
  }
  return verdicts;
}

std::vector<report::TableRow> Rows(const fs::path& folder) {
  const std::string table = files::ReadFile(folder / "table.csv");
  try {
    return report::TableRows(table);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}/{}", folder.string(), error.what()));
  }
}

Loaded Load(const fs::path& folder) {
  for (const char* file : {"experiment.yaml", "table.csv", "summary.json"}) {
    if (fs::is_regular_file(folder / file)) continue;
    throw std::invalid_argument(
        fmt::format("--compare {}: it is not the folder of a finished sweep: there is no {}",
                    folder.string(), file));
  }
  Loaded loaded{SavedExperiment(folder), {.folder = folder.string()}};
  const std::vector<experiment::Parameter>& parameters = loaded.experiment.space.parameters;
  const std::map<std::string, std::string> verdicts = Verdicts(folder);
  for (const report::TableRow& row : Rows(folder)) {
    const experiment::Theta theta = report::RequestOf(loaded.experiment, row).theta;
    const bool is_ok = row.at("status") == "ok", falsified = row.at("falsified") == "true";
    const std::string key = sweep::SettingKey(parameters, theta);
    loaded.sweep.trials.push_back(
        {.key = key,
         .setting = sweep::SettingText(parameters, theta),
         .trial = row.at("trial"),
         .is_told = is_ok || falsified,
         .falsified = falsified,
         .gap_m = is_ok ? std::strtod(row.at("gap_m").c_str(), nullptr) : sweep::kNotKnown,
         .theta = theta});
    const auto verdict = verdicts.find(report::ThetaJson(parameters, theta).dump());
    if (verdict != verdicts.end()) loaded.sweep.verdicts[key] = verdict->second;
  }
  return loaded;
}

/// The keys that differ. Throws std::invalid_argument for the first that must not.
std::vector<sweep::ChangedKey> ChangedKeys(const Loaded& before, const Loaded& after) {
  const std::map<std::string, std::string> earlier = experiment::FlatValues(before.experiment);
  const std::map<std::string, std::string> later = experiment::FlatValues(after.experiment);
  std::set<std::string> keys;
  for (const auto* side : {&earlier, &later}) {
    for (const auto& [key, value] : *side) keys.insert(key);
  }
  std::vector<sweep::ChangedKey> changed;
  for (const std::string& key : keys) {
    const auto value = [&](const std::map<std::string, std::string>& side) {
      const auto found = side.find(key);
      return found == side.end() ? std::string("not there") : found->second;
    };
    const std::string a = value(earlier), b = value(later);
    if (a == b || BeginsWithOne(key, kFree)) continue;
    if (BeginsWithOne(key, kSame)) {
      throw std::invalid_argument(
          fmt::format("--compare: {} and {} hold different experiments: {} is {} in the first and "
                      "{} in the second, and their trials cannot be compared",
                      before.sweep.folder, after.sweep.folder, key, report::Shortened(a, 60),
                      report::Shortened(b, 60)));
    }
    changed.push_back({key, a, b});
  }
  return changed;
}

}  // namespace

sweep::SweepChange CompareFolders(const fs::path& before, const fs::path& after) {
  const Loaded earlier = Load(before), later = Load(after);
  return sweep::CompareSweeps(earlier.sweep, later.sweep, ChangedKeys(earlier, later));
}

}  // namespace rift::sessions
