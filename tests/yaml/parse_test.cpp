#include <catch2/catch.hpp>

#include "rift/yaml/load.hpp"
#include "robot_schema.hpp"

namespace rift::yaml::test {
namespace {

std::string ParseError(const std::string& text) {
  return ErrorOf([&] { Parse(text, "f.yaml"); });
}

TEST_CASE("Every value and key knows its line and column") {
  const Node root = Parse("# a comment\na: 1\nb:\n  c: [x, \"y\"]\n", "f.yaml");
  REQUIRE(root.IsMap());
  CHECK(root.Find("a")->origin.Text() == "f.yaml:2:1");
  CHECK(root.Find("a")->value.origin.Text() == "f.yaml:2:4");
  const Node& list = root.Find("b")->value.Find("c")->value;
  CHECK(list.items[0].origin.Text() == "f.yaml:4:7");
  CHECK_FALSE(list.items[0].quoted);
  CHECK(list.items[1].origin.Text() == "f.yaml:4:10");
  CHECK(list.items[1].quoted);
}

TEST_CASE("A value left out is placed at its key") {
  const Node root = Parse("a:\n\n\nb: 1\n", "f.yaml");
  CHECK(root.Find("a")->value.IsNull());
  CHECK(root.Find("a")->value.origin.Text() == "f.yaml:1:1");
}

TEST_CASE("A file without a value is null") {
  for (const std::string text :
       {"", "\n\n", "# nothing\n", "---\n", "---\n...\n", "\xEF\xBB\xBF"}) {
    INFO(text);
    CHECK(Parse(text, "f.yaml").IsNull());
    CHECK(Parse(text, "f.yaml").origin.source == "f.yaml");
  }
}

TEST_CASE("A byte order mark and CRLF line ends change nothing") {
  const Node root = Parse(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: x\r\n",
      "f.yaml");
  CHECK(root.Find("a")->origin.Text() == "f.yaml:1:1");
  CHECK(root.Find("b")->value.text == "x");
  CHECK(root.Find("b")->value.origin.Text() == "f.yaml:2:4");
}

TEST_CASE("A key given twice is refused at any level and names both places") {
  CHECK(ParseError("a: 1\nb: 2\na: 3\n") ==
        "f.yaml:3:1: key 'a' is given twice: the first is at f.yaml:1:1; remove one of them");
  CHECK(ParseError("x:\n  - y: {k: 1, k: 2}\n") ==
        "f.yaml:2:15: key 'x[0].y.k' is given twice: the first is at f.yaml:2:9; "
        "remove one of them");
}

TEST_CASE("A plain key with dots opens nested maps") {
  const Node root = Parse("control.v_min: 1\ncontrol: {v_max: 2}\n\"a.b\": 3\n", "f.yaml");
  CHECK(root.Find("control")->value.Find("v_min")->value.text == "1");
  CHECK(root.Find("control")->value.Find("v_max")->value.text == "2");
  CHECK(root.Find("a.b")->value.text == "3");
  CHECK(ParseError("control: {v_min: 1}\ncontrol.v_min: 2\n") ==
        "f.yaml:2:1: key 'control.v_min' is given twice: the first is at f.yaml:1:11; "
        "remove one of them");
}

TEST_CASE("What the schema does not use of YAML is refused by name") {
  CHECK(ParseError("a: &x 1\nb: 2\n") ==
        "f.yaml:1:4: anchors (&name) are not supported; write the value out, or share it through "
        "'include'");
  CHECK(ParseError("<<: {a: 1}\n") ==
        "f.yaml:1:1: merge keys (<<) are not supported; share values through 'include'");
  CHECK(ParseError("a: !!str 5\n") ==
        "f.yaml:1:4: tags (here <tag:yaml.org,2002:str>) are not supported; remove it");
  CHECK(ParseError("? [a, b]\n: 1\n") ==
        "f.yaml:1:3: a key must be text, and this one is a list of 2");
  CHECK(ParseError(": 1\n") == "f.yaml:1:1: a key must be text, and this one is empty");
  CHECK(ParseError("a: 1\n---\nb: 2\n") ==
        "f.yaml:2:1: a second document starts here; a file holds one: check the indentation and "
        "the quotes, or remove what follows");
  CHECK(ParseError("a: *x\n") == "f.yaml:1:4: the referenced anchor is not defined");
}

TEST_CASE("Broken YAML names its place") {
  CHECK(ParseError("a: [1, 2\nb: 3\n") == "f.yaml:2:2: end of sequence flow not found");
  CHECK(ParseError("a: {b: 1\n") == "f.yaml:2:1: end of map flow not found");
  CHECK(ParseError("path: {surface}/v.csv\n") ==
        "f.yaml:1:16: end of map not found; text that starts with { or [ needs quotes");
  for (const std::string open : {"\"open\n", "'open''\n", "\"o\\\"\n\n"}) {
    const std::string error = ParseError("é: 1\r\na: " + open);
    INFO(open);
    CHECK(error == "f.yaml:2:4: the quote that opens here is never closed");
  }
  CHECK(ParseError("a: \"open") == "f.yaml:1:9: illegal EOF in scalar");
  CHECK(Parse("a: \"x\\\"y\"\nb: 'it''s'\nc: 'x\n\n  y'\n", "f").entries.size() == 3);
}

TEST_CASE("Bytes that are no YAML text are refused with their place") {
  CHECK(ParseError("a: caf\xE9\n") ==
        "f.yaml:1:7: byte 0xe9 is not UTF-8; save the file as UTF-8 text");
  CHECK(ParseError("a: \xC0\xAF\n") ==
        "f.yaml:1:4: byte 0xc0 is not UTF-8; save the file as UTF-8 text");
  CHECK(ParseError("a: \xED\xA0\x80\n") ==
        "f.yaml:1:4: byte 0xed is not UTF-8; save the file as UTF-8 text");
  CHECK(ParseError(std::string("a: 1\nb\0: 2\n", 11)) ==
        "f.yaml:2:2: control character 0x00; this is no YAML text file");
  CHECK(ParseError("a: 1\n\x04"
                   "b: 2\n") == "f.yaml:2:1: control character 0x04; this is no YAML text file");
  CHECK(ParseError("a:\n\tb: 1\n") == "f.yaml:2:1: a tab indents this line; YAML wants spaces");
}

TEST_CASE("A text that holds a zero byte, where names end, is refused with its place") {
  const std::string rule =
      ": the text holds \\0, where names of files and messages end: leave it out";
  CHECK(ParseError("name: \"a\\0b\"\n") == "f.yaml:1:7" + rule);
  CHECK(ParseError("\"a\\x00\": 1\n") == "f.yaml:1:1" + rule);
  CHECK(ParseError("a: [\"\\u0000\"]\n") == "f.yaml:1:5" + rule);
  CHECK(Parse("a: \"\\x01\"\nb: '\\0'\n", "f").Find("b")->value.text == "\\0");
}

TEST_CASE("A tab between values is no indentation") {
  const Node root = Parse("a:\t1\nb: 2\t# tab\n", "f.yaml");
  CHECK(root.Find("a")->value.text == "1");
  CHECK(root.Find("b")->value.text == "2");
}

TEST_CASE("Nesting is bounded whatever opens it") {
  CHECK(ParseError(std::string(100'000, '[')).find("more than 64 levels") != std::string::npos);
  std::string dashes;
  for (int i = 0; i < 20'000; ++i) dashes += "- ";
  CHECK(ParseError(dashes + "x").find("more than 64 levels") != std::string::npos);
  std::string blocks;
  for (int i = 0; i < 70; ++i) blocks += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  CHECK(ParseError(blocks) == "f.yaml:65:65: more than 64 levels of nesting");
  std::string dots = "a";
  for (int i = 0; i < 100'000; ++i) dots += ".a";
  CHECK(Parse("? " + dots + "\n: 1\n", "f.yaml").entries.size() == 1);
}

}  // namespace
}  // namespace rift::yaml::test
