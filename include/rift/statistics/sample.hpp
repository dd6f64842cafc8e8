#pragma once

#include <cstddef>
#include <vector>

namespace rift::statistics {

/// Which `most` of `count` places to look at where all are too many, in their order; all of them
/// where they are not. Drawn without replacement by a fixed seed (Knuth, The Art of Computer
/// Programming 2, 3.4.2, algorithm S), since every n-th row of a grid misses whole levels.
std::vector<std::size_t> SampleInOrder(std::size_t count, std::size_t most);

}  // namespace rift::statistics
