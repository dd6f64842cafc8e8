#include "rift/sessions/sweep/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
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
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/enum_name.hpp"

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

/// Throws for what is wrong with a table.
using Refuse = std::function<void(const std::string& what)>;

struct Loaded {
  experiment::Experiment experiment;
  sweep::TabledSweep sweep;
};

/// What is read of a summary.json.
struct Summary {
  std::map<std::string, std::string> verdicts;  ///< by the setting as it is written there
  bool has_all_settings = true;                 ///< else those with the largest gaps
  size_t trials = 0;
};

Summary ReadSummary(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  Summary summary;
  bool is_whole = true;
  try {
    const ordered_json json = ordered_json::parse(files::ReadFile(file));
    summary.trials = json.at("n").get<size_t>() + json.at("not_ok").get<size_t>();
    summary.has_all_settings = !json.contains("settings_omitted");
    for (const ordered_json& setting : json.at("settings")) {
      const std::string verdict = setting.at("verdict");
      is_whole = is_whole && yaml::ValueNamed<gap::Verdict>(verdict);
      summary.verdicts[setting.at("theta").dump()] = verdict;
    }
  } catch (const ordered_json::exception&) {
    is_whole = false;
  }
  if (is_whole) return summary;
  throw std::invalid_argument(
      fmt::format("{}: it is damaged, or of another version of rift: give the command of the "
                  "sweep again, which writes it anew",
                  file.string()));
}

std::vector<report::TableRow> Rows(const fs::path& folder) {
  const std::string table = files::ReadFile(folder / "table.csv");
  try {
    return report::TableRows(table);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}/{}", folder.string(), error.what()));
  }
}

/// A value of the list, or any number where there is a range.
bool IsIn(const experiment::Parameter& parameter, const experiment::ParameterValue& value) {
  if (parameter.IsContinuous()) return value.number && std::isfinite(*value.number);
  return std::any_of(parameter.levels.begin(), parameter.levels.end(),
                     [&](const auto& level) { return experiment::SameValue(level, value); });
}

void RequireInSpace(const std::vector<experiment::Parameter>& parameters,
                    const experiment::Theta& theta, const Refuse& refuse) {
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (IsIn(parameters[i], theta[i])) continue;
    refuse(fmt::format("has the {} '{}', which space in experiment.yaml does not have",
                       parameters[i].Name(), theta[i].text));
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
  const std::string table = (folder / "table.csv").string();
  const Refuse refuse = [&table](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("{} {}: they are of two sweeps, or damaged; give the command of the sweep "
                    "again, which writes both anew",
                    table, what));
  };
  const Summary summary = ReadSummary(folder);
  const std::vector<report::TableRow> rows = Rows(folder);
  if (rows.size() != summary.trials) {
    refuse(fmt::format("has {} rows, and summary.json tells of {}", rows.size(), summary.trials));
  }
  for (const report::TableRow& row : rows) {
    const experiment::Theta theta = report::RequestOf(loaded.experiment, row, table).theta;
    RequireInSpace(parameters, theta, refuse);
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
    const auto verdict = summary.verdicts.find(report::ThetaJson(parameters, theta).dump());
    if (verdict != summary.verdicts.end()) {
      loaded.sweep.verdicts[key] = verdict->second;
    } else if (summary.has_all_settings) {
      refuse(fmt::format("has the setting {}, and summary.json no verdict on it",
                         sweep::SettingText(parameters, theta)));
    }
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
