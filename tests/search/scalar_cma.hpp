#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace rift::search {

/// Hansen 2016 for one axis, where matrices are numbers.
struct ScalarCma {
  double mean, sigma, covariance = 1.0, length = 1.0, path_sigma = 0.0, path_c = 0.0;
  double growth = 1.0;  ///< of the step size in the last generation, before it is cut
  int generation = 0;
  std::vector<double> weights;
  double mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, chi;

  ScalarCma(double start, double step, int population) : mean(start), sigma(step) {
    const int parents = population / 2;
    double sum = 0.0, squares = 0.0;
    for (int i = 1; i <= parents; ++i) {
      weights.push_back(std::log(0.5 * (population + 1)) - std::log(i));
    }
    for (const double w : weights) sum += w;
    for (double& w : weights) w /= sum, squares += w * w;
    mu_eff = 1.0 / squares;
    c_sigma = (mu_eff + 2.0) / (1.0 + mu_eff + 5.0);
    d_sigma = 1.0 + 2.0 * std::max(0.0, std::sqrt((mu_eff - 1.0) / 2.0) - 1.0) + c_sigma;
    c_c = (4.0 + mu_eff) / (5.0 + 2.0 * mu_eff);
    c_1 = 2.0 / (2.3 * 2.3 + mu_eff);
    c_mu = std::min(1.0 - c_1, 2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / (9.0 + mu_eff));
    chi = 1.0 - 0.25 + 1.0 / 21.0;
  }
  void Learn(const std::vector<double>& best_first) {
    double step = 0.0, moved = 0.0, rank_mu = 0.0;
    for (size_t i = 0; i < weights.size(); ++i) {
      const double y = (best_first[i] - mean) / sigma;
      step += weights[i] * y;
      moved += weights[i] * best_first[i];
      rank_mu += weights[i] * y * y;
    }
    mean = moved;
    path_sigma = (1.0 - c_sigma) * path_sigma +
                 std::sqrt(c_sigma * (2.0 - c_sigma) * mu_eff) * step / length;
    const double settled = std::sqrt(1.0 - std::pow(1.0 - c_sigma, 2.0 * (generation + 1)));
    const bool is_steady = std::abs(path_sigma) / settled < (1.4 + 1.0) * chi;
    path_c *= 1.0 - c_c;
    if (is_steady) path_c += std::sqrt(c_c * (2.0 - c_c) * mu_eff) * step;
    covariance = (1.0 - c_1 - c_mu + (is_steady ? 0.0 : c_1 * c_c * (2.0 - c_c))) * covariance +
                 c_1 * path_c * path_c + c_mu * rank_mu;
    growth = c_sigma / d_sigma * (std::abs(path_sigma) / chi - 1.0);
    sigma *= std::exp(std::min(1.0, growth));
    sigma = std::min(sigma, 1.0);
    if (generation > 0) length = std::sqrt(covariance);  // as often as Hansen's B.2 says
    ++generation;
  }
};

}  // namespace rift::search
