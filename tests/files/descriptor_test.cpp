#include "rift/files/descriptor.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <utility>

#include "support/processes/process.hpp"

namespace rift::files {
namespace {

bool IsOpenInProcess(int number) { return ::fcntl(number, F_GETFD) >= 0; }

std::array<int, 2> Pipe() {
  std::array<int, 2> ends{};
  REQUIRE(::pipe2(ends.data(), O_CLOEXEC) == 0);
  return ends;
}

TEST_CASE("A descriptor is closed at the end of its scope, once, and no program inherits it") {
  const test::TemporaryFolder folder;
  int number = -1;
  {
    const Descriptor file(folder / "new", O_WRONLY | O_CREAT);
    REQUIRE(file.IsOpen());
    number = file.Number();
    CHECK(::fcntl(number, F_GETFD) == FD_CLOEXEC);
  }
  CHECK_FALSE(IsOpenInProcess(number));
  const Descriptor missing(folder / "none", O_RDONLY);
  CHECK_FALSE(missing.IsOpen());
  CHECK_FALSE(Descriptor().IsOpen());
}

TEST_CASE("A descriptor that is moved is closed by its new owner, and what that held before") {
  const auto [one, other] = Pipe();
  Descriptor first(one), second(other);
  first = std::move(second);
  CHECK(first.Number() == other);
  CHECK(IsOpenInProcess(other));
  second = {};
  CHECK_FALSE(IsOpenInProcess(one));
  {
    const Descriptor third(std::move(first));
    CHECK(third.Number() == other);
  }
  CHECK_FALSE(IsOpenInProcess(other));
}

TEST_CASE("A descriptor says whether its close succeeded, and is closed then") {
  const auto [one, other] = Pipe();
  Descriptor read(one);
  const Descriptor write(other);
  CHECK(read.Close());
  CHECK_FALSE(read.IsOpen());
  CHECK_FALSE(IsOpenInProcess(one));
  CHECK_FALSE(read.Close());
}

}  // namespace
}  // namespace rift::files
