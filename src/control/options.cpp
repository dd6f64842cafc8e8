#include "rift/control/options.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace rift::control {
namespace {

void CheckOrder(std::string_view low_name, double low, std::string_view high_name, double high) {
  if (low <= high) return;
  throw std::invalid_argument(fmt::format("{} is {}, and it must not exceed {}, which is {}",
                                          low_name, low, high_name, high));
}

// Fields() holds the ranges; options made in code have not been through the schema.
struct RangeCheck {
  template <class Range>
  void operator()(std::string_view key, const double& value, Range low, Range high,
                  std::string_view) const {
    if (value >= low && value <= high) return;
    throw std::invalid_argument(
        fmt::format("{} is {}, and it must lie in [{}, {}]", key, value, low, high));
  }
  template <class Range>
  void operator()(std::string_view key, const std::optional<double>& value, Range low, Range high,
                  std::string_view help) const {
    if (value) (*this)(key, *value, low, high, help);
  }
  void operator()(std::string_view, const bool&, std::string_view) const {}
  template <class Nested>
  void operator()(std::string_view, const Nested& nested, std::string_view) const {
    Nested::Fields(nested, *this);
  }
};

}  // namespace

void NavigatorOptions::Check() const {
  Fields(*this, RangeCheck{});
  CheckOrder("v_min", v_min, "v_max", v_max);
  CheckOrder("w_min", w_min, "w_max", w_max);
  CheckOrder("v_min", v_min, "cruise_speed", CruiseSpeed());
  CheckOrder("cruise_speed", CruiseSpeed(), "v_max", v_max);
  CheckOrder("dt_min_s", dt_min_s, "dt_max_s", dt_max_s);
}

}  // namespace rift::control
