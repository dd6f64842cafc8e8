// Squares whose edges lie where a picture of them says to the last grey value, against hand
// calculation.
#include "vision/tracking/edge_fit.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "rift/vision/tracking/tag_detector.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

constexpr int kPatch_px = 130;
constexpr double kBlack = 20.0, kWhite = 220.0;

/// An upright black square of eight cells from (kLow, kLow) on.
constexpr double kLow = 19.5;

struct Square {
  double side_px = 80.0;
  GreyPatch patch{{0, 0, kPatch_px, kPatch_px},
                  std::vector<std::uint8_t>(kPatch_px* kPatch_px, std::uint8_t{0})};

  double High() const { return kLow + side_px; }
  /// Of each pixel the grey value that `of` gives.
  void Paint(const std::function<double(int x, int y)>& of) {
    for (int y = 0; y < kPatch_px; ++y) {
      for (int x = 0; x < kPatch_px; ++x) {
        patch.pixels[static_cast<std::size_t>(y) * kPatch_px + x] =
            static_cast<std::uint8_t>(std::lround(of(x, y)));
      }
    }
  }
  std::optional<FittedSquare> Fit(double least_contrast = 30.0) const {
    const TagCorners corners{{{kLow, High()}, {High(), High()}, {High(), kLow}, {kLow, kLow}}};
    return FitSquare(test::SmallCamera(), patch, corners, ShapeOf(TagFamily::k36h11),
                     least_contrast, {});
  }
};

/// The share of the pixel that lies beyond `edge`.
double Beyond(int pixel, double edge) { return std::clamp(pixel + 0.5 - edge, 0.0, 1.0); }

double GreyAt(int x, int y, double high, double right) {
  const double black =
      Beyond(x, kLow) * (1.0 - Beyond(x, right)) * Beyond(y, kLow) * (1.0 - Beyond(y, high));
  return kWhite - (kWhite - kBlack) * black;
}

TEST_CASE("A profile across an edge has 0.45 of a cell to either side, one to 3.5 pixels") {
  struct Case {
    double side_px;  // cells of 10, 6 and 2.125 px: profiles of 3.5, 2.7 and 1 px to either side
    double off_px;   // of a line of ten grey values less, from the right edge
    double share;    // of it at the profile's end: it is felt a pixel further out
  };
  for (const Case& c : {Case{80.0, 3.5, 1.0},
                        {80.0, 4.5, 0.0},
                        {48.0, 3.5, 0.2},
                        {48.0, 4.5, 0.0},
                        {17.0, 1.5, 0.5},
                        {17.0, 2.5, 0.0}}) {
    Square square{.side_px = c.side_px};
    square.Paint([&](int x, int y) {
      return x == square.High() + c.off_px ? kWhite - 10.0
                                           : GreyAt(x, y, square.High(), square.High());
    });
    const auto fitted = square.Fit();
    INFO("a side of " << c.side_px << " px, the line at " << c.off_px);
    REQUIRE(fitted);
    CHECK(fitted->white_grey == Approx(kWhite - 0.25 * c.share * 10.0).margin(0.3));
    CHECK(fitted->black_grey == Approx(kBlack).margin(0.05));
  }
}

/// The right edge `off_px` further out in six of the sixty rows that are measured, in their middle.
Square Notched(double off_px) {
  Square square;
  square.Paint([&](int x, int y) {
    const double right = square.High() + (y >= 57 && y <= 62 ? off_px : 0.0);
    return GreyAt(x, y, square.High(), right);
  });
  return square;
}

TEST_CASE("Of a straight edge points within 0.15 px are kept, and those beyond are left out") {
  const auto kept = Notched(0.16).Fit();
  REQUIRE(kept);
  // A tenth of the points is off the others, and the line between them: by 0.144 px.
  CHECK(kept->rms_px == Approx(0.5 * 0.16 * std::sqrt(0.1 * 0.9)).epsilon(0.1));
  const auto without = Notched(0.2).Fit();
  REQUIRE(without);
  CHECK(without->rms_px < 0.003);
}

TEST_CASE("An edge is measured at every pixel, and so well are its corners known") {
  const auto fitted = Notched(0.16).Fit();
  REQUIRE(fitted);
  // Sixty points on each side at 1 px, of which one side's scatter. A line through them is known
  // in its middle by their number, and 40 px from there by their squared distances, as well.
  const double of_point_px2 = 4.0 * std::pow(fitted->rms_px, 2) * 60.0 / (4.0 * 58.0);
  const double distances_px2 = (60.0 * 60.0 * 60.0 - 60.0) / 12.0;
  const double expected = 1.5 * of_point_px2 * (1.0 / 60.0 + 40.0 * 40.0 / distances_px2);
  REQUIRE(expected > 1e-6);
  for (int i = 0; i < 8; ++i) {
    CHECK(fitted->corners.covariance(i, i) == Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("A step that rises by less than half the least contrast in two pixels is no edge") {
  // From black to white by 120 grey values, evenly over a few pixels.
  const auto is_found = [](double ramp_px) {
    Square square;
    square.Paint([&](int x, int y) {
      const double inside = std::min({x - kLow, square.High() - x, y - kLow, square.High() - y});
      return 160.0 - 120.0 * std::clamp(0.5 + inside / ramp_px, 0.0, 1.0);
    });
    return square.Fit(100.0).has_value();
  };
  CHECK(is_found(4.6));        // 52 grey values
  CHECK_FALSE(is_found(5.0));  // 48
}

TEST_CASE("A stronger edge more than a cell further out is not taken for one of the tag's") {
  // Black on paper of 120 grey values, which ends 14 px away on white.
  Square square;
  square.Paint([&](int x, int y) {
    const double beyond = std::max({kLow - x, x - square.High(), kLow - y, y - square.High()});
    if (beyond > 14.0) return 255.0;
    return 0.5 * (GreyAt(x, y, square.High(), square.High()) - kBlack) + kBlack;
  });
  const auto fitted = square.Fit();
  REQUIRE(fitted);
  CHECK(fitted->white_grey == Approx(120.0).margin(0.1));
  for (const Eigen::Vector2d& corner : fitted->pixels) {
    for (const double at : {corner.x(), corner.y()}) {
      CHECK(std::min(std::abs(at - kLow), std::abs(at - square.High())) < 0.05);
    }
  }
}

}  // namespace
}  // namespace rift::vision
