#pragma once

#include <string>
#include <string_view>

namespace rift::yaml {

/// Text as YAML, plain when every reader will take it for the same text (so not `true`, `1.0`,
/// `2024-01-01`, ``), else in double quotes. Throws Error when it is not UTF-8.
std::string QuotedWhenText(std::string_view text);

/// A scalar that was plain, as it was unless it holds what a plain scalar cannot.
std::string QuotedWhenUnsafe(std::string_view text);

/// A key: as text, and quoted when it has dots, which a plain key would open into nested maps.
std::string KeyText(std::string_view key);

}  // namespace rift::yaml
