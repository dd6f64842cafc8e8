#pragma once

#include <optional>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sessions {

/// Where the trials of a sweep are run, as it was asked for.
struct EngineRequest {
  std::string engine = "local";  ///< local, slurm, or a file of configs/engines
  std::string partition;
  std::optional<int> shards;
  std::string shard;            ///< a file: this process is a job and computes that shard
  double copy_every_s = 600.0;  ///< of a shard

  /// Calls field(key, member, [min, max,] what the value is called, help) for every member.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("engine", self.engine, "local|slurm|FILE.yaml",
          "where trials are run: local, slurm, or a file with a cluster's habits "
          "(configs/engines/slurm.yaml); a grid as job arrays, a search, a calibration, --shrink "
          "and --rare-event as one job each");
    field("partition", self.partition, "TEXT", "with --engine slurm: where its jobs go");
    field("shards", self.shards, 1, 1'000'000, "N",
          "with --engine slurm: parts that a batch of trials is run in; the results are the same "
          "for any [as many as last a minute each]");
    field("shard", self.shard, "FILE",
          "run the trials of one shard into --out/shards: what the jobs of --engine slurm do");
    field("copy_every", self.copy_every_s, 1.0, 86400.0, "S",
          "with --shard: how often what is done is copied there");
  }
};

/// The habits of the cluster that trials are run on; nothing where they are run on this machine.
/// Throws std::invalid_argument for an engine that is none, for an experiment (`file`) that has no
/// trials to be handed out, and for a program that is not on this machine and needed here;
/// yaml::Error for a wrong file.
std::optional<sweep::SlurmOptions> ClusterFor(const EngineRequest& request,
                                              const experiment::Experiment& experiment,
                                              const std::string& file);

}  // namespace rift::sessions
