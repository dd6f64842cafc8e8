#include "identification/planted.hpp"

#include <catch2/catch.hpp>

#include "rift/config/bind.hpp"
#include "rift/config/load.hpp"
#include "rift/config/tree.hpp"
#include "support/process.hpp"

namespace rift {
namespace {

test::GridStudy Robot() {
  const std::string configs = RIFT_SOURCE_DIR "/configs/";
  config::Node tree = config::Load(configs + "waypoints/paper.yaml", test::ReadFile);
  config::Merge(tree, config::Load(configs + "robots/3pi_2040.yaml", test::ReadFile));
  test::GridStudy study;
  config::Bind(tree, study);
  return study;
}

TEST_CASE("A planted mismatch is found again and a friction that never acts is flagged") {
  std::vector<test::Planted> planted = test::PlantAt(3);
  planted = {planted[1], planted[3]};
  sweep::CalibrationOptions options;
  options.runs = 0;
  options.iterations = 3;
  options.horizon.phases = 1;
  const sweep::Calibration found = test::FindPlanted(Robot(), planted, 3, 4, options, 1);
  const sweep::CalibratedParameter &mismatch = found.parameters[0],
                                   &unseen = found.parameters[1];
  INFO("mismatch " << mismatch.value << " in [" << mismatch.low << ", " << mismatch.high << "], "
                   << planted[0].truth << " was planted");
  CHECK(mismatch.low < planted[0].truth);
  CHECK(planted[0].truth < mismatch.high);
  CHECK(mismatch.is_identified);
  CHECK(mismatch.high - mismatch.low < 0.05);
  CHECK_FALSE(mismatch.is_at_bound);
  CHECK_FALSE(unseen.has_effect);
  CHECK_FALSE(unseen.is_identified);
  CHECK(unseen.value == planted[1].start);
  CHECK(found.loss_after < found.loss_before);
}

TEST_CASE("Threads change no byte of a calibration") {
  std::vector<test::Planted> planted = test::PlantAt(4);
  planted = {planted[1]};
  sweep::CalibrationOptions options;
  options.runs = 1;
  options.iterations = 1;
  options.horizon.phases = 1;
  const sweep::Calibration alone = test::FindPlanted(Robot(), planted, 4, 3, options, 1);
  const sweep::Calibration together = test::FindPlanted(Robot(), planted, 4, 3, options, 3);
  CHECK(alone.parameters[0].value == together.parameters[0].value);
  CHECK(alone.parameters[0].low == together.parameters[0].low);
  CHECK(alone.loss_after == together.loss_after);
}

}  // namespace
}  // namespace rift
