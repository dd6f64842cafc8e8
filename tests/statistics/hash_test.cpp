#include "rift/statistics/hash.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <vector>

namespace rift::statistics {
namespace {

TEST_CASE("Hashes are those of xxhsum") {
  CHECK(Hash64({}) == 0x2d06800538d394c2ULL);  // XXH3 of nothing with seed 0
  CHECK(Hash128Text("") == "99aa06d3014798d86001c324468d497f");
}

TEST_CASE("Lists that differ in one bit have different hashes") {
  std::set<std::uint64_t> hashes;
  std::vector<std::uint64_t> words(20, 0);
  for (std::uint64_t& word : words) {
    for (int bit = 0; bit < 64; ++bit) {
      word = 1ULL << bit;
      hashes.insert(Hash64(std::as_bytes(std::span(words))));
    }
    word = 0;
  }
  CHECK(hashes.size() == 20 * 64);
}

}  // namespace
}  // namespace rift::statistics
