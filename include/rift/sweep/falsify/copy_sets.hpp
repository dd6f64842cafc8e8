#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace rift::sweep {

/// Which of so many things are copies of one another, as sets that grow together.
class CopySets {
 public:
  explicit CopySets(size_t things) : first_(things) {
    std::iota(first_.begin(), first_.end(), size_t{0});
  }

  size_t FirstOf(size_t thing) {
    while (first_[thing] != thing) thing = first_[thing] = first_[first_[thing]];
    return thing;
  }
  bool IsFirst(size_t thing) { return FirstOf(thing) == thing; }
  void Join(size_t a, size_t b) {
    a = FirstOf(a);
    b = FirstOf(b);
    first_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<size_t> first_;
};

}  // namespace rift::sweep
