#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

TEST_CASE("Only terminal/print.cpp writes to stdout and stderr") {
  const std::regex prints(
      R"(fmt::print|std::c(out|err|log)\b|\b[vfd]?printf\(|\b(put(s|char)|perror)\()"
      R"(|\bf(write|put[cs])\(.*\bstd(out|err)\b)");
  int lines = 0;
  for (const char* top : {"src", "include/rift"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(test::SourceDir()) / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      if (entry.path().string().ends_with("src/terminal/print.cpp")) continue;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number, ++lines) {
        INFO(entry.path().string() << ":" << number << ": " << line);
        if (std::regex_search(line, prints)) FAIL_CHECK("prints by itself");
      }
    }
  }
  CHECK(lines > 1000);
}

}  // namespace
}  // namespace rift
