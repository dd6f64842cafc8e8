#include "rift/vision/camera/camera_source.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace rift::vision {
namespace {

TEST_CASE("Every parameter that names a secret is hidden, in whatever letters, and no other") {
  for (const char* key : {"pass", "PAS", "pwd", "pw", "auth", "authorization", "token",
                          "access_token", "secret", "client-secret", "key", "apikey", "cred",
                          "credentials", "sess", "session_id", "sig", "signature", "x0_Sig-9"}) {
    INFO(key);
    CHECK(WithoutPassword("http://cam/v?a=1&" + std::string(key) + "=se&b=2") ==
          "http://cam/v?a=1&" + std::string(key) + "=***&b=2");
    CHECK(WithoutPassword("rtsp://cam/" + std::string(key) + "=se/b=2") ==
          "rtsp://cam/" + std::string(key) + "=***/b=2");
  }
  for (const char* key : {"user", "channel", "size", "p", "w", "tok", "ke", "cre", "ses", "au"}) {
    INFO(key);
    const std::string address = "http://cam/v?a=1&" + std::string(key) + "=se&b=2";
    CHECK(WithoutPassword(address) == address);
  }
  CHECK(WithoutPassword("http://cam/v?pwd=a#b=c") == "http://cam/v?pwd=***#b=c");
  CHECK(WithoutPassword("http://cam/v?pwd=a/b;c=d") == "http://cam/v?pwd=***;c=d");
  CHECK(WithoutPassword("http://cam/pwd=a/b;c=d") == "http://cam/pwd=***/b;c=d");
  CHECK(WithoutPassword("http://u:p@cam:80") == "http://***@cam:80");
  CHECK(WithoutPassword("http://u:p@cam?a@b") == "http://***@cam?a@b");
  CHECK(WithoutPassword("http://u:p@cam#a@b") == "http://***@cam#a@b");
}

}  // namespace
}  // namespace rift::vision
