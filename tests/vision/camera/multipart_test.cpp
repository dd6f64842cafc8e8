#include <catch2/catch.hpp>

#include "vision/camera/sources.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using Parts = std::vector<std::string>;

constexpr const char* kType = "multipart/x-mixed-replace; boundary=b";
constexpr std::size_t kMost = 1000, kLargestHead = 16 * 1024;

/// The parts that are whole, and how many were passed over.
struct Cut {
  Parts parts;
  std::uint64_t skipped = 0;
};

Cut CutOf(const std::string& bytes, const std::string& type = kType) {
  MultipartReader reader(type, kMost);
  reader.Feed(bytes);
  Cut cut;
  while (const auto part = reader.Take()) cut.parts.emplace_back(part->begin(), part->end());
  cut.skipped = reader.Skipped();
  return cut;
}

std::string Sized(const std::string& body) {
  return "--b\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body + "\r\n";
}

TEST_CASE("The boundary is what the type says, in quotes or not, with its dashes or not") {
  for (const char* type :
       {"multipart/x-mixed-replace;boundary=Frame", "multipart/x-mixed-replace; boundary=--Frame",
        "Multipart/X-Mixed-Replace; BOUNDARY=\"Frame\"",
        "multipart/mixed; boundary=\"--Frame\" ; charset=utf-8",
        "multipart/mixed; charset=utf-8; boundary=Frame;x=y"}) {
    INFO(type);
    CHECK(CutOf("--Frame\r\n\r\none\r\n--Frame\r\n", type).parts == Parts{"one"});
    CHECK(CutOf("--frame\r\n\r\none\r\n--frame\r\n", type).parts.empty());
  }
  // Named with dashes that are part of it, as the standard has it.
  for (const char* boundary : {"--Frame", "----Frame"}) {
    const std::string type = "multipart/mixed; boundary=" + std::string(boundary);
    const std::string line = "--" + std::string(boundary) + "\r\n";
    INFO(type);
    CHECK(CutOf(line + "\r\none\r\n" + line + "\r\ntwo\r\n" + line, type).parts ==
          Parts{"one", "two"});
    CHECK(CutOf(line + "Content-Length: 3\r\n\r\none\r\n" + line, type).parts == Parts{"one"});
  }
  CHECK_THROWS_WITH(MultipartReader("multipart/x-mixed-replace", kMost),
                    "the server names no boundary between its pictures: it sends "
                    "'multipart/x-mixed-replace', without boundary=");
  CHECK_THROWS_WITH(MultipartReader("text/html; boundary=b", kMost),
                    "the server sends 'text/html; boundary=b', but rift reads MJPEG "
                    "(multipart/x-mixed-replace)");
  CHECK_THROWS_WITH(MultipartReader("", kMost), Contains("the server sends 'no content type'"));
}

TEST_CASE("A part is as long as its own length says, however that is written") {
  const std::string body = "12\n--b\n67";  // a boundary within
  for (const char* head : {"Content-Length: 9", "content-length:9", "CONTENT-LENGTH: \t 9 ",
                           "Content-Type: image/jpeg\r\nContent-Length: 9\r\nX-Further: 3"}) {
    INFO(head);
    CHECK(CutOf("--b\r\n" + std::string(head) + "\r\n\r\n" + body + "\r\n--b\r\n").parts ==
          Parts{body});
  }
  // What is no length of this part leaves it to the next boundary.
  for (const char* head : {"X-Content-Length: 2", "Content-Length: 2 bytes", "Content-Length: -2",
                           "Content-Length:", "Content-Type: image/jpeg"}) {
    INFO(head);
    CHECK(CutOf("--b\r\n" + std::string(head) + "\r\n\r\nabcd\r\n--b\r\n").parts == Parts{"abcd"});
  }
  CHECK(CutOf("--b\r\nContent-Length: 0\r\n\r\n" + Sized("next")).parts == Parts{"", "next"});
  CHECK(CutOf("--b\r\nContent-Length: 3\r\n\r\nab").parts.empty());  // it has not all come
  CHECK(CutOf("--b\r\nContent-Length: 3\r\n\r\nabc").parts == Parts{"abc"});
}

TEST_CASE("Lines of a head end with either sign, whatever stands in the picture") {
  CHECK(CutOf("--b\nContent-Length: 6\n\n\r\n\r\nxy--b").parts == Parts{"\r\n\r\nxy"});
  CHECK(CutOf("--b\r\nContent-Length: 4\r\n\r\n\n\nxy--b").parts == Parts{"\n\nxy"});
  CHECK(CutOf("noise\r\n--b\n\nxyz\n--b\n\nuv\r\n--b").parts == Parts{"xyz", "uv"});
  CHECK(CutOf("--b\r\n\r\n\r\n--b\r\n").parts == Parts{""});
}

TEST_CASE("A part of as many bytes as are put up with is taken, a larger one is passed over") {
  const std::string fits(kMost, 'x'), large(kMost + 1, 'x');
  CHECK(CutOf(Sized(fits) + Sized("next")).parts == Parts{fits, "next"});
  const Cut cut = CutOf(Sized(large) + Sized("next"));
  CHECK(cut.parts == Parts{"next"});
  CHECK(cut.skipped == 1);
  const Cut endless =
      CutOf("--b\r\nContent-Length: 99999999999999999999999\r\n\r\n" + Sized("next"));
  CHECK(endless.parts == Parts{"next"});
  CHECK(endless.skipped == 1);
}

TEST_CASE("A part without a length is passed over once it is larger than is put up with") {
  MultipartReader reader(kType, kMost);
  reader.Feed("--b\r\n\r\n" + std::string(kMost, 'x'));
  CHECK_FALSE(reader.Take());
  CHECK(reader.Skipped() == 0);
  reader.Feed("x");
  CHECK_FALSE(reader.Take());
  CHECK(reader.Skipped() == 1);
  // What is left of it is too, and its boundary may be cut anywhere.
  reader.Feed(std::string(kMost - 10, 'x') + "\r\n--");
  CHECK_FALSE(reader.Take());
  reader.Feed("b\r\n\r\nnext\r\n--b");
  CHECK(reader.Take() == std::vector<std::uint8_t>{'n', 'e', 'x', 't'});
  CHECK(reader.Skipped() == 1);
}

TEST_CASE("A head has 16 KiB at most, and one that is longer is no head") {
  // The blank line begins after so many bytes.
  const auto with_head = [](std::size_t bytes) {
    const std::string begin = "--b\r\nX: ";
    return begin + std::string(bytes - begin.size(), 'x') + "\r\n\r\none\r\n" + Sized("next");
  };
  CHECK(CutOf(with_head(kLargestHead)).parts == Parts{"one", "next"});
  const Cut longer = CutOf(with_head(kLargestHead + 1));
  CHECK(longer.parts == Parts{"next"});
  CHECK(longer.skipped == 1);
  MultipartReader reader(kType, 1'000'000);
  reader.Feed("--b" + std::string(kLargestHead, 'x'));
  CHECK_FALSE(reader.Take());
  CHECK(reader.Skipped() == 0);
  reader.Feed("x");
  CHECK_FALSE(reader.Take());
  CHECK(reader.Skipped() == 1);
}

TEST_CASE("Bytes without a boundary are an error once they are more than one picture may have") {
  MultipartReader reader(kType, kMost);
  reader.Feed(std::string(kMost, 'x'));
  CHECK_FALSE(reader.Take());
  reader.Feed("x");
  CHECK_THROWS_WITH(reader.Take(), "1001 bytes without the stream's boundary '--b'");
}

}  // namespace
}  // namespace rift::vision
