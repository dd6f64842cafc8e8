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
  const std::string host = name.substr(begin, name.find_first_of("/?#", begin) - begin);
  const std::size_t at = host.rfind('@');
  return at == std::string::npos ? name : name.substr(0, begin) + "***" + name.substr(begin + at);
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
