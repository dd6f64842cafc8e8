#pragma once

#include <string>

#include "rift/sweep/explain/sweep_change.hpp"

namespace rift::report {

/// Whether it became better, in one sentence: "309 of 960 trials failed, 12 of 960 do now: better".
std::string ChangeSentence(const sweep::SweepChange& change);

/// "-0.0120 m (-0.0200 to -0.0040)"; "-" where it is not known.
std::string GapChangeText(const sweep::SettingChange& change);

/// The sentence, the keys that differ, and a line for each setting.
std::string ChangeText(const sweep::SweepChange& change);

}  // namespace rift::report
