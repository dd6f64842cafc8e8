#pragma once

#include <string>
#include <vector>

namespace rift::experiment {

/// What is not known for sure of the simulated robot: draws from the posterior of a fit. Each draw
/// has a value for every key, in their order; a simulated run takes one of them, by its seed.
struct Ensemble {
  std::vector<std::string> keys;
  std::vector<std::vector<double>> draws;

  bool IsEmpty() const { return keys.empty(); }

  /// Calls field(key, member, help) for every member.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("keys", self.keys,
          "keys of simulation or trial whose values differ from run to run; one that is set in "
          "another file, with --set or by the space keeps that value");
    field("draws", self.draws, "lists of their values, one list a draw");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

}  // namespace rift::experiment
