#include "rift/yaml/load.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "rift/limits/limits.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/node.hpp"

namespace rift::yaml {
namespace {

/// Files that include each other twice at every level would double the work at every level.
constexpr int kMostFiles = 256;

class Loader {
 public:
  explicit Loader(const FileReader& read) : read_(read) {}

  /// `asked_at` starts the messages of a file that cannot be read.
  Node LoadFile(const std::string& path, const std::string& asked_at) {
    if (++files_ > kMostFiles) {
      throw Error(fmt::format("{}: more than {} files are included", asked_at, kMostFiles));
    }
    const std::string text = Read(path, asked_at);
    bytes_ += static_cast<double>(text.size());
    limits::Require(limits::Amount::kYamlBytes, bytes_, path);
    Node root = Parse(text, path);
    if (root.IsNull()) root.kind = Node::Kind::kMap;
    if (!root.IsMap()) {
      throw Error(fmt::format("{}: the file holds {}: must be keys with values (key: value)",
                              root.origin.Text(), Shown(root)));
    }
    chain_.push_back(path);
    Node whole = WithIncluded(std::move(root), path);
    chain_.pop_back();
    return whole;
  }

 private:
  std::string Read(const std::string& path, const std::string& asked_at) const {
    try {
      return read_(path);
    } catch (const std::exception& fault) {
      const std::string reason = fault.what();
      if (reason.find(path) != std::string::npos) {
        throw Error(fmt::format("{}: {}", asked_at, reason));
      }
      throw Error(fmt::format("{}: '{}' cannot be read: {}", asked_at, path, reason));
    }
  }

  Node WithIncluded(Node root, const std::string& path) {
    const auto found =
        std::find_if(root.entries.begin(), root.entries.end(),
                     [](const Node::Entry& entry) { return entry.key == "include"; });
    if (found == root.entries.end()) return root;
    const Node include = std::move(found->value);
    root.entries.erase(found);
    Node whole = Node::Map();
    whole.origin = root.origin;
    for (const Node& name : include.IsList() ? include.items : std::vector<Node>{include}) {
      Merge(whole, LoadIncluded(name, path));
    }
    Merge(whole, root);
    return whole;
  }

  Node LoadIncluded(const Node& name, const std::string& includer) {
    if (!name.IsScalar() || name.text.empty()) {
      Fail(name, "include", "must be the path of a YAML file, or a list of them");
    }
    const std::filesystem::path folder = std::filesystem::path(includer).parent_path();
    const std::string path = (folder / name.text).lexically_normal().string();
    const auto again = std::find(chain_.begin(), chain_.end(), path);
    if (again != chain_.end()) {
      throw Error(fmt::format("{}: files include each other: {} -> {}; remove one include",
                              name.origin.Text(), fmt::join(again, chain_.end(), " -> "), path));
    }
    return LoadFile(path, name.origin.Text());
  }

  const FileReader& read_;
  std::vector<std::string> chain_;
  int files_ = 0;
  double bytes_ = 0.0;  ///< of all files together: each byte takes its time
};

void SetOrigin(Node& node, const Origin& origin) {
  node.origin = origin;
  for (Node& item : node.items) SetOrigin(item, origin);
  for (Node::Entry& entry : node.entries) {
    entry.origin = origin;
    SetOrigin(entry.value, origin);
  }
}

}  // namespace

Node Load(const std::string& path, const FileReader& read) {
  return Loader(read).LoadFile(std::filesystem::path(path).lexically_normal().string(),
                               "configuration");
}

Node ParseOverride(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string key(assignment.substr(0, equals));
  if (equals == std::string_view::npos || SplitPath(key).empty()) {
    throw Error(
        fmt::format("--set '{}': must be key=value, as in --set gap.samples=500", assignment));
  }
  if (SplitPath(key).front() == "include") {
    throw Error(fmt::format(
        "--set '{}': include stands in a file, not in --set: write a file with include: "
        "[a.yaml, b.yaml] and give that",
        assignment));
  }
  const Origin origin{"--set " + key, 0, 0};
  Node value = Parse(assignment.substr(equals + 1), origin.source);
  SetOrigin(value, origin);
  Node root = Node::Map();
  root.origin = origin;
  AddAtPath(root, {key, origin, std::move(value), {}}, "");
  return root;
}

}  // namespace rift::yaml
