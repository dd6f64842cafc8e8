// The range and the default of every flag that takes a number, as the help of its command has them.
#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <string>

#include "support/processes/process.hpp"

namespace rift {
namespace {

using Ranges = std::map<std::string, std::string>;

/// What stands behind "in" for each flag of the command: "[0, 1]", "[0, 1]=0.5" with a default.
Ranges RangesOf(const std::string& command) {
  const test::ProcessResult result = test::RunRift({command, "--help"});
  REQUIRE(result.exit_code == 0);
  const std::regex line(R"(\n  (--[a-z-]+) \S+:in (\[[^\]]*\](?:=[-0-9.e]+)?))");
  Ranges ranges;
  for (std::sregex_iterator at(result.out.begin(), result.out.end(), line), end; at != end; ++at) {
    ranges[(*at)[1]] = (*at)[2];
  }
  return ranges;
}

TEST_CASE("The numbers that a flag takes, and the one it has without, stand in its help") {
  CHECK(RangesOf("simulate").empty());
  CHECK(RangesOf("gap") == Ranges{{"--samples", "[2, 10000000]=2000"},
                                  {"--skip-start", "[0, 0.95]=0"},
                                  {"--threshold", "[0, 1000]=0.06"},
                                  {"--standstill-radius", "[0, 1]=0.01"},
                                  {"--share", "[0.001, 0.999]=0.1"},
                                  {"--confidence", "[0.5, 0.999999]=0.95"},
                                  {"--tag-offset", "[-1, 1]=0"},
                                  {"--slip-bins", "[1, 1000]=20"},
                                  {"--moved-share", "[0, 1]=0.1"},
                                  {"--tag-ahead", "[-1, 1]"},
                                  {"--window", "[0.2, 10000]=3"}});
  Ranges sweep = RangesOf("sweep");
  sweep["--jobs"] = sweep["--jobs"].substr(0, 9);  // without the number of processors
  CHECK(sweep == Ranges{{"--jobs", "[1, 4096]"},
                        {"--shards", "[1, 1000000]"},
                        {"--copy-every", "[1, 86400]=600"},
                        {"--suggest", "[1, 1000]"}});
  CHECK(RangesOf("drive") == Ranges{{"--moved", "[0.0001, 1]=0.005"},
                                    {"--countdown", "[0, 60]"},
                                    {"--seconds", "[0.01, 3600]"},
                                    {"--repeat", "[1, 1000]"}});
  CHECK(RangesOf("track") == Ranges{{"--id", "[0, 2114]"},
                                    {"--tag-height", "[0, 2]"},
                                    {"--fps", "[0.1, 1000]"},
                                    {"--duration", "[0, 1e+09]"},
                                    {"--world-average", "[0, 60]=1"},
                                    {"--world-patience", "[0.1, 3600]=20"},
                                    {"--world-decimate", "[1, 8]=1"},
                                    {"--world-limit", "[1e-05, 10]=0.005"},
                                    {"--world-scale", "[0.001, 10]=0.05"},
                                    {"--check-every", "[0.1, 3600]=10"},
                                    {"--check-decimate", "[1, 8]=3"},
                                    {"--moved", "[0.0001, 1]=0.005"},
                                    {"--give-up", "[0, 3600]=5"}});
}

}  // namespace
}  // namespace rift
