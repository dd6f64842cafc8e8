#include "support/trials.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rift::test {

std::filesystem::path TrialsFolder() {
  const std::filesystem::path folder =
      std::filesystem::path(RIFT_SOURCE_DIR) / ".." / "shared" / "trials";
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

}  // namespace rift::test
