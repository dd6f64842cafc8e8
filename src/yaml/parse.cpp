#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "rift/yaml/error.hpp"
#include "rift/yaml/load.hpp"
#include "text_check.hpp"
#include "tree_builder.hpp"

namespace rift::yaml {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// yaml-cpp's usual complaint about `path: {surface}/x.csv` does not name the cure.
std::string QuoteHint(std::string_view text, int line) {
  for (int i = 0; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  const bool has_bracket = text.substr(0, text.find('\n')).find_first_of("{[") != text.npos;
  return has_bracket ? "; text that starts with { or [ needs quotes" : "";
}

}  // namespace

Node Parse(std::string_view text, const std::string& source) {
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  CheckText(text, source);
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(text, source);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& fault) {
    const bool placed = !fault.mark.is_null();
    const Origin at = placed ? builder.At(fault.mark) : Origin{source, 1, 1};
    throw Error(fmt::format("{}: {}{}", at.Text(), fault.msg,
                            placed ? QuoteHint(text, fault.mark.line) : ""));
  }
  Node root = builder.Take();
  if (root.origin.line == 0) root.origin = {source, 1, 1};
  return root;
}

}  // namespace rift::yaml
