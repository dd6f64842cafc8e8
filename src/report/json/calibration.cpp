#include "rift/report/json/json.hpp"

#include "rift/report/json/fields.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;
using sweep::CalibratedParameter;

ordered_json ParameterJson(const CalibratedParameter& p) {
  return {
      {"start", p.parameter.start},
      {"value", p.value},
      {"low", p.low},
      {"high", p.high},
      {"min", p.parameter.min},
      {"max", p.parameter.max},
      {"has_effect", p.has_effect},
      {"prior_mean", p.parameter.prior_sd > 0.0 ? ordered_json(p.parameter.prior_mean) : nullptr},
      {"prior_sd", p.parameter.prior_sd > 0.0 ? ordered_json(p.parameter.prior_sd) : nullptr},
      {"is_from_prior", p.is_from_prior},
      {"is_at_bound", p.is_at_bound},
      {"is_identified", p.is_identified}};
}

ordered_json ErrorJson(const sweep::ErrorStructure& e) {
  return {{"motions", e.motions},
          {"horizon_s", NumberOrNull(e.horizon_s)},
          {"ahead_rms_m", NumberOrNull(e.ahead_m)},
          {"ahead_mean_m", NumberOrNull(e.ahead_bias_m)},
          {"left_rms_m", NumberOrNull(e.left_m)},
          {"left_mean_m", NumberOrNull(e.left_bias_m)},
          {"turned_rms_rad", NumberOrNull(e.turned_rad)},
          {"turned_mean_rad", NumberOrNull(e.turned_bias_rad)},
          {"turning_left_mean_rad", NumberOrNull(e.turning_left_rad)},
          {"turning_right_mean_rad", NumberOrNull(e.turning_right_rad)},
          {"lag_s", NumberOrNull(e.lag_s)},
          {"frequency_hz", NumberOrNull(e.frequency_hz)},
          {"frequency_share", NumberOrNull(e.frequency_share)}};
}

ordered_json FitJson(const sweep::Calibration& fit) {
  ordered_json json = {{"loss_before", fit.loss_before},
                       {"loss_after", fit.loss_after},
                       {"steps", fit.steps},
                       {"has_converged", fit.has_converged},
                       {"trials_simulated", fit.trials_simulated}};
  ordered_json& parameters = json["parameters"] = ordered_json::object();
  ordered_json& correlation = json["correlation"] = ordered_json::array();
  for (size_t a = 0; a < fit.parameters.size(); ++a) {
    parameters[fit.parameters[a].parameter.key] = ParameterJson(fit.parameters[a]);
    ordered_json row = ordered_json::array();
    for (size_t b = 0; b < fit.parameters.size(); ++b) {
      row.push_back(NumberOrNull(
          fit.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))));
    }
    correlation.push_back(row);
  }
  return json;
}

}  // namespace

std::string CalibrationJson(const experiment::Experiment& experiment,
                            const sweep::CalibrationReport& report) {
  ordered_json json = {{"name", experiment.name},
                       {"confidence", experiment.calibrate.method.confidence},
                       {"fit", FitJson(report.calibration)}};
  ordered_json& agreement = json["agreement"] = ordered_json::object();
  for (size_t i = 0; i < report.agreement.size(); ++i) {
    const sweep::StartAgreement& one = report.agreement[i];
    agreement[report.calibration.parameters[i].parameter.key] = {
        {"values", one.values}, {"difference", one.difference}, {"agrees", one.agrees}};
  }
  for (const sweep::JudgedGroup& group : report.judged) {
    ordered_json& entry = json["judged"][group.level][group.side];
    entry["before"] = LikenessJson(group.before);
    entry["after"] = LikenessJson(group.after);
  }
  json["errors"] = ordered_json::object();  // stays so for a program
  for (const sweep::CalibrationReport::Errors& errors : report.errors) {
    json["errors"][errors.side] = {{"before", ErrorJson(errors.before)},
                                   {"after", ErrorJson(errors.after)}};
  }
  for (const sweep::CalibrationTrial& trial : report.trials) {
    json["trials"].push_back({{"log", trial.source},
                              {"level", trial.level},
                              {"trial", trial.trial},
                              {"held_out", trial.is_held_out},
                              {"mean_path_gap_before_m", NumberOrNull(trial.gap_before_m)},
                              {"mean_path_gap_after_m", NumberOrNull(trial.gap_after_m)}});
  }
  json["missing"] = report.missing;
  return Dump(json);
}

}  // namespace rift::report
