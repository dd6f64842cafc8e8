#include "support/trial_files.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rift/geometry/angle.hpp"

namespace rift::test {
namespace {

std::vector<TrialRow> ReadRows(const std::filesystem::path& path, TrialKind kind) {
  std::ifstream file(path);
  std::vector<TrialRow> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double t, x, y, z, roll, pitch, yaw, target_x, target_y;
    REQUIRE(fields >> t >> x >> y >> z >> roll >> pitch >> yaw >> target_x >> target_y);
    const double yaw_rad =
        kind == TrialKind::kWebots ? yaw - 0.5 * geometry::kPi : geometry::RadFromDeg(yaw);
    if (rows.empty() || t > rows.back().t_s) {
      rows.push_back({t, x, y, geometry::WrapToPi(yaw_rad), target_x, target_y});
    }
  }
  return rows;
}

double NumberAfter(const std::string& name, const std::string& key) {
  return std::stod(name.substr(name.find(key) + key.size(), 4));
}

}  // namespace

std::vector<TrialFile> LoadTrials(const std::string& surface, TrialKind kind) {
  const std::filesystem::path folder =
      std::filesystem::path(RIFT_SOURCE_DIR) / ".." / "shared" / "trials" / surface;
  std::vector<TrialFile> trials;
  if (!std::filesystem::exists(folder)) {
    WARN("SKIPPED: no " << surface << " trials beside this clone");
    return trials;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const bool is_webots = file.find("webots") != std::string::npos;
    if (is_webots != (kind == TrialKind::kWebots)) continue;
    trials.push_back({surface + "/" + file, surface, NumberAfter(file, "vmin"),
                      NumberAfter(file, "vmax"), ReadRows(entry.path(), kind)});
  }
  std::sort(trials.begin(), trials.end(),
            [](const TrialFile& a, const TrialFile& b) { return a.name < b.name; });
  return trials;
}

}  // namespace rift::test
