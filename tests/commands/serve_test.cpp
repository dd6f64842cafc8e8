// rift sweep --serve: the report of a sweep that runs.

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <list>
#include <regex>
#include <thread>

#include "sessions/sweep/page_server.hpp"
#include "support/http.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::ReadFile;

struct Address {
  int port = 0;
  std::string path;
};

/// Where the sweep says that its page is.
Address LiveAddress(const std::string& err) {
  std::smatch found;
  if (!std::regex_search(err, found, std::regex(R"(live: http://127\.0\.0\.1:(\d+)(/\w+/))"))) {
    return {};
  }
  return {std::stoi(found[1]), found[2]};
}

/// Local addresses that listen at the port, as the kernel writes them.
std::string Listening(int port) {
  char wanted[8];
  std::snprintf(wanted, sizeof wanted, ":%04X", port);
  std::string addresses;
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::istringstream lines(ReadFile(table));
    for (std::string line, slot, local, remote, state; std::getline(lines, line);) {
      std::istringstream(line) >> slot >> local >> remote >> state;
      if (local.ends_with(wanted) && state == "0A") addresses += local + " ";
    }
  }
  return addresses;
}

TEST_CASE("A sweep shows its report growing at an address of this machine alone") {
  const test::TemporaryFolder folder;
  // Far more trials than the test waits for.
  test::WriteText(folder / "long.yaml",
                  "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
                  "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 4000}\n"
                  "space: {surface: [ground, parchment], v_min: [0.14, 0.18]}\n");
  const std::string out = folder / "out";
  test::RunningRift sweep({"sweep", folder / "long.yaml", "--out", out, "--serve", "--quiet"});
  sweep.WaitUntil("an address", [&] { return LiveAddress(sweep.Err()).port != 0; });
  const Address at = LiveAddress(sweep.Err());
  CHECK(at.path.size() >= 32);
  CHECK(Listening(at.port) == "0100007F" + Listening(at.port).substr(8));
  std::string page;
  sweep.WaitUntil("trials on the page", [&] {
    page = test::AskServer(at.port, "GET " + at.path);
    return page.find("trials so far") != page.npos;
  });
  CHECK_THAT(page, Contains("200 OK") && Contains("no-store") && Contains("\"running\":true") &&
                       Contains("id=\"paths\""));
  for (const std::string& path : {std::string("/"), "/" + std::string(32, '0') + "/", at.path + "x",
                                  std::string("/live.html"), at.path + "../table.csv"}) {
    INFO(path);
    CHECK_THAT(test::AskServer(at.port, "GET " + path),
               Contains("404 Not Found") && !Contains("html><"));
  }
  sweep.Signal(SIGINT);
  sweep.Wait();
  CHECK_FALSE(std::filesystem::exists(out + "/live.html"));
  CHECK(test::AskServer(at.port, "GET " + at.path).empty());
}

TEST_CASE("A sweep that was watched serves its finished report before it ends") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  test::WriteText(folder / "short.yaml",
                  "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
                  "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 30}\n"
                  "space: {surface: [ground, parchment]}\n");
  const std::string out = folder / "out";
  test::RunningRift sweep({"sweep", folder / "short.yaml", "--out", out, "--serve", "--quiet"});
  sweep.WaitUntil("an address", [&] { return LiveAddress(sweep.Err()).port != 0; });
  const Address at = LiveAddress(sweep.Err());
  std::string page;
  sweep.WaitUntil("the finished report", [&] {
    page = test::AskServer(at.port, "GET " + at.path);
    return page.find("\"running\":false") != page.npos;
  });
  CHECK(sweep.Wait().exit_code == 0);
  CHECK_THAT(page, Contains(ReadFile(out + "/report.html")));
  CHECK_FALSE(std::filesystem::exists(out + "/live.html"));
}

TEST_CASE("A page server waits for the last page, whatever of the others was just asked for") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  test::WriteText(folder / "report", "it is over");
  sessions::PageServer server({folder / "live", folder / "report"});
  const Address at = LiveAddress("live: " + server.Url());
  std::atomic<bool> has_asked_again = false;
  std::string first, last;
  std::thread watcher([&] {
    first = test::AskServer(at.port, "GET " + at.path);
    // Long enough for a server that takes this answer for the last one.
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    std::filesystem::remove(folder / "live");
    has_asked_again = true;
    last = test::AskServer(at.port, "GET " + at.path);
  });
  const bool has_served = server.WaitForLast(1000 * static_cast<int>(test::kGiveUp.count()));
  const bool was_in_time = has_asked_again;
  watcher.join();
  CHECK(has_served);
  CHECK(was_in_time);
  CHECK_THAT(first, Contains("it runs"));
  CHECK_THAT(last, Contains("it is over"));
  CHECK(server.WaitForLast(0));
}

TEST_CASE("Clients that ask nothing keep nobody waiting, and are left alone after a while") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "report", "it is over");
  const sessions::PageServer server({folder / "report"});
  const Address at = LiveAddress("live: " + server.Url());
  std::list<test::SilentClient> silent;
  for (int i = 0; i < 10; ++i) silent.emplace_back(at.port);
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Contains("it is over"));
  CHECK(silent.back().IsConnected());
  for (int i = 0; i < 20; ++i) silent.emplace_back(at.port);  // more than are answered at once
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Contains("it is over"));
  test::WaitUntil("the end of the silence", [&] { return !silent.back().IsConnected(); });
}

TEST_CASE("A calibration has no page that grows") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "fit.yaml",
                  "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
                  "goal: calibrate\ncalibrate: {fit: {simulation.motor.mismatch: {min: -0.1, max: "
                  "0.1}}}\nreference: {kind: logs, path: \"a{trial}.csv\", trials: [1]}\n");
  const test::ProcessResult refused =
      test::RunRift({"sweep", folder / "fit.yaml", "--serve", "--out", folder / "out"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("--serve"));
}

}  // namespace
}  // namespace rift
