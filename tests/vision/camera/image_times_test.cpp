#include "vision/camera/image_times.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Pictures come in natural order and the numbers in their names are their time") {
  std::vector<std::string> files{"run/frame10.jpg", "run/frame2.jpg", "run/frame1.jpg"};
  std::sort(files.begin(), files.end(), IsBefore);
  CHECK(files == std::vector<std::string>{"run/frame1.jpg", "run/frame2.jpg", "run/frame10.jpg"});
  CHECK(IsBefore("aa", "b"));
  CHECK_FALSE(IsBefore("b", "aa"));
  CHECK(IsBefore("a", "aa"));
  CHECK(IsBefore("a9b", "a10"));
  CHECK_FALSE(IsBefore("a10", "a10"));
  // 3 to 9 are missing: at 10 a second the last one is 0.9 s after the first.
  CHECK(TimesByNames(files, 10.0).back() == Approx(0.9));
  // Every tenth picture was kept: the usual step is one period.
  CHECK(TimesByNames({"a0010.png", "a0020.png", "a0040.png", "a0050.png"}, 5.0).back() ==
        Approx(0.8));
  CHECK(TimesByNames({"a.png", "b.png", "c.png"}, 4.0) == std::vector<double>{0.0, 0.25, 0.5});
}

TEST_CASE("A file of times is read by order or by name and is held to its rules") {
  const std::vector<std::string> files{"run/a.jpg", "run/b.jpg"};
  CHECK(TimesFromText("# s\n0.5\n0.75\n", "t.txt", files) == std::vector<double>{0.5, 0.75});
  CHECK(TimesFromText("b.jpg, 2\na.jpg 1\n", "t.txt", files) == std::vector<double>{1.0, 2.0});
  CHECK_THROWS_WITH(TimesFromText("0.5\nsoon\n", "t.txt", files), Contains("t.txt:2"));
  CHECK_THROWS_WITH(TimesFromText("0.5\n", "t.txt", files), Contains("no time for the picture"));
  CHECK_THROWS_WITH(TimesFromText("2\n1\n", "t.txt", files), Contains("not later"));
  for (const char* none : {"nan", "-nan", "inf", "-inf", "1e999"}) {
    INFO(none);
    CHECK_THROWS_WITH(TimesFromText("0.5\n" + std::string(none) + "\n", "t.txt", files),
                      Contains("t.txt:2") && Contains("is no time"));
  }
  CHECK(TimesFromText("\xEF\xBB\xBF"
                      "1\n2\n",
                      "t", files) == std::vector<double>{1.0, 2.0});
  CHECK_THROWS_WITH(TimesFromText("1\n2\n3\n", "t", files),
                    "t: 3 times for 2 pictures: name the pictures, as in `a.jpg 0.5`");
  CHECK_THROWS_WITH(TimesFromText("a.jpg 1\nb.jpg 2\nrun/a.jpg 1\n", "t", files),
                    "t:3: a second time for the picture run/a.jpg");
  CHECK_THROWS_WITH(TimesFromText("1\nb.jpg 2\n", "t", files),
                    Contains("t:2: times with and without a picture's name"));
  CHECK(TimesFromText("c.jpg 0\na.jpg 1\nb.jpg 2\n", "t", files) == std::vector<double>{1.0, 2.0});
}

}  // namespace
}  // namespace rift::vision
