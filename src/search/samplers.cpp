#include "samplers.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace rift::search {
namespace {

/// Streams of the seed, so that no two samplers share their numbers.
enum Stream : std::uint64_t { kUniform = 1, kScramble, kStrata, kInside };

std::uint32_t Reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
  x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
  x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
  x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
  return (x >> 16) | (x << 16);
}

/// Nested uniform scrambling: each bit is flipped by a hash of the bits above it (Laine and Karras
/// 2011, constants of Burley 2020).
std::uint32_t OwenScrambled(std::uint32_t x, std::uint32_t seed) {
  x = Reversed(x);
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return Reversed(x);
}

}  // namespace

std::vector<Point> Sampler::Ask(int most) {
  std::vector<Point> points;
  for (int i = 0; i < most; ++i) points.push_back(Next());
  return points;
}

RandomSampler::RandomSampler(const Space& space, std::uint64_t seed)
    : Sampler(space), random_(seed, kUniform) {}

Point RandomSampler::Next() {
  Eigen::VectorXd unit(space_.Size());
  for (double& u : unit) u = random_.Uniform();
  return space_.FromUnit(unit);
}

SobolSequence::SobolSequence(int size, std::uint64_t seed)
    : engine_(static_cast<std::size_t>(size)) {
  statistics::Random random(seed, kScramble);
  for (int i = 0; i < size; ++i) {
    scrambles_.push_back(static_cast<std::uint32_t>(random.Below(1ULL << 32)));
  }
}

Eigen::VectorXd SobolSequence::Next() {
  Eigen::VectorXd unit(static_cast<Eigen::Index>(scrambles_.size()));
  for (std::size_t i = 0; i < scrambles_.size(); ++i) {
    const auto bits = static_cast<std::uint32_t>(engine_());
    unit[static_cast<Eigen::Index>(i)] = (OwenScrambled(bits, scrambles_[i]) + 0.5) * 0x1p-32;
  }
  return unit;
}

SobolSampler::SobolSampler(const Space& space, std::uint64_t seed)
    : Sampler(space), sequence_(space.Size(), seed) {}

Point SobolSampler::Next() { return space_.FromUnit(sequence_.Next()); }

LatinHypercubeSampler::LatinHypercubeSampler(const Space& space, std::uint64_t seed, int block)
    : Sampler(space), random_(seed, kStrata), used_(block) {
  std::vector<int> order(static_cast<std::size_t>(block));
  std::iota(order.begin(), order.end(), 0);
  strata_.assign(static_cast<std::size_t>(space.Size()), order);
}

void LatinHypercubeSampler::Shuffle() {
  for (std::vector<int>& order : strata_) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_.Below(i)]);
  }
  used_ = 0;
}

Point LatinHypercubeSampler::Next() {
  if (used_ == static_cast<int>(strata_.front().size())) Shuffle();
  Eigen::VectorXd unit(space_.Size());
  for (int i = 0; i < space_.Size(); ++i) {
    unit[i] = (strata_[i][used_] + random_.Uniform()) / static_cast<double>(strata_[i].size());
  }
  ++used_;
  return space_.FromUnit(unit);
}

CornerSampler::CornerSampler(const Space& space, std::uint64_t seed)
    : Sampler(space), corners_(space.Size(), seed), inside_(space.Size(), seed + kInside) {}

Point CornerSampler::Next() {
  constexpr int kTries = 256;
  for (int i = 0; i < kTries; ++i) {
    Eigen::VectorXd unit = corners_.Next();
    for (int axis = 0; axis < space_.Size(); ++axis) {
      if (!space_.IsCategorical(axis)) unit[axis] = unit[axis] < 0.5 ? 0.0 : 1.0;
    }
    const Point corner = space_.FromUnit(unit);
    if (seen_.Find(corner)) continue;
    seen_.Add({corner, 0.0});
    return corner;
  }
  return space_.FromUnit(inside_.Next());
}

}  // namespace rift::search
