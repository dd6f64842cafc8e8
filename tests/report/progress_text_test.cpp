#include "rift/report/json/progress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "rift/report/json/json.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

TEST_CASE("The time that is left is told in minutes and from an hour on in hours") {
  for (const auto& [left_s, text] : {std::pair{0.4, "0:00"},
                                     {0.6, "0:01"},
                                     {59.4, "0:59"},
                                     {61.0, "1:01"},
                                     {3599.0, "59:59"},
                                     {3600.0, "1:00:00"},
                                     {3661.0, "1:01:01"},
                                     {36000.0 + 59 * 60 + 9, "10:59:09"}}) {
    const std::string told = ProgressText({.most = 9, .left_s = left_s});
    INFO(told);
    CHECK(told == std::string("0/9 trials, 0.0/s, ") + text + " left, 0 failing, 0 without gap");
  }
  CHECK(ProgressText({.most = 30,
                      .is_settings = true,
                      .steps = 4,
                      .done = 17,
                      .falsified = 2,
                      .failed = 3,
                      .largest_gap_m = 0.0456,
                      .trials_per_s = 1.25,
                      .left_s = 60.0}) ==
        "4/30 settings, 17 trials, 1.2/s, at most 1:00 left, largest gap 0.0456 m, 2 failing, 3 "
        "without gap");
}

TEST_CASE("A progress bar is full in proportion and never beyond its end") {
  const auto full = [](int steps, int most) {
    const std::string bar = ProgressBar({.most = most, .steps = steps});
    CHECK(bar.size() == 26);
    return std::count(bar.begin(), bar.end(), '#');
  };
  CHECK(full(0, 48) == 0);
  CHECK(full(1, 48) == 0);
  CHECK(full(2, 48) == 1);
  CHECK(full(47, 48) == 23);
  CHECK(full(48, 48) == 24);
  CHECK(full(49, 48) == 24);
  CHECK(full(0, 0) == 0);
  CHECK(full(1'500'000'000, 2'000'000'000) == 18);
}

TEST_CASE("References and shards are counted apart in text and JSON") {
  sweep::ReferenceProgress references{.arrived = 3, .seeds = 8};
  CHECK(ReferencesText(references) == "references: 3 of 8 nominal runs");
  CHECK(json::parse(ReferencesJson(references)) ==
        json::parse(R"({"state": "references", "references": 8, "references_done": 3})"));
  references.others_tried = 1;
  references.last_failure = "fell";
  CHECK(ReferencesText(references) ==
        "references: 3 of 8 nominal runs, 1 other seeds tried for those that did not arrive (last: "
        "fell)");
  sweep::ShardCounts shards{.total = 9, .done = 4, .running = 3, .pending = 2};
  CHECK(ShardsText(shards) == "slurm: 4/9 shards done, 3 running, 2 pending");
  CHECK(json::parse(ShardsJson(shards)) ==
        json::parse(R"({"state": "running", "shards": 9, "shards_done": 4, "shards_running": 3,
                        "shards_pending": 2})"));
  shards.reason = "Resources";
  CHECK(ShardsText(shards) == "slurm: 4/9 shards done, 3 running, 2 pending (Resources)");
  const json status = json::parse(StatusJson({}, "running", shards));
  CHECK(status["shards"] == json::parse(R"({"total": 9, "done": 4, "running": 3, "pending": 2,
                                            "reason": "Resources"})"));
  CHECK(StatusText({}, "running", shards) ==
        "0: running, 0 trials done (planned: 0) in 0 s, 0 falsified\n"
        "shards on the cluster: 4 of 9 done, 3 running, 2 pending (Resources)\n");
}

TEST_CASE("Progress in JSON counts trials, and of a search settings beside them") {
  ProgressCounts counts{.most = 30,
                        .is_settings = false,
                        .steps = 4,
                        .done = 17,
                        .from_journal = 5,
                        .falsified = 2,
                        .failed = 3,
                        .trials_per_s = 1.25};
  CHECK(json::parse(ProgressJson("running", counts)) ==
        json::parse(R"({"state": "running", "done": 17, "from_journal": 5, "trials_per_s": 1.25,
                        "left_s": null, "largest_gap_m": null, "falsified": 2, "failed": 3,
                        "total": 30})"));
  counts.is_settings = true;
  counts.left_s = 7.5;
  counts.largest_gap_m = 0.0625;
  CHECK(json::parse(ProgressJson("done", counts)) ==
        json::parse(R"({"state": "done", "done": 17, "from_journal": 5, "trials_per_s": 1.25,
                        "left_s": 7.5, "largest_gap_m": 0.0625, "falsified": 2, "failed": 3,
                        "most_settings": 30, "settings": 4})"));
  CHECK(ProgressJson("done", counts).find('\n') == std::string::npos);
}

}  // namespace
}  // namespace rift::report
