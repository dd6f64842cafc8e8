#include "rift/files/outputs.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "support/processes/process.hpp"

namespace rift::files {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("Outputs that are new and have their folder are taken") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "in.csv", "x");
  CHECK_NOTHROW(CheckOutputs({folder / "in.csv"}, {{folder / "a.csv", folder / "b.csv"}, {}}));
  // In a folder that the command makes, or on the way to it.
  CHECK_NOTHROW(CheckOutputs({}, {{folder / "run/a.csv"}, folder / "run"}));
  CHECK_NOTHROW(CheckOutputs({}, {{folder / "run/b/a.csv"}, folder / "run"}));
  CHECK_NOTHROW(CheckOutputs({}, {{folder / "run/a.csv"}, folder / "run/deep/er"}));
  CHECK_NOTHROW(CheckOutputs({}, {{"/dev/stdout"}, {}}));
}

TEST_CASE("What no output can be is told before anything is written") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "in.csv", "x");
  fs::create_directory(folder / "sub");
  const auto check = [&](const std::vector<fs::path>& files, const fs::path& made = {}) {
    CheckOutputs({folder / "in.csv"}, {files, made});
  };
  CHECK_THROWS_WITH(check({"-"}), Contains("- is stdout"));
  CHECK_THROWS_WITH(check({folder / "sub"}), Contains("sub is a folder: name a file"));
  CHECK_THROWS_WITH(check({folder / "in.csv"}), Contains("is an input or another output"));
  CHECK_THROWS_WITH(check({folder / "a", folder / "x/../a"}), Contains("another output"));
  CHECK_THROWS_WITH(check({folder / "none/a.csv"}), Contains("there is no folder"));
  CHECK_THROWS_WITH(check({folder / "runs/a.csv"}, folder / "run"), Contains("there is no folder"));
  CHECK_THROWS_AS(check({folder / "none/a.csv"}), std::invalid_argument);
}

TEST_CASE("A file that is there is replaced with force alone") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", "x");
  CHECK_THROWS_WITH(CheckOutputs({}, {{folder / "a.csv"}, {}, false}),
                    Contains("is there already") && Contains("--force"));
  CHECK_NOTHROW(CheckOutputs({}, {{folder / "a.csv"}, {}, true}));
  CHECK_THROWS_WITH(CheckOutputs({folder / "a.csv"}, {{folder / "a.csv"}, {}, true}),
                    Contains("is an input"));
}

TEST_CASE("A folder of outputs is no file, no name of one and not stdout") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a", "x");
  fs::create_directory(folder / "old.csv");
  CHECK_NOTHROW(RequireFolderName(folder / "new", "a sweep"));
  CHECK_NOTHROW(RequireFolderName(folder / "v1.2", "a sweep"));
  CHECK_NOTHROW(RequireFolderName(folder / "old.csv", "a sweep"));
  CHECK_THROWS_WITH(RequireFolderName("-", "a sweep"),
                    "--out -: a sweep is a folder of files and cannot go to stdout: name a folder");
  CHECK_THROWS_WITH(RequireFolderName(folder / "a", "a sweep"), Contains("is a file, and a sweep"));
  for (const char* below : {"a/sub", "a/sub/further", "a/sub.csv"}) {
    CHECK_THROWS_WITH(RequireFolderName(folder / below, "a sweep"),
                      "--out " + (folder / below) + ": " + (folder / "a") +
                          " is a file, and no folder can be below it");
  }
  CHECK_NOTHROW(RequireFolderName(folder / "new/sub/further", "a sweep"));
  for (const char* name :
       {"x.csv", "x.html", "x.json", "x.log", "x.mcap", "x.mp4", "x.pdf", "x.png", "x.svg", "x.tum",
        "x.txt", "x.xlsx", "x.yaml", "x.yml", "x.zip"}) {
    CHECK_THROWS_WITH(RequireFolderName(folder / name, "a run"),
                      Contains("is the name of a file, and a run is a folder"));
  }
}

}  // namespace
}  // namespace rift::files
