#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "support/tree.hpp"

namespace rift::test {

/// Where the build brought the packages of tests/npm.
inline std::string NpmDir() { return BuildDir() + "/npm"; }

/// False, and said, where npm did not bring them when this was built: the test is skipped.
inline bool HasNpm(const std::string& package) {
  if (std::filesystem::exists(NpmDir() + "/installed")) return true;
  WARN("SKIPPED: npm did not bring " + package + " when this was built");
  return false;
}

}  // namespace rift::test
