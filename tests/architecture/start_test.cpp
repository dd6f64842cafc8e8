// Each test case is a process: what its program takes to start is spent some thousand times.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

/// The libraries that a program itself names.
std::string LibrariesOf(const fs::path& program) {
  const test::TemporaryFolder folder;
  REQUIRE(test::RunShell("readelf -d '" + program.string() + "' > " + (folder / "libraries")) == 0);
  return test::ReadFile(folder / "libraries");
}

TEST_CASE("A test needs OpenCV's libraries for files just where it is in a program that has them") {
  const std::string end = "_slow_start_test";
  const auto loads_slowly = [](const std::string& program) {
    const std::string libraries = LibrariesOf(program);
    return libraries.find("libopencv_imgcodecs") != std::string::npos ||
           libraries.find("libopencv_videoio") != std::string::npos;
  };
  int programs = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::BuildDir() + "/tests")) {
    const std::string program = entry.path().string();
    if (!program.ends_with(end)) continue;
    const std::string others = program.substr(0, program.size() - end.size()) + "_test";
    INFO("SLOW_START in tests/CMakeLists.txt lists the tests of " << program);
    CHECK(loads_slowly(program));
    CHECK_FALSE(loads_slowly(others));
    ++programs;
  }
  CHECK(programs >= 6);
}

}  // namespace
}  // namespace rift
