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

/// What a clone that was built holds, for commands that are run in the folder.
void LinkTree(const test::TemporaryFolder& folder) {
  for (const char* name : {"configs", "data"}) {
    std::filesystem::create_symlink(test::SourceDir() + "/" + name, folder / name);
  }
  std::filesystem::create_symlink(test::BuildDir(), folder / "build");
}

void RunAsPrinted(const test::TemporaryFolder& folder, const std::string& recipe) {
  const std::string log = folder / "log.txt";
  const int status = std::system(
      ("cd " + folder.Path().string() + " && " + recipe + " > " + log + " 2>&1").c_str());
  INFO(recipe << "\n" << test::ReadFile(log));
  CHECK(status == 0);
}

TEST_CASE("The README is short, and its recipes work as they are printed") {
  const std::string readme = test::ReadFile(test::SourceDir() + "/README.md");
  CHECK(std::count(readme.begin(), readme.end(), '\n') <= 120);
  const test::TemporaryFolder folder;
  LinkTree(folder);
  int driven = 0;
  for (const std::string& recipe : Recipes()) {
    if (recipe.find("/dev/") != recipe.npos) continue;  // a robot and a camera
    RunAsPrinted(folder, recipe);
    ++driven;
  }
  CHECK(driven >= 9);
}

/// The commands of a paragraph of docs/recipes.md, up to the next one.
std::vector<std::string> RecipesOf(const std::string& heading) {
  const std::string all = test::ReadFile(test::SourceDir() + "/docs/recipes.md");
  const size_t begin = all.find("**" + heading);
  REQUIRE(begin != all.npos);
  std::istringstream text(all.substr(begin, all.find("\n**", begin) - begin));
  std::vector<std::string> recipes;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("    build/rift")) recipes.push_back(line.substr(4));
  }
  return recipes;
}

TEST_CASE("The recipes for a running sweep and for before and after work as they are printed") {
  const test::TemporaryFolder folder;
  LinkTree(folder);
  for (const std::string heading : {"Watch it.", "Before and after."}) {
    const std::vector<std::string> recipes = RecipesOf(heading);
    CHECK_FALSE(recipes.empty());
    for (const std::string& recipe : recipes) RunAsPrinted(folder, recipe);
  }
  CHECK(std::filesystem::exists(folder / "out/watched/report.html"));
  CHECK(test::ReadFile(folder / "out/change.html").find("simulation.link.delay_s") !=
        std::string::npos);
}

TEST_CASE("The README's picture is what its command draws today") {
  const test::TemporaryFolder folder;
  const std::string drawn = folder / "demo.png";
  const std::string command =
      test::SourceDir() + "/data/readme/make " + test::BuildDir() + "/rift " + drawn;
  REQUIRE(std::system((command + " 2>/dev/null").c_str()) == 0);
  INFO("data/readme/make draws it anew");
  CHECK((test::ReadFile(drawn) == test::ReadFile(test::SourceDir() + "/data/readme/demo.png")));
}

}  // namespace
}  // namespace rift
