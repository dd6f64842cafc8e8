#include "number.hpp"

#include <fast_float/fast_float.h>

#include <cmath>

namespace rift::trajectory::csv {

std::from_chars_result FromChars(const char* begin, const char* end, double& value) {
  double read = 0.0;
  const auto [stop, error] = fast_float::from_chars(begin, end, read);
  // The edges of the range are told in another way: the standard has the last word there.
  const bool is_plain = error == std::errc{} && std::isfinite(read) && read != 0.0;
  if (!is_plain) return std::from_chars(begin, end, value);
  value = read;
  return {stop, error};
}

}  // namespace rift::trajectory::csv
