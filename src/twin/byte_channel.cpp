#include "rift/twin/byte_channel.hpp"

#include <algorithm>

namespace rift::twin {
namespace {

constexpr double kBitsPerByte = 10.0;  // 8N1: start, eight bits, stop

}  // namespace

void ByteChannel::Put(double at_s, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const double byte_s = options_.baud > 0.0 ? kBitsPerByte / options_.baud : 0.0;
  const bool is_lost = Happens(options_.line_loss);
  free_s_ = std::max(at_s + options_.delay_s, free_s_);
  for (const std::uint8_t value : bytes) {
    free_s_ += byte_s;
    if (is_lost || Happens(options_.byte_loss)) continue;
    on_the_way_.push_back({free_s_, value});
  }
}

std::vector<std::uint8_t> ByteChannel::Take(double now_s) {
  std::vector<std::uint8_t> arrived;
  while (!on_the_way_.empty() && on_the_way_.front().arrives_s <= now_s) {
    arrived.push_back(on_the_way_.front().value);
    on_the_way_.pop_front();
  }
  return arrived;
}

}  // namespace rift::twin
