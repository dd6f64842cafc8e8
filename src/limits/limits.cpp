#include "rift/limits/limits.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <stdexcept>

namespace rift::limits {
namespace {

struct Limit {
  double most;
  const char* unit;
};

// In the order of Amount; docs/limits.md says what each costs.
constexpr std::array<Limit, 8> kLimits{{{256.0 * 1024 * 1024, "bytes"},
                                        {1.0 * 1024 * 1024, "bytes of YAML"},
                                        {4096.0 * 4096.0, "pixels"},
                                        {2e6, "rows"},
                                        {10'000, "columns"},
                                        {1e6, "samples"},
                                        {10'000, "waypoints"},
                                        {1e6, "trials of a grid"}}};

std::atomic<bool> is_lifted = false;

const Limit& LimitOf(Amount amount) { return kLimits.at(static_cast<size_t>(amount)); }

}  // namespace

double Most(Amount amount) { return LimitOf(amount).most; }

void Require(Amount amount, double count, std::string_view where) {
  const Limit& limit = LimitOf(amount);
  if (count <= limit.most || is_lifted) return;
  throw std::invalid_argument(
      fmt::format("{}: {:.0f} {}: at most {:.0f} are taken; --large-inputs lifts this limit", where,
                  count, limit.unit, limit.most));
}

void Lift() { is_lifted = true; }

}  // namespace rift::limits
