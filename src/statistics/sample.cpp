#include "rift/statistics/sample.hpp"

#include <algorithm>

#include "rift/statistics/random.hpp"

namespace rift::statistics {

std::vector<std::size_t> SampleInOrder(std::size_t count, std::size_t most) {
  const CounterRandom random(0, 0);
  std::size_t wanted = std::min(count, most);
  std::vector<std::size_t> places;
  places.reserve(wanted);
  for (std::size_t i = 0; wanted > 0; ++i) {
    const auto left = static_cast<double>(count - i);
    if (left * random.Uniform(i, 0) >= static_cast<double>(wanted)) continue;
    places.push_back(i);
    --wanted;
  }
  return places;
}

}  // namespace rift::statistics
