// Runs of somebody else's program, here a few lines of a shell.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/files/files.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/program_files.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "support/inputs/paths.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/processes/small_disk.hpp"
#include "support/until.hpp"
#include "sweep/falsify/program_side.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const Inputs kFiles{[](const std::string& path) { return files::ReadIfThere(path); },
                    [](const std::string&) {}};

/// An experiment whose candidate is `sh FOLDER/sim.sh ARGUMENTS`, with a log beside it to be
/// copied.
class Shell {
 public:
  explicit Shell(const std::string& lines, std::vector<std::string> arguments = {"{out}"}) {
    test::WriteText(folder_ / "sim.sh", "HERE='" + folder_.Path().string() + "'\n" + lines + "\n");
    test::WriteText(folder_ / "good.csv", trajectory::WriteRift(test::StraightPath(0.75, 16)));
    experiment.candidate.kind = experiment::CandidateKind::kProgram;
    experiment.candidate.run.words = {"sh", folder_ / "sim.sh"};
    for (std::string& one : arguments) experiment.candidate.run.words.push_back(std::move(one));
    experiment.waypoints = {{.name = "s"}, {.name = "e", .x_m = 1.0, .y_m = 0.5}};
    experiment.reference.kind = experiment::ReferenceKind::kPath;
    experiment.reference.trials.names = {"1"};
    experiment.space.parameters = {{.key = "mu", .min = 0.0, .max = 1.0, .nominal = 0.5},
                                   {.key = "floor", .levels = {{"ice", {}}, {"rock", {}}}}};
    experiment.seed = 9;
    experiment.run.retries = 0;
    experiment.run.memory_mb = 512;
  }

  Recording Run(std::optional<std::uint64_t> seed = 7) const {
    std::fflush(stdout);  // the thread sanitizer's _exit writes a copy of it into an answer
    return CandidateProgram(experiment, {}, kFiles)
        ->Run({.theta = {{"0.25", 0.25}, {"ice", {}}}, .trial = "1", .seed = seed});
  }
  std::string Read(const std::string& name) const { return test::ReadFile(folder_ / name); }
  std::string operator/(const std::string& name) const { return folder_ / name; }
  std::string Refusal() const {
    try {
      CandidateProgram(experiment, {}, kFiles);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }

  experiment::Experiment experiment;

 private:
  test::TemporaryFolder folder_;
};

TEST_CASE("A program finds the values of its trial in arguments, environment and a file") {
  const Shell shell(
      "printf '%s\\n' \"$@\" > \"$HERE/args\"; printf '%s' \"$RIFT_TRIAL\" > "
      "\"$HERE/env\"; cp \"$6\" \"$HERE/theta\"; cp \"$HERE/good.csv\" \"$5\"",
      {"{mu:.3f}", "{floor}", "{trial}", "{seed}", "{out}", "{theta}", "{folder}"});
  const Recording run = shell.Run();
  REQUIRE(run.status == TrialStatus::kOk);
  CHECK(run.source == "program with seed 7");
  CHECK(run.trajectory.poses.size() == 16);
  CHECK(run.trajectory.poses.back().x_m == Approx(0.75));
  CHECK(std::isnan(run.left_m));
  const std::string arguments = shell.Read("args");
  CHECK(arguments.starts_with("0.250\nice\n1\n7\n"));
  const auto trial = nlohmann::json::parse(shell.Read("theta"));
  CHECK(trial == nlohmann::json::parse(shell.Read("env")));
  CHECK(trial["theta"]["mu"] == 0.25);
  CHECK(trial["theta"]["floor"] == "ice");
  CHECK(trial["seed"] == 7);
  CHECK(trial["trial"] == "1");
  const std::string folder = fs::path(trial["out"].get<std::string>()).parent_path().string();
  CHECK(
      arguments.ends_with(folder + "/trajectory.csv\n" + folder + "/theta.json\n" + folder + "\n"));
  CHECK_FALSE(fs::exists(folder));
  CHECK(shell.Run(std::nullopt).source == "program with seed 9");  // the experiment's
}

TEST_CASE("Exit codes are ends of a run as the side says, with what is left to the last waypoint") {
  struct Case {
    int code;
    TrialStatus status;
  };
  for (const Case& one : {Case{10, TrialStatus::kTimedOut}, Case{11, TrialStatus::kFell},
                          Case{12, TrialStatus::kLeftArena}, Case{13, TrialStatus::kLost},
                          Case{14, TrialStatus::kFault}, Case{1, TrialStatus::kFault}}) {
    INFO(one.code);
    Shell shell("cp \"$HERE/good.csv\" \"$1\"; echo 'last words' >&2; exit " +
                std::to_string(one.code));
    const Recording run = shell.Run();
    CHECK(run.status == one.status);
    CHECK_THAT(run.reason, Contains("last words"));
    CHECK(run.left_m == Approx(std::hypot(0.25, 0.5)));
    CHECK(run.trajectory.poses.size() == 16);
    shell.experiment.waypoints.pop_back();
    CHECK(std::isnan(shell.Run().left_m));
  }
  Shell shell("exit 21");
  shell.experiment.candidate.exit_codes = {20, 21, 22, 23};
  CHECK(shell.Run().status == TrialStatus::kFell);
  CHECK(std::isnan(shell.Run().left_m));  // no log tells how far it came
  shell.experiment.candidate.exit_codes.fell = 24;
  CHECK(shell.Run().status == TrialStatus::kFault);
}

TEST_CASE("What a program's run has left is the way through the waypoints that it did not reach") {
  Shell shell("cp \"$HERE/run.csv\" \"$1\"; exit 10");
  shell.experiment.control.reach_radius_m = 0.05;
  shell.experiment.waypoints = {{.name = "A"},
                                {.name = "B", .x_m = 1.0},
                                {.name = "C", .x_m = 1.0, .y_m = 1.0},
                                {.name = "D", .y_m = 1.0},
                                {.name = "A2"}};
  const auto left_m = [&](const std::vector<Eigen::Vector2d>& points_m) {
    std::string log = "t_s,x_m,y_m\n";
    for (size_t i = 0; i < points_m.size(); ++i) {
      log += fmt::format("{},{},{}\n", i, points_m[i].x(), points_m[i].y());
    }
    test::WriteText(shell / "run.csv", log);
    return shell.Run().left_m;
  };
  CHECK(left_m({{0.0, 0.0}, {0.0, 0.001}}) == Approx(4.0).margin(0.01));  // never left
  CHECK(left_m({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}) == Approx(2.0));
  CHECK(left_m({{0.0, 0.0}, {1.0, 0.0}, {1.1, 0.5}, {1.1, 1.1}, {0.5, 1.1}}) ==
        Approx(2.0 + std::hypot(0.5, 0.1)));                            // round C, too far from it
  CHECK(left_m({{0.0, 0.0}, {1.2, 0.02}, {1.0, 0.5}}) == Approx(2.5));  // past B between two rows
  CHECK(left_m({{0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}}) == Approx(3.0));  // the other way
  CHECK(left_m({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.0, 0.02}}) == 0.0);
}

TEST_CASE("An exit code that would say two things of a run is refused with both its keys") {
  Shell shell("exit 10");
  CHECK(shell.Refusal() == "accepted");
  shell.experiment.candidate.exit_codes.fell = 10;  // timed_out as it is by itself
  CHECK(shell.Refusal() ==
        "candidate.exit_codes: timed_out and fell are both 10: each needs a code of its own");
  shell.experiment.candidate.exit_codes = {20, 21, 22, 21};
  CHECK(shell.Refusal() ==
        "candidate.exit_codes: fell and lost are both 21: each needs a code of its own");
}

TEST_CASE("What a program fails at on a full disk is no result of its trial") {
  const test::TemporaryFolder folder;
  test::SmallDisk disk(folder / "disk");
  RIFT_SKIP_WITHOUT(disk)
  const test::Environment there("TMPDIR", folder / "disk");
  const std::string fill = "dd if=/dev/zero of=fill bs=64k 2> /dev/null; ";
  const std::string says = "the disk of " + (folder / "disk") + " is full, and a program failed";
  disk.Resize(512);
  for (const std::string end : {"exit 1", "cp \"$HERE/good.csv\" \"$1\"", "kill -SEGV $$"}) {
    INFO(end);
    CHECK_THROWS_WITH(Shell(fill + end).Run(), Catch::StartsWith(says));
    CHECK(fs::is_empty(folder / "disk"));
  }
  CHECK(Shell(fill + "exit 10").Run().status == TrialStatus::kTimedOut);  // as it says
  CHECK(Shell("exit 1").Run().status == TrialStatus::kFault);
  CHECK_THROWS_AS(Shell("echo 'a.log: No space left on device' >&2; exit 1").Run(), MachineTrouble);
}

TEST_CASE("A crash is tried again as often as is allowed, and anything else once") {
  Shell shell("echo x >> \"$HERE/runs\"; kill -SEGV $$");
  const auto runs = [&] {
    const std::string text = shell.Read("runs");
    fs::remove(shell / "runs");
    return text.size() / 2;
  };
  Recording run = shell.Run();
  CHECK(run.status == TrialStatus::kCrashed);
  CHECK(run.reason == "ended by signal 11 (Segmentation fault)");
  CHECK(runs() == 1);
  shell.experiment.run.retries = 1;
  CHECK(shell.Run().reason == "ended by signal 11 (Segmentation fault), twice");
  CHECK(runs() == 2);
  shell.experiment.run.retries = 2;
  CHECK(shell.Run().reason == "ended by signal 11 (Segmentation fault), 3 times");
  CHECK(runs() == 3);
  test::WriteText(shell / "sim.sh", "echo x >> '" + shell / "runs" + "'; exit 1");
  CHECK(shell.Run().status == TrialStatus::kFault);
  CHECK(runs() == 1);
}

TEST_CASE("Memory and files beyond the limit are told apart from other ends") {
  const auto run = [](const std::string& words) {
    return Shell("echo '" + words + "' >&2; exit 1").Run();
  };
  for (const char* words : {"std::bad_alloc", "MemoryError: no"}) {
    CHECK(run(words).status == TrialStatus::kOutOfMemory);
    CHECK(run(words).reason ==
          std::string("wanted memory of more than 512 MB (run.memory_mb): ") + words);
  }
  CHECK(run("write: File too large").reason ==
        "wanted a file of more than 512 MB (run.memory_mb): write: File too large");
  CHECK(run("write: File too large").status == TrialStatus::kOutOfMemory);
  CHECK(run("no friction").status == TrialStatus::kFault);
  CHECK(Shell("kill -XFSZ $$").Run().status == TrialStatus::kOutOfMemory);
  Shell again("echo MemoryError >&2; exit 1");
  again.experiment.run.retries = 1;
  CHECK_THAT(again.Run().reason, Catch::EndsWith(": MemoryError, twice"));
}

TEST_CASE("A run that says it is well and leaves no log, or a bad one, is told so") {
  CHECK(Shell("exit 0").Run().status == TrialStatus::kFault);
  CHECK(Shell("exit 0").Run().reason == "ended well and wrote no trajectory to {out}");
  const Recording bad = Shell("echo 't_s,x_m,y_m' > \"$1\"").Run();
  CHECK(bad.status == TrialStatus::kUnreadable);
  CHECK(bad.reason.starts_with("its trajectory: "));
  const Recording backwards =
      Shell("printf 't_s,x_m,y_m\\n0,0,0\\n2,1,0\\n1,2,0\\n' > \"$1\"").Run();
  CHECK(backwards.status == TrialStatus::kUnreadable);
  CHECK_THAT(backwards.reason, Contains("time runs backwards in it"));
  const Recording cut = Shell("printf 't_s,x_m,y_m\\n0,0,0\\n1,1,0\\n2,2' > \"$1\"").Run();
  CHECK(cut.status == TrialStatus::kUnreadable);
  CHECK_THAT(cut.reason, Contains("cut short"));
  // Of one that did not arrive the log is told if it can be read, and is no reason.
  const Recording fell = Shell("echo nothing > \"$1\"; exit 11").Run();
  CHECK(fell.status == TrialStatus::kFell);
  CHECK(fell.trajectory.poses.empty());
}

/// Does that for each line that it is told.
struct Persistent : Shell {
  explicit Persistent(const std::string& on_line)
      : Shell("while read -r LINE; do\n" + on_line + "\ndone", {"{folder}"}) {
    experiment.candidate.persistent = true;
  }
};

TEST_CASE("A persistent program answers each trial with a status, a reason and perhaps a log") {
  const std::string log = "t_s,x_m,y_m\\\\n0,0,0\\\\n1,0.4,0.5\\\\n";
  const auto answer = [&](const std::string& text) {
    return Persistent("printf '" + text + "\\n'").Run();
  };
  const Recording ok = answer("{\"status\": \"ok\", \"log\": \"" + log + "\"}");
  CHECK(ok.status == TrialStatus::kOk);
  CHECK(ok.reason.empty());
  CHECK(ok.trajectory.poses.size() == 2);
  const Recording fell =
      answer("{\"status\": \"fell\", \"reason\": \"on its side\", \"log\": \"" + log + "\"}");
  CHECK(fell.status == TrialStatus::kFell);
  CHECK(fell.reason == "on its side");
  CHECK(fell.left_m == Approx(0.6));
  const std::string long_word(3000, 'z');
  CHECK(answer("{\"status\": \"fell\", \"reason\": \"" + long_word + "\"}").reason ==
        long_word.substr(0, 200));
  CHECK(answer("{\"status\": \"fell\", \"reason\": \"one\\\\ntwo\"}").reason == "one");
  CHECK(answer("{\"status\": \"timed_out\"}").status == TrialStatus::kTimedOut);
  CHECK(answer("{\"status\": \"left_arena\"}").status == TrialStatus::kLeftArena);
  CHECK(answer("{\"status\": \"lost\"}").status == TrialStatus::kLost);
  CHECK(answer("{\"status\": \"fault\"}").reason == "the program says so");
  CHECK(answer("{\"status\": \"ok\"}").reason == "ended well and wrote no trajectory to {out}");
  CHECK(answer("{\"status\": \"crashed\"}").reason ==
        "answered with the status 'crashed', and it must be one of ok, timed_out, fell, "
        "left_arena, lost, fault");
  for (const char* text : {"hello", "[]", "{\"state\": \"ok\"}", "{\"status\": 3}"}) {
    CHECK(answer(text).status == TrialStatus::kFault);
    CHECK_THAT(answer(text).reason, Contains("a line of JSON with a status is expected"));
  }
}

TEST_CASE(
    "A persistent program serves several trials, is started anew after its end, and says why") {
  const Persistent shell(
      "echo x >> \"$HERE/lines\"\ncp \"$HERE/good.csv\" \"$1/trajectory.csv\"\n"
      "echo '{\"status\": \"ok\"}'");
  test::WriteText(shell / "sim.sh",
                  "echo y >> '" + shell / "starts" + "'\n" + shell.Read("sim.sh"));
  const auto program = CandidateProgram(shell.experiment, {}, kFiles);
  const TrialRequest request{.theta = {{"0.25", 0.25}, {"ice", {}}}, .trial = "1", .seed = 7};
  for (int i = 0; i < 3; ++i) CHECK(program->Run(request).status == TrialStatus::kOk);
  CHECK(shell.Read("lines") == "x\nx\nx\n");
  CHECK(shell.Read("starts") == "y\n");
  const Persistent ends("echo 'out of ideas' >&2; exit 3");
  const Recording end = ends.Run();
  CHECK(end.status == TrialStatus::kCrashed);
  CHECK(end.reason.starts_with("ended in the middle of a trial: "));
  CHECK_THAT(end.reason, Contains("out of ideas"));
  const Recording full = Persistent("echo MemoryError >&2; exit 1").Run();
  CHECK(full.status == TrialStatus::kOutOfMemory);
  CHECK(full.reason.starts_with("ended in the middle of a trial: wanted memory of more than "));
}

TEST_CASE("The log and the words of a trial are no part of the next one of a persistent program") {
  const Persistent shell(
      "N=$((N + 1))\ncase $N in\n"
      "1) cp \"$HERE/good.csv\" \"$1/trajectory.csv\"; echo old >&2; "
      "echo '{\"status\": \"ok\"}';;\n"
      "2) echo '{\"status\": \"ok\"}';;\n"
      "*) echo '{\"status\": \"fault\"}';;\nesac");
  const auto program = CandidateProgram(shell.experiment, {}, kFiles);
  const TrialRequest request{.theta = {{"0.25", 0.25}, {"ice", {}}}, .trial = "1", .seed = 7};
  CHECK(program->Run(request).status == TrialStatus::kOk);
  CHECK(program->Run(request).reason == "ended well and wrote no trajectory to {out}");
  CHECK(program->Run(request).reason == "the program says so");
}

/// Its answer is `ok` with a log that ends at as many metres as mu says, or what `on_line` makes of
/// that: $A, with $ID of the request.
struct Echo : Persistent {
  explicit Echo(const std::string& on_line)
      : Persistent(
            "MU=${LINE#*\\\"mu\\\":}; MU=${MU%%,*}; ID=${LINE#*\\\"id\\\":\\\"}; ID=${ID%%\\\"*}\n"
            "A='{\"status\": \"ok\", \"log\": \"t_s,x_m,y_m\\n0,0,0\\n1,'$MU',0\\n\"}'\n" +
            on_line),
        program(CandidateProgram(experiment, {}, kFiles)) {}
  Recording At(double mu) const {
    return program->Run({.theta = {{"", mu}, {"ice", {}}}, .trial = "1", .seed = 7});
  }
  double EndOf(double mu) const {
    const Recording run = At(mu);
    INFO(run.reason);
    REQUIRE(run.status == TrialStatus::kOk);
    return run.trajectory.poses.back().x_m;
  }
  std::unique_ptr<ProgramSide> program;
};

TEST_CASE("A second line to a trial is a fault of it and never the answer to the next one") {
  const Echo echo(
      "printf '%s\\n' \"$A\"; [ $MU != 0.5 ] || { sleep 0.02; printf '%s\\n' \"$A\"; }");
  CHECK(echo.EndOf(0.25) == 0.25);
  const Recording twice = echo.At(0.5);
  CHECK(twice.status == TrialStatus::kFault);
  CHECK(twice.trajectory.poses.empty());
  CHECK_THAT(twice.reason,
             Catch::StartsWith("wrote '{\"status\": \"ok\"") &&
                 Contains("' to stdout after its answer: answer each trial with one line"));
  CHECK(echo.EndOf(0.75) == 0.75);
}

TEST_CASE("A line that comes between two trials ends its process, and the next trial has its own") {
  const Echo echo(
      "printf '%s\\n' \"$A\"; while [ ! -e \"$HERE/taken\" ]; do sleep 0.01; done\n"
      "printf '%s\\n' \"$A\"; echo x >> \"$HERE/late\"");
  CHECK(echo.EndOf(0.25) == 0.25);
  test::WriteText(echo / "taken", "");
  test::WaitUntil("its late line", [&] { return fs::exists(echo / "late"); });
  fs::remove(echo / "taken");
  CHECK(echo.EndOf(0.75) == 0.75);
}

TEST_CASE("An answer that names another trial by its id is a fault") {
  const Echo echo(
      "FIRST=${FIRST:-$ID}; echo $ID >> \"$HERE/ids\"\n"
      "echo '{\"id\": \"'$FIRST'\", \"status\": \"timed_out\"}'");
  CHECK(echo.At(0.25).status == TrialStatus::kTimedOut);
  CHECK(echo.At(0.25).status == TrialStatus::kTimedOut);  // the same trial
  const Recording other = echo.At(0.5);
  CHECK(other.status == TrialStatus::kFault);
  CHECK_THAT(other.reason,
             Catch::StartsWith("answered with the id \"" + echo.Read("ids").substr(0, 32)) &&
                 Contains("and that of its trial is \""));
  CHECK(echo.At(0.5).status == TrialStatus::kTimedOut);  // the first of a new process
  CHECK(Persistent("echo '{\"id\": 3, \"status\": \"fell\"}'").Run().status == TrialStatus::kFault);
}

TEST_CASE("A program that this machine cannot start is no result of a trial") {
  Shell shell("");
  shell.experiment.candidate.run.words = {"no-such-program-of-rift"};
  const std::string says =
      "candidate.run: cannot run no-such-program-of-rift: No such file or directory, on ";
  for (const bool persistent : {false, true}) {
    shell.experiment.candidate.persistent = persistent;
    CHECK_THROWS_AS(shell.Run(), MachineTrouble);
    CHECK_THROWS_WITH(shell.Run(), Catch::StartsWith(says));
  }
  CHECK(Shell("exit 127").Run().status == TrialStatus::kFault);  // of what it starts
  CHECK(Shell("no-such-program-of-rift").Run().status == TrialStatus::kFault);
}

TEST_CASE("What a program lacks is said when it is made") {
  Shell shell("exit 0");
  shell.experiment.candidate.run.words = {};
  CHECK(shell.Refusal() ==
        "candidate.run is missing: name the program, such as candidate.run: [python3, sim.py, "
        "--out, \"{out}\"]");
  shell.experiment.candidate.run.words = {"sh", "{friction}"};
  CHECK(shell.Refusal().starts_with("candidate.run: path '{friction}' names {friction}"));
  shell.experiment.candidate.run.words = {"sh", "gone.sh"};
  CHECK(shell.Refusal() ==
        "candidate.run: there is no file 'gone.sh' beside the experiment, and sh would end at once "
        "in every trial: name it from the experiment's folder, or with its whole path");
  for (const char* name : {"out", "folder", "theta"}) {
    Shell named("exit 0");
    named.experiment.space.parameters = {
        {.key = std::string("sim.") + name, .levels = {{"1", 1.0}}, .origin = "e.yaml:7:3"}};
    CHECK(named.Refusal() == std::string("e.yaml:7:3: sim.") + name + ": {" + name +
                                 "} is what rift tells a program: name the parameter otherwise");
  }
  Persistent persistent(":");
  CHECK(persistent.Refusal() == "accepted");
  persistent.experiment.candidate.run.words.push_back("{seed}");
  CHECK(persistent.Refusal() ==
        "candidate.run: '{seed}': a persistent program is told of its trials in lines of JSON");
  Shell other("exit 0");
  CHECK(ReferenceProgram(other.experiment, {}, kFiles) == nullptr);
  other.experiment.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK(CandidateProgram(other.experiment, {}, kFiles) == nullptr);
}

TEST_CASE("The files among the arguments of a program have fingerprints") {
  const Shell shell("exit 0");
  const std::string hashes = CandidateProgram(shell.experiment, {}, kFiles)->HashesText();
  CHECK(hashes.size() == 32 + 2 + (shell / "sim.sh").size() + 1);
  CHECK(hashes.ends_with("  " + shell / "sim.sh" + "\n"));
  test::WriteText(shell / "sim.sh", "exit 1");
  CHECK(CandidateProgram(shell.experiment, {}, kFiles)->HashesText() != hashes);
}

TEST_CASE(
    "A script that is not there is known by its interpreter and its ending, and no other word") {
  const auto is_refused = [](const std::vector<std::string>& words) {
    try {
      RequireScript(words);
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  for (const auto& [interpreter, script] :
       std::vector<std::pair<std::string, std::string>>{{"python", "a.py"},
                                                        {"node", "a.js"},
                                                        {"node", "a.mjs"},
                                                        {"node", "a.cjs"},
                                                        {"ruby", "a.rb"},
                                                        {"perl", "a.pl"},
                                                        {"bash", "a.sh"},
                                                        {"sh", "a.sh"},
                                                        {"julia", "a.jl"},
                                                        {"lua", "a.lua"},
                                                        {"Rscript", "a.R"},
                                                        {"octave", "a.sh"},
                                                        {"python3", "a.py"},
                                                        {"python3.11", "a.py"},
                                                        {"/usr/bin/python3", "a.py"}}) {
    INFO(interpreter << " " << script);
    CHECK(is_refused({interpreter, script}));
  }
  CHECK_FALSE(is_refused({"python3"}));
  CHECK_FALSE(is_refused({"python3", "-m"}));
  CHECK_FALSE(is_refused({"python3", "{script}.py"}));
  CHECK_FALSE(is_refused({"python3", "a.txt"}));
  CHECK_FALSE(is_refused({"mine", "a.py"}));
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.py", "");
  CHECK_FALSE(is_refused({"python3", folder / "a.py"}));
  CHECK(is_refused({"python3", folder / "b.py"}));
}

TEST_CASE("A program is there when it may be executed, by its whole path or a name in PATH") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "mine", "#!/bin/sh\n");
  fs::create_directories(folder / "bin/folder");
  test::WriteText(folder / "bin/named", "#!/bin/sh\n");
  fs::permissions(folder / "bin/named", fs::perms::owner_all);
  const test::Environment path("PATH", folder / "empty:" + folder / "bin");
  experiment::Experiment experiment;
  const auto refusal = [&](const std::string& word, bool is_reference = false) -> std::string {
    experiment.candidate.kind =
        is_reference ? experiment::CandidateKind::kLogs : experiment::CandidateKind::kProgram;
    experiment.reference.kind =
        is_reference ? experiment::ReferenceKind::kProgram : experiment::ReferenceKind::kPath;
    (is_reference ? experiment.reference.run : experiment.candidate.run).words = {word};
    try {
      RequirePrograms(experiment, "e.yaml");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("named").empty());
  CHECK(refusal("named", true).empty());
  CHECK(refusal("{program}").empty());
  CHECK(refusal("gone") ==
        "e.yaml: candidate.run: there is no program 'gone' in PATH: install it, or mend the name");
  CHECK(refusal("gone", true).starts_with("e.yaml: reference.run: there is no program 'gone'"));
  CHECK(refusal("folder").find("there is no program 'folder'") != std::string::npos);
  CHECK(refusal(folder / "mine") ==
        "e.yaml: candidate.run: " + folder / "mine" +
            " is not executable: chmod +x it, or name its interpreter first");
  fs::permissions(folder / "mine", fs::perms::owner_all);
  CHECK(refusal(folder / "mine").empty());
  CHECK(refusal("./mine").find("there is no program ./mine") != std::string::npos);
  CHECK(refusal(folder / "bin").find("there is no program") != std::string::npos);
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.run.words = {"gone"};
  CHECK_NOTHROW(RequirePrograms(experiment, "e.yaml"));
}

TEST_CASE("Runs for whoever wants their paths come in order, with how each of them ended") {
  Shell shell(
      "[ \"$2\" != 2 ] || kill -SEGV $$\n[ \"$2\" != 3 ] || exit 12\n"
      "cp \"$HERE/good.csv\" \"$1\"",
      {"{out}", "{seed}"});
  Evaluator evaluator(shell.experiment, "e.yaml", kFiles);
  std::vector<TrialRequest> requests;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    requests.push_back({.theta = {{"0.25", 0.25}, {"ice", {}}}, .trial = "1", .seed = seed});
  }
  for (const int workers : {1, 2}) {
    const std::vector<Recording> runs = CandidateRuns(evaluator, workers).Run(requests);
    REQUIRE(runs.size() == 3);
    CHECK(runs[0].status == TrialStatus::kOk);
    CHECK(runs[0].trajectory.poses.size() == 16);
    CHECK(runs[1].status == TrialStatus::kCrashed);
    CHECK(runs[2].status == TrialStatus::kLeftArena);
  }
  const ProgramTrial good = RunProgramTrial(evaluator, requests[0]);
  CHECK(good.row.status == TrialStatus::kOk);
  CHECK(good.row.seed == 1u);
  CHECK(good.row.candidate == "program with seed 1");
  CHECK(good.row.reference == "waypoint path");
  CHECK(good.candidate.trajectory.poses.size() == 16);
  CHECK(good.row.comparison.gap_m ==
        Approx(gap::Gap(good.candidate.trajectory, evaluator.IdealPathAt(requests[0].theta),
                        shell.experiment.gap)));
  CHECK(RunProgramTrial(evaluator, requests[1]).row.status == TrialStatus::kCrashed);
  shell.experiment.run.timeout_s = 0.2;
  test::WriteText(shell / "sim.sh", "sleep 60");
  const ProgramTrial hung = RunProgramTrial(evaluator, requests[0]);
  CHECK(hung.row.status == TrialStatus::kHung);
  CHECK(hung.row.candidate == "program with seed 1");
  CHECK(hung.row.reference == "waypoint path");
  CHECK(hung.candidate.status == TrialStatus::kHung);
  CHECK(hung.candidate.reason == hung.row.reason);
}

TEST_CASE("Where the nominal run of a seed fails by noise another seed takes its place") {
  Shell shell("case $2 in 10) exit 11;; 11) exit 12;; esac\ncp \"$HERE/good.csv\" \"$1\"",
              {"{out}", "{seed}"});
  shell.experiment.reference.kind = experiment::ReferenceKind::kNominal;
  shell.experiment.reference.trials.names = {"1", "2", "3", "4"};
  Evaluator evaluator(shell.experiment, "e.yaml", kFiles);
  std::vector<ReferenceProgress> told;
  const auto replaced = evaluator.CheckReferences({1, [&](const ReferenceProgress& progress) {
                                                     told.push_back(progress);
                                                     return true;
                                                   }});
  REQUIRE(replaced);
  REQUIRE(replaced->size() == 2);
  CHECK((*replaced)[0].seed == 10);
  CHECK((*replaced)[1].seed == 11);
  for (const ReplacedReference& one : *replaced) {
    CHECK(one.used != one.seed);
    CHECK_THAT(one.reason, Contains("exit"));
  }
  REQUIRE_FALSE(told.empty());
  CHECK(told.front().seeds == 4);
  CHECK(told.front().others_tried == 0);
  CHECK(told.back().others_tried == 1);
  CHECK(told.back().arrived >= 2);
  CHECK_THAT(told.back().last_failure, Contains("exit"));
  TrialRow row{.theta = {{"0.5", 0.5}, {"ice", {}}}, .trial = "2", .seed = 10};
  evaluator.NameSides(row);
  const std::string used = "program with seed " + std::to_string((*replaced)[0].used);
  CHECK(row.candidate == used);
  CHECK(row.reference == used);
  const TrialRow evaluated = evaluator.Evaluate(RequestOf(row));
  CHECK(evaluated.seed == (*replaced)[0].used);
  CHECK(evaluated.comparison.gap_m == 0.0);  // the same program with the same seed
  CHECK_FALSE(Evaluator(shell.experiment, "e.yaml", kFiles)
                  .CheckReferences({1, [](const ReferenceProgress&) { return false; }}));
}

TEST_CASE("A drive of the robot is held against a program that is given up when it hangs") {
  Shell shell("cp \"$HERE/good.csv\" \"$1\"");
  shell.experiment.reference.kind = experiment::ReferenceKind::kProgram;
  shell.experiment.reference.run = shell.experiment.candidate.run;
  shell.experiment.candidate.kind = experiment::CandidateKind::kSimulation;
  shell.experiment.space.parameters.clear();
  shell.experiment.run.timeout_s = 0.2;
  std::vector<std::string> notes;
  const Inputs inputs{kFiles.read, [&](const std::string& line) { notes.push_back(line); }};
  Evaluator evaluator(shell.experiment, "e.yaml", inputs);
  const std::string drive = shell / "good.csv";
  const TrialRequest request{.trial = "1", .seed = 3};
  const TrialRow row = evaluator.EvaluateDriven(request, drive, trial::Outcome::kReached);
  CHECK(row.IsOk());
  CHECK(row.reference == "program with seed 3");
  CHECK(row.comparison.gap_m < 1e-9);
  CHECK(notes.empty());
  test::WriteText(shell / "sim.sh", "sleep 3");
  CHECK(evaluator.EvaluateDriven(request, drive, trial::Outcome::kReached).status ==
        TrialStatus::kHung);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], Catch::StartsWith(drive + ": program with seed 3: "));
}

TEST_CASE("A drive is judged by a program as candidate within its limits, if it is there at all") {
  Shell shell("sleep 3");
  shell.experiment.run.timeout_s = 0.2;
  const std::string drive = shell / "good.csv";
  const auto drive_at = [&](experiment::ReferenceKind kind) {
    shell.experiment.reference.kind = kind;
    shell.experiment.reference.path.text = drive;
    Evaluator evaluator(shell.experiment, "e.yaml", kFiles);
    return evaluator.EvaluateDriven({.theta = {{"0.5", 0.5}, {"ice", {}}}, .trial = "1", .seed = 3},
                                    drive, trial::Outcome::kReached);
  };
  CHECK(drive_at(experiment::ReferenceKind::kNominal).status == TrialStatus::kHung);
  CHECK(drive_at(experiment::ReferenceKind::kLogs).status == TrialStatus::kHung);
  shell.experiment.candidate.run.words = {"no-such-program-of-rift"};
  const TrialRow row = drive_at(experiment::ReferenceKind::kNominal);
  CHECK(row.status == TrialStatus::kFault);
  CHECK_THAT(row.reason, Contains("cannot run no-such-program-of-rift"));
}

TEST_CASE("A nominal run that no seed mends, or that never arrives, is told once and at once") {
  Shell shell("echo x >> \"$HERE/runs\"; exit 1", {"{out}"});
  shell.experiment.reference.kind = experiment::ReferenceKind::kNominal;
  shell.experiment.reference.trials.names = {"1", "2", "3"};
  CHECK_THROWS_WITH(
      Evaluator(shell.experiment, "e.yaml", kFiles).CheckReferences(),
      Catch::StartsWith("e.yaml: reference.kind is nominal, and the run with the experiment's own "
                        "values and seed 9 gives no trajectory to compare with (fault): "));
  CHECK(shell.Read("runs") == "x\n");
  test::WriteText(shell / "sim.sh", "echo y >> '" + shell / "runs" + "'; exit 13");
  CHECK_THROWS_WITH(
      Evaluator(shell.experiment, "e.yaml", kFiles).CheckReferences(),
      Catch::StartsWith("e.yaml: reference.kind is nominal, and the run with the experiment's own "
                        "values does not arrive, with seed 9 nor with 50 others: "));
  CHECK(shell.Read("runs").size() == 2 * (1 + 51));
  shell.experiment.reference.kind = experiment::ReferenceKind::kPath;
  CHECK(Evaluator(shell.experiment, "e.yaml", kFiles).CheckReferences()->empty());
}

TEST_CASE("A replaced reference that no trial of the sweep came to is not told") {
  Shell shell("case $2 in 9|12) exit 10;; esac\ncp \"$HERE/good.csv\" \"$1\"", {"{out}", "{seed}"});
  shell.experiment.reference.kind = experiment::ReferenceKind::kNominal;
  shell.experiment.reference.trials.names = {"1", "2"};
  shell.experiment.space.parameters = {{.key = "mu", .levels = {{"0.5", 0.5}}, .nominal = 0.5}};
  shell.experiment.goal = experiment::Goal::kFalsify;
  shell.experiment.search.budget = 1;
  shell.experiment.falsify.most_repeats = 4;  // the check looks at seeds 9 to 12
  Evaluator evaluator(shell.experiment, "e.yaml", kFiles);
  CHECK(evaluator.CheckReferences()->size() == 2);
  const auto seeds = [&] {
    const auto evaluate = [&](const TrialRequest& request) { return evaluator.Evaluate(request); };
    const auto result = Sweep(evaluator, RunHere(evaluate, {}), [](const auto&) { return true; });
    std::vector<std::uint64_t> told;
    for (const ReplacedReference& one : result->replaced) told.push_back(one.seed);
    return told;
  };
  CHECK(seeds() == std::vector<std::uint64_t>{9});
  shell.experiment.search.strategy = search::Method::kRandom;
  CHECK(seeds().empty());  // draws have seeds of their own
}

TEST_CASE("A sweep tells which of its references were replaced, and may stop at its noise floors") {
  Shell shell("[ $2 != 9 ] || exit 10\ncp \"$HERE/good.csv\" \"$1\"", {"{out}", "{seed}"});
  shell.experiment.reference.kind = experiment::ReferenceKind::kNominal;
  shell.experiment.reference.trials.names = {"1", "2"};
  shell.experiment.space.parameters = {{.key = "mu", .levels = {{"0.5", 0.5}}, .nominal = 0.5}};
  const RunTrials run = RunHere([](const TrialRequest& request) { return RowFor(request); }, {});
  const auto sweep = [&](const ReferenceWatch& watch) {
    Evaluator evaluator(shell.experiment, "e.yaml", kFiles);
    return Sweep(
        evaluator, run, [](const auto&) { return true; }, watch);
  };
  const auto result = sweep({});
  REQUIRE(result);
  REQUIRE(result->replaced.size() == 1);
  CHECK(result->replaced[0].seed == 9);
  CHECK(result->settings.at(0).noise_floor_m == 0.0);  // the program copies one log
  CHECK_FALSE(sweep({1, [](const ReferenceProgress& known) { return known.seeds > 0; }}));
}

}  // namespace
}  // namespace rift::sweep
