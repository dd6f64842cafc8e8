#pragma once

#include <set>
#include <string>
#include <vector>

namespace rift::test {

/// The names in the first column of the first table below `## HEADING` of docs/FILE, in order:
/// columns of a CSV file, keys of a JSON document. Throws std::runtime_error when there is none.
std::vector<std::string> Documented(const std::string& file, const std::string& heading);

/// The keys of the JSON document below that heading of docs/json.md.
std::set<std::string> DocumentedKeys(const std::string& heading);

/// The top-level keys of a JSON object.
template <class Json>
std::set<std::string> KeysOf(const Json& document) {
  std::set<std::string> keys;
  for (const auto& [key, value] : document.items()) keys.insert(key);
  return keys;
}

/// The header of a CSV text.
std::vector<std::string> Columns(const std::string& csv);

/// The rows of the table in docs/rooms.md: room, what it holds, what it may include.
struct DocumentedRoom {
  std::string name;
  std::string may_include;
};
std::vector<DocumentedRoom> DocumentedRooms();

}  // namespace rift::test
