// The bytes of a table: cells that are written, bytes that are no text, rows that were torn.
#include "rift/trajectory/csv.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace rift::trajectory::csv {
namespace {

TEST_CASE("A cell is quoted where it holds what parts cells, and its own quotes are doubled") {
  CHECK(Cell("a b") == "a b");
  CHECK(Cell("") == "");
  CHECK(Cell("a,b") == "\"a,b\"");
  CHECK(Cell("a\"b") == "\"a\"\"b\"");
  CHECK(Cell("\"\"") == "\"\"\"\"\"\"");
  CHECK(Cell("a\nb") == "\"a\nb\"");
  CHECK(Cell("a\rb") == "\"a\rb\"");
  CHECK(Cell("a;b") == "a;b");
  CHECK(Cell("a;b", ";") == "\"a;b\"");
  CHECK(Cell("a,b", ";") == "a,b");
  for (const char* text : {"a,b", "a\"b", "\"", ",\"", "plain"}) {
    CHECK(SplitHeader(Cell(text)) == std::vector<std::string>{text});
  }
}

TEST_CASE("Of the bytes below a blank seven are text: ends of lines, tabs, the bell and escape") {
  for (int byte = 0; byte < 256; ++byte) {
    INFO(byte);
    const bool is_text = byte >= 0x20 || byte == '\t' || byte == '\n' || byte == '\r' ||
                         byte == '\v' || byte == '\f' || byte == '\a' || byte == 0x1b;
    CHECK(IsNoText(static_cast<char>(byte)) == !is_text);
  }
}

TEST_CASE("Of a long text sixty bytes are shown, and those that no terminal shows as numbers") {
  CHECK(Shown(std::string(61, 'a')) == std::string(60, 'a'));
  CHECK(Shown(std::string(59, 'a') + "\x01z") == std::string(59, 'a') + "\\x01");
  for (int byte = 0; byte < 256; ++byte) {
    INFO(byte);
    const bool is_visible = byte >= 0x20 && byte != 0x7F && byte < 0xF8;
    CHECK((Shown(std::string(1, static_cast<char>(byte))).size() == 1) == is_visible);
  }
}

TEST_CASE("A comment is what begins with #, behind blanks or not, and a blank line is none") {
  CHECK(IsComment("# a"));
  CHECK(IsComment(" \t#"));
  CHECK_FALSE(IsComment("a #"));
  CHECK_FALSE(IsComment(""));
  CHECK(IsBlankLine(""));
  CHECK(IsBlankLine(" \t "));
  CHECK_FALSE(IsBlankLine(" ."));
  CHECK(WithoutMark("\xEF\xBB\xBFt") == "t");
  CHECK(WithoutMark("\xEF\xBBt") == "\xEF\xBBt");
}

TEST_CASE("A last row without its end is torn where it lacks cells or ends within a number") {
  const std::string head = "\r\nt,\"x,y\",z\n1,2,3\n";
  const std::string torn = "the last row was cut short while it was written: it is left out";
  const std::string perhaps = "the last row has no line end: its last number may be cut";
  for (const char* row : {"4", "4,", "4,5", "4,5,6e", "4,5,6E", "4,5,-", "4,5,+", "4,5,6."}) {
    INFO(row);
    CHECK(WithoutTornRow(head + row) == head);
    CHECK(NoteOfEnd(head + row) == torn);
  }
  for (const char* row : {"4,5,6", "4,5,", "4,5,6,7"}) {
    INFO(row);
    CHECK(WithoutTornRow(head + row) == head + row);
    CHECK(NoteOfEnd(head + row) == perhaps);
  }
  for (const std::string& whole : {head, head + " \t\r", head + "4,5,6\n", std::string("t,x,y")}) {
    CHECK(WithoutTornRow(whole) == whole);
    CHECK_FALSE(NoteOfEnd(whole));
  }
}

/// Rows until the last, or what is wrong with one.
std::string Rows(const std::string& text, bool has_header, char separator) {
  const std::string name = "a.csv";
  std::string rows;
  try {
    RowReader reader(text, name, has_header, separator);
    for (const std::string& column : reader.Columns()) rows += column + " ";
    while (reader.Next()) {
      rows += std::to_string(reader.Line()) + ":";
      for (const double cell : reader.Cells()) rows += " " + std::to_string(int(cell));
      rows += "; ";
    }
  } catch (const std::invalid_argument& error) {
    rows += error.what();
  }
  return rows;
}

TEST_CASE("Rows are told with their lines; comments are skipped where there is no header") {
  CHECK(Rows("\na,b\n\n1,2\n \n3,4", true, ',') == "a b 4: 1 2; 6: 3 4; ");
  CHECK(Rows("# c\n1 2\n\n#\n 3\t4 \n", false, ' ') == "2: 1 2; 5: 3 4; ");
  CHECK(Rows("a,b\n#,2\n", true, ',') ==
        "a b a.csv:2: column a is '#': a finite number is expected");
  CHECK(Rows("1 2\n3\n", false, ' ') ==
        "1: 1 2; a.csv:2: the row has 1 cells where 2 are expected");
  CHECK(Rows("1 2\n3 4 5\n", false, ' ') ==
        "1: 1 2; a.csv:2: the row has 3 cells where 2 are expected");
}

TEST_CASE("The lines of a table are its ends of lines and one more, and two millions are taken") {
  const std::string name = "a.csv";
  std::string text(1'999'999, '\n');
  CHECK_NOTHROW(RowReader(text, name, true, ','));
  text += '\n';
  CHECK_THROWS_WITH(RowReader(text, name, true, ','),
                    Catch::StartsWith("a.csv: 2000001 rows: at most 2000000 are taken"));
}

TEST_CASE("Advice stands beside the refusal of a column that it is of, and of no other") {
  const std::string name = "a.csv";
  for (const size_t advised : {0, 1}) {
    RowReader reader("p,q\nwide,1\n", name, true, ',');
    reader.Advise({advised}, "; so it is");
    CHECK_THROWS_WITH(reader.Next(),
                      std::string("a.csv:2: column p is 'wide': a finite number is expected") +
                          (advised == 0 ? "; so it is" : ""));
  }
}

}  // namespace
}  // namespace rift::trajectory::csv
