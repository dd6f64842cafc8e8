#include "first_rows.hpp"

#include <algorithm>
#include <map>

namespace rift::sweep {

FirstRows FirstOfEachSetting(const SweepResult& result, const std::vector<int>& rows) {
  if (rows.empty()) return {};
  std::map<experiment::Theta, int> count_of, seen;
  for (const int row : rows) ++count_of[result.rows[row].theta];
  std::vector<int> counts;
  for (const auto& [theta, count] : count_of) counts.push_back(count);
  std::sort(counts.begin(), counts.end());
  const int most = (result.falsification ? 1 : 2) * counts[(counts.size() - 1) / 2];
  FirstRows first;
  for (const int row : rows) {
    if (++seen[result.rows[row].theta] <= most) first.rows.push_back(row);
  }
  if (first.rows.size() < rows.size()) first.most_of_setting = most;
  return first;
}

}  // namespace rift::sweep
