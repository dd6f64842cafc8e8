// How texts, comments and ranges are written, to the letter.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"
#include "rift/yaml/write.hpp"
#include "robot_schema.hpp"

namespace rift::yaml::test {
namespace {

std::string Written(const std::string& text) {
  const std::string line = Emit(Node::Text(text));
  REQUIRE(line.ends_with("\n"));
  return line.substr(0, line.size() - 1);
}

TEST_CASE("Words that some reader takes for a truth value or for nothing are quoted in any case") {
  for (const std::string word : {"true", "false", "yes", "no", "on", "off", "null", "True", "FALSE",
                                 "Yes", "NO", "oN", "OFF", "Null", "NULL"}) {
    CHECK(Written(word) == '"' + word + '"');
  }
  for (const std::string word : {"trues", "o", "nul", "y", "n", "offs", "none", "tru"}) {
    CHECK(Written(word) == word);
  }
}

TEST_CASE("What some reader takes for a number, a date or a time is quoted") {
  for (const std::string text : {"1", "007", "1e5", "1.5", "1E-5", "0x1F", "0XAB", "0o17", "1_000",
                                 "12:30", "2024-01-01", "2024-01-01T12:00:00Z", "9 9", "1+2"}) {
    CHECK(Written(text) == '"' + text + '"');
  }
  for (const std::string text : {"3pi", "1g", "a1", "_1", "1/2", "/1", "30 km"}) {
    CHECK(Written(text) == text);
  }
}

TEST_CASE("A text is plain by its first, its inner and its last character") {
  for (const std::string plain :
       {"a_b-c.d/e+f=g(h)i@j%k*l m", "_a", "/a", "./a", "../a", "\xC3\xA9t\xC3\xA9", "Z", "a-"}) {
    CHECK(Written(plain) == plain);
  }
  for (const std::string quoted : {"-a",  ".a",  "..",  "+a",  "=a",  "(a)", "@a",  "%a",  "*a",
                                   "a,b", "a;b", "a:b", "a#b", "a[b", "a]b", "a{b", "a}b", "a!b",
                                   "a&b", "a|b", "a>b", "a'b", "a?b", "a`b", "a~b", "a ",  "~"}) {
    CHECK(Written(quoted) == '"' + quoted + '"');
  }
}

TEST_CASE("What a person cannot see is written by its code") {
  CHECK(Written("a\xC2\x85z") == "\"a\\x85z\"");
  CHECK(Written("a\xC2\x80z") == "\"a\\x80z\"");
  CHECK(Written("a\xC2\x9Fz") == "\"a\\x9fz\"");
  CHECK(Written("a\xC2\xA0z") == "\"a\\xa0z\"");
  CHECK(Written("a\xC2\xA1z") == "a\xC2\xA1z");
  CHECK(Written("a\xE2\x80\xA8z") == "\"a\\u2028z\"");
  CHECK(Written("a\xE2\x80\xA9z") == "\"a\\u2029z\"");
  CHECK(Written("a\xEF\xBB\xBFz") == "\"a\\ufeffz\"");
  CHECK(Written("a\xE2\x80\xA7z") == "a\xE2\x80\xA7z");
  CHECK(Written("\x7F") == "\"\\x7f\"");
  CHECK(Written("\x1F") == "\"\\x1f\"");
  CHECK(Written("\r") == "\"\\x0d\"");
  CHECK(Written("a\tb\nc") == "\"a\\tb\\nc\"");
  CHECK(Written("a\"b\\c") == "\"a\\\"b\\\\c\"");
}

TEST_CASE("A key with dots is quoted, and one without only where a text is") {
  Node map = Node::Map();
  map.Add("a.b", Node::Scalar("1"));
  map.Add("ab", Node::Scalar("true"));
  map.Add("on", Node::Text("true"));
  map.Add("", Node());
  CHECK(Emit(map) == "\"a.b\": 1\nab: true\n\"on\": \"true\"\n\"\": null\n");
}

TEST_CASE("A comment stays on its line") {
  Node map = Node::Map();
  map.Add("a", Node::Scalar("1"));
  map.Add("b", Node::Map());
  map.Find("b")->value.Add("c", Node::Scalar("2"));
  map.Find("a")->comment = "one\ntwo\rthree";
  map.Find("b")->comment = "block";
  CHECK(Emit(map) == "a: 1  # one two three\nb:  # block\n  c: 2\n");
}

TEST_CASE("A range is told by the ends that it has") {
  const double endless = HUGE_VAL;
  CHECK(RangeText({-0.5, 2.0}) == "in [-0.5, 2]");
  CHECK(RangeText({0.25, endless}) == "at least 0.25");
  CHECK(RangeText({-endless, 0.75}) == "at most 0.75");
  CHECK(RangeText({-endless, endless}) == "a finite number");
  const auto read = [&](const std::string& text, Range range) {
    return ErrorOf([&] { ReadDouble(Node::Scalar(text), {"k", range, "it"}); });
  };
  CHECK(read("0.75", {-endless, 0.75}) == "no error");
  CHECK(read("0.76", {-endless, 0.75}) == "key 'k' is 0.76: must be at most 0.75; meaning: it");
  CHECK(read("0.25", {0.25, endless}) == "no error");
  CHECK(read("0.24", {0.25, endless}) == "key 'k' is 0.24: must be at least 0.25; meaning: it");
}

TEST_CASE("A tree in a line is itself up to ninety bytes, and a number of things beyond") {
  CHECK(InlineText(Node()) == "null");
  CHECK(InlineText(Node::Map()) == "{}");
  CHECK(InlineText(Node::List()) == "[]");
  CHECK(InlineText(Node::List({Node::Scalar("1"), Node::Text("2"), Node()})) == "[1, \"2\", null]");
  CHECK(InlineText(Node::List({Node::List(), Node::Scalar("1"), Node::Scalar("2")})) == "3 items");
  Node map = Node::Map();
  map.Add("a", Node::Scalar("1"));
  map.Add("b", Node::Scalar("2"));
  CHECK(InlineText(map) == "2 entries");
}

TEST_CASE("A map is an axis when all of its keys are of an axis, and else a map of names") {
  CHECK(IsAxis(Parse("{min: 1, max: 2}", "f")));
  for (const char* key :
       {"min", "max", "scale", "integer", "values", "settable", "step", "nominal"}) {
    INFO(key);
    CHECK(IsAxis(Parse(std::string("{") + key + ": 1}", "f")));
    CHECK_FALSE(IsAxis(Parse(std::string("{v: [1], ") + key + ": 1}", "f")));
  }
  CHECK_FALSE(IsAxis(Parse("{}", "f")));
  CHECK_FALSE(IsAxis(Parse("[min, max]", "f")));
  const std::vector<FlatEntry> flat = Flatten(Parse("a: {min: [1], other: [2]}\n", "f"));
  REQUIRE(flat.size() == 2);
  CHECK(flat[0].key == "a.min");
  CHECK(flat[1].key == "a.other");
}

TEST_CASE("A bracket is proposed for quotes on the line of the mistake alone") {
  const auto message = [](const std::string& text) { return ErrorOf([&] { Parse(text, "f"); }); };
  CHECK(message("a: 1\nb: 2\npath: {surface}/v.csv\n") ==
        "f:3:16: end of map not found; text that starts with { or [ needs quotes");
  CHECK(message("a: [1]\nb: x: y\n") == "f:2:5: illegal map value");
  CHECK(message("b: x: y\na: [1]\n") == "f:1:5: illegal map value");
}

TEST_CASE("A reason that names its file is told as it is") {
  const auto fails = [](const std::string& reason) {
    return ErrorOf([&] {
      Load("lab/a.yaml", [&](const std::string&) -> std::string { throw Error(reason); });
    });
  };
  CHECK(fails("lab/a.yaml is a folder") == "configuration: lab/a.yaml is a folder");
  CHECK(fails("a.yaml is a folder") ==
        "configuration: 'lab/a.yaml' cannot be read: a.yaml is a folder");
}

TEST_CASE("Every part of an override is placed at it") {
  const Node root = ParseOverride("a.b={c: [1, {d: 2}]}");
  CHECK(root.origin.Text() == "--set a.b");
  const Node::Entry* b = root.Find("a")->value.Find("b");
  CHECK(b->origin.Text() == "--set a.b");
  const Node::Entry* c = b->value.Find("c");
  CHECK(c->origin.Text() == "--set a.b");
  CHECK(c->value.items[0].origin.Text() == "--set a.b");
  CHECK(c->value.items[1].Find("d")->origin.Text() == "--set a.b");
  CHECK(c->value.items[1].Find("d")->value.origin.Text() == "--set a.b");
}

TEST_CASE("What is written over replaces values and lists, and joins maps") {
  Node base = Parse("a: {x: 1, y: {p: 1}}\nb: [1, 2]\nc: 3\nd: {q: 1}\n", "base");
  Merge(base, Parse("a: {y: {r: 2}, x: 5}\nb: [9]\nc: {s: 1}\nd: 4\ne: 6\n", "over"));
  CHECK(Emit(base) == "a:\n  x: 5\n  y:\n    p: 1\n    r: 2\nb: [9]\nc:\n  s: 1\nd: 4\ne: 6\n");
  CHECK(base.Find("a")->value.Find("x")->origin.source == "over");
  CHECK(base.Find("a")->origin.source == "base");
  CHECK(base.Find("d")->origin.source == "over");
}

TEST_CASE("Keys with dots are opened in the maps within a map too") {
  CHECK(Emit(ExpandDottedKeys(Parse("x: {\"a.b\": 1, y: {\"c.d\": 2}}\n", "f"))) ==
        "x:\n  a:\n    b: 1\n  y:\n    c:\n      d: 2\n");
}

}  // namespace
}  // namespace rift::yaml::test
