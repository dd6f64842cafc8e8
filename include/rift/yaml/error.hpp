#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace rift::yaml {

/// Everything that can be wrong with a configuration, as one line:
/// `file:line:column: key 'control.v_min' is 1.7: must be in [0, 1]; ...`.
class Error : public std::runtime_error {
 public:
  /// Control characters of the message are escaped, so that it is one line whatever it quotes.
  explicit Error(std::string_view message);
};

}  // namespace rift::yaml
