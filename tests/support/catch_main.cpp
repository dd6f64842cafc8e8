#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

// The system's programs before others of the same name: a python3 that chooses a version first
// takes ten times as long to start.
int main(int count, char** words) {
  const char* const path = std::getenv("PATH");
  const std::string system_first = std::string("/usr/bin") + (path != nullptr ? ":" : "") +
                                   std::string(path != nullptr ? path : "");
  ::setenv("PATH", system_first.c_str(), 1);
  return Catch::Session().run(count, words);
}
