#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

/// What the libFuzzer targets have in common. A target ends the process when a rule is broken: that
/// is a finding, as a crash, a leak or undefined behaviour is.
namespace rift::fuzz {

inline void Require(bool is_so, std::string_view rule, std::string_view got = "") {
  if (is_so) return;
  std::fprintf(stderr, "broken: %.*s\n%.*s\n", static_cast<int>(rule.size()), rule.data(),
               static_cast<int>(got.size()), got.data());
  std::abort();
}

/// What people are told of bad input.
inline void RequireOneLine(std::string_view message) {
  Require(!message.empty() && message.find('\n') == message.npos, "an error is one line", message);
}

inline std::string_view TextOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Takes the text before the first `separator` off the front of `rest`; all of it when there is
/// none.
inline std::string_view TakeUntil(std::string_view& rest, char separator) {
  const std::string_view taken = rest.substr(0, rest.find(separator));
  rest.remove_prefix(taken.size() == rest.size() ? rest.size() : taken.size() + 1);
  return taken;
}

/// `sound` with bytes overwritten: each four bytes of `damage` are an offset (little endian, modulo
/// the length) and a byte. So that a fuzzer damages what has a checksum instead of guessing it.
inline std::string Overwritten(std::string sound, std::string_view damage) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(damage[at]); };
  for (std::size_t at = 0; at + 4 <= damage.size() && !sound.empty(); at += 4) {
    const std::size_t offset = byte(at) | byte(at + 1) << 8U | byte(at + 2) << 16U;
    sound[offset % sound.size()] = damage[at + 3];
  }
  return sound;
}

}  // namespace rift::fuzz
