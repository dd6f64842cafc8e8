#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <string>

#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

using OnLine = std::function<void(const std::string& where, const std::string& line)>;

/// Every line of code outside the room of statistics.
void ForEachLineElsewhere(const OnLine& on_line) {
  for (const char* top : {"src", "include/rift"}) {
    const fs::path root = fs::path(test::SourceDir()) / top;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      if (entry.path().parent_path().filename() == "statistics") continue;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number) {
        on_line(entry.path().string() + ":" + std::to_string(number), line);
      }
    }
  }
}

void CheckNowhereElse(const std::regex& pattern) {
  int lines = 0;
  ForEachLineElsewhere([&](const std::string& where, const std::string& line) {
    ++lines;
    INFO(where << ": " << line);
    if (std::regex_search(line, pattern)) FAIL_CHECK("a second definition");
  });
  CHECK(lines > 1000);
}

TEST_CASE("Quantiles of a list are computed by the room of statistics alone") {
  // A selection, a function of that name over a list, or an index that is a share of the length.
  CheckNowhereElse(
      std::regex("nth_element"
                 R"(|double (Median|Quantile|Percentile)\w*\((const )?std::(vector<double>|span))"
                 R"(|\[.*(share|percent|0\.\d+) \* .*size\(\))"
                 R"(|\[.*size\(\) \* \d+ / 100\])"));
}

TEST_CASE("Means and spreads of a list are computed by the room of statistics alone") {
  CheckNowhereElse(std::regex(
      R"(double (Mean|Variance|StandardDeviation|Scatter)\((const )?std::(vector<double>&|span))"));
}

TEST_CASE("Hashes are computed and seeds are mixed by the room of statistics alone") {
  CheckNowhereElse(std::regex(
      R"(0x(9e3779b97f4a7c15|bf58476d1ce4e5b9|ff51afd7ed558ccd|cbf29ce484222325|100000001b3))",
      std::regex::icase));
}

}  // namespace
}  // namespace rift
