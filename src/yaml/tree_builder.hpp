#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Builds our tree from yaml-cpp's events. Its own YAML::Node would lose what a strict reader
/// needs: duplicate keys, where keys stand, which scalars were quoted.
class TreeBuilder : public YAML::EventHandler {
 public:
  /// `text` is what yaml-cpp reads; it must outlive the builder.
  TreeBuilder(std::string_view text, std::string source)
      : text_(text), source_(std::move(source)) {}

  Node Take() { return std::move(root_); }
  Origin At(const YAML::Mark& mark) const;

  void OnDocumentStart(const YAML::Mark& mark) override;
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override;
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override;
  void OnMapEnd() override;

 private:
  /// A list or map that is still open.
  struct Frame {
    Node node;
    bool has_key = false;  ///< of a map: a key waits for its value
    Node key;
    std::vector<Node> keys;  ///< of a map: one for each of node.items, until it is closed
  };

  void Open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor);
  void Close();
  void Deliver(Node value);
  void TakeKey(Frame& frame, Node key);
  void CheckPlain(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) const;
  std::string Path() const;

  std::string_view text_;
  std::string source_;
  std::vector<Frame> open_;
  Node root_;
  bool has_document_ = false;
};

}  // namespace rift::yaml
