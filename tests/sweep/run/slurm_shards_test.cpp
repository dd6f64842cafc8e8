// What becomes of the shards of a sweep where Slurm or a journal does not do what it should.
#include "rift/sweep/run/slurm_shards.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/sweep/run/job_array.hpp"
#include "support/inputs/trials.hpp"
#include "sweep/run/stand_in_cluster.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

/// How often a text is in another.
int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// A watch that keeps what it is told to say.
SlurmShards::Watch Keeping(std::vector<std::string>& said) {
  SlurmShards::Watch watch;
  watch.say = [&said](const std::string& line) { said.push_back(line); };
  return watch;
}

/// The absolute name of what is given by its way from the working directory.
std::string SeenFromHere(const fs::path& path) {
  return (fs::current_path() / fs::relative(path)).string();
}

TEST_CASE("An array that Slurm may have taken without an answer is not submitted twice") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  cluster.Finishes(shard, "a");
  cluster.Does("sbatch", "echo 'Socket timed out' >&2\nexit 1\n");
  // The queue does not answer after that, and has the task at the third look.
  cluster.Does("squeue",
               "echo x >> \"$D/asked\"; N=$(wc -l < \"$D/asked\")\n"
               "[ $N -ne 2 ] || { echo 'Connection refused' >&2; exit 1; }\n"
               "[ $N -lt 3 ] || echo '41_0|RUNNING|None'\n"
               "[ $N -lt 5 ] || for F in \"$D\"/ready/*; do\n"
               "  cp \"$F\" \"$D/out/shards/${F##*/}.sqlite\"\ndone\n");
  const SlurmOptions options = Quick();
  std::vector<std::string> said;
  SlurmShards slurm(cluster.Out(), options, "", journal, Keeping(said));
  CHECK(slurm.Run({shard}));
  CHECK(said == std::vector<std::string>{"note: sbatch: Socket timed out; trying again",
                                         "note: squeue: Connection refused; trying again"});
  CHECK(Count(cluster.Arguments("sbatch"), "--parsable\n") == 1);
  CHECK(cluster.Arguments("scancel") == "41\n");  // it was still in the queue at the end
  CHECK(journal.Find("a") == "row of a");
}

TEST_CASE("An array has as many tasks as the cluster lets where the options leave that open") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Answers("scontrol", "MaxArraySize = 2\n");
  std::vector<Shard> shards;
  for (const char* key : {"a", "b", "c"}) {
    shards.push_back(ShardOf(key));
    cluster.Finishes(shards.back(), key);
  }
  const SlurmOptions options = Quick(0);
  SlurmShards slurm(cluster.Out(), options, "", journal, {});
  CHECK(slurm.Run(shards));
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0-1\n");
  CHECK(test::ReadFile(cluster.Out() / "slurm/2/jobs") == "41 0\n");
  CHECK(cluster.Arguments("scontrol") == "show\nconfig\n");
  for (const char* key : {"a", "b", "c"}) CHECK(journal.Has(key));
}

TEST_CASE("A task that cannot be cancelled now is submitted anew once it is, and counts nowhere") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  cluster.Does("scancel",
               "[ -e \"$D/asked\" ] || {\n"
               "  : > \"$D/asked\"; echo 'Unable to contact slurm controller' >&2; exit 1\n}\n");
  std::vector<std::string> said;
  std::vector<ShardCounts> seen;
  SlurmShards::Watch watch = Keeping(said);
  watch.seen = [&](const ShardCounts& counts) {
    seen.push_back(counts);
    if (seen.size() == 1) cluster.Answers("squeue", "41_0|PENDING|JobHoldMaxRequeue\n");
    if (seen.size() != 3) return;
    cluster.Answers("squeue", "");
    cluster.Finishes(shard, "a");
  };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({shard}));
  const std::string held =
      "note: shard 0 of " + (cluster.Out() / "slurm/1").string() +
      " lost its node so often that Slurm holds it (JobHoldMaxRequeue); it is submitted anew";
  CHECK(said == std::vector<std::string>{
                    held, "note: scancel: Unable to contact slurm controller; trying again", held});
  CHECK(cluster.Arguments("scancel") == "41_0\n41_0\n");
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0\n41 0\n");
  REQUIRE(seen.size() == 4);
  CHECK(seen[1] == ShardCounts{.total = 1});
  CHECK(seen[2] == ShardCounts{.total = 1});
  CHECK(seen[3] == ShardCounts{.total = 1, .done = 1});
}

TEST_CASE(
    "The journal of a shard of another experiment is told, removed, and the shard run again") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard shard = ShardOf("a");
  const fs::path ready = cluster / ("ready/" + ShardName(EncodeShard(shard)));
  Journal(ready, {{"seed", "2"}}).Close();
  std::vector<std::string> said;
  SlurmShards::Watch watch;
  watch.say = [&](const std::string& line) {
    said.push_back(line);
    fs::remove(ready);
    cluster.Finishes(shard, "a");
  };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({shard}));
  CHECK(said == std::vector<std::string>{
                    "note: " + ShardJournal(cluster.Out(), ShardName(EncodeShard(shard))).string() +
                    " is the journal of another experiment; its shard is run again"});
  CHECK(test::ReadFile(cluster.Out() / "slurm/1/jobs") == "41 0\n41 0\n");
  CHECK(journal.Has("a"));
}

TEST_CASE("A shard without a journal and without a word is told with nothing as its last line") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Does("sbatch", "");
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, {});
  const std::string array = (cluster.Out() / "slurm/1").string();
  CHECK_THROWS_WITH(slurm.Run({ShardOf("a")}),
                    "shard 0 of " + array +
                        " was run 3 times and left no journal; the last line of " + array +
                        "/0.log: nothing");
}

TEST_CASE("Each array of a sweep is cleaned up when all of its own shards are done") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const std::vector<Shard> shards{ShardOf("a"), ShardOf("b"), ShardOf("c"), ShardOf("d")};
  for (const size_t i : {0, 1, 2}) cluster.Finishes(shards[i], std::string(1, "abc"[i]));
  const fs::path first = cluster.Out() / "slurm/1", second = cluster.Out() / "slurm/2";
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts& counts) {
    if (++looks != 3) return;
    CHECK(counts.total == 2);  // of the second array alone
    CHECK(counts.done == 1);
    CHECK_FALSE(fs::exists(first / "shards"));
    CHECK(fs::exists(second / "shards"));
    CHECK(fs::exists(cluster.Out() / "shards"));
    CHECK_FALSE(fs::exists(ShardJournal(cluster.Out(), ShardName(EncodeShard(shards[1])))));
    cluster.Finishes(shards[3], "d");
  };
  const SlurmOptions options = Quick(2);
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run(shards));
  CHECK(test::ReadFile(first / "jobs") == "41 0-1\n");
  CHECK(test::ReadFile(second / "jobs") == "41 0-1\n41 1\n");  // what is done is not run again
  for (const char* key : {"a", "b", "c", "d"}) CHECK(journal.Has(key));
}

TEST_CASE("Where Slurm does not answer, jobs that may be left are named, and the folders go") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  WriteArrays(cluster, journal, {ShardOf("a"), ShardOf("b")}, Quick(1));
  cluster.Fails("squeue", "Connection refused\n");
  std::vector<std::string> said, expected;
  for (const char* number : {"1", "2"}) {
    const std::string name = JobArray(cluster.Out() / "slurm" / number).JobName();
    expected.push_back("note: jobs named " + name +
                       " may still be in the queue, where scancel --name=" + name +
                       " ends them: squeue: Connection refused");
  }
  SlurmShards::Forget(cluster.Out(), [&](const std::string& line) { said.push_back(line); });
  CHECK(said == expected);
  CHECK_FALSE(fs::exists(cluster.Out() / "slurm"));
  CHECK_FALSE(fs::exists(cluster.Out() / "shards"));
  CHECK(fs::exists(cluster.Out() / "journal.sqlite"));
  CHECK_FALSE(SlurmShards::AreOpen(cluster.Out()));
}

TEST_CASE("The note that a sweep is running stands in its journal, for others to read") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Finishes(ShardOf("a"), "a");
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, {});
  CHECK(slurm.Run({ShardOf("a")}));
  CHECK(journal.Note("state") == "running");
}

TEST_CASE("Whoever was stopped leaves the queue alone from then on and complains of nothing") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  int looks = 0;
  std::vector<std::string> said;
  SlurmShards::Watch watch = Keeping(said);
  watch.seen = [&](const ShardCounts&) { ++looks; };
  watch.go_on = [&] { return looks < 1; };
  const SlurmOptions options = Quick();
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK_FALSE(slurm.Run({ShardOf("a")}));
  CHECK(looks == 1);
  CHECK(cluster.Arguments("sbatch").empty());
  CHECK(said.empty());
  CHECK(SlurmShards::AreOpen(cluster.Out()));  // the same command goes on with it
}

TEST_CASE("A cluster that took an array is asked again soon when it is busy the next time") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  const Shard first = ShardOf("a"), second = ShardOf("b");
  cluster.Finishes(first, "a");
  cluster.Finishes(second, "b");
  // Busy four times, and once after the first array was taken.
  cluster.Does("sbatch",
               "echo x >> \"$D/tried\"\n"
               "case $(wc -l < \"$D/tried\") in 1|2|3|4|6)\n"
               "  echo 'over the job limit' >&2; exit 1;; esac\n" +
                   test::ReadFile(cluster / "sbatch.also"));
  int looks = 0;
  SlurmShards::Watch watch;
  watch.seen = [&](const ShardCounts&) { ++looks; };
  SlurmOptions options = Quick();
  options.poll_s = 0.02;
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  CHECK(slurm.Run({first}));
  looks = 0;
  CHECK(slurm.Run({second}));
  CHECK(looks == 3);  // before it was refused, before it was taken, and when it was done
  CHECK(journal.Has("b"));
}

TEST_CASE("Tasks start where the sweep was started, under names that hold from there") {
  const Cluster cluster;
  Journal journal = cluster.NewJournal();
  cluster.Finishes(ShardOf("a"), "a");
  const SlurmOptions options = Quick();
  SlurmShards slurm(fs::relative(cluster.Out()), options, "", journal, {});
  CHECK(slurm.Run({ShardOf("a")}));
  const std::string array = (cluster.Out() / "slurm/1").string();
  CHECK(cluster.Arguments("sbatch") ==
        "--parsable\n--propagate=NONE\n--job-name=" + JobArray(array).JobName() +
            "\n--chdir=" + fs::current_path().string() + "\n--output=" + SeenFromHere(array) +
            "/%a.log\n--open-mode=append\n--requeue\n--cpus-per-task=2\n--array=0\n" +
            SeenFromHere(array) + "/array.sh\n");
  CHECK_THAT(test::ReadFile(array + "/array.sh"),
             Catch::Contains(" --out '" + SeenFromHere(cluster.Out()) + "' --shard '" +
                             SeenFromHere(array) + "'/"));
}

}  // namespace
}  // namespace rift::sweep
