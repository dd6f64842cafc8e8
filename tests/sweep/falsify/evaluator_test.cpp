#include "rift/sweep/falsify/evaluator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

/// Files by name; what is not there is missing, and "locked.csv" cannot be read.
struct Files {
  std::map<std::string, std::string> text;
  std::vector<std::string> notes{};

  Inputs AsInputs() {
    return {[this](const std::string& path) -> std::optional<std::string> {
              if (path.ends_with("locked.csv")) throw std::invalid_argument("cannot read " + path);
              const auto found = text.find(path);
              return found == text.end() ? std::nullopt : std::optional(found->second);
            },
            [this](const std::string& line) { notes.push_back(line); }};
  }
};

std::string LogBeside(double offset_m) {
  return trajectory::WriteRift(test::Moved(test::StraightPath(0.7, 40), {0.0, offset_m, 0.0}));
}

experiment::Experiment LogsAgainstLogs() {
  experiment::Experiment experiment;
  experiment.candidate = {experiment::CandidateKind::kLogs, {"{surface}_sim.csv"}};
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "{surface}_{trial}.csv";
  experiment.reference.trials.names = {"1", "2"};
  experiment.space.parameters = {{.key = "surface", .levels = {{"ground", {}}, {"ice", {}}}}};
  return experiment;
}

RunTrials Here(Evaluator& evaluator) {
  return RunHere([&](const TrialRequest& trial) { return evaluator.Evaluate(trial); }, {});
}

TEST_CASE("A sweep of logs tells each trial's gap and how far the repeats are apart") {
  Files files{{{"ground_sim.csv", LogBeside(0.0)},
               {"ground_1.csv", LogBeside(0.05)},
               {"ground_2.csv", LogBeside(0.08)}}};
  const experiment::Experiment experiment = LogsAgainstLogs();
  Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
  const auto result = Sweep(evaluator, Here(evaluator), [](const auto&) { return true; });
  REQUIRE(result);
  REQUIRE(result->rows.size() == 4);
  CHECK(result->rows[0].comparison.gap_m == Approx(0.05));
  CHECK(result->rows[1].comparison.gap_m == Approx(0.08));
  CHECK_FALSE(result->rows[0].falsified);
  CHECK(result->rows[1].falsified);
  CHECK(result->settings[0].noise_floor_m == Approx(0.03));
  const trajectory::Trajectory log = test::StraightPath(0.7, 40);
  const double took_s = log.poses.back().t_s - log.poses.front().t_s;
  for (const int row : {0, 1}) {
    const TrialEvidence& evidence = result->rows[row].evidence;
    CHECK(evidence.path_m.size() == kPathSteps + 1);
    REQUIRE(evidence.path_times_s.size() == kPathSteps + 1);
    CHECK(evidence.path_times_s.front() == 0.0F);
    CHECK(evidence.path_times_s[16] == Approx(took_s / 4.0));
    CHECK(evidence.path_times_s.back() == Approx(took_s));
  }
  CHECK(result->rows[2].status == TrialStatus::kMissing);
  CHECK(result->rows[2].reason == "ice_1.csv: no such file");
}

/// 0.3 m/s seen by a camera of 30 frames a second in a loop of 58 ms that stamps what it found.
trajectory::Trajectory StampedByALoop() {
  trajectory::Trajectory log;
  for (double now_s = 0.2; now_s < 4.0; now_s += 0.058) {
    const double captured_s = std::floor(now_s * 30.0) / 30.0;
    log.poses.push_back({.t_s = now_s, .x_m = 0.3 * captured_s, .y_m = 0.0});
  }
  return log;
}

TEST_CASE("Stamps go back to the camera's frames where the experiment asks for it") {
  const trajectory::Trajectory stamped = StampedByALoop();
  Files files{{{"ground_1.csv", trajectory::WriteRift(stamped)}, {"ice_1.csv", LogBeside(0.1)}}};
  experiment::Experiment experiment = LogsAgainstLogs();
  const auto reference = [&](const char* surface) {
    Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
    return evaluator.Reference({.theta = {{surface, {}}}, .trial = "1"}).trajectory;
  };
  CHECK(reference("ground").poses[5].t_s == stamped.poses[5].t_s);
  experiment.reference.grid_fps = 30.0;
  const trajectory::Trajectory on_frames = reference("ground");
  REQUIRE(on_frames.poses.size() == stamped.poses.size());
  for (size_t i = 1; i < on_frames.poses.size(); ++i) {
    const auto &a = on_frames.poses[i - 1], &b = on_frames.poses[i];
    CHECK((b.x_m - a.x_m) / (b.t_s - a.t_s) == Approx(0.3).epsilon(0.01));
  }
  CHECK(files.notes.empty());
  experiment.candidate.path.text = "{surface}_1.csv";
  const auto candidate = [&] {
    Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
    return evaluator.Candidate({.theta = {{"ground", {}}}, .trial = "1"}, {}).trajectory;
  };
  CHECK(candidate().poses[5].t_s == stamped.poses[5].t_s);
  experiment.candidate.grid_fps = 30.0;
  CHECK(candidate().poses[5].t_s == on_frames.poses[5].t_s);
  CHECK(reference("ice").poses[5].t_s == test::StraightPath(0.7, 40).poses[5].t_s);
  REQUIRE(files.notes.size() == 1);
  CHECK(files.notes[0].find("ice_1.csv: no frame grid") == 0);
}

TEST_CASE("A log that cannot be read or breaks a rule is a row with its reason") {
  Files files{{{"ground_sim.csv", LogBeside(0.0)}, {"bad.csv", "t_s,x_m,y_m\n0,0\n"}}};
  experiment::Experiment experiment = LogsAgainstLogs();
  experiment.space.parameters.clear();
  experiment.reference.trials.names = {"1"};
  experiment.candidate.path.text = "ground_sim.csv";
  const std::string broken = GENERATE(as<std::string>(), "locked.csv", "bad.csv");
  experiment.reference.path.text = broken;
  Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
  const TrialRow row = evaluator.Evaluate({.theta = {}, .trial = "1"});
  CHECK(row.status == TrialStatus::kUnreadable);
  CHECK_FALSE(row.Tells());
  CHECK_THAT(row.reason, Catch::StartsWith(broken == "bad.csv" ? "bad.csv" : "cannot read locked"));
  CHECK(row.reason.find(" against ") == std::string::npos);
}

TEST_CASE("The key of a trial changes with its setting, repeat, seed and the bytes of its log") {
  experiment::Experiment experiment = LogsAgainstLogs();
  experiment.candidate = {};
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.5}};
  const auto key_of = [&](const std::string& log, const TrialRequest& request) {
    Files files{{{"ground_1.csv", log}, {"ground_2.csv", log}, {"ice_1.csv", log}}};
    Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
    evaluator.LoadLogs();
    return evaluator.KeyOf(request);
  };
  const TrialRequest request{.theta = {{"ground", {}}}, .trial = "1", .seed = 3};
  const std::string key = key_of(LogBeside(0.05), request);
  CHECK(key_of(LogBeside(0.05), request) == key);
  CHECK(key_of(LogBeside(0.06), request) != key);
  CHECK(key_of(LogBeside(0.05), {.theta = {{"ice", {}}}, .trial = "1", .seed = 3}) != key);
  CHECK(key_of(LogBeside(0.05), {.theta = {{"ground", {}}}, .trial = "2", .seed = 3}) != key);
  CHECK(key_of(LogBeside(0.05), {.theta = {{"ground", {}}}, .trial = "1", .seed = 4}) != key);
}

TEST_CASE("Both sides of a simulated trial are taken at the same point ahead of the tag") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.4, .y_m = 0.1}};
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "own.csv";
  experiment.reference.trials.names = {"1"};
  Files files;
  const TrialRequest request{.theta = {}, .trial = "1", .seed = 5};
  Evaluator untouched(experiment, "own.yaml", files.AsInputs());
  const SimulatedRun run = Simulate(untouched.TrialFor(request, {}));
  REQUIRE(run.result.outcome == trial::Outcome::kReached);
  files.text["own.csv"] = trajectory::WriteRift(run.result.trajectory);
  for (const double tag_offset_m : {0.0, 0.03, -0.05}) {
    // The log is the very run: moved alike, both paths stay one.
    experiment.reference.tag_offset_m = tag_offset_m;
    Evaluator evaluator(experiment, "own.yaml", files.AsInputs());
    const TrialRow row = evaluator.Evaluate(request);
    INFO(row.reason);
    REQUIRE(row.IsOk());
    CHECK(row.comparison.gap_m < 1e-6);
    // Another seed is another run, and told so.
    CHECK(evaluator.Evaluate({.theta = {}, .trial = "1", .seed = 6}).comparison.gap_m > 1e-5);
  }
}

TEST_CASE("The key of a setting names its values however their numbers are written") {
  const std::vector<experiment::Parameter> axes{{.key = "a.surface"}, {.key = "a.v_min"}};
  const std::string key = "a.surface=ground a.v_min=0.2 ";
  CHECK(SettingKey(axes, {{"ground", {}}, {"0.20", 0.2}}) == key);
  CHECK(SettingKey(axes, {{"ground", {}}, {"+.2", 0.2}}) == key);
  CHECK(SettingKey(axes, {{"ground", {}}, {"0.2", 0.2}}) == key);
}

TEST_CASE("Settings of different texts have different keys whatever stands in the texts") {
  const std::vector<experiment::Parameter> axes{{.key = "a"}, {.key = "b"}};
  std::set<std::string> keys;
  const std::vector<std::string> texts{"x",         "x b=y", "y b=z", "z",  "x b=\"y", "y\" b=z",
                                       "\"x b=y\"", "",      " ",     "\"", "\"\""};
  for (const std::string& a : texts) {
    for (const std::string& b : texts) keys.insert(SettingKey(axes, {{a, {}}, {b, {}}}));
  }
  CHECK(keys.size() == texts.size() * texts.size());
}

TEST_CASE("The fingerprints of the logs that were read stand in the inputs") {
  Files files{{{"ground_sim.csv", LogBeside(0.0)}, {"ground_1.csv", LogBeside(0.05)}}};
  const experiment::Experiment experiment = LogsAgainstLogs();
  Evaluator evaluator(experiment, "logs.yaml", files.AsInputs());
  evaluator.Evaluate({.theta = {{"ground", {}}}, .trial = "1"});
  const std::string text = evaluator.InputsText();
  CHECK(text.find("  ground_sim.csv\n") == 32);
  CHECK(text.find("  ground_1.csv\n") != std::string::npos);
  CHECK(text.find("ground_2.csv") == std::string::npos);
}

TEST_CASE("A simulated trial starts on the task or where its reference stood, behind its own tag") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start", .x_m = 0.1}, {.name = "end", .x_m = 0.5}};
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  experiment.reference.trials.names = {"1"};
  experiment.reference.tag_offset_m = 0.02;
  experiment.simulation.mocap.tag_ahead_m = 0.01;
  experiment.space.parameters = {{.key = "simulation.mocap.tag_ahead_m", .min = 0.0, .max = 0.1}};
  Files files;
  Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
  const TrialRequest request{.theta = {{"0.05", 0.05}}, .trial = "1", .seed = 4};
  const Recording reference{.trajectory = test::Moved(test::StraightPath(0.7, 400), {1, 2, 0.5})};
  const SimulatedTrial on_task = evaluator.TrialFor(request, reference);
  CHECK(on_task.start.x_m == Approx(0.05));
  CHECK(on_task.start.y_m == Approx(0.0).margin(1e-12));
  CHECK(on_task.seed == 4);
  experiment.start = experiment::Start::kReference;
  const geometry::Pose2 stood = trajectory::StandingPose(reference.trajectory);
  const geometry::Pose2 start = evaluator.TrialFor(request, reference).start;
  CHECK(start.x_m == Approx(stood.x_m - 0.07 * std::cos(0.5)));
  CHECK(start.y_m == Approx(stood.y_m - 0.07 * std::sin(0.5)));
  CHECK(start.yaw_rad == Approx(0.5));
}

TEST_CASE("Of two logs that of the reference is moved, and each tells what its controller asked") {
  trajectory::Trajectory log = test::StraightPath(0.7, 141);
  for (trajectory::StampedPose& pose : log.poses) {
    pose.t_s *= 5.0;  // 0.2 m/s
    pose.yaw_rad = 0.0;
    pose.target_x_m = pose.x_m < 0.27 ? 0.3 : 0.6;
    pose.target_y_m = 0.0;
  }
  Files files{{{"sim.csv", trajectory::WriteRift(log)}, {"0.2.csv", trajectory::WriteRift(log)}}};
  experiment::Experiment experiment = LogsAgainstLogs();
  experiment.space.parameters = {{.key = "v_max", .levels = {{"0.2", 0.2}}}};
  experiment.candidate.path.text = "sim.csv";
  experiment.reference.path.text = "{v_max}.csv";
  experiment.reference.trials.names = {"1"};
  experiment.reference.tag_offset_m = 0.1;
  Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
  const TrialRequest request{.theta = {{"0.2", 0.2}}, .trial = "1"};
  const auto asked = RebuildLimits(log, {.v_max = 0.2});
  REQUIRE(asked->v_max > RebuildLimits(log, {})->v_max + 2);
  for (const bool is_reference : {false, true}) {
    INFO(is_reference);
    const Recording side =
        is_reference ? evaluator.Reference(request) : evaluator.Candidate(request, {});
    CHECK(side.trajectory.poses[0].x_m == Approx(is_reference ? 0.1 : 0.0));
    REQUIRE(side.limits);
    CHECK(side.limits->decisions == asked->decisions);
    // Moved there and back by a tenth, a pose may lie across a limit by rounding.
    CHECK(side.limits->v_max == Approx(asked->v_max).margin(1.0));
  }
}

TEST_CASE("A setting that breaks a rule is a row that says so where odometry is judged, too") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.5}};
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.objective = experiment::Objective::kOdometry;
  experiment.space.parameters = {{.key = "trial.pose_stale_s", .min = 0.1, .max = 9.0}};
  Files files;
  Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
  const TrialRow row = evaluator.Evaluate({.theta = {{"5", 5.0}}, .trial = "1", .seed = 1});
  CHECK(row.status == TrialStatus::kInvalid);
  CHECK_THAT(row.reason, Catch::Contains("pose_stale_s is 5"));
  CHECK_FALSE(row.falsified);
}

TEST_CASE("A trial's key holds the files of both sides' programs, and an invalid setting has one") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.5}};
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  Files files;
  const auto key = [&](const std::string& text) {
    files.text["/bin/sh"] = text;
    Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
    const std::string of_trial = evaluator.KeyOf({.theta = {}, .trial = "1", .seed = 1});
    const bool has_program = evaluator.InputsText().ends_with("  /bin/sh\n");
    CHECK(has_program == (of_trial.find(" program=") != of_trial.npos));
    return of_trial;
  };
  experiment.space.parameters.clear();
  CHECK(key("a") == key("b"));
  experiment.candidate.kind = experiment::CandidateKind::kProgram;
  experiment.candidate.run.words = {"/bin/sh", "{out}"};
  CHECK(key("a") != key("b"));
  experiment.candidate.kind = experiment::CandidateKind::kSimulation;
  experiment.reference.kind = experiment::ReferenceKind::kProgram;
  experiment.reference.run.words = {"/bin/sh", "{out}"};
  CHECK(key("a") != key("b"));

  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.space.parameters = {{.key = "trial.pose_stale_s", .min = 0.1, .max = 9.0}};
  experiment.simulation.terrain.surfaces["hills"].shape = simulation::Shape::kHeightfield;
  experiment.simulation.terrain.surfaces["hills"].image = "hills.png";
  Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
  CHECK(evaluator.KeyOf({.theta = {{"5", 5.0}}, .trial = "1", .seed = 1}) ==
        "trial.pose_stale_s=5 trial=1 seed=1");
}

TEST_CASE("As many nominal runs are asked for as a setting may get trials, 100 where it repeats") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.5}};
  experiment.reference.kind = experiment::ReferenceKind::kNominal;
  experiment.reference.trials.names = {"1", "2", "3", "4"};
  Files files;
  const auto seeds = [&](Repeat repeat, int most_repeats) {
    experiment.falsify.repeat = repeat;
    experiment.falsify.most_repeats = most_repeats;
    Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
    int asked = 0;
    const ReferenceWatch stops{1, [&](const ReferenceProgress& progress) {
                                 asked = progress.seeds;
                                 return false;
                               }};
    CHECK_FALSE(evaluator.CheckReferences(stops));
    return asked;
  };
  CHECK(seeds(Repeat::kDoubtful, 7) == 4);
  CHECK(seeds(Repeat::kEvery, 7) == 7);
  CHECK(seeds(Repeat::kEvery, 3) == 4);
  CHECK(seeds(Repeat::kEvery, 500) == 100);
  experiment.goal = experiment::Goal::kFalsify;
  CHECK(seeds(Repeat::kDoubtful, 7) == 7);
  CHECK(seeds(Repeat::kEvery, 7) == 7);
  CHECK(seeds(Repeat::kNone, 7) == 4);
  experiment.search.strategy = search::Method::kRandom;  // its draws have seeds of their own
  for (const Repeat repeat : {Repeat::kNone, Repeat::kDoubtful, Repeat::kEvery}) {
    CHECK(seeds(repeat, 7) == 1);
  }
  experiment.goal = experiment::Goal::kGrid;
  CHECK(seeds(Repeat::kDoubtful, 7) == 4);
  experiment.candidate = {experiment::CandidateKind::kLogs, {"{trial}.csv"}};
  Evaluator of_logs(experiment, "e.yaml", files.AsInputs());
  const auto replaced = of_logs.CheckReferences({1, [](const auto&) { return false; }});
  REQUIRE(replaced);  // these have no seeds that a run could be of
  CHECK(replaced->empty());
}

TEST_CASE("Stamps of a simulated run go back to the frames that the candidate is to stand on") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start"}, {.name = "end", .x_m = 0.9}};
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.reference.trials.names = {"1"};
  experiment.simulation.mocap.rate_hz = 30.0;
  experiment.simulation.mocap.frame_jitter_s = 0.0;
  experiment.simulation.mocap.host_period_s = 0.058;
  experiment.simulation.mocap.stamp_jitter_s = 0.0;
  Files files;
  const auto run = [&](double grid_fps) {
    experiment.candidate.grid_fps = grid_fps;
    Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
    return evaluator.Candidate({.theta = {}, .trial = "1", .seed = 3}, {}).trajectory;
  };
  const trajectory::Trajectory stamped = run(0.0), on_frames = run(30.0);
  const trajectory::Trajectory expected = trajectory::OnFramesOf(stamped, 30.0);
  REQUIRE(expected.poses[9].t_s != stamped.poses[9].t_s);
  REQUIRE(on_frames.poses.size() == expected.poses.size());
  for (size_t i = 0; i < expected.poses.size(); ++i) {
    CHECK(on_frames.poses[i].t_s == expected.poses[i].t_s);
  }
  // And those of the nominal run beside it.
  experiment.reference.kind = experiment::ReferenceKind::kNominal;
  Evaluator evaluator(experiment, "e.yaml", files.AsInputs());
  const TrialRow row = evaluator.Evaluate({.theta = {}, .trial = "1", .seed = 3});
  REQUIRE(row.IsOk());
  CHECK(row.comparison.equal_time_m == 0.0);
}

}  // namespace
}  // namespace rift::sweep
