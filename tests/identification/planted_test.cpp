#include "identification/planted.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift {
namespace {

TEST_CASE("A planted mismatch is found again and a friction that never acts is flagged") {
  std::vector<test::Planted> planted = test::PlantAt(3);
  planted = {planted[1], planted[3]};
  sweep::CalibrationOptions options;
  options.runs = 0;
  options.iterations = 3;
  options.horizon.phases = 2;
  options.simulated_logs = 6;
  const sweep::Calibration found =
      test::FindPlanted(test::LoadGridStudy(), planted, 3, 5, options, 2);
  const sweep::CalibratedParameter &mismatch = found.parameters[0], &unseen = found.parameters[1];
  INFO("mismatch " << mismatch.value << " in [" << mismatch.low << ", " << mismatch.high << "], "
                   << planted[0].truth << " was planted");
  CHECK(mismatch.low < planted[0].truth);
  CHECK(planted[0].truth < mismatch.high);
  CHECK(mismatch.high - mismatch.low < 0.15);
  CHECK_FALSE(mismatch.is_at_bound);
  CHECK_FALSE(unseen.has_effect);
  CHECK_FALSE(unseen.is_identified);
  CHECK(unseen.value == Approx(planted[1].start));
  CHECK(found.loss_after < found.loss_before);
}

TEST_CASE("A planted radio delay is found from below and from above") {
  for (const double start : {0.05, 0.17}) {
    std::vector<test::Planted> planted = {test::PlantAt(5)[0]};
    planted[0].start = start;
    sweep::CalibrationOptions options;
    options.runs = 0;
    options.horizon.phases = 3;
    options.corrections = 0;
    const sweep::Calibration found =
        test::FindPlanted(test::LoadGridStudy(), planted, 5, 8, options, 2);
    const sweep::CalibratedParameter& delay = found.parameters[0];
    INFO("from " << start << ": " << delay.value << " in [" << delay.low << ", " << delay.high
                 << "], " << planted[0].truth << " was planted");
    // A replay takes each pose for as old as poses are on average; they differ by a frame, 33 ms.
    CHECK(delay.value == Approx(planted[0].truth).margin(0.025));
    CHECK(found.has_converged);
  }
}

TEST_CASE("A calibration without a simulated log of the fit is the least error and says less") {
  std::vector<test::Planted> planted = {test::PlantAt(6)[1]};
  sweep::CalibrationOptions options;
  options.runs = 0;
  options.iterations = 2;
  options.horizon.phases = 2;
  options.simulated_logs = 3;
  const sweep::Calibration corrected =
      test::FindPlanted(test::LoadGridStudy(), planted, 6, 3, options, 2);
  options.corrections = 0;
  const sweep::Calibration least =
      test::FindPlanted(test::LoadGridStudy(), planted, 6, 3, options, 2);
  CHECK(least.trials_simulated < corrected.trials_simulated);
  CHECK(least.parameters[0].value != corrected.parameters[0].value);
  // What simulated logs tell scatters too.
  CHECK(least.parameters[0].high - least.parameters[0].low <
        corrected.parameters[0].high - corrected.parameters[0].low);
}

TEST_CASE("Whole drives tell a tracker's scatter and a pull, and nothing of what never acts") {
  std::vector<test::Planted> planted = test::PlantAt(1);
  planted = {{"simulation.terrain.surfaces.parchment.tracker_noise", 0.2, 3.0, 0.8, 1.8},
             planted[1],
             {"simulation.terrain.surfaces.parchment.unevenness", 0.0, 0.16, 0.03, 0.09},
             planted[3]};
  sweep::CalibrationOptions options;
  options.runs = 0;
  options.iterations = 4;
  options.corrections = 0;
  options.horizon.phases = 2;
  options.features = {.rounds = 2, .draws = 200};
  const sweep::Calibration found =
      test::FindPlanted(test::LoadGridStudy(), planted, 1, 10, options, 2);
  for (size_t i = 0; i < 3; ++i) {
    const sweep::CalibratedParameter& one = found.parameters[i];
    INFO(planted[i].key << ": " << one.value << " in [" << one.low << ", " << one.high << "], "
                        << planted[i].truth << " was planted");
    CHECK(one.low < planted[i].truth);
    CHECK(planted[i].truth < one.high);
    CHECK_FALSE(one.is_from_prior);
    // Ten drives on uneven ground are hardly like others: what is open is said to be.
    const double share = (one.high - one.low) / (planted[i].max - planted[i].min);
    CHECK((i == 2 ? share > 0.4 : share < 0.7));
  }
  CHECK_FALSE(found.parameters[2].is_identified);
  const sweep::CalibratedParameter& unseen = found.parameters[3];
  CHECK_FALSE(unseen.has_effect);
  CHECK(unseen.value == Approx(planted[3].start));
  CHECK(std::isnan(found.correlation(3, 0)));
  CHECK(std::abs(found.correlation(1, 0)) < 1.0);
  CHECK(found.loss_after < found.loss_before);
}

TEST_CASE("Threads change no byte of a fit by features") {
  std::vector<test::Planted> planted = {test::PlantAt(4)[1]};
  sweep::CalibrationOptions options;
  options.runs = 0;
  options.iterations = 1;
  options.corrections = 0;
  options.horizon.phases = 1;
  options.features = {.rounds = 1, .draws = 8};
  const sweep::Calibration alone =
      test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 1);
  const sweep::Calibration together =
      test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 3);
  CHECK(alone.parameters[0].value == together.parameters[0].value);
  CHECK(alone.parameters[0].high == together.parameters[0].high);
  CHECK(alone.loss_before == together.loss_before);
  options.features.rounds = 0;
  const sweep::Calibration by_motions =
      test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 2);
  CHECK(alone.parameters[0].value != by_motions.parameters[0].value);
  CHECK(alone.trials_simulated == by_motions.trials_simulated + 3 * (2 + 8 + 2 * 8));
  options.features = {.rounds = 1, .draws = 5};
  CHECK_THROWS_WITH(test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 2),
                    Catch::Contains("draws is 5, and 1 parameters that act need 6 or more"));
}

TEST_CASE("Threads change no byte of a calibration") {
  std::vector<test::Planted> planted = test::PlantAt(4);
  planted = {planted[1]};
  sweep::CalibrationOptions options;
  options.runs = 1;
  options.iterations = 1;
  options.horizon.phases = 1;
  options.simulated_logs = 3;
  options.corrections = 1;
  const sweep::Calibration alone =
      test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 1);
  const sweep::Calibration together =
      test::FindPlanted(test::LoadGridStudy(), planted, 4, 3, options, 3);
  CHECK(alone.parameters[0].value == together.parameters[0].value);
  CHECK(alone.parameters[0].low == together.parameters[0].low);
  CHECK(alone.loss_after == together.loss_after);
}

}  // namespace
}  // namespace rift
