// The README's recipes, as they are printed, in the order they are printed.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "support/process.hpp"
#include "support/running_rift.hpp"
#include "support/tree.hpp"
#include "support/trials.hpp"

namespace rift {
namespace {

std::vector<std::string> Recipes() {
  std::istringstream text(test::ReadFile(test::SourceDir() + "/README.md"));
  std::vector<std::string> recipes;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("    build/rift")) recipes.push_back(line.substr(4));
  }
  return recipes;
}

TEST_CASE("The README is short, and its recipes work as they are printed") {
  const std::string readme = test::ReadFile(test::SourceDir() + "/README.md");
  CHECK(std::count(readme.begin(), readme.end(), '\n') <= 120);
  const test::TemporaryFolder folder;
  for (const char* name : {"configs", "data"}) {
    std::filesystem::create_symlink(test::SourceDir() + "/" + name, folder / name);
  }
  std::filesystem::create_symlink(test::BuildDir(), folder / "build");
  int driven = 0;
  for (const std::string& recipe : Recipes()) {
    if (recipe.find("/dev/") != recipe.npos) continue;  // a robot and a camera
    const std::string log = folder / "log.txt";
    const int status = std::system(
        ("cd " + folder.Path().string() + " && " + recipe + " > " + log + " 2>&1").c_str());
    INFO(recipe << "\n" << test::ReadFile(log));
    CHECK(status == 0);
    ++driven;
  }
  CHECK(driven >= 9);
}

}  // namespace
}  // namespace rift
