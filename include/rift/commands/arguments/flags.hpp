#pragma once

#include <string>
#include <vector>

#include "rift/flags/flags.hpp"

namespace rift::commands {

using flags::AddFlags;
using flags::FlagMaker;
using flags::InRange;

/// `--set KEY=VALUE`, as often as one likes; `example` is one, such as control.v_min=0.2.
CLI::Option* AddSetFlag(CLI::App& app, std::vector<std::string>& overrides, const char* example);

/// `--keys`: lists every key that an experiment can have, and ends.
void AddKeysFlag(CLI::App& app);

}  // namespace rift::commands
