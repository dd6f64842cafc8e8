#pragma once

#include <string>
#include <vector>

namespace rift::trajectory {

/// "pose.pose.position.x" and "posePositionX [mm]" in lower-case words.
std::vector<std::string> WordsOf(const std::string& name);

/// Whether a word is a position's.
bool IsX(const std::string& word);
bool IsY(const std::string& word);

/// Of the words of a name, of which there is one at least.
bool IsRotation(const std::vector<std::string>& words);
/// A change of what it is named after, or how certain that is.
bool IsRate(const std::vector<std::string>& words);

/// A column by its name.
struct NamedColumn {
  std::string name;
  std::string quantity;  ///< one of a pose or `nanosec`; empty: none
  std::string unit;      ///< where its name tells one
  int rank = 0;          ///< of several that may be one quantity the lowest is taken
};
NamedColumn NamedColumnOf(const std::string& name);

}  // namespace rift::trajectory
