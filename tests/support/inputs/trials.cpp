#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rift::test {
namespace {

double NumberAfter(const std::string& name, const std::string& key) {
  return std::stod(name.substr(name.find(key) + key.size(), 4));
}

}  // namespace

std::filesystem::path TrialsFolder() {
  const std::filesystem::path folder =
      std::filesystem::path(SourceDir()) / ".." / "shared" / "trials";
  return std::filesystem::exists(folder / "published_gaps.csv") ? folder : std::filesystem::path();
}

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<TrialPair> PublishedPairs() {
  std::istringstream table(ReadFile(TrialsFolder() / "published_gaps.csv"));
  std::string line;
  std::getline(table, line);
  std::vector<TrialPair> pairs;
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    TrialPair pair;
    std::string trial, gap;
    std::getline(cells, pair.surface, ',');
    std::getline(cells, pair.v_min, ',');
    std::getline(cells, pair.v_max, ',');
    std::getline(cells, trial, ',');
    std::getline(cells, gap, ',');
    pair.trial = std::stoi(trial);
    pair.published_gap_m = std::stod(gap);
    const std::string stem = "vmin" + pair.v_min + "_vmax" + pair.v_max;
    pair.webots = TrialsFolder() / pair.surface / (stem + "_webots.csv");
    pair.real = TrialsFolder() / pair.surface / (stem + "_real" + trial + ".csv");
    pairs.push_back(pair);
  }
  return pairs;
}

trajectory::Trajectory LoadTrajectory(const std::filesystem::path& path,
                                      trajectory::Format format) {
  return trajectory::ReadLog(ReadFile(path), path.string(), format).trajectory;
}

std::vector<TrialLog> LogsOn(const std::string& surface, trajectory::Format format) {
  std::vector<TrialLog> logs;
  for (const auto& entry : std::filesystem::directory_iterator(TrialsFolder() / surface)) {
    const std::string file = entry.path().filename().string();
    const bool is_webots = file.find("webots") != std::string::npos;
    if (is_webots != (format == trajectory::Format::kWebots)) continue;
    logs.push_back({surface + "/" + file, NumberAfter(file, "vmin"), NumberAfter(file, "vmax"),
                    LoadTrajectory(entry.path(), format)});
  }
  std::sort(logs.begin(), logs.end(),
            [](const TrialLog& a, const TrialLog& b) { return a.name < b.name; });
  return logs;
}

}  // namespace rift::test
