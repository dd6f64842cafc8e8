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

TEST_CASE("What is wrong with an output is told in one whole line") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "in.csv", "x");
  fs::create_directory(folder / "sub");
  const auto check = [&](const fs::path& file, const fs::path& made = {}) {
    CheckOutputs({folder / "in.csv"}, {{file}, made, false});
  };
  CHECK_THROWS_WITH(check("-"), "- is stdout, and a file is needed here: name a file");
  CHECK_THROWS_WITH(check(folder / "sub"), folder / "sub" + " is a folder: name a file");
  CHECK_THROWS_WITH(check(folder / "in.csv"),
                    folder / "in.csv" + " is an input or another output: name another file");
  CHECK_THROWS_WITH(check(folder / "none/a.csv"),
                    folder / "none/a.csv" + ": there is no folder " + folder / "none" +
                        ": mend the name, or make the folder with mkdir -p");
  test::WriteText(folder / "old.csv", "x");
  CHECK_THROWS_WITH(check(folder / "old.csv"),
                    folder / "old.csv" +
                        " is there already: name another file or folder, or give --force to "
                        "replace it");
  CHECK_THROWS_WITH(RequireFolderName(folder / "old.csv", "a sweep"),
                    "--out " + folder / "old.csv" +
                        " is a file, and a sweep is a folder of files: name a folder");
  CHECK_THROWS_WITH(RequireFolderName(folder / "new.csv", "a run"),
                    "--out " + folder / "new.csv" +
                        " is the name of a file, and a run is a folder of files: name a folder");
}

TEST_CASE("A folder whose name begins as that of the one that is made is another") {
  const test::TemporaryFolder folder;
  // No folder is made: where it has to be there.
  CHECK_THROWS_AS(CheckOutputs({}, {{folder / "run/a.csv"}, {}}), std::invalid_argument);
  CHECK_THROWS_AS(CheckOutputs({}, {{folder / "run1/a.csv"}, folder / "run"}),
                  std::invalid_argument);
  CHECK_THROWS_AS(CheckOutputs({}, {{folder / "run/a.csv"}, folder / "run1"}),
                  std::invalid_argument);
  CHECK_NOTHROW(CheckOutputs({}, {{folder / "x/../run/a.csv"}, folder / "run/."}));
  // Where the process is there is a folder always.
  CHECK_NOTHROW(CheckOutputs({}, {{"a_file_that_is_not_there.csv"}, {}}));
  // Each output counts as taken for the ones after it.
  CHECK_THROWS_WITH(CheckOutputs({}, {{folder / "a", folder / "b", folder / "a"}, {}}),
                    folder / "a" + " is an input or another output: name another file");
}

}  // namespace
}  // namespace rift::files
