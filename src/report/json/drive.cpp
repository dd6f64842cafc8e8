#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "rift/hardware/listener.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/stop_text.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using hardware::PoseStages;
using nlohmann::ordered_json;

ordered_json TimeOrNull(double time_s) {
  return time_s < 0.0 ? ordered_json(nullptr) : ordered_json(time_s);
}

/// Keys that an experiment takes from a link that was measured, whose robot has src/firmware. The
/// simulated link adds the time of the bytes itself (simulation.link.baud).
std::vector<std::pair<std::string, ordered_json>> KeysOf(const hardware::PingResult& ping,
                                                         const hardware::HardwareOptions& options) {
  return {{"hardware.stopping.delay_s", ping.OneWay_s()},
          {"simulation.link.delay_s", hardware::RadioDelay_s(ping, options.line)},
          {"simulation.link.line_loss", ping.loss},
          {"simulation.link.poll_s", 0},
          {"simulation.link.uart_bytes", hardware::Listener::kReceiveBuffer},
          {"simulation.link.watchdog_s", 1e-3 * hardware::Listener::kWatchdog_ms}};
}

ordered_json PingBlock(const hardware::PingResult& ping, const hardware::HardwareOptions& options) {
  ordered_json json{{"protocol", yaml::NameOf(ping.protocol)},
                    {"sent", ping.sent},
                    {"answered", ping.answered},
                    {"loss", ping.loss},
                    {"longest_burst", ping.longest_burst},
                    {"p50_s", TimeOrNull(ping.p50_s)},
                    {"p95_s", TimeOrNull(ping.p95_s)},
                    {"p99_s", TimeOrNull(ping.p99_s)},
                    {"max_s", TimeOrNull(ping.max_s)},
                    {"jitter_s", TimeOrNull(ping.jitter_s)},
                    {"battery_v", TimeOrNull(ping.battery_v)}};
  json["broken_budget"] = hardware::BrokenBudget(ping, options.ping);
  if (ping.IsMeasured()) {
    for (const auto& [key, value] : KeysOf(ping, options)) json["set"][key] = value;
  }
  return json;
}

/// A stage of a pose's way from light to wheels.
struct Stage {
  const char* name;
  double PoseStages::*from;
  double PoseStages::*to;
};
constexpr Stage kCaptureToCommand{"capture_to_command", &PoseStages::captured_s,
                                  &PoseStages::written_s};
constexpr std::array<Stage, 7> kStages{{
    {"camera", &PoseStages::captured_s, &PoseStages::arrived_s},
    {"tag", &PoseStages::arrived_s, &PoseStages::ready_s},
    {"waiting", &PoseStages::ready_s, &PoseStages::sensed_s},
    {"decision", &PoseStages::sensed_s, &PoseStages::commanded_s},
    {"line", &PoseStages::commanded_s, &PoseStages::written_s},
    kCaptureToCommand,
    {"capture_to_answer", &PoseStages::captured_s, &PoseStages::answered_s},
}};

std::vector<double> Times_s(const std::vector<PoseStages>& poses, const Stage& stage) {
  std::vector<double> times_s;
  for (const PoseStages& pose : poses) {
    if (pose.*stage.from >= 0.0 && pose.*stage.to >= 0.0) {
      times_s.push_back(pose.*stage.to - pose.*stage.from);
    }
  }
  return times_s;
}

ordered_json StageJson(const std::vector<PoseStages>& poses, const Stage& stage) {
  const std::vector<double> times_s = Times_s(poses, stage);
  ordered_json json{
      {"n", times_s.size()}, {"p50_s", nullptr}, {"p95_s", nullptr}, {"p99_s", nullptr}};
  if (times_s.empty()) return json;
  json["p50_s"] = statistics::Quantile(times_s, 0.5);
  json["p95_s"] = statistics::Quantile(times_s, 0.95);
  json["p99_s"] = statistics::Quantile(times_s, 0.99);
  return json;
}

ordered_json StopJson(const hardware::DriveRecord& evidence) {
  ordered_json json{{"reason", nullptr}, {"text", nullptr}, {"at_s", nullptr}};
  if (evidence.stop) {
    json = {{"reason", yaml::NameOf(evidence.stop->reason)},
            {"text", evidence.stop->text},
            {"at_s", evidence.stop->at_s}};
  }
  json["acknowledged"] = nullptr;
  if (evidence.stop_acknowledged) json["acknowledged"] = *evidence.stop_acknowledged;
  return json;
}

/// Where the time between a turn and the command that answers it goes; null where unknown.
ordered_json LoopDelayJson(const hardware::DriveRun& run) {
  ordered_json json{{"camera_s", nullptr},
                    {"camera_most_s", nullptr},
                    {"host_s", nullptr},
                    {"link_s", nullptr},
                    {"robot_s", nullptr},
                    {"total_s", nullptr},
                    {"camera_over_drive_s", nullptr},
                    {"turned_deg", nullptr},
                    {"seen_deg", nullptr}};
  const auto set = [&json](const char* key, const std::optional<double>& value) {
    if (value) json[key] = *value;
  };
  if (run.latency) {
    const hardware::LoopDelay& delay = run.latency->delay;
    set("camera_s", delay.camera_s);
    set("host_s", delay.host_s);
    set("link_s", delay.link_s);
    set("robot_s", delay.robot_s);
    set("total_s", delay.total_s);
    set("camera_most_s", delay.camera_most_s);
    set("turned_deg", run.latency->turned_deg);
    set("seen_deg", run.latency->seen_deg);
  }
  set("camera_over_drive_s", run.camera_latency_s);
  return json;
}

/// Whether a robot was asked at all is told by the protocol that it was to speak.
std::string PlainPingText(const hardware::LineOptions& options) {
  if (options.protocol == hardware::Protocol::kPlain) {
    return "the robot is to be spoken to in plain lines (hardware.line.protocol: plain) and cannot "
           "be asked, so its link cannot be measured (auto finds out whether it answers)\n";
  }
  return fmt::format(
      "the robot did not answer within {:g} s (hardware.line.hello_s), so it is taken to speak "
      "plain, and its link cannot be measured (a 3pi+ answers with src/firmware on it)\n",
      options.hello_s);
}

std::string Cell(double time_s) { return time_s < 0.0 ? "" : fmt::format("{:.6f}", time_s); }

/// Whether the stamps of a drive's poses are of the light and not of when the camera gave it.
bool IsCameraTimed(const hardware::DriveRun& run) {
  return run.latency && run.latency->delay.camera_s;
}

/// How much older a picture may be than its stamp.
std::string StampText(const hardware::DriveRun& run) {
  if (IsCameraTimed(run)) return "";
  if (!run.latency || !run.latency->delay.camera_most_s) {
    return "; how late the stamps are was not measured";
  }
  return fmt::format("; the stamps may be up to {:.0f} ms late",
                     1e3 * *run.latency->delay.camera_most_s);
}

/// What the prediction that makes up for a delay lacks of the robot's wheels and speed.
std::string PredictedRobotText(const experiment::Experiment& experiment) {
  const control::DiffDriveOptions &predicted = experiment.control.latency.drive,
                                  &robot = experiment.hardware.odometry.drive;
  std::string text;
  const auto set = [&text](const char* key, double now, double wanted) {
    if (now != wanted) text += fmt::format(" --set control.latency.drive.{}={:g}", key, wanted);
  };
  set("wheel_radius_m", predicted.wheel_radius_m, robot.wheel_radius_m);
  set("track_m", predicted.track_m, robot.track_m);
  set("full_power_speed_rad_s", predicted.full_power_speed_rad_s, robot.full_power_speed_rad_s);
  return text;
}

/// The value named at a place of the document; nothing where there is none.
template <typename Enum>
std::optional<Enum> NamedIn(const std::string& json, const char* place) {
  const nlohmann::json::json_pointer pointer(place);
  const auto document = nlohmann::json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!document.contains(pointer) || !document[pointer].is_string()) return std::nullopt;
  return yaml::ValueNamed<Enum>(document[pointer].template get<std::string>());
}

}  // namespace

std::string PingJson(const hardware::PingResult& ping, const hardware::HardwareOptions& options) {
  return Dump(PingBlock(ping, options));
}

std::string PingText(const hardware::PingResult& ping, const hardware::HardwareOptions& options) {
  if (ping.protocol == hardware::Protocol::kPlain) {
    return PlainPingText(options.line);
  }
  std::string text = fmt::format("{} of {} commands answered, {:.1f} % lost, {} in a row at most\n",
                                 ping.answered, ping.sent, 100.0 * ping.loss, ping.longest_burst);
  if (ping.IsMeasured()) {
    text +=
        fmt::format("round trip p50 {:.1f} ms, p95 {:.1f}, p99 {:.1f}, max {:.1f}, jitter {:.1f}\n",
                    1e3 * ping.p50_s, 1e3 * ping.p95_s, 1e3 * ping.p99_s, 1e3 * ping.max_s,
                    1e3 * ping.jitter_s);
    text += fmt::format("battery {:.2f} V\n", ping.battery_v);
    text += "for the experiment:";
    for (const auto& [key, value] : KeysOf(ping, options)) {
      text += value.is_number_integer() ? fmt::format(" --set {}={}", key, value.get<int>())
                                        : fmt::format(" --set {}={:.3f}", key, value.get<double>());
    }
    text += "\n";
  }
  for (const std::string& broken : hardware::BrokenBudget(ping, options.ping)) {
    text += fmt::format("over budget: {}\n", broken);
  }
  return text;
}

std::string InterruptedDriveJson(const experiment::Experiment& experiment) {
  return Dump({{"name", experiment.name},
               {"rift_version", RIFT_VERSION},
               {"state", yaml::NameOf(RunState::kInterrupted)},
               {"outcome", nullptr},
               {"reason", "the log was not closed: rift was ended, or could not write"}});
}

std::string DriveJson(const experiment::Experiment& experiment, const hardware::DriveRun& run,
                      RunState state) {
  const trial::TrialResult& result = run.trial;
  ordered_json json{{"name", experiment.name},
                    {"rift_version", RIFT_VERSION},
                    {"state", yaml::NameOf(state)},
                    {"dry_run", run.dry_run},
                    {"outcome", yaml::NameOf(result.outcome)},
                    {"reason", result.reason},
                    {"duration_s", result.Duration_s()},
                    {"path_length_m", result.trajectory.ArcLength_m()},
                    {"poses", result.trajectory.poses.size()},
                    {"poses_refused", result.poses_refused},
                    {"stale_decisions", result.stale_decisions}};
  json["stop"] = StopJson(run.evidence);
  json["stopping_distance_m"] = run.stopping_distance_m;
  json["loop_delay"] = LoopDelayJson(run);
  json["latency"] = ordered_json::object();
  for (const Stage& stage : kStages)
    json["latency"][stage.name] = StageJson(run.evidence.poses, stage);
  json["link"] = {{"sent", run.evidence.sent},
                  {"answered", run.evidence.answered},
                  {"rejected_by_robot", run.evidence.rejected_by_robot}};
  json["ping"] = PingBlock(run.ping, experiment.hardware);
  json["waypoints"] = WaypointsJson(result);
  json["limits"] = LimitsJson(result.limits);
  json["steering"] = SteeringJson(SteeringOf(experiment, run));
  return Dump(json);
}

std::string DriveText(const experiment::Experiment& experiment, const hardware::DriveRun& run) {
  const trial::TrialResult& result = run.trial;
  std::string text =
      fmt::format("{}: {}\n{:.2f} s, {} poses logged\n", yaml::NameOf(result.outcome),
                  result.reason, result.Duration_s(), result.trajectory.poses.size());
  if (run.dry_run) text += "dry run: the robot was sent zeros alone\n";
  const std::vector<double> latency_s = Times_s(run.evidence.poses, kCaptureToCommand);
  if (!latency_s.empty()) {
    text += fmt::format("{} to command p50 {:.1f} ms, p95 {:.1f}, p99 {:.1f}{}\n",
                        IsCameraTimed(run) ? "capture" : "time stamp",
                        1e3 * statistics::Quantile(latency_s, 0.5),
                        1e3 * statistics::Quantile(latency_s, 0.95),
                        1e3 * statistics::Quantile(latency_s, 0.99), StampText(run));
  }
  if (run.latency && run.latency->delay.total_s) {
    const double delay_s = *run.latency->delay.total_s;
    text += fmt::format(
        "loop delay {:.0f} ms; to make up for it: --set control.latency.delay_s={:.3f}{}\n",
        1e3 * delay_s, delay_s, PredictedRobotText(experiment));
  }
  return text + StopText(run.evidence.stop_acknowledged) + "\n";
}

std::string StagesCsv(const hardware::DriveRecord& evidence) {
  std::string text = "captured_s,arrived_s,ready_s,sensed_s,commanded_s,written_s,answered_s\n";
  for (const PoseStages& pose : evidence.poses) text += StagesRow(pose);
  return text;
}

std::string StagesRow(const PoseStages& pose) {
  std::string text = Cell(pose.captured_s);
  for (const double time_s : {pose.arrived_s, pose.ready_s, pose.sensed_s, pose.commanded_s,
                              pose.written_s, pose.answered_s}) {
    text += "," + Cell(time_s);
  }
  return text + "\n";
}

std::string DriveEnding(const std::string& summary_json) {
  const auto summary = nlohmann::json::parse(summary_json, nullptr, /*allow_exceptions=*/false);
  if (!summary.is_object()) return "without a summary";
  const auto word = [&summary](const char* key) {
    const auto found = summary.find(key);
    return found != summary.end() && found->is_string() ? found->get<std::string>() : "";
  };
  if (word("state") == "interrupted") return "interrupted: " + word("reason");
  return fmt::format("{}: {}", word("outcome"), word("reason"));
}

std::optional<trial::Outcome> DriveOutcome(const std::string& summary_json) {
  return NamedIn<trial::Outcome>(summary_json, "/outcome");
}

std::optional<hardware::Protocol> DriveProtocol(const std::string& summary_json) {
  return NamedIn<hardware::Protocol>(summary_json, "/ping/protocol");
}

}  // namespace rift::report
