#include "rift/vision/calibration/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lens_fit.hpp"
#include "rift/statistics/quantile.hpp"
#include "verdict.hpp"

namespace rift::vision {
namespace {

std::vector<ViewResult*> Used(Calibration& calibration) {
  std::vector<ViewResult*> used;
  for (ViewResult& result : calibration.views) {
    if (result.used) used.push_back(&result);
  }
  return used;
}

FitInput InputOf(const std::vector<ViewResult*>& used, const Board& board) {
  FitInput input{.board = board};
  for (const ViewResult* result : used) input.views.push_back(&result->view);
  return input;
}

/// Views with corners and of the size that most have.
void Admit(Calibration& calibration) {
  std::map<std::pair<int, int>, int> sizes;
  for (const ViewResult& result : calibration.views) {
    if (!result.view.corners.empty()) ++sizes[{result.view.width_px, result.view.height_px}];
  }
  if (sizes.empty()) return;
  const auto most = std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
  for (ViewResult& result : calibration.views) {
    const BoardView& view = result.view;
    if (view.corners.empty()) {
      result.dropped = view.problem;
    } else if (std::pair(view.width_px, view.height_px) != most) {
      result.dropped = fmt::format("it is {}x{}, the others {}x{}", view.width_px, view.height_px,
                                   most.first, most.second);
    }
    result.used = result.dropped.empty();
  }
}

void TakeErrors(const std::vector<ViewResult*>& used, const LensFit& fit) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i]->rms_px = fit.ViewRms_px(i);
    used[i]->residuals_px = fit.residuals_px[i];
  }
}

double MedianRms_px(const std::vector<ViewResult*>& used) {
  std::vector<double> errors_px;
  for (const ViewResult* result : used) errors_px.push_back(result->rms_px);
  return statistics::Median(std::move(errors_px));
}

/// Leaves out the worst view when it is far off the others; whether it did.
bool DropWorst(const std::vector<ViewResult*>& used, const CalibrationOptions& options) {
  const double median_px = MedianRms_px(used);
  ViewResult& worst = **std::max_element(
      used.begin(), used.end(),
      [](const ViewResult* a, const ViewResult* b) { return a->rms_px < b->rms_px; });
  if (worst.rms_px < std::max(options.outlier_px, options.outlier_factor * median_px)) return false;
  worst.used = false;
  worst.dropped =
      fmt::format("outlier: its error is {:.2f} px, the median {:.2f} px", worst.rms_px, median_px);
  return true;
}

bool Enough(const std::vector<ViewResult*>& used, const CalibrationOptions& options) {
  return static_cast<int>(used.size()) >= options.least_views;
}

std::optional<LensFit> FitWithoutOutliers(Calibration& calibration, Lens lens,
                                          const CalibrationOptions& options) {
  for (;;) {
    const std::vector<ViewResult*> used = Used(calibration);
    if (!Enough(used, options)) return {};
    std::optional<LensFit> fit = FitLens(InputOf(used, calibration.board), lens);
    if (!fit) return {};
    TakeErrors(used, *fit);
    const bool may_drop = static_cast<int>(used.size()) > options.least_views;
    if (!may_drop || !DropWorst(used, options)) return fit;
  }
}

/// The lens that explains the views better, with a handicap for the fisheye.
std::optional<LensFit> ChooseLens(Calibration& calibration, const CalibrationOptions& options) {
  Calibration as_fisheye = calibration;
  std::optional<LensFit> plumb = FitWithoutOutliers(calibration, Lens::kPlumbBob, options);
  std::optional<LensFit> fisheye = FitWithoutOutliers(as_fisheye, Lens::kEquidistant, options);
  calibration.plumb_bob_px = plumb ? plumb->camera.rms_px : kNotComputed;
  calibration.equidistant_px = fisheye ? fisheye->camera.rms_px : kNotComputed;
  const auto used = [](Calibration& c) { return Used(c).size(); };
  const bool take_fisheye =
      fisheye && (!plumb || (used(as_fisheye) >= used(calibration) &&
                             fisheye->camera.rms_px < options.fisheye_gain * plumb->camera.rms_px));
  if (!take_fisheye) return plumb;
  calibration.views = as_fisheye.views;
  return fisheye;
}

/// The same fit to every other view, compared on the floor.
double CrossCheck_m(Calibration& calibration, const CalibrationOptions& options) {
  std::array<std::vector<ViewResult*>, 2> halves;
  const std::vector<ViewResult*> used = Used(calibration);
  for (std::size_t i = 0; i < used.size(); ++i) halves[i % 2].push_back(used[i]);
  if (halves[1].size() < 3) return kNotComputed;
  const auto odd = FitLens(InputOf(halves[0], calibration.board), calibration.camera.lens);
  const auto even = FitLens(InputOf(halves[1], calibration.board), calibration.camera.lens);
  if (!odd || !even) return kNotComputed;
  return FloorDifference_m(odd->camera, even->camera, options.camera_height_m);
}

void TakeFit(Calibration& calibration, const LensFit& fit, const CalibrationOptions& options) {
  calibration.camera = fit.camera;
  calibration.parameters = fit.parameters;
  calibration.rms_px = fit.camera.rms_px;
  TakeErrors(Used(calibration), fit);
  const BentFit bent = FitBentBoard(InputOf(Used(calibration), calibration.board));
  calibration.flat_px = bent.flat_px;
  calibration.bent_px = bent.rms_px;
  calibration.bend_m = bent.bend_m;
  calibration.cross_check_m = CrossCheck_m(calibration, options);
  const double seen_m = calibration.rms_px * options.camera_height_m / fit.camera.k(0, 0);
  calibration.floor_error_m = std::hypot(seen_m, calibration.cross_check_m / 2.0);
}

}  // namespace

Calibration Calibrate(const std::vector<BoardView>& views, const Board& board,
                      const CalibrationOptions& options) {
  board.Check();
  Calibration calibration{.board = board};
  for (const BoardView& view : views) calibration.views.push_back({.view = view});
  Admit(calibration);
  const std::optional<LensFit> fit = ChooseLens(calibration, options);
  if (fit) TakeFit(calibration, *fit, options);
  calibration.coverage = CoverageOf(calibration.views, board);
  Judge(calibration, options);
  return calibration;
}

}  // namespace rift::vision
