#pragma once

#include <functional>
#include <string>
#include <vector>

#include "support/tree.hpp"

namespace rift::test {

/// A command that writes `file` below the folder `out`, which is there.
struct Work {
  using Words = std::vector<std::string>;

  std::string name;
  std::function<Words(const std::string& out)> words;
  std::string file;
};

/// One of gap, simulate, sweep and track, in this order. A second each.
inline std::vector<Work> Works() {
  using Words = Work::Words;
  const std::string source = SourceDir();
  return {{"gap",
           [source](const std::string& out) {
             const std::string example = source + "/data/example/";
             return Words{"gap", example + "simulator.csv", example + "robot1.csv", "--profile",
                          out + "/profile.csv"};
           },
           "profile.csv"},
          {"simulate",
           [source](const std::string& out) {
             return Words{"simulate", source + "/configs/waypoints/paper.yaml", "--out", out};
           },
           "trajectory.csv"},
          {"sweep",
           [source](const std::string& out) {
             return Words{"sweep",  source + "/configs/waypoints/paper.yaml",
                          "--set",  "space={surface: [ground, parchment], v_min: [0.14, 0.16]}",
                          "--jobs", "2",
                          "--out",  out};
           },
           "table.csv"},
          {"track",
           [source](const std::string& out) {
             const std::string camera = source + "/data/camera/";
             return Words{"track",
                          "--camera",
                          camera + "frames/*.jpg",
                          "--fps",
                          "15",
                          "--calibration",
                          camera + "camera.yaml",
                          "--out",
                          out + "/log.csv"};
           },
           "log.csv"}};
}

}  // namespace rift::test
