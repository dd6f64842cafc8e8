#pragma once

#include <vector>

#include "rift/statistics/inference.hpp"

namespace rift::statistics {

/// How strongly trials speak about a share of successes, as natural logarithms of e-values: against
/// "at most the bound" and against "at least the bound".
struct ShareEvidence {
  double above = 0.0;
  double below = 0.0;
};

/// Evidence that may be looked at after every trial: where the share is at or below the bound,
/// `above` ever reaches log(1/alpha) with a probability of at most alpha, however long the trials
/// go on and whatever makes them end (Ville 1939); `below` likewise where it is at or above. Each
/// is a mixture of likelihood ratios (Robbins 1970) against shares whose odds are 2 to 100 times
/// those of the bound, most of the weight on the nearest. Throws std::invalid_argument unless 0 <=
/// successes <= trials and 0 < bound < 1.
ShareEvidence EvidenceOnShare(int successes, int trials, double bound);

/// The shares that the evidence does not exclude: the share is above `low` at every look with this
/// confidence, and below `high` at every look with the same. [0, 1] without a trial.
Interval AnytimeInterval(int successes, int trials, double confidence);

/// The evidence that each of `discoveries` among `hypotheses` needs, so that of all discoveries at
/// most a share of alpha is wrong on average: the e-BH rule of Wang and Ramdas 2022, which holds
/// for evidence that depends on each other, and, with a number of hypotheses fixed in advance, at
/// any time at which one stops.
double NeededEvidence(int hypotheses, int discoveries, double alpha);

/// The most discoveries of which each has the evidence that so many need.
int CountDiscoveries(std::vector<double> evidence, int hypotheses, double alpha);

}  // namespace rift::statistics
