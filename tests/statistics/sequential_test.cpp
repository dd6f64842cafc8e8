#include "rift/statistics/sequential.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "rift/statistics/random.hpp"

namespace rift::statistics {
namespace {

constexpr double kAlpha = 0.05;
const double kNeeded = NeededEvidence(1, 1, kAlpha);

struct Stream {
  int trials = 0;
  bool is_above = false;
  bool is_below = false;
};

/// The evidence on one bound, computed once for each number of successes and trials.
class EvidenceOn {
 public:
  explicit EvidenceOn(double bound) : bound_(bound) {}
  const ShareEvidence& At(int successes, int trials) {
    const auto [at, is_new] = known_.try_emplace({successes, trials});
    if (is_new) at->second = EvidenceOnShare(successes, trials, bound_);
    return at->second;
  }

 private:
  double bound_;
  std::map<std::pair<int, int>, ShareEvidence> known_;
};

/// Looks after every trial and stops at the first that decides.
Stream Watch(Random& random, double share, EvidenceOn& evidence_on, int most) {
  Stream stream;
  int successes = 0;
  while (stream.trials < most && !stream.is_above && !stream.is_below) {
    ++stream.trials;
    successes += random.Uniform() < share;
    const ShareEvidence evidence = evidence_on.At(successes, stream.trials);
    stream.is_above = evidence.above >= kNeeded;
    stream.is_below = evidence.below >= kNeeded;
  }
  return stream;
}

double AtMost(int successes, int trials, double share) {
  double sum = 0.0;
  for (int k = 0; k <= successes; ++k) sum += BinomialPdf(trials, share, k);
  return sum;
}

/// The least n at which the exact test of a fixed number of trials shows the share to be below the
/// bound, with errors of at most 5 %, and misses it in at most 1 %.
int FixedTrials(double share, double bound) {
  if (share > bound) return FixedTrials(1.0 - share, 1.0 - bound);
  for (int n = 1;; ++n) {
    int most = -1;
    double sum = BinomialPdf(n, bound, 0);
    while (sum <= kAlpha) sum += BinomialPdf(n, bound, ++most + 1);
    if (most >= 0 && AtMost(most, n, share) >= 0.99) return n;
  }
}

struct Alarms {
  double above = 0.0;
  double below = 0.0;
};

/// The probability of each decision within `most` trials, watched after every one: exact, by the
/// distribution of the successes of the streams that go on.
Alarms AlarmsAt(double share, double bound, int most) {
  Alarms alarms;
  std::vector<double> going{1.0};  // by successes
  for (int n = 1; n <= most; ++n) {
    std::vector<double> next(going.size() + 1, 0.0);
    for (size_t k = 0; k < going.size(); ++k) {
      next[k] += (1.0 - share) * going[k];
      next[k + 1] += share * going[k];
    }
    for (size_t k = 0; k < next.size(); ++k) {
      if (next[k] < 1e-12) continue;
      const ShareEvidence evidence = EvidenceOnShare(static_cast<int>(k), n, bound);
      if (evidence.above < kNeeded && evidence.below < kNeeded) continue;
      (evidence.above >= kNeeded ? alarms.above : alarms.below) += next[k];
      next[k] = 0.0;
    }
    going = std::move(next);
  }
  return alarms;
}

TEST_CASE("Streams watched after every trial give a false alarm in at most 5 % of all cases") {
  for (const double bound : {0.05, 0.1, 0.3, 0.5}) {
    const Alarms alarms = AlarmsAt(bound, bound, 1000);
    CAPTURE(bound, alarms.above, alarms.below);
    CHECK(alarms.above <= 0.05);
    CHECK(alarms.below <= 0.05);
    CHECK(alarms.above + alarms.below >= 0.05);  // no evidence is given away
  }
  CHECK(AlarmsAt(0.05, 0.1, 1000).above <= 0.01);
  CHECK(AlarmsAt(0.2, 0.1, 1000).below <= 0.01);
}

TEST_CASE("Of 1000 streams on the wrong side at most 50 are false alarms") {
  for (const double bound : {0.1, 0.5}) {
    Random random(1, static_cast<std::uint64_t>(1000.0 * bound));
    EvidenceOn evidence(bound);
    int above = 0, below = 0;
    for (int i = 0; i < 1000; ++i) {
      above += Watch(random, 0.95 * bound, evidence, 1000).is_above;
      below += Watch(random, 1.05 * bound, evidence, 1000).is_below;
    }
    CAPTURE(bound, above, below);
    CHECK(above <= 50);
    CHECK(below <= 50);
  }
}

TEST_CASE("Streams end after 0.6 of the trials that a fixed number with equal errors needs") {
  struct Case {
    double bound, share;
  };
  for (const auto [bound, share] : {Case{0.1, 0.025},
                                    {0.1, 0.05},
                                    {0.1, 0.2},
                                    {0.1, 0.4},
                                    {0.2, 0.1},
                                    {0.2, 0.4},
                                    {0.5, 0.1},
                                    {0.5, 0.25}}) {
    Random random(2, static_cast<std::uint64_t>(1e6 * bound + 1e3 * share));
    EvidenceOn evidence(bound);
    int wrong = 0, open = 0;
    double trials = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const Stream stream = Watch(random, share, evidence, 5000);
      wrong += share > bound ? stream.is_below : stream.is_above;
      open += !stream.is_above && !stream.is_below;
      trials += stream.trials / 1000.0;
    }
    const int fixed = FixedTrials(share, bound);
    CAPTURE(bound, share, trials, wrong, open, fixed);
    CHECK(wrong + open <= 10);  // misses no more than the 1 % of the fixed number
    CHECK(trials <= 0.6 * fixed);
  }
}

TEST_CASE("The interval holds at every look in 95 % of streams on each side") {
  for (const double share : {0.02, 0.3, 0.9}) {
    Random random(3, static_cast<std::uint64_t>(100.0 * share));
    std::map<std::pair<int, int>, Interval> intervals;  // by successes and trials
    int missed_low = 0, missed_high = 0;
    for (int i = 0; i < 400; ++i) {
      int successes = 0;
      bool is_low_missed = false, is_high_missed = false;
      for (int n = 1; n <= 150; ++n) {
        successes += random.Uniform() < share;
        const auto [at, is_new] = intervals.try_emplace({successes, n});
        if (is_new) at->second = AnytimeInterval(successes, n, 0.95);
        const Interval& interval = at->second;
        is_low_missed = is_low_missed || interval.low > share;
        is_high_missed = is_high_missed || interval.high < share;
      }
      missed_low += is_low_missed;
      missed_high += is_high_missed;
    }
    CAPTURE(share, missed_low, missed_high);
    CHECK(missed_low <= 28);  // 20 expected at most; 28 has a probability of 3 %
    CHECK(missed_high <= 28);
  }
}

TEST_CASE("Evidence and interval say the same and an interval without trials says nothing") {
  for (int successes = 0; successes <= 12; ++successes) {
    const Interval interval = AnytimeInterval(successes, 12, 0.95);
    CHECK(interval.low <= successes / 12.0);
    CHECK(interval.high >= successes / 12.0);
    for (const double bound : {0.05, 0.1, 0.5, 0.8}) {
      const ShareEvidence evidence = EvidenceOnShare(successes, 12, bound);
      CHECK((evidence.above >= kNeeded) == (interval.low > bound));
      CHECK((evidence.below >= kNeeded) == (interval.high < bound));
    }
  }
  CHECK(AnytimeInterval(0, 0, 0.95).low == 0.0);
  CHECK(AnytimeInterval(0, 0, 0.95).high == 1.0);
  CHECK(EvidenceOnShare(0, 0, 0.1).above == Approx(0.0).margin(1e-12));
}

TEST_CASE("Evidence does not overflow however many trials agree") {
  const ShareEvidence all = EvidenceOnShare(2'000'000'000, 2'000'000'000, 0.1);
  CHECK(std::isfinite(all.above));
  CHECK(all.above > 1e9);
  CHECK(all.below < 0.0);
}

TEST_CASE("Evidence refuses counts and bounds that cannot be") {
  const std::string counts = "a share: successes must lie between 0 and the trials";
  for (const int wrong : {-1, 3}) {
    CHECK_THROWS_WITH(EvidenceOnShare(wrong, 2, 0.1), counts);
    CHECK_THROWS_WITH(AnytimeInterval(wrong, 2, 0.9), counts);
  }
  for (const double wrong : {-0.1, 0.0, 1.0, 1.1, std::nan("")}) {
    CHECK_THROWS_WITH(EvidenceOnShare(0, 2, wrong), "a share: the bound must lie between 0 and 1");
    CHECK_THROWS_WITH(AnytimeInterval(1, 2, wrong),
                      "a share: the confidence must lie between 0 and 1");
  }
}

TEST_CASE("Discoveries among many hypotheses need more evidence and less once there are several") {
  const auto log_e = [](double e) { return std::log(e); };
  CHECK(CountDiscoveries({log_e(20.1)}, 1, 0.05) == 1);
  CHECK(CountDiscoveries({log_e(19.9)}, 1, 0.05) == 0);
  CHECK(CountDiscoveries({log_e(199.0)}, 10, 0.05) == 0);
  CHECK(CountDiscoveries({log_e(201.0), log_e(99.0)}, 10, 0.05) == 1);
  CHECK(CountDiscoveries({log_e(101.0), log_e(1.0), log_e(101.0)}, 10, 0.05) == 2);
  CHECK(CountDiscoveries({}, 10, 0.05) == 0);
}

}  // namespace
}  // namespace rift::statistics
