#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rift::yaml {

/// Everything that can be wrong with a configuration, as one line:
/// `file:line:column: key 'control.v_min' is 1.7: must be in [0, 1]; ...`.
class Error : public std::runtime_error {
 public:
  /// Control characters of the message are escaped, so that it is one line whatever it quotes.
  explicit Error(std::string_view message);
};

/// Where a value was written. Line and column count from 1 (columns in bytes); line 0 means that
/// `source` says it all (`--set gap.samples`, or empty for a value made by the program).
struct Origin {
  std::string source;
  int line = 0;
  int column = 0;

  /// `file:line:column`, or `source` alone when there is no line.
  std::string Text() const;
};

/// One value of a configuration: nothing, a scalar as written, a list, or a map in file order.
struct Node {
  enum class Kind { kNull, kScalar, kList, kMap };
  struct Entry;

  Kind kind = Kind::kNull;
  Origin origin;
  std::string text;            ///< of a scalar, without its quotes
  bool quoted = false;         ///< a quoted scalar is text, even when it reads like a number
  std::vector<Node> items;     ///< of a list
  std::vector<Entry> entries;  ///< of a map; keys are unique

  static Node Scalar(std::string plain_text);
  /// A scalar that stays text whatever it looks like.
  static Node Text(std::string text);
  static Node List();
  static Node List(std::vector<Node> items);
  static Node Map();

  bool IsNull() const { return kind == Kind::kNull; }
  bool IsScalar() const { return kind == Kind::kScalar; }
  bool IsList() const { return kind == Kind::kList; }
  bool IsMap() const { return kind == Kind::kMap; }

  /// The entry of a map, nullptr when there is none (or this is no map).
  const Entry* Find(std::string_view key) const;
  Entry* Find(std::string_view key);
  /// Appends an entry whose key was written where its value was.
  void Add(std::string key, Node value);
};

struct Node::Entry {
  std::string key;
  Origin origin;  ///< of the key
  Node value;
  std::string comment;  ///< written after the key or value by Emit; one line
};

/// The value as messages show it: one line, cut when long, quoted when it was.
std::string Shown(const Node& node);

/// Throws Error: `origin: key 'key' is <value>: rule`.
[[noreturn]] void Fail(const Node& node, std::string_view key, std::string_view rule);

/// `path.key`, or `key` when the path is empty.
std::string Join(std::string_view path, std::string_view key);

/// Lays `over` over `base`: maps merge key by key at every level; anything else replaces. A block
/// keeps the origin of its first writer, each value that of its last.
void Merge(Node& base, const Node& over);

/// A map whose keys are all among min, max, scale, integer, values, settable and step: an axis of a
/// parameter space, not a block of further names.
bool IsAxis(const Node& node);

struct FlatEntry {
  std::string key;  ///< dotted
  Origin origin;    ///< of the last part of the key
  const Node* value = nullptr;
};

/// The leaves of a map under their dotted keys, in order, so that `space: {control: {v_min: ..}}`,
/// `space: {control.v_min: ..}` and `--set space.control.v_min=..` are one thing. A map is opened
/// unless it is empty or `is_leaf` says that it is a value. The entries point into `map`.
/// Throws Error when two ways of writing a key meet.
std::vector<FlatEntry> Flatten(const Node& map,
                               const std::function<bool(const Node&)>& is_leaf = IsAxis);

/// Opens keys with dots into nested maps, the inverse of Flatten: `{a.b: 1}` -> `{a: {b: 1}}`.
/// Throws Error when two ways of writing a key meet.
Node ExpandDottedKeys(const Node& map);

}  // namespace rift::yaml
