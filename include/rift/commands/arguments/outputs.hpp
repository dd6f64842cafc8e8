#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "rift/files/outputs.hpp"

namespace rift::commands {

using files::CheckOutputs;
using files::Outputs;
using files::RequireFolderName;

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

/// `--force`, for every command that writes files.
void AddForceFlag(CLI::App& app, bool& force);

/// A run in the folder of a sweep would replace what its rows are made again from: throws
/// std::invalid_argument.
void RefuseSweepFolder(const std::filesystem::path& folder);

/// A sweep in the folder of a run would leave two experiments in one: throws std::invalid_argument.
void RefuseRunFolder(const std::filesystem::path& folder);

}  // namespace rift::commands
