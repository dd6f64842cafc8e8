#include "rift/vision/camera/camera_source.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "sources.hpp"

namespace rift::vision {
namespace {

bool IsNumber(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Whether a parameter of an address is a password by its name: pwd, loginpas, access_token.
bool NamesSecret(std::string key) {
  std::transform(key.begin(), key.end(), key.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* known : {"pas", "pw", "auth", "token", "secret", "key", "cred", "sess", "sig"}) {
    if (key.find(known) != key.npos) return true;
  }
  return false;
}

/// Of what follows the host. Some cameras take their parameters in the path.
std::string WithoutSecrets(std::string text) {
  constexpr std::string_view kOfKeys =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  for (std::size_t equals = text.find('='); equals != text.npos;
       equals = text.find('=', equals + 1)) {
    const std::string before = text.substr(0, equals);
    const std::size_t key = before.find_last_not_of(kOfKeys) + 1;  // 0 without any
    if (!NamesSecret(before.substr(key))) continue;
    const bool is_query = before.find('?') != before.npos;
    const std::size_t end = text.find_first_of(is_query ? "&;#" : "/?&;#", equals);
    text.replace(equals + 1, std::min(end, text.size()) - equals - 1, "***");
  }
  return text;
}

}  // namespace

bool NamesPicture(std::string_view name) {
  std::string ending = std::filesystem::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const std::string_view known :
       {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff", ".pgm", ".ppm"}) {
    if (ending == known) return true;
  }
  return false;
}

SourceKind KindOf(std::string_view name) {
  if (name.starts_with("/dev/") || IsNumber(name)) return SourceKind::kDevice;
  if (name.starts_with("http://") || name.starts_with("https://")) return SourceKind::kStream;
  if (name.find("://") != std::string_view::npos) return SourceKind::kNetwork;
  const bool is_pattern = name.find_first_of("*?[") != std::string_view::npos;
  if (is_pattern || NamesPicture(name) || std::filesystem::is_directory(name)) {
    return SourceKind::kImages;
  }
  return SourceKind::kVideo;
}

std::string WithoutPassword(const std::string& name) {
  const std::size_t scheme = name.find("://");
  if (scheme == std::string::npos) return name;
  const std::size_t begin = scheme + 3;
  // A password may hold an @ of its own (RFC 3986 wants %40); a path that has one is none.
  const std::size_t end = std::min(name.find_first_of("/?#", begin), name.size());
  const std::string host = name.substr(begin, end - begin);
  const std::size_t at = host.rfind('@');
  return name.substr(0, begin) + (at == std::string::npos ? host : "***" + host.substr(at)) +
         WithoutSecrets(name.substr(end));
}

std::unique_ptr<CameraSource> OpenCamera(const std::string& name, const CaptureOptions& options) {
  switch (KindOf(name)) {
    case SourceKind::kDevice:
      return OpenDevice(IsNumber(name) ? "/dev/video" + name : name, options);
    case SourceKind::kStream:
      return OpenStream(name, options);
    case SourceKind::kNetwork:
      return OpenNetwork(name, options);
    case SourceKind::kImages:
      return OpenImages(name, options);
    case SourceKind::kVideo:
      break;
  }
  return OpenVideo(name);
}

}  // namespace rift::vision
