#include "rift/vision/calibration/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lens_fit.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::vision {
namespace {

/// Sets verdict and reasons from all else.
void Judge(Calibration& calibration, const CalibrationOptions& options);

class Judgement {
 public:
  explicit Judgement(Calibration& calibration) : calibration_(calibration) {
    calibration_.verdict = CalibrationVerdict::kGood;
  }

  void AtMostUsable(std::string reason) { Note(CalibrationVerdict::kUsable, std::move(reason)); }
  void Refuse(std::string reason) { Note(CalibrationVerdict::kRefuse, std::move(reason)); }

 private:
  void Note(CalibrationVerdict at_most, std::string reason) {
    calibration_.verdict = std::max(calibration_.verdict, at_most);
    calibration_.reasons.push_back(std::move(reason));
  }

  Calibration& calibration_;
};

std::string CopiesText(const Calibration& calibration) {
  const auto copies = std::count_if(calibration.views.begin(), calibration.views.end(),
                                    [](const ViewResult& result) { return result.is_copy; });
  return copies == 0 ? "" : fmt::format(" ({} show the same as another)", copies);
}

void JudgeViews(Judgement& judgement, const Calibration& calibration,
                const CalibrationOptions& options) {
  int used = 0;
  std::string drawn_over;
  for (const ViewResult& result : calibration.views) {
    used += result.used;
    if (result.is_copy) continue;
    if (!result.used) {
      judgement.AtMostUsable(fmt::format("{} is left out: {}", result.view.name, result.dropped));
    } else if (result.view.coloured > options.coloured_share) {
      drawn_over += (drawn_over.empty() ? "" : ", ") + result.view.name;
    }
  }
  if (!drawn_over.empty()) {
    judgement.AtMostUsable(
        fmt::format("something coloured is drawn over the board's corners in {}: save pictures "
                    "before drawing on them",
                    drawn_over));
  }
  if (used < options.least_views) {
    judgement.Refuse(fmt::format("only {} of {} views can be used{}, at least {} are needed", used,
                                 calibration.views.size(), CopiesText(calibration),
                                 options.least_views));
  } else if (used < options.good_views) {
    judgement.AtMostUsable(
        fmt::format("only {} views are used, good ones have {} or more", used, options.good_views));
  }
}

void JudgeErrors(Judgement& judgement, const Calibration& calibration,
                 const CalibrationOptions& options) {
  const std::string error = fmt::format("the error of the corners is {:.2f} px RMS, good is {:g}",
                                        calibration.rms_px, options.good_px);
  if (calibration.rms_px > options.refuse_px) {
    judgement.Refuse(error);
  } else if (calibration.rms_px > options.good_px) {
    judgement.AtMostUsable(error);
  }
  if (std::isnan(calibration.floor_error_m)) {
    judgement.AtMostUsable("odd and even views could not be held against each other: too few");
    return;
  }
  const std::string floor = fmt::format(
      "it implies {:.1f} mm on a floor {:g} m away (odd views against even ones: {:.1f} mm), good "
      "is {:g} mm",
      1e3 * calibration.floor_error_m, options.camera_height_m, 1e3 * calibration.cross_check_m,
      1e3 * options.good_floor_m);
  if (calibration.floor_error_m > options.refuse_floor_m) {
    judgement.Refuse(floor);
  } else if (calibration.floor_error_m > options.good_floor_m) {
    judgement.AtMostUsable(floor);
  }
}

void JudgeBoard(Judgement& judgement, const Calibration& calibration,
                const CalibrationOptions& options) {
  const bool bent = calibration.bent_px < options.bent_gain * calibration.flat_px;
  if (!bent) return;
  judgement.AtMostUsable(fmt::format(
      "the board is not flat: the error falls from {:.2f} to {:.2f} px when it may bend, "
      "by {:.1f} mm: glue it to glass or a plate",
      calibration.flat_px, calibration.bent_px, 1e3 * calibration.bend_m));
}

void JudgeCoverage(Judgement& judgement, const Coverage& coverage,
                   const CalibrationOptions& options) {
  struct Side {
    double share;
    const char* advice;
  };
  const std::vector<std::pair<std::string, Side>> sides{
      {"x", {coverage.x, "hold the board at the left and right edges too"}},
      {"y", {coverage.y, "hold the board at the upper and lower edges too"}},
      {"size", {coverage.size, "bring the board nearer, until it fills the picture"}},
      {"skew",
       {coverage.skew, "tilt the board by 40 degrees, one corner nearer than the opposite one"}}};
  for (const auto& [name, side] : sides) {
    if (side.share >= options.good_coverage) continue;
    judgement.AtMostUsable(fmt::format("coverage in {} is {:.0f} %, good is {:.0f} %: {}", name,
                                       100.0 * side.share, 100.0 * options.good_coverage,
                                       side.advice));
  }
}

void Judge(Calibration& calibration, const CalibrationOptions& options) {
  Judgement judgement(calibration);
  JudgeViews(judgement, calibration, options);
  if (calibration.camera.width_px == 0) {
    judgement.Refuse("no lens model fits the views");
    return;
  }
  JudgeErrors(judgement, calibration, options);
  JudgeBoard(judgement, calibration, options);
  JudgeCoverage(judgement, calibration.coverage, options);
}

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

double Distance_px(const BoardView& a, const BoardView& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    sum += (a.corners[i] - b.corners[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.corners.size()));
}

/// Copies count as one view: thirteen of them would agree with each other perfectly.
void IgnoreCopies(Calibration& calibration, double same_px) {
  std::vector<const ViewResult*> kept;
  for (ViewResult& result : calibration.views) {
    if (!result.used) continue;
    const auto original = std::find_if(kept.begin(), kept.end(), [&](const ViewResult* other) {
      return Distance_px(result.view, other->view) <= same_px;
    });
    if (original == kept.end()) {
      kept.push_back(&result);
      continue;
    }
    result.used = false;
    result.is_copy = true;
    result.dropped = fmt::format("it shows the same as {}", (*original)->view.name);
  }
}

/// Views with corners and of the size that most have.
void Admit(Calibration& calibration) {
  std::map<std::pair<int, int>, int> sizes;
  for (ViewResult& result : calibration.views) {
    if (result.view.corners.empty()) {
      result.dropped = result.view.problem;
    } else {
      ++sizes[{result.view.width_px, result.view.height_px}];
    }
  }
  if (sizes.empty()) return;
  const auto most = std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
  for (ViewResult& result : calibration.views) {
    const BoardView& view = result.view;
    if (!view.corners.empty() && std::pair(view.width_px, view.height_px) != most) {
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
  IgnoreCopies(calibration, options.same_px);
  const std::optional<LensFit> fit = ChooseLens(calibration, options);
  if (fit) TakeFit(calibration, *fit, options);
  calibration.coverage = CoverageOf(calibration.views, board);
  calibration.next = NextViewFor(calibration.views, board, options.good_coverage);
  Judge(calibration, options);
  return calibration;
}

}  // namespace rift::vision
