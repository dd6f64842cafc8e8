#include "flags.hpp"

#include <string>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"

namespace rift::commands {
namespace {

void AddEngineFlags(CLI::App& app, EngineRequest& request) {
  app.add_option("--engine", request.engine,
                 "where trials are run: local, slurm, or a file with a cluster's habits "
                 "(configs/engines/slurm.yaml); a grid as job arrays, a search, a calibration, "
                 "--shrink and --rare-event as one job each")
      ->type_name("local|slurm|FILE.yaml")
      ->capture_default_str();
  app.add_option("--partition", request.partition, "with --engine slurm: where its jobs go");
  app.add_option("--shards", request.shards,
                 "with --engine slurm: parts that a batch of trials is run in; the results are the "
                 "same for any [as many as last a minute each]")
      ->type_name("N")
      ->check(InRange(1, 1'000'000));
  app.add_option(
         "--shard", request.shard,
         "run the trials of one shard into --out/shards: what the jobs of --engine slurm do")
      ->type_name("FILE");
  app.add_option("--copy-every", request.copy_every_s,
                 "with --shard: how often what is done is copied there")
      ->type_name("S")
      ->check(InRange(1.0, 86400.0))
      ->capture_default_str();
}

void AddExplainFlags(CLI::App& app, SweepRequest& request) {
  app.add_option(
         "--suggest", request.suggest,
         "suggest up to N experiments on the robot, print what each would decide and write them "
         "to DIR/suggested.yaml, which rift drive --suggested DIR drives")
      ->type_name("N")
      ->check(InRange(1, 1000));
  app.add_option("--shrink", request.further.shrink,
                 "bring a failing row of table.csv down to the fewest and smallest changes from "
                 "the experiment's own values that still fail, by further trials")
      ->type_name("ROW|worst");
  app.add_flag("--rare-event", request.further.rare_event,
               "estimate a small failure probability over the space by further trials (subset "
               "simulation)");
}

}  // namespace

void AddSweepFlags(CLI::App& app, SweepRequest& request) {
  app.add_option("EXPERIMENT", request.experiment, "YAML file of the experiment");
  AddSetFlag(app, request.overrides, "gap.skip_start=0.1");
  app.add_option("--out", request.out,
                 "folder for journal, table, summary, figures and report [out/NAME]")
      ->type_name("DIR");
  app.add_option("--budget", request.budget, "settings that a search may try (search.budget)")
      ->type_name("N");
  app.add_option("--seconds", request.seconds, "time that a search may take (search.max_s)")
      ->type_name("S");
  app.add_option("--jobs", request.jobs, "worker processes; the results are the same for any")
      ->check(InRange(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--fresh,--force", request.fresh,
               "start over instead of going on with an earlier journal, and replace what another "
               "experiment left");
  AddAnyWaypointsFlag(app, request.any_waypoints);
  app.add_option("--status", request.status, "tell how far the sweep in a folder is, and end")
      ->type_name("DIR");
  app.add_option("--compare", request.compare,
                 "hold the folders of two sweeps over the same space against each other, before "
                 "and after a change, and end")
      ->expected(2)
      ->type_name("DIR");
  app.add_option("--page", request.page, "with --compare: write it as a page as well")
      ->type_name("FILE.html");
  AddEngineFlags(app, request.engine);
  AddExplainFlags(app, request);
  AddKeysFlag(app);
  app.add_flag("--brief", request.brief,
               "print five lines: what fails, where, why, how sure, what next");
  CLI::Option* quiet = app.add_flag("--quiet", request.quiet, "no progress");
  app.add_flag("--json-progress", request.json_progress, "progress as lines of JSON on stderr")
      ->excludes(quiet);
  app.add_flag("--json", request.json, "print the summary (or status) as JSON instead of text")
      ->excludes(app.get_option("--brief"));
  app.add_option("--write-robot", request.write_robot,
                 "goal: calibrate: write the fitted robot, to be used as include:")
      ->type_name("FILE.yaml");
  app.add_flag("--serve", request.serve,
               "show the report growing while the sweep runs, at an address of this machine alone "
               "that is printed on stderr");
  app.add_flag("--exit-code", request.exit_code,
               "end with 1 when a setting is falsified, or undecided with a failure");
  app.footer(
      "Ctrl-C stops a sweep, and the same command goes on with it, also after a crash.\n"
      "goal: calibrate fits the simulator, or somebody else's, to logs (configs/calibrate.yaml).\n"
      "Example: rift sweep configs/waypoints/paper.yaml --out out/paper\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --suggest 3 --shrink "
      "worst\n"
      "         rift sweep configs/programs/diff_drive.yaml --out out/own (somebody else's "
      "simulator)\n"
      "         rift sweep configs/programs/calibrate.yaml --out out/fit (its parameters, fitted "
      "to "
      "logs)\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --serve\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --engine slurm --shards "
      "40\n"
      "         rift sweep --compare out/before out/after --page out/change.html");
}

}  // namespace rift::commands
