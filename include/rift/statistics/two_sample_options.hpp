#pragma once

namespace rift::statistics {

/// How a classifier is trained and tried that is to tell two samples apart.
struct TwoSampleOptions {
  double ridge = 1.0;
  int folds = 12;
  int permutations = 199;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("ridge", self.ridge, 1e-6, 1e6,
          "holds the weights of standardised features near zero: half this times their squares is "
          "added to the loss of the observations, of which each sample counts as many as the "
          "smaller one has");
    field(
        "folds", self.folds, 2, 1000,
        "parts into which settings are dealt; each is told by a classifier trained on the others");
    field("permutations", self.permutations, 0, 1'000'000,
          "times the labels are shuffled within each setting, for the p-value; 0: none");
  }
};

}  // namespace rift::statistics
