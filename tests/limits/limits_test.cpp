#include "rift/limits/limits.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

namespace rift::limits {
namespace {

struct Stated {
  Amount amount;
  double most;
  std::string words;
};

/// As docs/limits.md states them.
const Stated kStated[] = {
    {Amount::kFileBytes, 268'435'456.0, "268435456 bytes"},
    {Amount::kYamlBytes, 1'048'576.0, "1048576 bytes of YAML"},
    {Amount::kPixels, 16'777'216.0, "16777216 pixels"},
    {Amount::kRows, 2'000'000.0, "2000000 rows"},
    {Amount::kColumns, 10'000.0, "10000 columns"},
    {Amount::kSamples, 1'000'000.0, "1000000 samples"},
    {Amount::kWaypoints, 10'000.0, "10000 waypoints"},
    {Amount::kGridTrials, 1'000'000.0, "1000000 trials of a grid"},
};

TEST_CASE("As much as each limit is taken, and what is more is refused with both numbers") {
  for (const auto& [amount, most, words] : kStated) {
    INFO(words);
    CHECK(Most(amount) == most);
    CHECK_NOTHROW(Require(amount, 0.0, "a.csv"));
    CHECK_NOTHROW(Require(amount, most, "a.csv"));
    CHECK_THROWS_AS(Require(amount, most + 1.0, "a.csv"), std::invalid_argument);
    // 268435456 bytes: "a.csv: 536870912 bytes: at most 268435456 are taken; ..."
    const std::string unit = words.substr(words.find(' '));
    const std::string number = words.substr(0, words.find(' '));
    CHECK_THROWS_WITH(Require(amount, 2.0 * most, "a.csv"),
                      "a.csv: " + std::to_string(std::lround(2.0 * most)) + unit + ": at most " +
                          number + " are taken; --large-inputs lifts this limit");
  }
}

TEST_CASE("Once they are lifted no limit is left, in the processes that are forked as well") {
  const pid_t child = ::fork();
  if (child == 0) {
    Lift();
    for (const auto& [amount, most, words] : kStated) {
      try {
        Require(amount, 1e6 * most, "a.csv");
      } catch (const std::invalid_argument&) {
        ::_exit(1);
      }
    }
    const pid_t grandchild = ::fork();
    if (grandchild == 0) {
      try {
        Require(Amount::kRows, 1e18, "a.csv");
      } catch (const std::invalid_argument&) {
        ::_exit(1);
      }
      ::_exit(0);
    }
    int ended = 1;
    ::waitpid(grandchild, &ended, 0);
    ::_exit(ended == 0 ? 0 : 2);
  }
  int status = -1;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  CHECK_THROWS(Require(Amount::kRows, 1e18, "a.csv"));  // here they hold
}

}  // namespace
}  // namespace rift::limits
