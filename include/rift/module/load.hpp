#pragma once

#include <filesystem>
#include <string>

namespace rift::module {

/// Where a module lies relative to this program: lib/rift/ beside it (build tree) or beside its
/// folder (install tree).
std::filesystem::path PathOf(const std::string& file);

/// Opens a module for as long as the program runs and finds its one symbol. `needed_by` begins the
/// line for people when it is not there, such as "the camera needs". Throws std::runtime_error when
/// it is not there or does not fit.
void* Load(const std::filesystem::path& path, const char* symbol, const std::string& needed_by);

}  // namespace rift::module
