#pragma once

#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace rift::sweep {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// Numbers, enums, and structs of nothing but them.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !kIsOptional<T>;

/// Appends values to bytes as this machine holds them: for another process of it, and for a journal
/// that it wrote itself. Numbers keep every bit, the payload of a NaN included.
class ByteWriter {
 public:
  template <Plain T>
  void operator()(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const std::string& text) {
    (*this)(text.size());
    bytes_ += text;
  }
  template <class T>
  void operator()(const std::optional<T>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }

  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what ByteWriter wrote, in the same order. Throws std::runtime_error when bytes are
/// missing.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <Plain T>
  void operator()(T& value) {
    std::memcpy(&value, Next(sizeof value).data(), sizeof value);
  }
  void operator()(std::string& text) {
    size_t size = 0;
    (*this)(size);
    text = Next(size);
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    bool has_value = false;
    (*this)(has_value);
    value.reset();
    if (has_value) (*this)(value.emplace());
  }

  bool IsAtEnd() const { return bytes_.empty(); }

 private:
  std::string_view Next(size_t count) {
    if (count > bytes_.size()) throw std::runtime_error("a row of the sweep is cut short");
    const std::string_view next = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return next;
  }

  std::string_view bytes_;
};

}  // namespace rift::sweep
