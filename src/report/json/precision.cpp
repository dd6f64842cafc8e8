#include "rift/report/json/precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;
using vision::PrecisionMap;
using vision::PrecisionPlace;

double P95(const std::vector<double>& values) { return statistics::Quantile(values, 0.95); }

/// One number a place, in the order of the picture; `-` where there is none.
std::string Laid(const PrecisionMap& map, const std::string& title, int decimals,
                 const std::function<double(const PrecisionPlace&)>& value) {
  std::string text = title + "\n";
  for (int row = 0; row < map.rows; ++row) {
    text += "  ";
    for (int column = 0; column < map.columns; ++column) {
      const int place = row * map.columns + column;
      const double number = value(map.places[static_cast<std::size_t>(place)]);
      text += std::isfinite(number) ? fmt::format("{:8.{}f}", number, decimals)
                                    : fmt::format("{:>8}", "-");
    }
    text += "\n";
  }
  return text;
}

/// Errors of all places, and how often the tag was found.
struct Overall {
  std::vector<double> off_m, yaw_off_rad;
  int views = 0, found = 0, places = 0, blind_places = 0;
};

Overall OverallOf(const PrecisionMap& map) {
  Overall all;
  for (const PrecisionPlace& place : map.places) {
    if (!place.floor_m) continue;
    ++all.places;
    all.blind_places += place.found < place.views;
    all.views += place.views;
    all.found += place.found;
    all.off_m.insert(all.off_m.end(), place.off_m.begin(), place.off_m.end());
    all.yaw_off_rad.insert(all.yaw_off_rad.end(), place.yaw_off_rad.begin(),
                           place.yaw_off_rad.end());
  }
  return all;
}

ordered_json PlaceJson(const PrecisionPlace& place) {
  ordered_json json{{"x_px", place.at_px.x()}, {"y_px", place.at_px.y()}};
  json["x_m"] = place.floor_m ? ordered_json(place.floor_m->x()) : ordered_json(nullptr);
  json["y_m"] = place.floor_m ? ordered_json(place.floor_m->y()) : ordered_json(nullptr);
  json["side_px"] = place.side_px;
  json["views"] = place.views;
  json["found"] = place.found;
  json["position_rms_m"] = NumberOrNull(statistics::RootMeanSquare(place.off_m));
  json["position_p95_m"] = NumberOrNull(P95(place.off_m));
  json["yaw_rms_rad"] = NumberOrNull(statistics::RootMeanSquare(place.yaw_off_rad));
  json["yaw_p95_rad"] = NumberOrNull(P95(place.yaw_off_rad));
  json["shift_by_height"] = place.shift_by_height;
  json["least_size_m"] =
      place.least_size_m ? ordered_json(*place.least_size_m) : ordered_json(nullptr);
  return json;
}

}  // namespace

std::string PrecisionText(const PrecisionMap& map, const vision::TagOptions& tag) {
  const Overall all = OverallOf(map);
  if (all.places == 0) return "the picture shows no floor: is the world frame right?\n";
  std::string text = fmt::format(
      "the tag of {:g} m, {:g} m above the floor, at {} places with {} views each, laid out as the "
      "picture is\n",
      tag.size_m, tag.height_m, all.places, all.views / all.places);
  text += Laid(map, "floor, x in m", 2, [](const PrecisionPlace& place) {
    return place.floor_m ? place.floor_m->x() : std::nan("");
  });
  text += Laid(map, "floor, y in m", 2, [](const PrecisionPlace& place) {
    return place.floor_m ? place.floor_m->y() : std::nan("");
  });
  text += Laid(map, "the tag's short side in px", 1, [](const PrecisionPlace& place) {
    return place.floor_m ? place.side_px : std::nan("");
  });
  text += Laid(map, "position, RMS error in mm", 3, [](const PrecisionPlace& place) {
    return 1e3 * statistics::RootMeanSquare(place.off_m);
  });
  text += Laid(map, "heading, RMS error in deg", 3, [](const PrecisionPlace& place) {
    return geometry::DegFromRad(statistics::RootMeanSquare(place.yaw_off_rad));
  });
  text += Laid(map, "found, % of the views", 0, [](const PrecisionPlace& place) {
    return place.floor_m ? 100.0 * place.found / place.views : std::nan("");
  });
  text += Laid(map, "smallest tag that is found, in mm", 0, [](const PrecisionPlace& place) {
    return place.least_size_m ? 1e3 * *place.least_size_m : std::nan("");
  });
  if (all.found > 0) {
    text += fmt::format("position: p95 {:.2f} mm, heading: p95 {:.2f} deg, over all places; ",
                        1e3 * P95(all.off_m), geometry::DegFromRad(P95(all.yaw_off_rad)));
  }
  text += fmt::format("found in {} of {} views\n", all.found, all.views);
  double most_shift = 0.0;
  for (const PrecisionPlace& place : map.places) {
    if (place.floor_m) most_shift = std::max(most_shift, place.shift_by_height);
  }
  text += fmt::format(
      "a tag is found from {:.0f} px on; a height that is wrong by 1 mm moves the pose by up to "
      "{:.2f} "
      "mm\n",
      map.least_side_px, most_shift);
  if (all.blind_places > 0) {
    text += fmt::format(
        "at {} of {} places the tag is missed in some views: keep the path away from "
        "them, lower the camera, or print the tag larger\n",
        all.blind_places, all.places);
  }
  return text;
}

std::string PrecisionJson(const PrecisionMap& map, const vision::TagOptions& tag,
                          const vision::SyntheticCameraOptions& look) {
  const Overall all = OverallOf(map);
  ordered_json json{{"rift_version", RIFT_VERSION},
                    {"tag_family", vision::NameOf(tag.family)},
                    {"tag_size_m", tag.size_m},
                    {"tag_height_m", tag.height_m},
                    {"columns", map.columns},
                    {"rows", map.rows},
                    {"position_p95_m", NumberOrNull(P95(all.off_m))},
                    {"yaw_p95_rad", NumberOrNull(P95(all.yaw_off_rad))},
                    {"views", all.views},
                    {"found", all.found},
                    {"least_side_px", map.least_side_px},
                    {"look", FieldsToJson(look)}};
  for (const PrecisionPlace& place : map.places) json["places"].push_back(PlaceJson(place));
  return Dump(json);
}

}  // namespace rift::report
