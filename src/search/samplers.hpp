#pragma once

#include <boost/random/sobol.hpp>
#include <cstdint>
#include <vector>

#include "archive.hpp"
#include "rift/search/strategy.hpp"
#include "rift/statistics/random.hpp"
#include "space.hpp"

namespace rift::search {

/// Strategies that learn nothing: points in a fixed sequence.
class Sampler : public Strategy {
 public:
  explicit Sampler(const Space& space) : space_(space) {}

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation>) override {}

 protected:
  const Space& space_;

 private:
  virtual Point Next() = 0;
};

/// Uniform and independent.
class RandomSampler : public Sampler {
 public:
  RandomSampler(const Space& space, std::uint64_t seed);

 private:
  Point Next() override;
  statistics::Random random_;
};

/// A scrambled Sobol sequence in the unit cube (Joe and Kuo's directions, as in Boost; Owen
/// scrambling by hashing, Burley 2020): every seed has another one, evenly spread at any length.
class SobolSequence {
 public:
  SobolSequence(int size, std::uint64_t seed);
  Eigen::VectorXd Next();

 private:
  boost::random::sobol_engine<std::uint32_t, 32> engine_;
  std::vector<std::uint32_t> scrambles_;  ///< one an axis
};

class SobolSampler : public Sampler {
 public:
  SobolSampler(const Space& space, std::uint64_t seed);

 private:
  Point Next() override;
  SobolSequence sequence_;
};

/// Latin hypercubes of `block` points, one after the other (McKay 1979).
class LatinHypercubeSampler : public Sampler {
 public:
  LatinHypercubeSampler(const Space& space, std::uint64_t seed, int block);

 private:
  Point Next() override;
  void Shuffle();

  statistics::Random random_;
  std::vector<std::vector<int>> strata_;  ///< of each axis, in the order of the points
  int used_;
};

/// Points with every numeric axis at one of its bounds and the categories anywhere: a Sobol
/// sequence drawn to the corners, so that few of many corners are still balanced. Once it meets
/// no new one any more, Sobol points.
class CornerSampler : public Sampler {
 public:
  CornerSampler(const Space& space, std::uint64_t seed);

 private:
  Point Next() override;
  SobolSequence corners_;
  SobolSequence inside_;
  Archive seen_;
};

}  // namespace rift::search
