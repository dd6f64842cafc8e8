#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

constexpr double kBitsPerLine = 100.0;  // ten bytes, each with start and stop bit

/// The prior with the powers that turn its wheels at all; a servo turns them by any.
trial::SteeringPrior WithMotor(const trial::SteeringModel& model,
                               const simulation::SimulationOptions& simulation) {
  const simulation::MotorOptions& motor = simulation.motor;
  if (motor.model == simulation::MotorModel::kServo) return {model};
  const simulation::BodyOptions& body = simulation.body;
  const auto surface = simulation.terrain.surfaces.find(simulation.terrain.surface);
  const double rolling =
      surface == simulation.terrain.surfaces.end() ? 0.0 : surface->second.rolling_resistance;
  const double rolling_nm = rolling * body.WeightOnWheel_n() * body.wheel_radius_m;
  return {model, motor.dead_band,
          (motor.Breakaway_nm() + rolling_nm) / (motor.StallTorque_nm() * motor.supply_ratio)};
}

trial::SteeringModel RigidModel(double full_rad_s, double radius_m, double track_m,
                                double command_delay_s) {
  const double full_mps = full_rad_s * radius_m;
  return {full_mps, 2.0 * full_mps / track_m, 0.0, command_delay_s};
}

trial::SteeringPrior PriorOf(const simulation::SimulationOptions& simulation) {
  const simulation::LinkOptions& link = simulation.link;
  const double line_s = link.baud > 0.0 ? kBitsPerLine / link.baud : 0.0;
  return WithMotor(RigidModel(simulation.motor.supply_ratio * simulation.motor.NoLoad_rad_s(),
                              simulation.body.wheel_radius_m, simulation.body.track_m,
                              link.delay_s + line_s + 0.5 * link.poll_s + simulation.motor.lag_s),
                   simulation);
}

trial::SteeringPrior PriorOf(const experiment::Experiment& experiment,
                             const hardware::DriveRun& run) {
  const control::DiffDriveOptions& drive = experiment.hardware.odometry.drive;
  const double delay_s =
      run.ping.IsMeasured() ? run.ping.OneWay_s() : experiment.hardware.stopping.delay_s;
  return WithMotor(
      RigidModel(drive.full_power_speed_rad_s, drive.wheel_radius_m, drive.track_m, delay_s),
      experiment.simulation);
}

ordered_json ProposalsJson(const std::vector<trial::KeyProposal>& proposals) {
  ordered_json json = ordered_json::array();
  for (const trial::KeyProposal& proposal : proposals) {
    json.push_back({{"key", proposal.key}, {"was", proposal.was}, {"value", proposal.value}});
  }
  return json;
}

ordered_json TriedJson(const trial::SteeringCheck& check) {
  return check.tried_s ? ordered_json(*check.tried_s) : ordered_json(nullptr);
}

/// What the proposals are made of, and whether they were tried.
std::string SourceText(const trial::SteeringCheck& check) {
  const std::string source = check.is_identified
                                 ? "by the steering of this run"
                                 : "by the robot's file, since this run does not show its steering";
  return source + (check.tried_s ? fmt::format("; simulated so, the robot arrives after {:.1f} s",
                                               *check.tried_s)
                                 : "; not tried");
}

/// Shares of the decisions that each limit changed, the most frequent first.
std::string LimitShares(const trial::LimitCounts& limits) {
  std::vector<std::pair<size_t, std::string>> bound;
  trial::LimitCounts::Fields(limits, [&](const char* name, size_t count) {
    if (count > 0) bound.emplace_back(count, name);
  });
  std::stable_sort(bound.begin(), bound.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [count, name] : bound) {
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", name,
                        100.0 * static_cast<double>(count) / static_cast<double>(limits.decisions));
  }
  return text.empty() ? "no limit" : text;
}

}  // namespace

trial::SteeringCheck SteeringOf(const experiment::Experiment& experiment,
                                const sweep::SimulatedRun& run) {
  return trial::CheckSteering(run.result, experiment::TaskOf(experiment), experiment.control,
                              experiment.trial, PriorOf(experiment.simulation));
}

trial::SteeringCheck SteeringOf(const experiment::Experiment& experiment,
                                const hardware::DriveRun& run) {
  if (run.dry_run || !run.has_begun) return {};
  return trial::CheckSteering(run.trial, experiment::TaskOf(experiment), experiment.control,
                              experiment.trial, PriorOf(experiment, run));
}

ordered_json SteeringJson(const trial::SteeringCheck& check) {
  if (check.model.speed_mps == 0.0) return nullptr;
  return {{"turns", check.turns},
          {"identified", check.is_identified},
          {"r2", check.r2},
          {"speed_mps", check.model.speed_mps},
          {"yaw_rate_rad_s", check.model.yaw_rate_rad_s},
          {"pose_age_s", check.model.pose_age_s},
          {"command_delay_s", check.model.command_delay_s},
          {"delay_s", check.delay_s},
          {"crossover_rad_s", check.margins.crossover_rad_s},
          {"phase_margin_deg", check.margins.phase_margin_deg},
          {"longest_delay_s", check.margins.longest_delay_s},
          {"circle_m", check.circle_m},
          {"swing_deg", geometry::DegFromRad(check.swing.heading_rad)},
          {"swing_m", check.swing.path_m},
          {"pull_rad_s", check.model.pull_rad_s},
          {"causes", check.causes},
          {"proposals", ProposalsJson(check.proposals)},
          {"tried_s", TriedJson(check)}};
}

std::vector<std::string> SteeringLines(const trial::SteeringCheck& check,
                                       const trial::LimitCounts& limits) {
  std::vector<std::string> lines;
  if (check.HasCircled()) {
    lines.push_back(
        fmt::format("it circled: {:.1f} turns on the way to one waypoint", check.turns));
  }
  if (check.causes.empty()) return lines;
  for (const std::string& cause : check.causes) lines.push_back("why: " + cause);
  if (limits.decisions > 0) {
    lines.push_back(fmt::format("limits that bound, of {} decisions: {}", limits.decisions,
                                LimitShares(limits)));
  }
  if (check.proposals.empty()) {
    if (check.failed_tries > 0) {
      lines.push_back(fmt::format(
          "nothing to try: {} simulated runs with other gains and limits did not mend it",
          check.failed_tries));
    }
    return lines;
  }
  std::string keys;
  for (const trial::KeyProposal& proposal : check.proposals) {
    keys += fmt::format(" --set {}={:g}", proposal.key, proposal.value);
  }
  lines.push_back(fmt::format("try:{} ({})", keys, SourceText(check)));
  return lines;
}

}  // namespace rift::report
