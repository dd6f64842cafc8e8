// What the commands of Slurm are given and how their answers are read, with stand-ins for them.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "rift/sweep/run/slurm.hpp"
#include "rift/sweep/run/slurm_options.hpp"
#include "rift/sweep/run/slurm_shards.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"
#include "sweep/run/stand_in_cluster.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

const SlurmArray kArray{.name = "rift-a",
                        .tasks = {0, 1, 2, 5},
                        .script = "/o/array.sh",
                        .logs = "/o/50%",
                        .folder = "/work here"};

TEST_CASE("An array is submitted with its name, folders, tasks and processors, and gives its id") {
  const Stand stand;
  stand.Answers("sbatch", "123\n");
  SlurmOptions options;
  options.cpus_per_task = 3;
  CHECK(SubmitArray(kArray, options) == "123");
  CHECK(stand.Arguments("sbatch") ==
        "--parsable\n--propagate=NONE\n--job-name=rift-a\n--chdir=/work here\n"
        "--output=/o/50%%/%a.log\n--open-mode=append\n--requeue\n--cpus-per-task=3\n"
        "--array=0-2,5\n/o/array.sh\n");
  options.shards_at_once = 7;
  options.account = "me";
  options.partition = "fast";
  options.time_limit = "1:00:00";
  options.arguments = {"--nice", "--qos=low"};
  stand.Answers("sbatch", "77;cluster\n");
  CHECK(SubmitArray(kArray, options) == "77");
  const std::string arguments = stand.Arguments("sbatch");
  CHECK(
      arguments.ends_with("--array=0-2,5%7\n--account=me\n--partition=fast\n--time=1:00:00\n"
                          "--nice\n--qos=low\n/o/array.sh\n"));
  stand.Answers("sbatch", "Submitted\n");
  CHECK_THROWS_WITH(SubmitArray(kArray, options), "sbatch told no job id, but: Submitted\n");
}

TEST_CASE("Tasks in the queue stand by their index with job, state and reason") {
  const Stand stand;
  stand.Answers("squeue",
                "12_3|RUNNING|None\n12_0|PENDING|Resources\n13_10|REQUEUE_HOLD|JobHoldMaxRequeue\n"
                "14|RUNNING|None\n|_5\nnothing\n12_4|PENDING\n");
  const std::map<int, SlurmTask> tasks = QueuedTasks("rift-a");
  CHECK(stand.Arguments("squeue") ==
        "--me\n--noheader\n--array\n--name=rift-a\n--format=%i|%T|%r\n");
  REQUIRE(tasks.size() == 3);
  CHECK(tasks.at(3).job == "12");
  CHECK(tasks.at(3).state == "RUNNING");
  CHECK(tasks.at(3).reason.empty());
  CHECK_FALSE(tasks.at(3).IsWaiting());
  CHECK_FALSE(tasks.at(3).IsGivenUp());
  CHECK(tasks.at(0).reason == "Resources");
  CHECK(tasks.at(0).IsWaiting());
  CHECK(tasks.at(10).job == "13");
  CHECK(tasks.at(10).IsWaiting());
  CHECK(tasks.at(10).IsGivenUp());
}

TEST_CASE("Jobs are cancelled once each, a task by its index, and none without jobs") {
  const Stand stand;
  CancelArrays("rift-a");
  CHECK(stand.Arguments("scancel").empty());
  stand.Answers("squeue", "9_1|RUNNING|None\n12_3|RUNNING|None\n9_2|PENDING|None\n");
  CancelArrays("rift-a");
  CHECK(stand.Arguments("scancel") == "12\n9\n");
  CancelTask({.job = "12"}, 4);
  CHECK(stand.Arguments("scancel") == "12_4\n");
}

TEST_CASE("What Slurm cannot answer now is told apart from what it refuses") {
  const Stand stand;
  for (const char* busy :
       {"sbatch: error: Resource temporarily unavailable", "please try again", "Socket timed out",
        "Unable to contact slurm controller", "Connection refused",
        "Unexpected missing socket error", "Zero Bytes were transmitted", "submit limit reached",
        "over the job limit", "QOSMaxSubmitJobPerUserLimit", "AssocMaxSubmitJobLimit"}) {
    INFO(busy);
    stand.Fails("sbatch", std::string("a line before\n") + busy + "\n");
    CHECK_THROWS_AS(SubmitArray(kArray, {}), SlurmBusy);
  }
  stand.Does("sbatch", "kill -9 $$\n");
  CHECK_THROWS_WITH(SubmitArray(kArray, {}), "sbatch: was ended by signal 9 without a word");
  CHECK_THROWS_AS(SubmitArray(kArray, {}), SlurmBusy);
  stand.Does("sbatch", "");
  const auto refusal = [&](const std::string& words, const std::string& code = "1") {
    stand.Fails("sbatch", words, code);
    try {
      SubmitArray(kArray, {});
    } catch (const SlurmBusy&) {
      return std::string("busy");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refusal("sbatch: error: Invalid account\n") == "sbatch: error: Invalid account");
  CHECK(refusal("Invalid partition\n") == "sbatch: Invalid partition");
  CHECK(refusal("", "3") == "sbatch: ended with exit code 3 without a word");
  CHECK(refusal("cannot resolve configuration source\n") ==
        "sbatch: cannot resolve configuration source; --engine slurm works where Slurm answers, as "
        "on its login node: use --engine local here");
}

TEST_CASE("The largest array is the cluster's, and Slurm's default where nobody says") {
  const Stand stand;
  stand.Answers("scontrol", "MaxJobCount = 10\nMaxArraySize            = 501\nMaxArray = 3\n");
  CHECK(MaxArraySize() == 501);
  CHECK(stand.Arguments("scontrol") == "show\nconfig\n");
  stand.Answers("scontrol", "MaxArraySize = 0\n");
  CHECK(MaxArraySize() == 1);
  stand.Answers("scontrol", "MaxJobCount = 10\nMaxArraySize\n");
  CHECK(MaxArraySize() == 1001);
  stand.Fails("scontrol", "Unable to contact slurm controller\n");
  CHECK(MaxArraySize() == 1001);
  stand.Fails("scontrol", "no such command\n");
  CHECK_THROWS_AS(MaxArraySize(), std::runtime_error);
}

TEST_CASE("Without Slurm's commands the message says which engine works") {
  const test::TemporaryFolder empty;
  const test::Environment path("PATH", empty.Path().string());
  CHECK_THROWS_WITH(MaxArraySize(), Catch::Contains("cannot run scontrol") &&
                                        Catch::Contains("without them use --engine local"));
}

TEST_CASE("A command of Slurm that does not answer in time is killed, and may be asked again") {
  const Stand stand;
  stand.Does("squeue", "echo $$ > \"$D/new\"\nmv \"$D/new\" \"$D/pid\"\nexec sleep 1000\n");
  CHECK_THROWS_WITH(QueuedTasks("rift-a", {.limit_s = 0.1}), "squeue did not answer within 0.1 s");
  const auto is_there = [&] { return fs::exists(stand / "pid"); };
  CHECK_THROWS_MATCHES(QueuedTasks("rift-a", {.go_on = [&] { return !is_there(); }}), SlurmBusy,
                       Catch::Message("squeue did not answer within 1 s"));
  CHECK_THROWS_MATCHES(QueuedTasks("rift-a", {.limit_s = 0.2, .go_on = [] { return false; }}),
                       SlurmBusy, Catch::Message("squeue did not answer within 0.2 s"));
  const pid_t pid = std::stoi(test::ReadFile(stand / "pid"));
  test::WaitUntil("its end", [&] { return ::kill(pid, 0) != 0; });
  stand.Does("squeue", "");
  CHECK(QueuedTasks("rift-a", {.limit_s = 30.0}).empty());
}

TEST_CASE("The rows of all shards are in the journal, and what only their jobs need is gone") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const std::vector<Shard> shards{ShardOf("a"), ShardOf("b"), ShardOf("c")};
  cluster.Finishes(shards[0], "a");
  cluster.Finishes(shards[1], "b");
  cluster.Finishes(shards[2], "c");
  cluster.Does("sbatch", test::ReadFile(cluster / "sbatch.also") +
                             "echo words > \"$F/0.log\"; : > \"$F/1.log\"\n");
  std::vector<ShardCounts> seen;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts& counts) {
    seen.push_back(counts);
    const bool is_open = SlurmShards::AreOpen(cluster.Out());
    CHECK(is_open);
  };
  const SlurmOptions options = Quick(2);  // two arrays
  SlurmShards slurm(cluster.Out(), options, "experiment: text\n", journal, watch);
  CHECK(slurm.Run({}));
  CHECK(cluster.Arguments("sbatch").empty());
  CHECK(slurm.Run(shards));
  for (const char* key : {"a", "b", "c"}) CHECK(journal.Find(key) == std::string("row of ") + key);
  REQUIRE(seen.size() >= 2);
  CHECK(seen.front().total == 3);
  CHECK(seen.front().done == 0);
  CHECK(seen.back().done == seen.back().total);
  CHECK_FALSE(SlurmShards::AreOpen(cluster.Out()));
  const fs::path first = cluster.Out() / "slurm/1", second = cluster.Out() / "slurm/2";
  CHECK(test::ReadFile(first / "jobs") == "41 0-1\n");
  CHECK(test::ReadFile(second / "jobs") == "41 0\n");
  for (const fs::path& array : {first, second}) {
    CHECK_FALSE(fs::exists(array / "shards"));
    CHECK_FALSE(fs::exists(array / "0.shard"));
    CHECK_FALSE(fs::exists(array / "experiment.yaml"));
    CHECK(test::ReadFile(array / "0.log") == "words\n");
  }
  CHECK_FALSE(fs::exists(first / "1.log"));  // an empty one
  CHECK_FALSE(fs::exists(cluster.Out() / "shards"));
  CHECK(test::ReadFile(first / "array.sh") ==
        "#!/bin/bash\n# A task of the job array of a sweep: one shard.\n"
        "[ -z \"${SLURM_TMPDIR:-}\" ] || export TMPDIR=\"$SLURM_TMPDIR\"\nmodule load x\n"
        "exec '/bin/my rift' sweep '" +
            (first / "experiment.yaml").string() + "' --out '" + cluster.Out().string() +
            "' --shard '" + first.string() +
            "'/\"$SLURM_ARRAY_TASK_ID\".shard --jobs 2 --copy-every 4.5 --large-inputs\n");
  // The next array has the next number.
  const Shard more = ShardOf("d");
  cluster.Finishes(more, "d");
  CHECK(slurm.Run({more}));
  CHECK(fs::exists(cluster.Out() / "slurm/3/jobs"));
}

TEST_CASE("A shard that leaves no journal is run three times, and told with its last words") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const std::vector<Shard> shards{ShardOf("a"), ShardOf("b")};
  cluster.Finishes(shards[0], "a");
  cluster.Does("sbatch", test::ReadFile(cluster / "sbatch.also") +
                             "printf 'first\\nthe last words\\n\\n' > \"$F/1.log\"\n");
  cluster.Answers("squeue", "41_7|RUNNING|None\n");  // whatever is left under the name
  const SlurmOptions options = Quick();
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts&) { ++looks; };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK_THROWS_WITH(slurm.Run(shards),
                    Catch::StartsWith("shard 1 of " + (cluster.Out() / "slurm/1").string() +
                                      " was run 3 times and left no journal; the last line of ") &&
                        Catch::EndsWith("1.log: the last words"));
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0-1\n41 1\n41 1\n");
  CHECK(looks == 1 + 3 + 3 + 3);  // it has to be absent three times in a row
  CHECK(cluster.Arguments("scancel") == "41\n");
  CHECK(journal.Find("a"));
  CHECK(SlurmShards::AreOpen(cluster.Out()));
  std::vector<std::string> said;
  const auto say = [&](const std::string& line) { said.push_back(line); };
  SlurmShards::Forget(cluster.Out(), say);
  CHECK(cluster.Arguments("scancel") == "41\n");
  CHECK_FALSE(fs::exists(cluster.Out() / "slurm"));
  CHECK_FALSE(fs::exists(cluster.Out() / "shards"));
  CHECK(said.empty());
}

TEST_CASE("Whoever is told to stop cancels the jobs, and the next takes in what they left") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  const SlurmOptions options = Quick();
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts& counts) {
    ++looks;
    if (looks == 2) {
      CHECK(counts.running == 1);
      CHECK(counts.pending == 0);
    }
  };
  watch.go_on = [&] { return looks < 2; };
  cluster.Answers("squeue", "41_0|RUNNING|None\n");
  SlurmShards stopped(cluster.Out(), options, "", journal, watch);
  CHECK_FALSE(stopped.Run({shard}));
  CHECK(cluster.Arguments("scancel") == "41\n");
  CHECK(SlurmShards::AreOpen(cluster.Out()));

  const std::optional<ShardCounts> open = ReadShardCounts(cluster.Out());
  REQUIRE(open);
  CHECK(*open == ShardCounts{.total = 1, .running = 1});
  cluster.Answers("squeue", "41_0|PENDING|Priority\n");
  CHECK(*ReadShardCounts(cluster.Out()) ==
        ShardCounts{.total = 1, .pending = 1, .reason = "Priority"});
  cluster.Answers("squeue", "");
  cluster.Finishes(shard, "a");
  cluster.Arguments("sbatch");
  {
    Journal part(UnfinishedShardJournal(cluster.Out(), ShardName(EncodeShard(shard))),
                 kFactsOfShards);
    part.Add("of a part", {"ok", 0.01, false, "its row"});
    part.Close();
  }
  SlurmOptions others = options;
  others.prologue = {"module load y"};
  int later_looks = 0;
  SlurmShards::Watch later;
  later.seen = [&](const ShardCounts&) { ++later_looks; };
  SlurmShards next(cluster.Out(), others, "", journal, later);
  CHECK(next.Resume());
  CHECK(later_looks == 2);  // at once, since whoever submitted it is gone
  CHECK_THAT(test::ReadFile(cluster.Out() / "slurm/1/array.sh"),
             Catch::Contains("\nmodule load y\n"));
  CHECK(cluster.Arguments("sbatch").ends_with("array.sh\n"));  // once more
  CHECK(journal.Find("a") == "row of a");
  CHECK(journal.Find("of a part") == "its row");
  CHECK_FALSE(ReadShardCounts(cluster.Out()));
  CHECK(next.Resume());  // nothing is open
}

TEST_CASE("A task that Slurm holds for good is cancelled, and told") {
  struct Held {
    std::string reason, since;
  };
  const Held held =
      GENERATE(Held{"JobHoldMaxRequeue", "lost its node so often"},
               Held{"launch failed requeued held", "failed to start, so"},
               Held{"launch_failed_requeued_held", "failed to start, so"},
               Held{"user env retrieval failed requeued held", "failed to start, so"});
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  const SlurmOptions options = Quick();
  std::vector<std::string> said;
  int looks = 0;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  watch.seen = [&](const ShardCounts&) {
    ++looks;
    if (looks == 1) cluster.Answers("squeue", "41_0|PENDING|" + held.reason + "\n");
    if (looks == 2) {
      cluster.Answers("squeue", "");
      cluster.Finishes(shard, "a");
    }
  };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({shard}));
  REQUIRE(said.size() == 1);
  CHECK(said[0] == "note: shard 0 of " + (cluster.Out() / "slurm/1").string() + " " + held.since +
                       " that Slurm holds it (" + held.reason + "); it is submitted anew");
  CHECK(cluster.Arguments("scancel").starts_with("41_0\n"));
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0\n41 0\n");
}

TEST_CASE("A queue that was read once may fail in any way later, and at first in none") {
  for (const int failing : {1, 3}) {
    const Cluster cluster;
    Journal journal = cluster.NewJournal();
    const Shard shard = ShardOf("a");
    cluster.Finishes(shard, "a");
    cluster.Does("sbatch", "");
    cluster.Answers("squeue", "41_0|RUNNING|None\n");
    // Done only after the call that fails without a word.
    cluster.Does("squeue",
                 "echo x >> \"$D/asked\"; N=$(wc -l < \"$D/asked\")\n"
                 "[ $N -ne " +
                     std::to_string(failing) +
                     " ] || exit 1\n"
                     "[ $N -lt 5 ] || for F in \"$D\"/ready/*; do\n"
                     "  cp \"$F\" \"$D/out/shards/${F##*/}.sqlite\"\ndone\n");
    const SlurmOptions options = Quick();
    std::vector<std::string> said;
    SlurmShards::Watch watch;
    watch.say = [&](const std::string& line) { said.push_back(line); };
    SlurmShards slurm(cluster.Out(), options, "", journal, watch);
    if (failing == 1) {
      CHECK_THROWS_WITH(slurm.Run({shard}), "squeue: ended with exit code 1 without a word");
      continue;
    }
    CHECK(slurm.Run({shard}));
    CHECK(journal.Find("a") == std::string("row of a"));
    CHECK(said == std::vector<std::string>{
                      "note: squeue: ended with exit code 1 without a word; trying again"});
  }
}

TEST_CASE("A busy cluster is asked again with half of the tasks, and complained of once") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  std::vector<Shard> shards;
  for (const char* key : {"a", "b", "c", "d", "e"}) {
    shards.push_back(ShardOf(key));
    cluster.Finishes(shards.back(), key);
  }
  const std::string finishes = test::ReadFile(cluster / "sbatch.also");
  // Refused twice, and then no more.
  cluster.Does("sbatch",
               "echo x >> \"$D/tried\"\nif [ $(wc -l < \"$D/tried\") -le 2 ]; then\n"
               "  echo 'over the job limit' >&2; exit 1\nfi\n" +
                   finishes);
  const SlurmOptions options = Quick();
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run(shards));
  CHECK(said == std::vector<std::string>{"note: sbatch: over the job limit; trying again"});
  const std::string arguments = cluster.Arguments("sbatch");
  CHECK(arguments.find("--array=0-4\n") != std::string::npos);  // all
  CHECK(arguments.find("--array=0-1\n") != std::string::npos);  // then half of five
  CHECK(arguments.find("--array=0\n") != std::string::npos);    // then half of two
}

TEST_CASE("A shard that was seen in the queue between two looks without it is not run twice") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  const SlurmOptions options = Quick();
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts&) {
    ++looks;
    cluster.Answers("squeue", looks == 3 ? "41_0|RUNNING|None\n" : "");
    if (looks != 6) return;
    cluster.Finishes(shard, "a");
    const std::string name = ShardName(EncodeShard(shard));
    fs::copy_file(cluster / ("ready/" + name), ShardJournal(cluster.Out(), name));
  };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({shard}));
  CHECK(looks == 7);
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0\n");
}

TEST_CASE("Shards are counted as done, running or waiting, with why the first of them waits") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  std::vector<Shard> shards;
  for (const char* key : {"a", "b", "c", "d", "e"}) shards.push_back(ShardOf(key));
  cluster.Finishes(shards[1], "b");
  cluster.Answers("squeue",
                  "41_1|RUNNING|None\n41_2|RUNNING|None\n41_3|PENDING|Priority\n"
                  "41_4|PENDING|Resources\n");
  const ShardCounts expected{
      .total = 5, .done = 1, .running = 1, .pending = 2, .reason = "Priority"};
  ShardCounts seen;
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts& counts) {
    seen = counts;
    if (++looks == 2) CHECK(ReadShardCounts(cluster.Out()) == expected);
  };
  watch.go_on = [&] { return looks < 2; };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK_FALSE(slurm.Run(shards));
  CHECK(seen == expected);
}

TEST_CASE("An array has the number behind the largest, and no job of it is left at its end") {
  const Cluster cluster;
  for (const char* name : {"2", "10", "7", "1", "3", "12x", "x", "1234567890"}) {
    fs::create_directories(cluster.Out() / "slurm" / name);
  }
  test::WriteText(cluster.Out() / "slurm/99", "no folder");
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  cluster.Finishes(shard, "a");
  cluster.Answers("squeue", "41_7|RUNNING|None\n");  // whatever is left under the name
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, {});
  CHECK(slurm.Run({shard}));
  CHECK(fs::exists(cluster.Out() / "slurm/11/jobs"));
  CHECK(cluster.Arguments("scancel") == "41\n");
}

TEST_CASE("Whoever is told to stop does not wait for a queue that does not answer") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Does("squeue", "[ -e \"$D/asked\" ] || { : > \"$D/asked\"; exec sleep 1000; }\n");
  cluster.Answers("squeue", "41_0|RUNNING|None\n");
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  watch.go_on = [&] { return !fs::exists(cluster / "asked"); };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK_FALSE(slurm.Run({ShardOf("a")}));
  CHECK(cluster.Arguments("sbatch").empty());
  CHECK(cluster.Arguments("scancel") == "41\n");
  CHECK(said.empty());
}

TEST_CASE("Shards are counted without a queue that does not answer, which is asked once") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  WriteArrays(cluster, journal, {ShardOf("a"), ShardOf("b")}, Quick(1));
  cluster.Arguments("squeue");
  cluster.Does("squeue", "exec sleep 1000\n");
  CHECK(*ReadShardCounts(cluster.Out(), 0.3) == ShardCounts{.total = 2});
  const std::string asked = cluster.Arguments("squeue");
  CHECK(std::count(asked.begin(), asked.end(), '\n') <= 5);  // arguments
}

TEST_CASE("A shard whose files are damaged or gone is not submitted, and its rows are missing") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const SlurmOptions options = Quick();
  std::vector<Shard> shards;
  for (const char* key : {"a", "b", "c", "d"}) {
    shards.push_back(ShardOf(key));
    cluster.Finishes(shards.back(), key);
  }
  WriteArrays(cluster, journal, shards, options);
  const std::string array = (cluster.Out() / "slurm/1/").string();
  test::WriteText(array + "0.shard", "damaged");
  fs::remove(array + "2.shard");
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  const std::string end = " is not there or not what was submitted; what is missing is run again";
  SECTION("its own") {
    CHECK(slurm.Resume());
    CHECK(test::ReadFile(array + "jobs") == "41 1,3\n");
    CHECK(said == std::vector<std::string>{"note: " + array + "0.shard" + end,
                                           "note: " + array + "2.shard" + end});
    CHECK_FALSE(journal.Has("a"));
    CHECK(journal.Has("b"));
  }
  SECTION("the experiment of all") {
    test::WriteText(array + "experiment.yaml", "name: x\n");
    CHECK(slurm.Resume());
    CHECK(cluster.Arguments("sbatch").empty());
    REQUIRE(said.size() == 3);
    CHECK(said[1] == "note: " + array + "experiment.yaml" + end);
  }
  SECTION("while it is run") {
    fs::remove_all(cluster.Out() / "slurm");
    const Shard other = ShardOf("e");
    cluster.Does("sbatch", "for A; do S=$A; done\necho x > \"${S%/*}/0.shard\"\n");
    CHECK(slurm.Run({other}));
    CHECK(said == std::vector<std::string>{"note: " + array + "0.shard" + end});
    CHECK(test::ReadFile(array + "jobs") == "41 0\n");
  }
  CHECK_FALSE(SlurmShards::AreOpen(cluster.Out()));
}

TEST_CASE("What hung in an array of an experiment with other limits is left out, and told") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const SlurmOptions options = Quick();
  const std::vector<Shard> shards{ShardOf("a"), ShardOf("b")};
  cluster.Finishes(shards[0], "a", "hung");
  cluster.Finishes(shards[1], "b");
  for (const bool is_same : {false, true}) {
    WriteArrays(cluster, journal, shards, options);
    std::vector<std::string> said;
    SlurmShards::Watch watch;
    watch.say = [&](const std::string& line) { said.push_back(line); };
    SlurmShards slurm(cluster.Out(), options, is_same ? "" : "run: x\n", journal, watch);
    CHECK(slurm.Resume());
    CHECK(journal.Has("a") == is_same);
    CHECK(journal.Has("b"));
    CHECK(said.size() == (is_same ? 0 : 1));
    if (is_same) continue;
    CHECK(said.at(0) ==
          "note: " + ShardJournal(cluster.Out(), ShardName(EncodeShard(shards[0]))).string() +
              ": 1 of its trials hung, crashed or ran out of memory, perhaps under other limits "
              "(run), and are left out; what is missing is run again");
  }
}

TEST_CASE("A complaint is told again once a submission came between") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Does(
      "sbatch",
      "echo x >> \"$D/tried\"\n"
      "case $(wc -l < \"$D/tried\") in 1|3) echo 'over the job limit' >&2; exit 1;; esac\n" +
          test::ReadFile(cluster / "sbatch.also"));
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  for (const char* key : {"a", "b"}) {
    cluster.Finishes(ShardOf(key), key);
    CHECK(slurm.Run({ShardOf(key)}));
  }
  const std::string busy = "note: sbatch: over the job limit; trying again";
  CHECK(said == std::vector<std::string>{busy, busy});
}

TEST_CASE("A cluster that stays busy is left alone for twice as long each time") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Finishes(ShardOf("a"), "a");
  // It notes when it was asked, and refuses five times.
  cluster.Does("sbatch",
               "date +%s%N >> \"$D/tried\"\nif [ $(wc -l < \"$D/tried\") -le 5 ]; then\n"
               "  echo 'over the job limit' >&2; exit 1\nfi\n" +
                   test::ReadFile(cluster / "sbatch.also"));
  SlurmOptions options = Quick();
  options.poll_s = 0.02;
  SlurmShards slurm(cluster.Out(), options, "", journal, {});
  CHECK(slurm.Run({ShardOf("a")}));
  std::istringstream lines(test::ReadFile(cluster / "tried"));
  std::vector<std::int64_t> asked_ns;
  for (std::int64_t t_ns = 0; lines >> t_ns;) asked_ns.push_back(t_ns);
  REQUIRE(asked_ns.size() == 6);
  for (size_t i = 0; i < 5; ++i) {
    INFO(i);
    // 0.02 s, 0.04 s ... 0.32 s at least: how much longer it takes is the machine's.
    CHECK(asked_ns[i + 1] - asked_ns[i] >= (20'000'000 << i));
  }
}

TEST_CASE("Damaged rows in the journal of a shard are counted, told and left out") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  for (const char* key : {"a", "b", "c"}) cluster.Finishes(shard, key);
  const std::string name = ShardName(EncodeShard(shard));
  SQLite::Database(cluster / ("ready/" + name), SQLite::OPEN_READWRITE)
      .exec("UPDATE trial SET row = 'other' WHERE key <> 'b'");
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) { said.push_back(line); };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({shard}));
  CHECK(said == std::vector<std::string>{
                    "note: " + ShardJournal(cluster.Out(), name).string() +
                    ": 2 of its rows were damaged and are left out; what is missing is run again"});
  CHECK_FALSE(journal.Has("a"));
  CHECK(journal.Has("b"));
  CHECK_FALSE(journal.Has("c"));
}

}  // namespace
}  // namespace rift::sweep
