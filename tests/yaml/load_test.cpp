#include <map>

#include <catch2/catch.hpp>

#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/write.hpp"
#include "robot_schema.hpp"

namespace rift::yaml::test {
namespace {

using Files = std::map<std::string, std::string>;

FileReader ReaderOf(const Files& files) {
  return [files](const std::string& path) {
    const auto found = files.find(path);
    if (found == files.end()) throw std::runtime_error("no such file");
    return found->second;
  };
}

std::string LoadError(const Files& files) {
  return ErrorOf([&] { Load("lab/main.yaml", ReaderOf(files)); });
}

Node WithOverrides(Node root, const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) Merge(root, ParseOverride(assignment));
  return root;
}

TEST_CASE("The including file wins over what it includes and maps merge at every level") {
  const Node root =
      Load("lab/main.yaml",
           ReaderOf({{"lab/main.yaml", "include: [base.yaml, robots/a.yaml]\ngap: {samples: 7}\n"},
                     {"lab/base.yaml", "gap: {samples: 5, align: se2}\nlist: [1, 2, 3]\n"},
                     {"lab/robots/a.yaml", "include: ../more.yaml\nlist: [9]\n"},
                     {"lab/more.yaml", "more: 1\n"}}));
  CHECK(Emit(root) == "gap:\n  samples: 7\n  align: se2\nlist: [9]\nmore: 1\n");
  CHECK(root.Find("gap")->value.Find("samples")->value.origin.Text() == "lab/main.yaml:2:16");
  CHECK(root.Find("gap")->value.Find("align")->value.origin.Text() == "lab/base.yaml:1:26");
  CHECK(root.Find("include") == nullptr);
}

TEST_CASE("An empty file is an experiment of defaults") {
  CHECK(Load("main.yaml", ReaderOf({{"main.yaml", ""}})).IsMap());
}

TEST_CASE("A file may be included twice when it makes no cycle") {
  const Files files{{"lab/main.yaml", "include: [b.yaml, c.yaml]\n"},
                    {"lab/b.yaml", "include: d.yaml\n"},
                    {"lab/c.yaml", "include: d.yaml\n"},
                    {"lab/d.yaml", "d: 1\n"}};
  CHECK(Emit(Load("lab/main.yaml", ReaderOf(files))) == "d: 1\n");
}

TEST_CASE("A cycle of includes names the chain") {
  CHECK(LoadError({{"lab/main.yaml", "a: 1\ninclude: b.yaml\n"},
                   {"lab/b.yaml", "include: ./c.yaml\n"},
                   {"lab/c.yaml", "include: ../lab/b.yaml\n"}}) ==
        "lab/c.yaml:1:10: files include each other: lab/b.yaml -> lab/c.yaml -> lab/b.yaml; "
        "remove one include");
  CHECK(LoadError({{"lab/main.yaml", "include: main.yaml\n"}}) ==
        "lab/main.yaml:1:10: files include each other: lab/main.yaml -> lab/main.yaml; "
        "remove one include");
}

TEST_CASE("Includes that multiply are bounded") {
  Files files{{"lab/main.yaml", "include: [1.yaml, 1.yaml]\n"}};
  for (int i = 1; i < 40; ++i) {
    const std::string next = std::to_string(i + 1) + ".yaml";
    files["lab/" + std::to_string(i) + ".yaml"] = "include: [" + next + ", " + next + "]\n";
  }
  files["lab/40.yaml"] = "";
  CHECK(LoadError(files).find("more than 256 files are included") != std::string::npos);
}

TEST_CASE("The limit of a YAML file holds for it and all that it includes together") {
  const std::string comment = "#" + std::string(600'000, 'x') + "\n";
  const Files files{{"lab/main.yaml", "include: [a.yaml, b.yaml]\n"},
                    {"lab/a.yaml", comment},
                    {"lab/b.yaml", comment}};
  CHECK_THROWS_WITH(
      Load("lab/main.yaml", ReaderOf(files)),
      Catch::StartsWith("lab/b.yaml: 1200030 bytes of YAML: at most 1048576 are taken"));
}

TEST_CASE("A file that is missing or no map or badly named is refused") {
  CHECK(ErrorOf([] { Load("x.yaml", ReaderOf({})); }) ==
        "configuration: 'x.yaml' cannot be read: no such file");
  CHECK(LoadError({{"lab/main.yaml", "include: [gone.yaml]\n"}}) ==
        "lab/main.yaml:1:11: 'lab/gone.yaml' cannot be read: no such file");
  CHECK(LoadError({{"lab/main.yaml", "- 1\n- 2\n"}}) ==
        "lab/main.yaml:1:1: the file holds a list of 2: must be keys with values (key: value)");
  CHECK(LoadError({{"lab/main.yaml", "include: {a: b}\n"}}) ==
        "lab/main.yaml:1:10: key 'include' is a block of keys: must be the path of a YAML file, "
        "or a list of them");
  CHECK(LoadError({{"lab/main.yaml", "include:\n"}}) ==
        "lab/main.yaml:1:1: key 'include' is empty: must be the path of a YAML file, "
        "or a list of them");
}

TEST_CASE("An override is read as YAML and merged at its key") {
  const Node file = Parse("gap: {samples: 5, align: se2}\nlist: [1]\n", "f.yaml");
  const Node root =
      WithOverrides(file, {"gap.samples=1e3", "list=[4, 5]", "new.key.deep=text = more", "empty="});
  CHECK(Emit(root) ==
        "gap:\n  samples: 1e3\n  align: se2\nlist: [4, 5]\nnew:\n  key:\n    deep: text = more\n"
        "empty: null\n");
  CHECK(root.Find("gap")->value.Find("samples")->value.origin.Text() == "--set gap.samples");
  CHECK(root.Find("list")->value.items[0].origin.Text() == "--set list");
}

TEST_CASE("An override that is no assignment is refused") {
  CHECK(ErrorOf([] { ParseOverride("gap.samples"); }) ==
        "--set 'gap.samples': must be key=value, as in --set gap.samples=500");
  CHECK(ErrorOf([] { ParseOverride("=5"); }) ==
        "--set '=5': must be key=value, as in --set gap.samples=500");
  CHECK(ErrorOf([] { ParseOverride("a..b=5"); }) ==
        "--set 'a..b=5': must be key=value, as in --set gap.samples=500");
  CHECK(ErrorOf([] { ParseOverride("a.b=[1, 2"); }) ==
        "--set a.b:1:1: end of sequence flow not found; text that starts with { or [ needs quotes");
}

TEST_CASE("An include is refused of an override, which knows no file beside it") {
  for (const char* include : {"include=other.yaml", "include.a=1"}) {
    CHECK(ErrorOf([&] { ParseOverride(include); }) ==
          "--set '" + std::string(include) +
              "': include stands in a file, not in --set: write a file with include: [a.yaml, "
              "b.yaml] and give that");
  }
  CHECK(ParseOverride("run.include=1").Find("run") != nullptr);
}

TEST_CASE("Every way to write an axis of the space means the same") {
  const std::vector<Node> ways{
      Parse("space: {control.v_min: [0.1, 0.2]}", "f"),
      Parse("space: {\"control.v_min\": [0.1, 0.2]}", "f"),
      Parse("space: {control: {v_min: [0.1, 0.2]}}", "f"),
      Parse("space.control.v_min: [0.1, 0.2]", "f"),
      ParseOverride("space.control.v_min=[0.1, 0.2]"),
      WithOverrides(Parse("space: {control.v_min: [5]}", "f"), {"space.control.v_min=[0.1, 0.2]"}),
      WithOverrides(Parse("space: {control: {v_min: [5]}}", "f"),
                    {"space={control.v_min: [0.1, 0.2]}"})};
  for (const Node& way : ways) {
    const std::vector<FlatEntry> flat = Flatten(way.Find("space")->value);
    REQUIRE(flat.size() == 1);
    CHECK(flat[0].key == "control.v_min");
    CHECK(Emit(*flat[0].value) == "[0.1, 0.2]\n");
  }
}

TEST_CASE("A map of min and max is one axis and other maps are names") {
  const Node root =
      Parse("control: {v_min: {min: 0, max: 1, scale: log}, v_max: [1]}\nempty: {}\n", "f");
  const std::vector<FlatEntry> flat = Flatten(root);
  REQUIRE(flat.size() == 3);
  CHECK(flat[0].key == "control.v_min");
  CHECK(flat[0].origin.Text() == "f:1:11");
  CHECK(IsAxis(*flat[0].value));
  CHECK(flat[1].key == "control.v_max");
  CHECK(flat[2].key == "empty");
}

TEST_CASE("Two spellings of one axis are refused") {
  const Node root = Parse("\"a.b\": 1\na: {b: 2}\n", "f");
  CHECK(ErrorOf([&] { Flatten(root); }) ==
        "f:2:5: key 'a.b' is given twice: the first is at f:1:1; remove one of them");
  CHECK(ErrorOf([&] { ExpandDottedKeys(root); }) ==
        "f:2:5: key 'a.b' is given twice: the first is at f:1:1; remove one of them");
  CHECK(Emit(ExpandDottedKeys(Parse("\"a.b\": 1\na: {c: 2}\n", "f"))) == "a:\n  b: 1\n  c: 2\n");
}

}  // namespace
}  // namespace rift::yaml::test
