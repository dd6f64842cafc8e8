#pragma once

#include <map>
#include <optional>
#include <string>

#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::test {

/// The text of files by their names.
using Files = std::map<std::string, std::string>;

/// What an evaluator reads, of `files`, which must outlive it; its warnings are dropped.
inline sweep::Inputs InputsOf(const Files& files) {
  return {[&files](const std::string& path) -> std::optional<std::string> {
            const auto found = files.find(path);
            return found == files.end() ? std::nullopt : std::optional(found->second);
          },
          [](const std::string&) {}};
}

}  // namespace rift::test
