#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "rift/vision/calibration/live_views.hpp"

namespace rift::vision {
namespace {

// What good views span, from ROS's camera_calibration (calibrator.py, _param_ranges).
constexpr double kSpanX = 0.7, kSpanY = 0.7, kSpanSize = 0.4, kSpanSkew = 0.5;
// About its diagonal: a skew of 0.5. About a side the same tilt gives less than half of that.
constexpr double kTilt_rad = 40.0 * std::numbers::pi / 180.0;
constexpr const char* kTilt = "tilted by 40 degrees, one corner nearer than the opposite one";

struct Outline {
  Eigen::Vector2d upper_left, upper_right, lower_right, lower_left;

  double Area() const {
    const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return a.x() * b.y() - a.y() * b.x();
    };
    return 0.5 * std::abs(cross(lower_right - upper_left, lower_left - upper_right));
  }
  double UpperRightAngle_rad() const {
    const Eigen::Vector2d a = upper_left - upper_right, b = lower_right - upper_right;
    return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
  }
};

Outline OutlineOf(const BoardView& view, const Board& board) {
  const auto& c = view.corners;
  const std::size_t last = c.size() - 1, width = static_cast<std::size_t>(board.columns) - 1;
  return {c[0], c[width], c[last], c[last - width]};
}

class Span {
 public:
  void Cover(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  double ShareOf(double plenty) const { return std::clamp((high_ - low_) / plenty, 0.0, 1.0); }

 private:
  double low_ = HUGE_VAL, high_ = -HUGE_VAL;
};

double ShareOfPicture(const std::vector<ViewResult>& views) {
  constexpr int kColumns = 8, kRows = 6;
  std::set<std::pair<int, int>> cells;
  for (const ViewResult& result : views) {
    if (!result.used) continue;
    for (const Eigen::Vector2d& corner : result.view.corners) {
      cells.emplace(static_cast<int>(corner.x() * kColumns / result.view.width_px),
                    static_cast<int>(corner.y() * kRows / result.view.height_px));
    }
  }
  return static_cast<double>(cells.size()) / (kColumns * kRows);
}

}  // namespace

ViewPlace PlaceOf(const BoardView& view, const Board& board) {
  const Outline outline = OutlineOf(view, board);
  const double side_px = std::sqrt(outline.Area());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : view.corners) mean += corner;
  mean /= static_cast<double>(view.corners.size());
  const auto share = [side_px](double at_px, double room_px) {
    return std::clamp((at_px - side_px / 2.0) / std::max(1.0, room_px - side_px), 0.0, 1.0);
  };
  const double skew = 2.0 * std::abs(std::numbers::pi / 2.0 - outline.UpperRightAngle_rad());
  return {share(mean.x(), view.width_px), share(mean.y(), view.height_px),
          side_px / std::sqrt(static_cast<double>(view.width_px) * view.height_px),
          std::min(1.0, skew)};
}

// Size and skew count from none at all: far and flat views are easy to come by.
Coverage CoverageOf(const std::vector<ViewResult>& views, const Board& board) {
  Span x, y, size, skew;
  size.Cover(0.0);
  skew.Cover(0.0);
  for (const ViewResult& result : views) {
    if (!result.used) continue;
    const ViewPlace place = PlaceOf(result.view, board);
    x.Cover(place.x);
    y.Cover(place.y);
    size.Cover(place.size);
    skew.Cover(place.skew);
  }
  return {x.ShareOf(kSpanX), y.ShareOf(kSpanY), size.ShareOf(kSpanSize), skew.ShareOf(kSpanSkew),
          ShareOfPicture(views)};
}

namespace {

/// Places to try: the middles of a 3 x 3 grid, far and near, flat and tilted.
constexpr std::array<double, 3> kAcross{0.05, 0.5, 0.95};
constexpr std::array<double, 2> kSizes{0.25, 0.5}, kSkews{0.05, 0.6};

std::vector<ViewPlace> PlacesToTry() {
  std::vector<ViewPlace> places;
  for (const double x : kAcross) {
    for (const double y : kAcross) {
      for (const double size : kSizes) {
        for (const double skew : kSkews) places.push_back({x, y, size, skew});
      }
    }
  }
  return places;
}

Coverage CoverageOf(const std::vector<ViewPlace>& places) {
  Span x, y, size, skew;
  size.Cover(0.0);
  skew.Cover(0.0);
  for (const ViewPlace& place : places) {
    x.Cover(place.x);
    y.Cover(place.y);
    size.Cover(place.size);
    skew.Cover(place.skew);
  }
  return {.x = x.ShareOf(kSpanX),
          .y = y.ShareOf(kSpanY),
          .size = size.ShareOf(kSpanSize),
          .skew = skew.ShareOf(kSpanSkew)};
}

double Distance(const ViewPlace& a, const ViewPlace& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.skew - b.skew);
}

/// What the views lack, each side at most `enough`.
double Covered(const Coverage& c, double enough) {
  return std::min(c.x, enough) + std::min(c.y, enough) + std::min(c.size, enough) +
         std::min(c.skew, enough);
}

std::string TextOf(const ViewPlace& place) {
  constexpr std::array<const char*, 3> kColumns{"left", "", "right"};
  constexpr std::array<const char*, 3> kRows{"upper", "", "lower"};
  const auto third = [](double share) { return share < 0.33 ? 0 : share > 0.67 ? 2 : 1; };
  std::string where = kRows[third(place.y)];
  const std::string column = kColumns[third(place.x)];
  if (!where.empty() && !column.empty()) where += " ";
  where += column;
  where = where.empty()
              ? "in the middle of the picture"
              : fmt::format("at the {} {} of the picture", where,
                            third(place.x) != 1 && third(place.y) != 1 ? "corner" : "edge");
  return fmt::format("hold the board {}, {}, {}", where,
                     place.size > 0.4 ? "near, so that it fills half of the picture"
                                      : "farther away, a quarter of the picture wide",
                     place.skew > 0.3 ? kTilt : "facing the camera");
}

}  // namespace

NextView NextViewFor(const std::vector<ViewResult>& views, const Board& board, double enough) {
  std::vector<ViewPlace> places;
  for (const ViewResult& result : views) {
    if (result.used) places.push_back(PlaceOf(result.view, board));
  }
  const Coverage now = places.empty() ? Coverage{} : CoverageOf(places);
  if (std::min({now.x, now.y, now.size, now.skew}) >= enough) return {};
  NextView next;
  double best = -1.0;
  for (const ViewPlace& place : PlacesToTry()) {
    double nearest = 4.0;
    for (const ViewPlace& taken : places) nearest = std::min(nearest, Distance(place, taken));
    std::vector<ViewPlace> with = places;
    with.push_back(place);
    // Coverage first; among equals the place that is least like those that were taken.
    const double gain = Covered(CoverageOf(with), enough) + 0.05 * nearest;
    if (gain <= best) continue;
    best = gain;
    next.place = place;
  }
  next.text = TextOf(next.place);
  return next;
}

std::string WayTo(const ViewPlace& now, const ViewPlace& next) {
  constexpr double kAside = 0.2, kNearer = 0.07, kTilted = 0.3;
  std::vector<std::string> steps;
  std::string aside;
  if (std::abs(next.x - now.x) > kAside) aside = next.x < now.x ? "left" : "right";
  if (std::abs(next.y - now.y) > kAside) {
    aside += fmt::format("{}{}", aside.empty() ? "" : " and ", next.y < now.y ? "up" : "down");
  }
  if (!aside.empty()) steps.push_back("move it " + aside + " in the picture");
  if (std::abs(next.size - now.size) > kNearer) {
    steps.emplace_back(next.size > now.size ? "bring it nearer" : "take it farther away");
  }
  if (next.skew > kTilted && now.skew < kTilted) {
    steps.emplace_back("tilt it by 40 degrees, one corner nearer than the opposite one");
  } else if (next.skew < kTilted && now.skew > kTilted) {
    steps.emplace_back("turn it to face the camera");
  }
  return fmt::format("{}", fmt::join(steps, ", "));
}

std::array<Eigen::Vector2d, 4> OutlineAt(const ViewPlace& place, const Board& board, int width_px,
                                         int height_px) {
  constexpr double kTilted = 0.3;
  const double side_px = place.size * std::sqrt(1.0 * width_px * height_px);
  const double aspect = std::sqrt((board.columns - 1.0) / (board.rows - 1.0));
  const Eigen::Vector2d flat = 0.5 * side_px * Eigen::Vector2d(aspect, 1.0 / aspect);
  // Seen from afar a tilt shortens what lies across its axis; the area stays.
  const double shortened = place.skew > kTilted ? std::cos(kTilt_rad) : 1.0;
  const Eigen::Vector2d axis = Eigen::Vector2d(1.0, 1.0).normalized();
  const auto tilted = [&](double x, double y) -> Eigen::Vector2d {
    const Eigen::Vector2d corner(x * flat.x(), y * flat.y());
    const Eigen::Vector2d along = corner.dot(axis) * axis;
    return (along + shortened * (corner - along)) / std::sqrt(shortened);
  };
  const Eigen::Vector2d half = tilted(1.0, 1.0).cwiseAbs().cwiseMax(tilted(1.0, -1.0).cwiseAbs());
  // The outer squares and some white around them have to be in the picture too.
  const double around_px = 1.2 * 2.0 * flat.x() / (board.columns - 1);
  const auto at = [&](double share, double room_px, double half_px) {
    const double wanted_px = side_px / 2.0 + share * (room_px - side_px);
    const double least_px = half_px + around_px;
    return std::clamp(wanted_px, std::min(least_px, room_px / 2.0),
                      std::max(room_px - least_px, room_px / 2.0));
  };
  const Eigen::Vector2d middle(at(place.x, width_px, half.x()), at(place.y, height_px, half.y()));
  return {middle + tilted(-1.0, -1.0), middle + tilted(1.0, -1.0), middle + tilted(1.0, 1.0),
          middle + tilted(-1.0, 1.0)};
}

}  // namespace rift::vision
