#include <catch2/catch.hpp>
#include <filesystem>

#include "support/inputs/trials.hpp"
#include "support/processes/broken_streams.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"
#include "support/works.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using test::ProcessResult;
using test::RunRift;
using Words = std::vector<std::string>;

const std::string kExample = test::SourceDir() + "/data/example/";

// What a terminal would take as its new title, and how it is shown.
const std::string kTitle = "\x1b]0;pwned\x07";
const std::string kShownTitle = R"(\x1b]0;pwned\x07)";

TEST_CASE(
    "With streams that are closed or full every file is written and lost results are exit 3") {
  const test::QuickGnuplot gnuplot;
  const test::Work work = test::Works()[GENERATE(range(0, 4))];
  const test::TemporaryFolder folder;
  for (const char* name : {"usual", "out"}) std::filesystem::create_directories(folder / name);
  const ProcessResult usual = RunRift(work.words(folder / "usual"));
  INFO(work.name << ": " << usual.err);
  REQUIRE(usual.exit_code == 0);
  REQUIRE_FALSE(usual.out.empty());
  for (const test::Streams& streams : test::BrokenStreams(folder)) {
    const std::string out = folder / "out";
    const ProcessResult result = RunRift(work.words(out), streams.redirection);
    INFO(work.name << " " << streams.redirection << ": " << result.err);
    CHECK(result.exit_code == (streams.take_results ? 0 : 3));
    CHECK(result.out.empty() == !streams.take_results);
    CHECK_THAT(result.err, EndsWith(streams.says));
    if (streams.says.empty()) CHECK_THAT(result.err, !Contains("rift: "));
    CHECK(test::ReadFile(out + "/" + work.file) == test::ReadFile(folder / "usual/" + work.file));
    std::filesystem::remove_all(out);
    std::filesystem::create_directories(out);
  }
}

TEST_CASE("Bad input stays exit 2 when nobody can be told") {
  const test::TemporaryFolder folder;
  for (const test::Streams& streams : test::BrokenStreams(folder)) {
    INFO(streams.redirection);
    CHECK(
        RunRift({"gap", folder / "none.csv", folder / "none.csv"}, streams.redirection).exit_code ==
        2);
    CHECK(RunRift({"--no-such-option"}, streams.redirection).exit_code == 2);
  }
}

TEST_CASE("Help and keys that stdout does not take are exit 3") {
  for (const Words& words :
       {Words{"--help"}, {"--version"}, {"gap", "--help"}, {"sweep", "--keys"}}) {
    CHECK(RunRift(words).exit_code == 0);
    CHECK(RunRift(words, ">/dev/full").exit_code == 3);
    CHECK(RunRift(words, ">&-").exit_code == 3);
  }
}

TEST_CASE("A twin that cannot say where it is does not start") {
  const test::TemporaryFolder folder;
  const Words words{"simulate", test::SourceDir() + "/configs/twin.yaml", "--twin", "--out",
                    folder / "run"};
  const ProcessResult result = RunRift(words, ">&-");
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("nobody can learn where the twin is"));
}

TEST_CASE("An output named /dev/null is not taken for a closed stream") {
  const ProcessResult result = RunRift(
      {"gap", kExample + "simulator.csv", kExample + "robot1.csv", "--profile", "/dev/null"},
      "2>&-");
  CHECK(result.exit_code == 0);
}

TEST_CASE("What a terminal would obey or hide is shown escaped in an error") {
  struct Name {
    std::string name, shown;
  };
  for (const auto& [name, shown] :
       {Name{kTitle, kShownTitle}, Name{"\x7f\r", R"(\x7f\x0d)"},
        Name{"a\nrift: b", R"(a\x0arift: b)"},
        Name{"\xc2\x9b"
             "2J",
             R"(\u{9b}2J)"},
        Name{"\xe2\x80\x8f"
             "vsc",
             R"(\u{200f}vsc)"},
        Name{"\xe2\x80\xa8", R"(\u{2028})"}, Name{"\xd8\x9c\xe2\x81\xa9", R"(\u{61c}\u{2069})"},
        Name{"\x9b"
             "2J\xff\xc0\x80",
             R"(\x9b2J\xff\xc0\x80)"},
        Name{"\xed\xa0\x80\xe2\x80", R"(\xed\xa0\x80\xe2\x80)"},
        Name{"ü→\xf0\x9f\xa4\x96 \\", "ü→\xf0\x9f\xa4\x96 \\"}}) {
    const ProcessResult result = RunRift({"gap", name, "none.csv"});
    CHECK(result.exit_code == 2);
    CHECK(result.err == "rift: cannot read " + shown + ": No such file or directory\n");
  }
}

TEST_CASE("Names of an experiment and cells of a log are shown escaped and saved as they are") {
  const test::TemporaryFolder folder;
  const std::string quoted = R"("\x1b]0;pwned\x07\u202E")";
  test::WriteText(folder / "task.yaml",
                  "name: " + quoted + "\nwaypoints: [{x: 0, y: 0, heading: 0}, {name: " + quoted +
                      ", x: 0.25, y: 0.02, stop: true}]\ngap: {threshold_m: 0.01}\n"
                      "reference: {kind: nominal, trials: 2}\nspace: {v_min: [0.14, 0.16]}\n");
  const auto is_clean = [](const ProcessResult& result) {
    return (result.out + result.err).find_first_of("\x1b\x07") == std::string::npos;
  };
  const ProcessResult run =
      RunRift({"simulate", folder / "task.yaml", "--out", folder / (kTitle + "run")});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(is_clean(run));
  CHECK_THAT(run.out, Contains(kShownTitle + R"(\u{202e} reached at)"));
  CHECK_THAT(run.err, Contains(kShownTitle + "run/trajectory.csv"));
  CHECK_THAT(test::ReadFile(folder / (kTitle + "run/experiment.yaml")),
             Contains(R"(\x1b]0;pwned)"));
  const ProcessResult sweep =
      RunRift({"sweep", folder / "task.yaml", "--out", folder / "sweep", "--quiet"});
  CHECK(sweep.exit_code == 0);
  CHECK(is_clean(sweep));
  const ProcessResult status = RunRift({"sweep", "--status", folder / "sweep"});
  CHECK_THAT(status.out, StartsWith(kShownTitle + R"(\u{202e}: done)"));

  const ProcessResult json =
      RunRift({"simulate", folder / "task.yaml", "--out", folder / "json", "--json"});
  CHECK(json.out == test::ReadFile(folder / "json/summary.json"));

  test::WriteText(folder / "log.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1," + kTitle + ",0,0\n");
  const ProcessResult gap = RunRift({"gap", folder / "log.csv", folder / "log.csv"});
  CHECK(gap.exit_code == 2);
  CHECK(is_clean(gap));
  CHECK_THAT(gap.err, Contains(kShownTitle));
}

}  // namespace
}  // namespace rift
