#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/statistics/hash.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/shard.hpp"
#include "rift/sweep/run/slurm_options.hpp"
#include "rift/sweep/run/slurm_shards.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"

// Stand-ins for the commands of Slurm, and for a cluster behind them.
namespace rift::sweep {

inline const Facts kFactsOfShards{{"seed", "1"}};

/// Commands that write down their arguments and give the answers they are told.
class Stand {
 public:
  Stand() {
    for (const char* name : {"sbatch", "squeue", "scancel", "scontrol"}) {
      test::WriteText(bin_ / name, "#!/bin/sh\nD='" + folder_.Path().string() +
                                       "'; N=${0##*/}\n"
                                       "printf '%s\\n' \"$@\" >> \"$D/$N.args\"\n"
                                       "[ ! -f \"$D/$N.also\" ] || . \"$D/$N.also\"\n"
                                       "[ ! -f \"$D/$N.err\" ] || cat \"$D/$N.err\" >&2\n"
                                       "[ ! -f \"$D/$N.out\" ] || cat \"$D/$N.out\"\n"
                                       "[ ! -f \"$D/$N.code\" ] || exit $(cat \"$D/$N.code\")\n");
      std::filesystem::permissions(bin_ / name, std::filesystem::perms::owner_all);
    }
  }

  void Answers(const std::string& name, const std::string& out) const {
    test::WriteText(folder_ / (name + ".out"), out);
  }
  void Fails(const std::string& name, const std::string& words,
             const std::string& code = "1") const {
    test::WriteText(folder_ / (name + ".err"), words);
    test::WriteText(folder_ / (name + ".code"), code);
  }
  /// Lines of a shell in the middle of a command; $D is this folder.
  void Does(const std::string& name, const std::string& lines) const {
    test::WriteText(folder_ / (name + ".also"), lines);
  }
  /// A line for each argument since the last call.
  std::string Arguments(const std::string& name) const {
    const std::filesystem::path file = folder_ / (name + ".args");
    if (!std::filesystem::exists(file)) return "";
    const std::string text = test::ReadFile(file);
    std::filesystem::remove(file);
    return text;
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_;
  std::filesystem::path bin_ = folder_.Path() / "bin";
  test::Environment path_{"PATH", bin_.string() + ":" + std::getenv("PATH")};
};

/// Of an experiment whose text is empty.
inline Shard ShardOf(const std::string& request) {
  return {.facts = "f", .experiment = statistics::Hash128Text(""), .requests = {request}};
}

/// A cluster that has finished what it is given, where a journal lies ready in `ready`.
class Cluster : public Stand {
 public:
  Cluster() {
    std::filesystem::create_directories(*this / "ready");
    Answers("sbatch", "41\n");
    Does("sbatch",
         "for A; do S=$A; done\nF=${S%/*}\nI=0\nO=${F%/slurm/*}/shards\n"
         "while read -r NAME; do\n"
         "  [ ! -f \"$D/ready/$NAME\" ] || cp \"$D/ready/$NAME\" \"$O/$NAME.sqlite\"\n"
         "done < \"$F/shards\"\n");
  }
  void Finishes(const Shard& shard, const std::string& key,
                const std::string& status = "ok") const {
    Journal journal(*this / ("ready/" + ShardName(EncodeShard(shard))), kFactsOfShards);
    journal.Add(key, {status, 0.01, false, "row of " + key});
    journal.Close();
  }
  std::filesystem::path Out() const { return *this / "out"; }
  Journal NewJournal() const {
    std::filesystem::create_directories(Out());
    return Journal(Out() / "journal.sqlite", kFactsOfShards);
  }
};

inline SlurmOptions Quick(int most = 1000) {
  SlurmOptions options;
  options.poll_s = 0.001;
  options.max_array_size = most;
  options.cpus_per_task = 2;
  options.copy_every_s = 4.5;
  options.program = "/bin/my rift";
  options.prologue = {"module load x"};
  return options;
}

/// Arrays of a sweep that was stopped before any was submitted.
inline void WriteArrays(const Cluster& cluster, Journal& journal, const std::vector<Shard>& shards,
                        const SlurmOptions& options) {
  SlurmShards::Watch watch;
  watch.go_on = [] { return false; };
  SlurmShards slurm(cluster.Out(), options, "", journal, watch);
  cluster.Arguments("sbatch");
  CHECK_FALSE(slurm.Run(shards));
  CHECK(cluster.Arguments("sbatch").empty());
}

}  // namespace rift::sweep
