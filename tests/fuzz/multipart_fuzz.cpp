// What an http camera sends: a first line with its Content-Type, then the body.
#include <stdexcept>
#include <vector>

#include "fuzz.hpp"
#include "vision/camera/sources.hpp"

namespace rift {
namespace {

constexpr std::size_t kMostBytes = 4096;

using Parts = std::vector<std::vector<std::uint8_t>>;

/// The parts of a body that comes in pieces of `piece` bytes; nothing when it is refused.
std::optional<Parts> PartsOf(std::string_view type, std::string_view body, std::size_t piece) {
  try {
    vision::MultipartReader reader(type, kMostBytes);
    Parts parts;
    for (std::size_t at = 0; at < body.size(); at += piece) {
      reader.Feed(body.substr(at, piece));
      while (auto part = reader.Take()) {
        fuzz::Require(part->size() <= kMostBytes, "a part is no longer than the limit");
        parts.push_back(std::move(*part));
      }
    }
    return parts;
  } catch (const std::invalid_argument&) {
  } catch (const std::runtime_error&) {
  }
  return std::nullopt;
}

}  // namespace
}  // namespace rift

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  std::string_view body = fuzz::TextOf(data, size);
  const std::string_view type = fuzz::TakeUntil(body, '\n');
  const auto whole = PartsOf(type, body, body.size() + 1);
  for (const std::size_t piece : {1U, 7U, 100U}) {
    const auto pieces = PartsOf(type, body, piece);
    // Beyond the limit it depends on what has come when something is passed over.
    if (body.size() <= kMostBytes) {
      fuzz::Require(pieces == whole, "parts do not depend on how the bytes came");
    }
  }
  return 0;
}
