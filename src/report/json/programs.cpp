#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

ordered_json IntervalJson(const statistics::Interval& interval) {
  return {NumberOrNull(interval.low), NumberOrNull(interval.high)};
}

ordered_json SlipJson(const std::vector<odometry::Slip>& slip) {
  ordered_json json{{"u", ordered_json::array()},
                    {"left", ordered_json::array()},
                    {"right", ordered_json::array()}};
  for (const odometry::Slip& part : slip) {
    json["u"].push_back(part.u);
    json["left"].push_back(NumberOrNull(part.left));
    json["right"].push_back(NumberOrNull(part.right));
  }
  return json;
}

ordered_json RunJson(const odometry::RunMeasures& run) {
  return {{"did_move", run.did_move},
          {"length_m", NumberOrNull(run.length_m)},
          {"deviation_m", NumberOrNull(run.deviation_m)},
          {"largest_deviation_m", NumberOrNull(run.largest_deviation_m)},
          {"end_error_m", NumberOrNull(run.end_error_m)},
          {"drift_per_m", NumberOrNull(run.drift_per_m)},
          {"odometry_gap_m", NumberOrNull(run.odometry_gap_m)},
          {"yaw_drift_rad", NumberOrNull(run.yaw_drift_rad)},
          {"slip_left", NumberOrNull(run.slip_left)},
          {"slip_right", NumberOrNull(run.slip_right)},
          {"slip", SlipJson(run.slip)}};
}

ordered_json CellJson(const odometry::CellMeasures& cell) {
  return {{"runs", cell.runs},
          {"moved", cell.moved},
          {"did_move", cell.DidMove()},
          {"deviation_m", NumberOrNull(cell.deviation_m)},
          {"deviation_interval_m", IntervalJson(cell.deviation_interval_m)},
          {"spread_m", NumberOrNull(cell.spread_m)},
          {"drift_per_m", NumberOrNull(cell.drift_per_m)},
          {"odometry_gap_m", NumberOrNull(cell.odometry_gap_m)},
          {"slip_left", NumberOrNull(cell.slip_left)},
          {"slip_right", NumberOrNull(cell.slip_right)},
          {"slip", SlipJson(cell.slip)}};
}

ordered_json EstimateJson(const odometry::Estimate& estimate) {
  return {{"value", NumberOrNull(estimate.value)},
          {"interval", IntervalJson(estimate.interval)},
          {"is_told", estimate.is_told}};
}

}  // namespace

std::string ProgramsJson(const std::vector<experiment::Parameter>& parameters,
                         const std::vector<sweep::ProgramCell>& cells) {
  ordered_json json{{"definition", odometry::SpreadText()}, {"cells", ordered_json::array()}};
  for (const sweep::ProgramCell& cell : cells) {
    ordered_json entry{{"theta", ThetaJson(parameters, cell.theta)}};
    entry.update(CellJson(cell.measures));
    entry["trials"] = ordered_json::array();
    for (const odometry::RunMeasures& run : cell.runs) entry["trials"].push_back(RunJson(run));
    entry["lost"] = cell.lost;
    json["cells"].push_back(std::move(entry));
  }
  return Dump(json);
}

std::string OdometryJson(const odometry::OdometryResult& result) {
  ordered_json json{{"definition", odometry::SpreadText()}, {"runs", ordered_json::array()}};
  for (const odometry::OdometryResult::Run& run : result.runs) {
    ordered_json entry{{"run", run.name}};
    entry.update(RunJson(run.measures));
    json["runs"].push_back(std::move(entry));
  }
  json["cell"] = result.cell ? CellJson(*result.cell) : ordered_json();
  json["umbmark"] = nullptr;
  if (result.umbmark) {
    const odometry::Umbmark& u = *result.umbmark;
    json["umbmark"] = {{"ccw_runs", u.ccw_runs},
                       {"cw_runs", u.cw_runs},
                       {"ccw_m", {u.ccw_m.x(), u.ccw_m.y()}},
                       {"cw_m", {u.cw_m.x(), u.cw_m.y()}},
                       {"largest_m", u.largest_m}};
  }
  json["calibration"] = nullptr;
  if (result.calibration) {
    const odometry::OdometryCalibration& found = *result.calibration;
    json["calibration"] = {{"wheel_radius_m", EstimateJson(found.wheel_radius_m)},
                           {"right_over_left", EstimateJson(found.right_over_left)},
                           {"track_m", EstimateJson(found.track_m)},
                           {"tag_ahead_m", EstimateJson(found.tag_ahead_m)},
                           {"noise_m", found.noise_m},
                           {"noise_yaw_rad", found.noise_yaw_rad},
                           {"runs", found.runs},
                           {"windows", found.windows},
                           {"confidence", result.confidence}};
  }
  return Dump(json);
}

}  // namespace rift::report
