#include "domain.hpp"

#include <cstdint>
#include <utility>

#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

constexpr std::uint64_t kMiddleStream = 112;
constexpr int kTried = 32;       // places; the mean of those within is the middle
constexpr int kBisections = 24;  // to 1e-7 of a range

}  // namespace

Domain::Domain(Contained contained, const Eigen::VectorXd& start)
    : contained_(std::move(contained)), middle_(start) {
  if (!contained_) return;
  const statistics::CounterRandom random(1, kMiddleStream);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(start.size());
  int found = 0;
  for (int i = 0; i < kTried; ++i) {
    Eigen::VectorXd shares(start.size());
    for (Eigen::Index k = 0; k < shares.size(); ++k) {
      shares[k] = random.Uniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
    }
    if (!Contains(shares)) continue;
    sum += shares;
    ++found;
  }
  if (found > 0 && Contains(sum / found)) middle_ = sum / found;
}

Eigen::VectorXd Domain::Nearest(const Eigen::VectorXd& shares) const {
  if (Contains(shares)) return shares;
  double within = 0.0, beyond = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double share = 0.5 * (within + beyond);
    (Contains(middle_ + share * (shares - middle_)) ? within : beyond) = share;
  }
  return middle_ + within * (shares - middle_);
}

}  // namespace rift::sweep
