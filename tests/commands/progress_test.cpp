#include "commands/sweep/progress.hpp"

#include <fcntl.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"

namespace rift::commands {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

/// One of this process's streams is another file for as long as this lives.
class Redirected {
 public:
  Redirected(int stream, int file) : stream_(stream), before_(::dup(stream)) {
    ::dup2(file, stream);
  }
  ~Redirected() {
    ::dup2(before_, stream_);
    ::close(before_);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;

 private:
  int stream_, before_;
};

/// What it says on stderr.
std::string Said(const std::function<void()>& say) {
  const test::TemporaryFolder folder;
  const std::string name = folder / "said";
  const int file = ::open(name.c_str(), O_CREAT | O_WRONLY, 0600);
  {
    const Redirected redirected(2, file);
    say();
  }
  ::close(file);
  return test::ReadFile(name);
}

sweep::TrialRow Row(const std::string& theta, double gap_m, bool falsified) {
  sweep::TrialRow row{.theta = {{theta, {}}}, .falsified = falsified};
  row.comparison.gap_m = gap_m;
  return row;
}

sweep::TrialRow Lost(bool falsified) {
  return {.theta = {{"b", {}}}, .status = sweep::TrialStatus::kFell, .falsified = falsified};
}

TEST_CASE("The last word of a sweep's progress counts its trials") {
  const auto sweep = [](ProgressStyle style, const sessions::SweepSize& size) {
    return Said([&] {
      SweepProgress progress(style, size);
      progress.Seen(Row("a", 0.03, false), true);
      progress.Seen(Row("a", 0.07, true), false);
      progress.Seen(Row("b", 0.05, true), false);
      progress.Seen(Lost(true), false);
      progress.Seen(Lost(false), false);
      progress.End("stopped");
    });
  };
  const json trials = json::parse(sweep(ProgressStyle::kJson, {.most = 8}));
  CHECK(trials["trials_per_s"] > 0.0);
  json expected = {{"state", "stopped"}, {"done", 5},   {"from_journal", 1},
                   {"left_s", nullptr},  {"failed", 2}, {"largest_gap_m", 0.07},
                   {"falsified", 3},     {"total", 8},  {"trials_per_s", trials["trials_per_s"]}};
  CHECK(trials == expected);
  const json settings = json::parse(sweep(ProgressStyle::kJson, {8, true}));
  expected.erase("total");
  expected["most_settings"] = 8;
  expected["settings"] = 2;
  expected["trials_per_s"] = settings["trials_per_s"];
  CHECK(settings == expected);
  const std::string bar = sweep(ProgressStyle::kBar, {.most = 8});
  CHECK_THAT(bar, Contains("[###############.........] 5/8 trials, ") &&
                      Contains(", largest gap 0.0700 m, 3 failing, 2 without gap"));
  CHECK(bar.back() == '\n');
  CHECK_THAT(sweep(ProgressStyle::kBar, {8, true}),
             Contains("[######..................] 2/8 settings, 5 trials, "));
  CHECK_THAT(sweep(ProgressStyle::kBar, {.most = 1}), Contains("[########################] 5/1"));
  CHECK_THAT(sweep(ProgressStyle::kBar, {.most = 0}), Contains("[........................] 5/0"));
  CHECK(sweep(ProgressStyle::kQuiet, {.most = 8}) == "");
  CHECK(sweep(ProgressStyle::kLines, {.most = 8}) == "");  // too short to be worth a line
}

TEST_CASE("Progress is not said again before its period is over, and tells the time left") {
  const auto begun = std::chrono::steady_clock::now();
  const std::string said = Said([] {
    SweepProgress progress(ProgressStyle::kBar, {.most = 1000});
    for (int i = 0; i < 10; ++i) progress.Tick();
    for (int i = 0; i < 10; ++i) progress.Seen(Row("a", 0.01, false), i < 5);
    ::usleep(110'000);
    for (int i = 0; i < 10; ++i) progress.Tick();
  });
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  const auto lines = std::count(said.begin(), said.end(), '\r');
  INFO(said);
  CHECK(lines >= 1);
  // A second in place may be cleared first; a busy machine takes more periods of 0.1 s than two.
  CHECK(lines <= 2 * (1 + static_cast<long>(took.count() / 0.1)));
  // 5 trials took 0.11 s or, on a busy machine, more; 990 are left.
  CHECK_THAT(said, Contains("10/1000 trials, ") && Contains(" left, largest gap 0.0100 m"));
  CHECK(said.back() == '\n');  // the bar was cut short
}

TEST_CASE(
    "The time left is that of what is to be done, at the rate of what was run and not found") {
  const std::string said = Said([] {
    SweepProgress trials(ProgressStyle::kJson, {.most = 1000});
    SweepProgress settings(ProgressStyle::kJson, {30, true});
    for (int i = 0; i < 10; ++i) trials.Seen(Row("a", 0.01, false), i < 4);
    settings.Seen(Row("a", 0.01, false), true);
    for (const char* theta : {"b", "b", "b", "c"}) settings.Seen(Row(theta, 0.01, false), false);
    ::usleep(510'000);
    trials.Tick();
    settings.Tick();
    settings.Tick();  // too soon
  });
  REQUIRE(std::count(said.begin(), said.end(), '\n') == 2);
  const json trials = json::parse(said.substr(0, said.find('\n')));
  const json settings = json::parse(said.substr(said.find('\n')));
  CHECK(trials["state"] == "running");
  // Both have the same time in them, however long that was.
  const auto left_at_rate = [](const json& told) {
    return told["left_s"].get<double>() * told["trials_per_s"].get<double>();
  };
  CHECK(left_at_rate(trials) == Approx((1000 - 10) * 6.0 / 6.0));
  CHECK(left_at_rate(settings) == Approx((30 - 3) * 4.0 / 2.0));
  CHECK(trials["trials_per_s"].get<double>() <= 6.0 / 0.5);
}

TEST_CASE("A warning is a line of its own in every style, and takes the place of a bar") {
  const auto warned = [](ProgressStyle style) {
    return Said([style] { SweepProgress(style, {.most = 8}).Warn("two runs are alike"); });
  };
  CHECK(warned(ProgressStyle::kBar) == "\r\x1b[Ktwo runs are alike\n");
  for (const ProgressStyle style :
       {ProgressStyle::kQuiet, ProgressStyle::kLines, ProgressStyle::kJson}) {
    CHECK(warned(style) == "two runs are alike\n");
  }
}

TEST_CASE("Nominal runs are counted before the trials, until all have arrived") {
  const std::string said = Said([] {
    SweepProgress progress(ProgressStyle::kBar, {.most = 8});
    ::usleep(110'000);
    progress.Tick(sweep::ReferenceProgress{.arrived = 4, .seeds = 4});
    progress.Tick(sweep::ReferenceProgress{.arrived = 3, .seeds = 4});
    progress.Tick(sweep::ReferenceProgress{.arrived = 2, .seeds = 4});  // too soon
  });
  CHECK_THAT(said, Contains("references: 3 of 4 nominal runs") && !Contains("4 of 4"));
}

TEST_CASE("Progress is a bar where stderr is a terminal, whatever stdout is") {
  int terminal = -1, shown = -1;
  REQUIRE(::openpty(&terminal, &shown, nullptr, nullptr, nullptr) == 0);
  const int file = ::open("/dev/null", O_WRONLY);
  ProgressStyle with_terminal, without_terminal;
  {
    const Redirected out(1, file), err(2, shown);
    with_terminal = StyleFor(false, false);
  }
  {
    const Redirected out(1, shown), err(2, file);
    without_terminal = StyleFor(false, false);
  }
  CHECK(with_terminal == ProgressStyle::kBar);
  CHECK(without_terminal == ProgressStyle::kLines);
  CHECK(StyleFor(true, true) == ProgressStyle::kQuiet);
  CHECK(StyleFor(false, true) == ProgressStyle::kJson);
  for (const int descriptor : {terminal, shown, file}) ::close(descriptor);
}

}  // namespace
}  // namespace rift::commands
