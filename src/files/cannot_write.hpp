#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace rift::files {

[[noreturn]] inline void CannotWrite(const std::filesystem::path& path, int reason = errno) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), strerror(reason)));
}

}  // namespace rift::files
