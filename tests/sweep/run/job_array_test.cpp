// The folder of a job array: its files, its name, and what a task would refuse.
#include "rift/sweep/run/job_array.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/statistics/hash.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

Shard ShardWith(const std::string& request, const std::string& experiment = "name: x\n") {
  return {.facts = "f", .experiment = statistics::Hash128Text(experiment), .requests = {request}};
}

std::vector<std::string> NamesOf(const std::vector<JobArray>& arrays) {
  std::vector<std::string> names;
  for (const JobArray& array : arrays) names.push_back(array.Folder().filename().string());
  return names;
}

TEST_CASE("Arrays stand by their number, and open are those with shards") {
  const test::TemporaryFolder out;
  CHECK(JobArray::Of(out.Path()).empty());
  CHECK(JobArray::Next(out.Path()).Folder() == out.Path() / "slurm/1");
  for (const char* name : {"10", "9", "2", "123456789", "12345678", "1b", "-1"}) {
    fs::create_directories(out / (std::string("slurm/") + name));
  }
  CHECK(NamesOf(JobArray::Of(out.Path())) == std::vector<std::string>{"2", "9", "10", "12345678"});
  CHECK(JobArray::OpenOf(out.Path()).empty());
  CHECK(JobArray::Next(out.Path()).Folder() == out.Path() / "slurm/12345679");
  JobArray(out / "slurm/9").Write("name: x\n", {ShardWith("a")});
  JobArray(out / "slurm/10").Write("name: x\n", {ShardWith("b")});
  JobArray(out / "slurm/2").Write("name: x\n", {});
  CHECK(NamesOf(JobArray::OpenOf(out.Path())) == std::vector<std::string>{"9", "10"});
}

TEST_CASE("An array holds its shards in their order, each under the number of its task") {
  const test::TemporaryFolder out;
  JobArray array(out / "slurm/1");
  const std::vector<Shard> shards{ShardWith("a"), ShardWith("b"), ShardWith("c")};
  const std::vector<std::string> names = array.Write("name: x\n", shards);
  REQUIRE(names.size() == 3);
  CHECK(array.OpenShards() == names);
  for (size_t task = 0; task < 3; ++task) {
    const std::string bytes = EncodeShard(shards[task]);
    CHECK(names[task] == ShardName(bytes));
    CHECK(test::ReadFile(out / ("slurm/1/" + std::to_string(task) + ".shard")) == bytes);
    CHECK(array.WhyUseless(task, names[task]).empty());
  }
  CHECK(test::ReadFile(out / "slurm/1/experiment.yaml") == "name: x\n");
  CHECK(array.IsOf("name: x\n"));
  CHECK_FALSE(array.IsOf("name: y\n"));
  CHECK_FALSE(JobArray(out / "slurm/2").IsOf("name: x\n"));
  CHECK(array.Script() == out / "slurm/1/array.sh");
  CHECK(array.LogFile(12) == out / "slurm/1/12.log");
}

TEST_CASE("A task refuses a shard or an experiment that is not what was submitted") {
  const test::TemporaryFolder out;
  JobArray array(out / "slurm/1");
  const std::vector<std::string> names =
      array.Write("name: x\n", {ShardWith("a"), ShardWith("b"), ShardWith("c", "name: y\n")});
  const std::string folder = out / "slurm/1/", end = " is not there or not what was submitted";
  CHECK(array.WhyUseless(0, names[1]) == folder + "0.shard" + end);
  CHECK(array.WhyUseless(3, names[1]) == folder + "3.shard" + end);
  CHECK(array.WhyUseless(2, names[2]) == folder + "experiment.yaml" + end);
  // Bytes under their own name, and yet no shard.
  test::WriteText(folder + "1.shard", "no shard");
  CHECK_THAT(array.WhyUseless(1, ShardName("no shard")),
             Catch::StartsWith(folder + "1.shard is no shard of a sweep that this version of rift "
                                        "wrote: "));
  CHECK(array.WhyUseless(0, names[0]).empty());
  fs::remove(folder + "experiment.yaml");
  CHECK(array.WhyUseless(0, names[0]) == folder + "experiment.yaml" + end);
}

TEST_CASE("The last line of a task is the last that is not empty") {
  const test::TemporaryFolder out;
  const JobArray array(out.Path());
  CHECK(array.LastLine(0) == "nothing");
  test::WriteText(out / "0.log", "");
  test::WriteText(out / "1.log", "\n\n");
  test::WriteText(out / "2.log", "first\nsecond");
  test::WriteText(out / "3.log", "first\n third \n\n\n");
  CHECK(array.LastLine(0) == "nothing");
  CHECK(array.LastLine(1) == "nothing");
  CHECK(array.LastLine(2) == "second");
  CHECK(array.LastLine(3) == " third ");
}

TEST_CASE("Jobs have a name of their folder, however the folder is written") {
  const test::TemporaryFolder out;
  fs::create_directories(out / "a/slurm/1");
  fs::create_directories(out / "a/slurm/2");
  const std::string name = JobArray(out / "a/slurm/1").JobName();
  CHECK(name.size() == 5 + 16);
  CHECK(name.starts_with("rift-"));
  CHECK(name.find_first_not_of("0123456789abcdef", 5) == name.npos);
  CHECK(JobArray(out / "a/slurm/2").JobName() != name);
  CHECK(JobArray(out / "b/slurm/1").JobName() != name);
  CHECK(JobArray(out / "a/slurm/../slurm/1").JobName() == name);
  fs::create_directory_symlink(out / "a", out / "link");
  CHECK(JobArray(out / "link/slurm/1").JobName() == name);
}

TEST_CASE("What was submitted is noted line by line") {
  const test::TemporaryFolder out;
  const JobArray array(out.Path());
  array.NoteJob("12", "0-3,7");
  array.NoteJob("13", "2");
  CHECK(test::ReadFile(out / "jobs") == "12 0-3,7\n13 2\n");
}

TEST_CASE(
    "An array that is over keeps its script, its jobs and words, and no shard of it is left") {
  const test::TemporaryFolder out;
  JobArray array(out / "slurm/1");
  const std::vector<std::string> names =
      array.Write("name: x\n", {ShardWith("a"), ShardWith("b"), ShardWith("c")});
  const std::string folder = out / "slurm/1/";
  test::WriteText(folder + "array.sh", "script");
  array.NoteJob("12", "0-2");
  test::WriteText(folder + "0.log", "words\n");
  test::WriteText(folder + "1.log", "");  // and task 2 has none
  test::WriteText(ShardJournal(out.Path(), names[0]), "journal");
  test::WriteText(UnfinishedShardJournal(out.Path(), names[1]), "part");
  test::WriteText(ShardJournal(out.Path(), "other"), "of another array");
  test::WriteText(UnfinishedShardJournal(out.Path(), "other"), "of another array");
  array.CleanUp(out.Path(), names);
  const auto files = [](const fs::path& in) {
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(in)) {
      left.push_back(entry.path().filename().string());
    }
    std::sort(left.begin(), left.end());
    return left;
  };
  CHECK(files(out / "slurm/1") == std::vector<std::string>{"0.log", "array.sh", "jobs"});
  CHECK(files(out / "shards") == std::vector<std::string>{"other.part", "other.sqlite"});
  CHECK(array.OpenShards().empty());
}

TEST_CASE("The script of an array runs the file that was started here where no other is named") {
  const test::TemporaryFolder out;
  const JobArray array(out / "slurm/it's 1");
  SlurmOptions options;
  options.cpus_per_task = 7;
  options.copy_every_s = 90.0;
  options.prologue = {"module load gcc", "ulimit -c 0"};
  array.WriteScript(out.Path() / "to here", options);
  const std::string script = test::ReadFile(array.Script());
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  CHECK_THAT(script,
             Catch::Contains("\nmodule load gcc\nulimit -c 0\nexec '" + program + "' sweep '"));
  CHECK_THAT(script, Catch::Contains("' --out '" + (out / "to here") + "' --shard '"));
  CHECK_THAT(script, Catch::EndsWith("'/\"$SLURM_ARRAY_TASK_ID\".shard --jobs 7 --copy-every 90 "
                                     "--large-inputs\n"));
}

}  // namespace
}  // namespace rift::sweep
