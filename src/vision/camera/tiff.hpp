#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

namespace rift::vision {

/// A TIFF file, or the structure of one inside an Exif segment: folders of entries, offsets from
/// its first byte (TIFF 6.0, section 2). What lies outside reads as nothing.
class Tiff {
 public:
  explicit Tiff(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    is_little_ = bytes_.size() > 1 && bytes_[0] == 'I' && bytes_[1] == 'I';
  }

  struct Entry {
    int type = 0;
    std::size_t count = 0, at = 0;  ///< at: of its value or its offset
  };

  /// Where the first folder begins.
  std::optional<std::size_t> Root() const { return Number(2, 2) == 42U ? Number(4, 4) : none_; }
  std::optional<Entry> Find(std::size_t folder, int tag) const {
    const auto entries = Number(folder, 2);
    for (std::size_t i = 0; entries && i < *entries; ++i) {
      const std::size_t at = folder + 2 + i * kEntryBytes;
      const auto found = Number(at, 2), type = Number(at + 2, 2), count = Number(at + 4, 4);
      if (!found || !type || !count) return std::nullopt;
      if (*found == static_cast<std::size_t>(tag)) return Entry{int(*type), *count, at + 8};
    }
    return std::nullopt;
  }
  std::optional<std::size_t> Offset(const Entry& entry) const {
    return entry.type == kLong ? Number(entry.at, 4) : none_;
  }
  /// The first number of an entry of whole numbers.
  std::optional<std::size_t> Value(const Entry& entry) const {
    return entry.type == kShort ? Number(entry.at, 2) : Offset(entry);
  }
  /// Up to its zero byte; up to four letters stand in the entry itself.
  std::string_view Text(const Entry& entry) const {
    const auto at = entry.count <= 4 ? entry.at : Number(entry.at, 4);
    if (entry.type != kAscii || !at || *at >= bytes_.size()) return {};
    const std::size_t length = std::min(entry.count, bytes_.size() - *at);
    const auto* letters = reinterpret_cast<const char*>(bytes_.data() + *at);
    return {letters, strnlen(letters, length)};
  }

 private:
  std::optional<std::size_t> Number(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || bytes_.size() - at < length) return std::nullopt;
    std::size_t number = 0;
    for (std::size_t i = 0; i < length; ++i) {
      number = number << 8 | bytes_[at + (is_little_ ? length - 1 - i : i)];
    }
    return number;
  }

  static constexpr int kAscii = 2, kShort = 3, kLong = 4;
  static constexpr std::size_t kEntryBytes = 12;
  static constexpr std::optional<std::size_t> none_ = std::nullopt;
  std::span<const std::uint8_t> bytes_;
  bool is_little_ = false;
};

}  // namespace rift::vision
