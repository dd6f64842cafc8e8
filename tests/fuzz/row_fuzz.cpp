// A row of the journal: behind a first byte D damage to a sound one, else the row itself.
#include <stdexcept>

#include "fuzz.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift {
namespace {

std::string SoundRow() {
  sweep::TrialRow row{.trial = "1", .seed = 7};
  row.candidate = "simulation with seed 7";
  row.reference = "path";
  row.reason = "reached";
  row.comparison.gap_m = 0.04;
  for (int k = 0; k < 4; ++k) row.evidence.errors_m.emplace_back(0.01 * k, 0.02);
  for (int k = 0; k < 4; ++k) row.evidence.path_m.emplace_back(0.01F, 0.02F);
  return sweep::EncodeFindings(row);
}

}  // namespace
}  // namespace rift

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  static const std::string sound = SoundRow();
  const std::string_view text = fuzz::TextOf(data, size);
  const bool is_damage = text.starts_with('D');
  const std::string bytes =
      is_damage ? fuzz::Overwritten(sound, text.substr(1)) : std::string(text);
  sweep::TrialRow row;
  try {
    sweep::DecodeFindings(bytes, row);
  } catch (const std::runtime_error& error) {
    fuzz::RequireOneLine(error.what());
    return 0;
  }
  fuzz::Require(static_cast<std::size_t>(row.status) < EnumNames(sweep::TrialStatus{}).size(),
                "a status is one that there is");
  sweep::EncodeFindings(row);
  return 0;
}
