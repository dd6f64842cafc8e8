// Where a reader or writer of YAML turns from taking to refusing, on both sides of each bound.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"
#include "rift/yaml/suggest.hpp"
#include "rift/yaml/utf8.hpp"
#include "rift/yaml/write.hpp"
#include "robot_schema.hpp"
#include "yaml/text_check.hpp"

namespace rift::yaml::test {
namespace {

TEST_CASE("A message shows sixty bytes of a text, cut between characters") {
  const std::string sixty(60, 'x');
  CHECK(Shown(Node::Scalar(sixty)) == sixty);
  CHECK(Shown(Node::Scalar(sixty + "y")) == sixty + "...");
  CHECK(Shown(Node::Text(sixty + "y")) == '"' + sixty + "...\"");
  const std::string e_acute = "\xC3\xA9", euro = "\xE2\x82\xAC";
  CHECK(Shown(Node::Scalar(std::string(58, 'x') + e_acute + "y")) ==
        std::string(58, 'x') + e_acute + "...");
  CHECK(Shown(Node::Scalar(std::string(59, 'x') + e_acute + "y")) == std::string(59, 'x') + "...");
  CHECK(Shown(Node::Scalar(std::string(58, 'x') + euro + "y")) == std::string(58, 'x') + "...");
  CHECK(ErrorOf([&] { Fail(Node::Scalar("1"), sixty + "y", "no"); }) ==
        "key '" + sixty + "...' is 1: no");
}

TEST_CASE("UTF-8 is what its standard allows, to the first and last of each length") {
  const auto length = [](const std::string& bytes) { return Utf8Length(bytes, 0); };
  CHECK(length("\x7F") == 1);
  CHECK(length("\xC2\x80") == 2);
  CHECK(length("\xDF\xBF") == 2);
  CHECK(length("\xE0\xA0\x80") == 3);
  CHECK(length("\xED\x9F\xBF") == 3);  // before the surrogates, and behind them
  CHECK(length("\xEE\x80\x80") == 3);
  CHECK(length("\xEF\xBF\xBF") == 3);
  CHECK(length("\xF0\x90\x80\x80") == 4);
  CHECK(length("\xF4\x8F\xBF\xBF") == 4);
  CHECK(Utf8Length("ab\xC3\xA9", 2) == 2);
  for (const char* wrong :
       {"\x80", "\xBF", "\xC1\xBF", "\xC2", "\xC2\x41", "\xC2\xC0", "\xE0\x9F\xBF", "\xED\xA0\x80",
        "\xED\xBF\xBF", "\xE2\x82", "\xE2\x41\xAC", "\xE2\x82\x41", "\xF0\x8F\xBF\xBF",
        "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xF9\x90\x80\x80", "\xFF", "\xF0\x90\x80"}) {
    INFO(Node::Text(wrong).text.size()
         << " bytes from " << int(static_cast<unsigned char>(*wrong)));
    CHECK(length(wrong) == 0);
  }
}

TEST_CASE("A place of a wrong byte counts lines from one and bytes of its line from one") {
  const auto error = [](const std::string& text) { return ErrorOf([&] { CheckText(text, "f"); }); };
  CHECK(error("\xFF").starts_with("f:1:1: byte 0xff"));
  CHECK(error("ab\n\xC3\xA9"
              "c\x01")
            .starts_with("f:2:4: control character 0x01"));
  CHECK(error("a\n\n  \tb").starts_with("f:3:3: a tab indents"));
  CHECK(error("a\r\nb\rc").starts_with("f:2:2: control character 0x0d"));
  CHECK(error("a\r").starts_with("f:1:2: control character 0x0d"));
  CHECK(error("a\x7F").starts_with("f:1:2: control character 0x7f"));
  CHECK(error("a\x1F").starts_with("f:1:2: control character 0x1f"));
  CHECK_NOTHROW(CheckText("a ~\t\xC2\x80\r\n", "f"));
}

std::string Dotted(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

TEST_CASE("A key opens into thirty-two blocks at most, and is one text beyond") {
  const Node opened = Parse(Dotted(32) + ": 1\n", "f");
  REQUIRE(opened.entries.size() == 1);
  CHECK(opened.entries[0].key == "a");
  const Node whole = Parse(Dotted(33) + ": 1\n", "f");
  CHECK(whole.entries[0].key == Dotted(33));
}

TEST_CASE("A block takes ten thousand keys") {
  const auto block = [](int keys) {
    std::string text;
    for (int i = 0; i < keys; ++i) text += "k" + std::to_string(i) + ": 1\n";
    return Parse(text, "f").entries.size();
  };
  CHECK(block(10'000) == 10'000);
  CHECK_THROWS_WITH(block(10'001), "f:1:1: more than 10000 keys in one block");
}

TEST_CASE("A block takes ten thousand keys with those that included files add to it") {
  const auto load = [](int keys) {
    const auto block = [](const std::string& name, int count) {
      std::string text = "run:\n";
      for (int i = 0; i < count; ++i) text += "  " + name + std::to_string(i) + ": 1\n";
      return text;
    };
    return Load("main.yaml", [&](const std::string& path) {
      if (path == "a.yaml") return block("a", 6000);
      if (path == "b.yaml") return block("b", 3999) + "  a5: 1\n";  // it is there already
      return "include: [a.yaml, b.yaml]\n" + block("c", keys);
    });
  };
  CHECK(load(1).Find("run")->value.entries.size() == 10'000);
  CHECK_THROWS_WITH(load(2), "a.yaml:2:3: more than 10000 keys in one block");
}

TEST_CASE("One text of YAML has a mebibyte at most, wherever it comes from") {
  const std::string most = "#" + std::string((1 << 20) - 1, 'x');
  CHECK(Parse(most, "camera.yaml").IsNull());
  CHECK_THROWS_WITH(Parse(most + "x", "camera.yaml"),
                    "camera.yaml: 1048577 bytes of YAML: at most 1048576 are taken; --large-inputs "
                    "lifts this limit");
}

TEST_CASE("An experiment is of 256 files at most") {
  const auto load = [](int included) {
    std::string main = "include: [";
    for (int i = 0; i < included; ++i) main += i == 0 ? "b.yaml" : ", b.yaml";
    return Load("main.yaml", [&](const std::string& path) {
      return path == "main.yaml" ? main + "]\n" : "b: 1\n";
    });
  };
  CHECK(load(255).Find("b") != nullptr);
  CHECK_THROWS_WITH(load(256), "main.yaml:1:2051: more than 256 files are included");
}

TEST_CASE("A list stands on a line of ninety bytes and its margin, a longer one below its key") {
  const auto list = [](int bytes) {  // brackets and all
    return Node::List({Node::Text(std::string(static_cast<std::size_t>(bytes) - 2, 'x'))});
  };
  const auto page = [](int depth, Node value) {
    for (int i = 0; i <= depth; ++i) {
      Node map = Node::Map();
      map.Add("k", std::move(value));
      value = std::move(map);
    }
    return Emit(value);
  };
  const auto is_on_line = [&](int depth, int bytes) {
    return page(depth, list(bytes)).find("k: [x") != std::string::npos;
  };
  CHECK(is_on_line(0, 90));
  CHECK_FALSE(is_on_line(0, 91));
  CHECK(is_on_line(2, 86));
  CHECK_FALSE(is_on_line(2, 87));
  CHECK(page(1, list(91)) == "k:\n  k:\n    - " + std::string(89, 'x') + "\n");
  CHECK(InlineText(list(90)) == "[" + std::string(88, 'x') + "]");
  CHECK(InlineText(list(91)) == "1 items");
  CHECK(InlineText(Node::Text(std::string(91, 'x'))) == "0 items");
}

TEST_CASE("A name is near by a third of its letters, by one at least, and shares one") {
  CHECK(Nearest("samqle", {"sample"}) == "sample");
  CHECK(Nearest("sbmqle", {"sample"}) == "sample");  // two of six
  CHECK(Nearest("sbmqlf", {"sample"}).empty());
  CHECK(Nearest("spexd", {"speed"}) == "speed");
  CHECK(Nearest("syexd", {"speed"}).empty());  // two of five
  CHECK(Nearest("ab", {"abc"}) == "abc");
  CHECK(Nearest("samples", {"sampl"}).empty());  // a third of the shorter one
  CHECK(Nearest("samples", {"sample"}) == "sample");
  CHECK(Nearest("samplers", {"sample"}) == "sample");  // longer by two of six
  CHECK(Nearest("y", {"x"}).empty());                  // nothing would be left of it
  CHECK(Nearest("cat", {"dog", "bat", "hat"}) == "bat");
  CHECK(Nearest("samplo", {"semple", "sample"}) == "sample");
  CHECK(EditDistance("ab", "ba") == 1);
  CHECK(EditDistance("xab", "xba") == 1);
  CHECK(EditDistance("abc", "ca") == 3);
  CHECK(EditDistance("abcd", "acbd") == 1);
  CHECK(EditDistance("abc", "") == 3);
}

TEST_CASE("Of many keys a message names eight") {
  std::vector<std::string> keys;
  std::string eight;
  for (int i = 1; i <= 8; ++i) {
    keys.push_back("key" + std::string(static_cast<std::size_t>(4 * i), 'z'));
    eight += (i > 1 ? ", " : "") + keys.back();
  }
  CHECK(KeyHint("qqqq", keys) == "known keys: " + eight);
  keys.push_back("other");
  CHECK(KeyHint("qqqq", keys) == "known keys: " + eight + ", and 1 more");
  keys.push_back("another");
  CHECK(KeyHint("qqqq", keys) == "known keys: " + eight + ", and 2 more");
}

TEST_CASE("A seed with an exponent goes up to 2^53, and in digits up to 2^64") {
  const auto read = [](const std::string& text) {
    return ReadUint64(Node::Scalar(text), {"seed"});
  };
  CHECK(read("9.007199254740992e15") == 9007199254740992u);
  CHECK(read("18446744073709551615") == 18446744073709551615u);
  for (const char* written_out : {"9.007199254740994e15", "1e16", "1.8e19"}) {
    CHECK_THROWS_WITH(read(written_out), Catch::Contains("must be written out in digits above"));
  }
  for (const char* beyond : {"1.8446744073709551616e19", "1.9e19", "-1", "-1e-300"}) {
    CHECK_THROWS(read(beyond));
  }
  CHECK_THROWS_WITH(read("1.9e19"), Catch::Contains("must be in [0, 18446744073709551615]"));
  CHECK(read("0") == 0u);
  CHECK(read("-0") == 0u);
}

TEST_CASE("A whole number goes to the ends of its range, or of what an int holds") {
  const auto read = [](const std::string& text, std::optional<Range> range) {
    return ReadInt(Node::Scalar(text), {"n", range});
  };
  CHECK(read("2147483647", {}) == 2147483647);
  CHECK(read("-2147483648", {}) == -2147483647 - 1);
  CHECK_THROWS_WITH(read("2147483648", {}),
                    "key 'n' is 2147483648: must be in [-2147483648, 2147483647]");
  CHECK_THROWS(read("-2147483649", {}));
  CHECK(read("3", Range{3, 5}) == 3);
  CHECK(read("5", Range{3, 5}) == 5);
  CHECK_THROWS(read("2", Range{3, 5}));
  CHECK_THROWS(read("6", Range{3, 5}));
}

}  // namespace
}  // namespace rift::yaml::test
