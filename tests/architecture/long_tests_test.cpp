// The tests that ctest starts first are tests that there are: ctest says nothing of a name that is
// none.
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <string>

#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

/// All sources of the tests of a room, sentences that are split over lines put together.
std::string SourcesOf(const std::string& room) {
  std::string text;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::SourceDir() + "/tests/" + room)) {
    if (entry.path().extension() == ".cpp") text += test::ReadFile(entry.path().string());
  }
  text = std::regex_replace(text, std::regex(R"(\n\s*)"), "");
  return std::regex_replace(text, std::regex("\"\""), "");
}

TEST_CASE("Each long test that is named is a test") {
  const std::string table = test::ReadFile(test::SourceDir() + "/tests/long_tests.cmake");
  const std::regex row(
      R"(set_tests_properties\(\[==\[(\w+):([^\]]*)\]==\] PROPERTIES COST \d+[^)]*\))");
  int rows = 0;
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at, ++rows) {
    INFO(at->str());
    CHECK(SourcesOf((*at)[1]).find("TEST_CASE(\"" + (*at)[2].str() + "\"") != std::string::npos);
  }
  CHECK(rows >= 30);
}

}  // namespace
}  // namespace rift
