#pragma once

#include <CLI/CLI.hpp>

#include "request.hpp"

namespace rift::commands {

/// The flags of `rift sweep`; `request` must outlive the app.
void AddSweepFlags(CLI::App& app, SweepRequest& request);

}  // namespace rift::commands
