#include "request.hpp"
#include "rift/commands/arguments/arguments.hpp"

namespace rift::commands {

void AddSweepFlags(CLI::App& app, SweepRequest& request) {
  FlagMaker flags(app);
  app.add_option("EXPERIMENT", request.experiment, "YAML file of the experiment");
  AddSetFlag(app, request.overrides, "gap.skip_start=0.1");
  flags("out", request.out, "DIR",
        "folder for journal, table, summary, figures and report [out/NAME]");
  flags("budget", request.budget, "N", "settings that a search may try (search.budget)");
  flags("seconds", request.seconds, "S", "time that a search may take (search.max_s)");
  flags("jobs", request.jobs, 1, 4096, "N", "worker processes; the results are the same for any");
  app.add_flag("--fresh,--force", request.fresh,
               "start over instead of going on with an earlier journal, and replace what another "
               "experiment left");
  AddAnyWaypointsFlag(app, request.any_waypoints);
  flags("status", request.status, "DIR", "tell how far the sweep in a folder is, and end");
  app.add_option("--compare", request.compare,
                 "hold the folders of two sweeps over the same space against each other, before "
                 "and after a change, and end")
      ->expected(2)
      ->type_name("DIR");
  flags("page", request.page, "FILE.html", "with --compare: write it as a page as well");
  AddFlags(app, request.engine);
  flags("suggest", request.suggest, 1, 1000, "N",
        "suggest up to N experiments on the robot, print what each would decide and write them to "
        "DIR/suggested.yaml, which rift drive --suggested DIR drives (of recorded logs they are "
        "printed alone: no drive sets what names a log)");
  AddFlags(app, request.further);
  AddKeysFlag(app);
  flags("brief", request.brief, "print five lines: what fails, where, why, how sure, what next");
  flags("quiet", request.quiet, "no progress");
  flags("json_progress", request.json_progress, "progress as lines of JSON on stderr");
  flags("json", request.json, "print the summary (or status) as JSON instead of text");
  flags("write_robot", request.write_robot, "FILE.yaml",
        "goal: calibrate: write the fitted robot, to be used as include:");
  flags("serve", request.serve,
        "show the report growing while the sweep runs, at an address of this machine alone that "
        "is printed on stderr");
  flags("exit_code", request.exit_code,
        "end with 1 when a setting is falsified, or undecided with a failure");
  flags::Exclude(app, "--quiet", {"--json-progress"});
  flags::Exclude(app, "--json", {"--brief"});
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
