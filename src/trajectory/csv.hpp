#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory::csv {

/// The text without its byte order mark.
std::string_view WithoutMark(std::string_view text);

/// Takes the next line off `rest`, without its CR LF or LF.
std::string_view TakeLine(std::string_view& rest);

/// At most 60 bytes of it for a message, those that no terminal shows written as \xNN.
std::string Shown(std::string_view text);

/// Cells between commas, without the blanks or the double quotes around them.
std::vector<std::string> SplitHeader(std::string_view line);

/// Up to eight bytes that are looked for again. No text at all repeats a longer one.
class ShortText {
 public:
  ShortText() = default;
  /// Nothing either where fewer than eight bytes are left before `end`.
  ShortText(const char* begin, size_t size, const char* end);

  /// True when the bytes from `at` on begin with this text.
  bool IsAt(const char* at, const char* end) const;
  size_t Size() const { return size_; }

 private:
  size_t size_ = 0;  ///< 0: not to be found
  std::uint64_t bytes_ = 0, mask_ = 0;
};

/// The numbers of a text table, one row after the other: a long log is not held twice. Separated by
/// `separator` (a blank stands for any run of blanks and tabs). No two columns of a header may
/// share a name. Everything throws std::invalid_argument `name:line: ...`.
class RowReader {
 public:
  /// `head`: the piece before the next one. `pieces` and `name` must outlive the reader.
  RowReader(std::string_view head, const TextPieces& pieces, const std::string& name,
            bool has_header, char separator);

  /// Header cells; empty for a table without header.
  const std::vector<std::string>& Columns() const { return columns_; }

  /// Goes on to the next row; false after the last.
  bool Next();
  /// The row as numbers; a cell that was empty is NaN, any other is finite.
  std::span<const double> Cells() const { return cells_; }
  /// 1-based line of the row in the file.
  int Line() const { return line_number_; }
  /// This row and those to come, were they as long as this one, and a fifth more.
  size_t RowsToExpect() const;

 private:
  bool HasMore();
  void ReadHeader();
  bool IsSkipped(std::string_view line) const;
  bool TakePlain();
  void ReadAny(std::string_view line);
  double Number(std::string_view cell, size_t column) const;
  [[noreturn]] void Refuse(std::string_view cell, size_t column) const;

  std::string_view rest_;  ///< of the piece
  const TextPieces& pieces_;
  size_t seen_bytes_;  ///< of all pieces so far
  const std::string& name_;
  const bool has_header_;
  const char separator_;
  std::vector<std::string> columns_;
  std::vector<double> cells_;     ///< as many as the first row had, or the header
  std::vector<ShortText> above_;  ///< their text with what ends it, where it was plain
  size_t line_size_ = 0;          ///< of the last row, its end included
  int line_number_ = 0;
};

}  // namespace rift::trajectory::csv
