#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::vision {
namespace {

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

void JudgeViews(Judgement& judgement, const Calibration& calibration,
                const CalibrationOptions& options) {
  int used = 0;
  std::string drawn_over;
  for (const ViewResult& result : calibration.views) {
    used += result.used;
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
    judgement.Refuse(fmt::format("only {} of {} views can be used, at least {} are needed", used,
                                 calibration.views.size(), options.least_views));
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
      {"skew", {coverage.skew, "tilt the board by up to 45 degrees"}}};
  for (const auto& [name, side] : sides) {
    if (side.share >= options.good_coverage) continue;
    judgement.AtMostUsable(fmt::format("coverage in {} is {:.0f} %, good is {:.0f} %: {}", name,
                                       100.0 * side.share, 100.0 * options.good_coverage,
                                       side.advice));
  }
}

}  // namespace

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

}  // namespace rift::vision
