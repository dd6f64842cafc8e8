#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

/// Clocks that somebody may set, or a time server: an interval of theirs can be anything.
const std::regex kWallClock(
    R"(\b(system_clock|high_resolution_clock|utc_clock|file_clock|gettimeofday|ftime|timespec_get)\b)"
    R"(|CLOCK_(REALTIME|TAI)|\bstd::time\b|(^|[^\w.>:])(::)?time\((nullptr|NULL|0|&\w+)\))");

TEST_CASE("No interval is taken from a clock that can be set") {
  CHECK(std::regex_search("const auto t = std::chrono::system_clock::now();", kWallClock));
  CHECK(std::regex_search("srand(time(nullptr));", kWallClock));
  CHECK_FALSE(std::regex_search("const double end = log.time(0);", kWallClock));
  int lines = 0;
  for (const char* top : {"src", "include/rift"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(test::SourceDir()) / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number, ++lines) {
        INFO(entry.path().string() << ":" << number << ": " << line);
        if (std::regex_search(line, kWallClock)) FAIL_CHECK("a clock that can be set");
      }
    }
  }
  CHECK(lines > 1000);
}

}  // namespace
}  // namespace rift
