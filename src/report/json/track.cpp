#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rift/report/json/fields.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/yaml/enum_name.hpp"
#include "rift/yaml/write.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

double RowsPerSecond(const vision::TrackRun& run, int rows) {
  const double span_s = run.last_t_s - run.first_t_s;
  return rows > 1 && span_s > 0.0 ? (rows - 1) / span_s : std::nan("");
}

ordered_json MissesJson(const vision::TrackRun& run) {
  ordered_json json = ordered_json::object();
  for (std::size_t i = 1; i < run.misses.size(); ++i) {
    if (run.misses[i] > 0)
      json[std::string(yaml::NameOf(static_cast<vision::Miss>(i)))] = run.misses[i];
  }
  return json;
}

/// Pictures by what their pose is worth, each tag's counted by itself.
ordered_json StatesJson(const vision::TrackRun& run) {
  ordered_json json = ordered_json::object();
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    json[std::string(yaml::NameOf(static_cast<vision::TrackState>(i)))] = run.states[i];
  }
  return json;
}

int CountOf(const vision::TrackRun& run, vision::TrackState state) {
  return run.states[static_cast<std::size_t>(state)];
}

std::string MissesText(const vision::TrackRun& run) {
  if (run.frames == 0) return "none came";
  std::string kinds;
  int all = 0;
  for (std::size_t i = 1; i < run.misses.size(); ++i) {
    if (run.misses[i] == 0) continue;
    all += run.misses[i];
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", run.misses[i],
                         yaml::NameOf(static_cast<vision::Miss>(i)));
  }
  if (all == 0) return "the tag in every one";
  const int looked = std::accumulate(run.states.begin(), run.states.end(), 0);
  if (looked <= run.frames) return fmt::format("{} without the tag ({})", all, kinds);
  return fmt::format("a tag of several missed {} of {} times ({})", all, looked, kinds);
}

ordered_json FrameJson(const vision::CameraModel& camera) {
  if (!camera.world) {
    return {{"name", "camera"},
            {"meaning",
             "no world frame is set: the camera's own place, x right, y up in the picture, z "
             "towards the camera"}};
  }
  return {{"name", "world"},
          {"meaning", "z up, y up, metres, from the floor"},
          {"origin", camera.world->origin},
          {"residual_m", camera.world->residual_m}};
}

ordered_json SpanJson(const std::vector<double>& values) {
  return {{"p50", NumberOrNull(statistics::Quantile(values, 0.5))},
          {"p95", NumberOrNull(statistics::Quantile(values, 0.95))},
          {"max", NumberOrNull(statistics::Quantile(values, 1.0))}};
}

/// Tenths of a millimetre: finer than anybody clicks.
yaml::Node Metres(double value) { return yaml::Node::Scalar(fmt::format("{:.4f}", value)); }

std::string NextText(const vision::Calibration& c) {
  if (c.verdict == vision::CalibrationVerdict::kGood || c.next.text.empty()) return "";
  return fmt::format("next picture: {}\n", c.next.text);
}

/// Which tags a picture shows without the one that was asked for, and the flags for them.
std::string OthersText(const std::vector<vision::TagInPicture>& found, vision::TagFamily asked_for,
                       const std::string& id_flag) {
  constexpr std::size_t kMost = 4;
  std::string text = "the picture shows";
  for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i) {
    const auto& [family, id] = found[i];
    std::string flags;
    if (family != asked_for) flags = fmt::format("--set track.tag.family={} ", NameOf(family));
    text += fmt::format("{} {} id {} ({}{}{})", i == 0 ? "" : ",", NameOf(family), id, flags,
                        id_flag, id);
  }
  return text + (found.size() > kMost ? fmt::format(" and {} more", found.size() - kMost) : "");
}

/// NaN where there were too few views for it.
std::string Millimetres(double value_m, int decimals) {
  return std::isnan(value_m) ? "not known" : fmt::format("{:.{}f} mm", 1e3 * value_m, decimals);
}

}  // namespace

std::string TrackJson(const TrackInputs& inputs, const vision::CameraModel& camera,
                      const experiment::TrackOptions& options, const vision::TrackRun& run,
                      int rows) {
  ordered_json json{
      {"rift_version", RIFT_VERSION},
      {"camera", inputs.camera},
      {"recording", run.is_recording},
      {"calibration", inputs.calibration},
      {"calibration_hash", inputs.calibration_hash},
      {"width_px", camera.width_px},
      {"height_px", camera.height_px},
      {"frame", FrameJson(camera)},
      {"state", yaml::NameOf(run.state)},
      {"reason", run.reason},
      {"zero_of_t_s_on_the_steady_clock", run.zero_s},
      {"rows", rows},
      {"rows_per_s", NumberOrNull(RowsPerSecond(run, rows))},
      {"pictures", run.frames},
      {"delivered", run.status.delivered},
      {"dropped", run.status.dropped},
      {"skipped", run.status.skipped},
      {"reconnects", run.status.reconnects},
      {"misses", MissesJson(run)},
      {"states", StatesJson(run)},
      {"repeated_times", run.repeated},
      {"most_tags_of_this_id", run.most_tags_of_this_id},
      {"latency_s", SpanJson(run.latencies_s)},
      {"finding_s", SpanJson(run.costs_s)},
      {"reference_tags_off_m", run.moved_m ? ordered_json(*run.moved_m) : ordered_json(nullptr)}};
  json["track"] = {{"capture", FieldsToJson(options.capture)},
                   {"tag", FieldsToJson(options.tag)},
                   {"session", FieldsToJson(inputs.session)}};
  return Dump(json);
}

std::string TrackText(const vision::TrackRun& run, int rows) {
  std::string text = fmt::format("{} rows", rows);
  const double rate = RowsPerSecond(run, rows);
  if (!std::isnan(rate)) {
    text += fmt::format(" in {:.1f} s, {:.1f} a second", run.last_t_s - run.first_t_s, rate);
  }
  text += fmt::format("; {} pictures, {}, {} dropped\n", run.frames, MissesText(run),
                      run.status.dropped);
  if (run.status.skipped > 0 || run.status.reconnects > 0) {
    text +=
        fmt::format("{} damaged, too large or odd-sized pictures passed over, {} reconnections\n",
                    run.status.skipped, run.status.reconnects);
  }
  if (!run.latencies_s.empty()) {
    text += fmt::format("latency from stamp to pose: p50 {:.0f} ms, p95 {:.0f} ms\n",
                        1e3 * statistics::Quantile(run.latencies_s, 0.5),
                        1e3 * statistics::Quantile(run.latencies_s, 0.95));
  }
  if (!run.costs_s.empty()) {
    text += fmt::format("finding the tag: p50 {:.1f} ms, p95 {:.1f} ms\n",
                        1e3 * statistics::Quantile(run.costs_s, 0.5),
                        1e3 * statistics::Quantile(run.costs_s, 0.95));
  }
  if (const int doubtful = CountOf(run, vision::TrackState::kAmbiguous); doubtful > 0) {
    text += fmt::format(
        "{} rows are ambiguous (track_state 2): another tag of this id may be the robot's\n",
        doubtful);
  }
  if (run.off_floor > 0) {
    text += fmt::format(
        "{} of {} rows are not on the floor (on_floor 0): the tag was lifted or leant, or its "
        "side, its height, the lens or the world frame is not as told\n",
        run.off_floor, rows);
  }
  if (run.most_tags_of_this_id > 1) {
    text += fmt::format("{} tags of this id were in the picture: take the others away\n",
                        run.most_tags_of_this_id);
  }
  return text;
}

std::vector<std::string> UnseenLines(const vision::InsteadOfTag& instead,
                                     vision::TagFamily asked_for, const std::string& id_flag) {
  std::vector<std::string> lines;
  if (instead.is_unmeasured) {
    lines.emplace_back(
        "the picture shows the tag that was asked for, and it could not be measured: is it "
        "overexposed, blurred by motion, dim, too small or bent, or is track.tag.size_m or "
        "track.tag.height_m not its own?");
  }
  if (instead.is_mirrored) {
    lines.emplace_back(
        "the picture shows the tag that was asked for as in a mirror: switch off whatever "
        "mirrors the picture, in the camera, its driver or the program between");
  }
  if (!instead.others.empty()) lines.push_back(OthersText(instead.others, asked_for, id_flag));
  return lines;
}

std::string CalibrationText(const vision::Calibration& c) {
  std::string text = fmt::format("verdict: {}\n", yaml::NameOf(c.verdict));
  for (const std::string& reason : c.reasons) text += fmt::format("  {}\n", reason);
  if (c.camera.width_px == 0) return text + NextText(c);
  text += fmt::format("{} {}x{}, error {:.3f} px RMS (plumb_bob {:.3f}, equidistant {:.3f})\n",
                      yaml::NameOf(c.camera.lens), c.camera.width_px, c.camera.height_px, c.rms_px,
                      c.plumb_bob_px, c.equidistant_px);
  text += fmt::format("on the floor: {}; odd views against even ones: {}\n",
                      Millimetres(c.floor_error_m, 2), Millimetres(c.cross_check_m, 2));
  text += fmt::format("coverage: x {:.0f} %, y {:.0f} %, size {:.0f} %, skew {:.0f} %\n",
                      100 * c.coverage.x, 100 * c.coverage.y, 100 * c.coverage.size,
                      100 * c.coverage.skew);
  for (const vision::ParameterEstimate& p : c.parameters) {
    text += fmt::format("  {:<4} {:12.5g} +- {:.2g}\n", p.name, p.value, p.deviation);
  }
  for (const vision::ViewResult& view : c.views) {
    if (view.used) text += fmt::format("  {}: {:.3f} px\n", view.view.name, view.rms_px);
    if (view.is_copy) text += fmt::format("  {}: ignored, {}\n", view.view.name, view.dropped);
  }
  return text + NextText(c);
}

std::string CalibrationComment(const vision::Calibration& c) {
  std::string text = fmt::format(
      "# rift track --calibrate, board {}x{} of {:g} m squares: {}.\n"
      "# {:.2f} px RMS, on the floor {}; odd views against even ones {}.\n",
      c.board.columns, c.board.rows, c.board.square_m, yaml::NameOf(c.verdict), c.rms_px,
      Millimetres(c.floor_error_m, 1), Millimetres(c.cross_check_m, 1));
  for (const std::string& reason : c.reasons) text += fmt::format("# - {}\n", reason);
  return text;
}

std::string WaypointsYaml(const std::vector<control::Waypoint>& waypoints) {
  yaml::Node list = yaml::Node::List();
  for (const control::Waypoint& waypoint : waypoints) {
    yaml::Node item = yaml::Node::Map();
    item.Add("name", yaml::Node::Text(waypoint.name));
    item.Add("x", Metres(waypoint.x_m));
    item.Add("y", Metres(waypoint.y_m));
    if (waypoint.heading_deg) {
      item.Add("heading", yaml::Node::Scalar(fmt::format("{:.1f}", *waypoint.heading_deg)));
    }
    item.Add("stop", yaml::Node::Scalar(waypoint.stop ? "true" : "false"));
    list.items.push_back(item);
  }
  yaml::Node root = yaml::Node::Map();
  root.Add("waypoints", list);
  return yaml::Emit(root);
}

}  // namespace rift::report
