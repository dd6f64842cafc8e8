#pragma once

#include <concepts>
#include <cstddef>
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

/// T is U or const U, for the two directions of Members().
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

/// Appends values to bytes as this machine holds them: for another process of it, and for a journal
/// that it wrote itself. Numbers keep every bit, the payload of a NaN included. A struct with texts
/// or lists in it has a function of this namespace that hands its members to either direction:
///   template <class Bytes, Is<Thing> T> void Members(Bytes& bytes, T& thing) { bytes(thing.name);
///   }
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
  template <class T>
  void operator()(const std::vector<T>& items) {
    (*this)(items.size());
    for (const T& item : items) (*this)(item);
  }
  template <class T>
  requires(!Plain<T>) void operator()(const T& value) { Members(*this, value); }

  /// Writes how many items follow, and gives it back; see ByteReader.
  size_t Count(size_t items, size_t /*bytes_each*/) {
    (*this)(items);
    return items;
  }

  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what ByteWriter wrote, in the same order. Throws std::runtime_error when bytes are missing
/// and for a bool or a value of an enum (which has EnumNames) that is none.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <Plain T>
  void operator()(T& value) {
    const std::string_view bytes = Next(sizeof value);
    if constexpr (std::is_same_v<T, bool>) {
      if (bytes[0] != 0 && bytes[0] != 1) NoSuchValue();
    } else if constexpr (std::is_enum_v<T>) {
      std::underlying_type_t<T> index{};
      std::memcpy(&index, bytes.data(), sizeof index);
      if (index < 0 || static_cast<size_t>(index) >= EnumNames(T{}).size()) NoSuchValue();
    }
    std::memcpy(&value, bytes.data(), sizeof value);
  }
  void operator()(std::string& text) { text = Next(Count(0, 1)); }
  template <class T>
  void operator()(std::optional<T>& value) {
    bool has_value = false;
    (*this)(has_value);
    value.reset();
    if (has_value) (*this)(value.emplace());
  }

  template <class T>
  void operator()(std::vector<T>& items) {
    constexpr size_t kLeastBytes = Plain<T> ? sizeof(T) : 1;
    items.resize(Count(0, kLeastBytes));
    for (T& item : items) (*this)(item);
  }
  template <class T>
  requires(!Plain<T>) void operator()(T& value) { Members(*this, value); }

  /// How many items follow, each of at least that many bytes; more than there can be are an error.
  size_t Count(size_t /*items*/, size_t bytes_each) {
    size_t count = 0;
    (*this)(count);
    if (count > bytes_.size() / bytes_each) CutShort();
    return count;
  }

  bool IsAtEnd() const { return bytes_.empty(); }

 private:
  std::string_view Next(size_t count) {
    if (count > bytes_.size()) CutShort();
    const std::string_view next = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return next;
  }

  [[noreturn]] static void CutShort() {
    throw std::runtime_error("a row of the sweep is cut short");
  }
  [[noreturn]] static void NoSuchValue() {
    throw std::runtime_error("a row of the sweep holds a value that there is none of");
  }

  std::string_view bytes_;
};

}  // namespace rift::sweep
