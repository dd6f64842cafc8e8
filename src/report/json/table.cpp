#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "rift/sweep/explain/worst_trial.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using trajectory::csv::Cell;

std::string NumberCell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string RowCsv(const sweep::TrialRow& row, size_t id) {
  std::string text;
  for (const experiment::ParameterValue& value : row.theta) text += Cell(value.text) + ',';
  const std::string falsified = row.IsOk() || row.falsified ? fmt::format("{}", row.falsified) : "";
  text += fmt::format("{},{},{},{}", Cell(row.trial), NumberCell(row.comparison.gap_m), falsified,
                      yaml::NameOf(row.status));
  const gap::Comparison& c = row.comparison;
  for (const double value : {c.gap_u, c.exact_gap_m, c.mean_error_m, c.rms_error_m,
                             c.start_offset_m, c.start_aligned_gap_m, c.shape_gap_m, c.length_ratio,
                             c.end_error_m, row.way_gap_m, row.left_m}) {
    text += ',' + NumberCell(value);
  }
  return text + ',' + Cell(row.reason) + ',' + Cell(row.candidate) + ',' + Cell(row.reference) +
         ',' + (row.seed ? fmt::format("{}", *row.seed) : "") + fmt::format(",{}\n", id);
}

constexpr std::array<std::string_view, 12> kNumberColumns{"gap_m",
                                                          "u",
                                                          "exact_gap_m",
                                                          "mean_error_m",
                                                          "rms_error_m",
                                                          "start_offset_m",
                                                          "start_aligned_gap_m",
                                                          "shape_gap_m",
                                                          "length_ratio",
                                                          "end_error_m",
                                                          "way_gap_m",
                                                          "left_m"};

/// The number where all of the cell is one, as it is written here.
template <class Number>
std::optional<Number> NumberIn(const std::string& cell) {
  Number number{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return number;
}

bool IsGap(const std::string& cell) {
  const std::optional<double> gap_m = NumberIn<double>(cell);
  return gap_m && std::isfinite(*gap_m) && *gap_m >= 0.0;
}

/// The rows of a table.csv, one after the other. A table is read back as it was written or not at
/// all: a cell that was overwritten must not become a zero.
class TableReader {
 public:
  /// `text` must outlive the reader. Throws std::invalid_argument for columns that no
  /// sweep writes.
  TableReader(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
    columns_ = NextRecord();
    for (const std::string_view column : experiment::kFixedColumns) {
      if (std::count(columns_.begin(), columns_.end(), column) == 1) continue;
      Refuse(fmt::format("its header does not name the column {} once", column));
    }
  }

  bool IsAtEnd() const { return rest_.empty(); }

  /// Throws std::invalid_argument for a row that no sweep writes.
  TableRow Next() {
    ++row_;
    const std::vector<std::string> cells = NextRecord();
    if (cells.size() != columns_.size()) {
      Refuse(fmt::format("row {} has {} cells, and the header {}", row_, cells.size(),
                         columns_.size()));
    }
    TableRow row;
    for (size_t i = 0; i < columns_.size(); ++i) row[columns_[i]] = cells[i];
    Check(row);
    return row;
  }

  size_t RowsRead() const { return row_; }

 private:
  /// RFC 4180.
  std::vector<std::string> NextRecord() {
    std::vector<std::string> cells(1);
    bool is_quoted = false;
    size_t at = 0;
    for (; at < rest_.size(); ++at) {
      const char c = rest_[at];
      const bool is_double = is_quoted && c == '"' && rest_.substr(at + 1).starts_with('"');
      if (is_double) {
        cells.back() += '"';
        ++at;
      } else if (c == '"') {
        is_quoted = !is_quoted;
      } else if (c == ',' && !is_quoted) {
        cells.emplace_back();
      } else if (c == '\n' && !is_quoted) {
        break;
      } else {
        cells.back() += c;
      }
    }
    if (at >= rest_.size()) {
      Refuse(row_ == 0 ? "its header is cut short" : fmt::format("row {} is cut short", row_));
    }
    rest_.remove_prefix(at + 1);
    return cells;
  }

  void Check(const TableRow& row) const {
    const auto require = [&](std::string_view column, bool is_right) {
      if (is_right) return;
      Refuse(fmt::format("{} of row {} is '{}'", column, row_, row.at(std::string(column))));
    };
    require("id", row.at("id") == fmt::format("{}", row_));  // none cut out, doubled or exchanged
    const std::optional<sweep::TrialStatus> status =
        yaml::ValueNamed<sweep::TrialStatus>(row.at("status"));
    require("status", status.has_value());
    const bool is_ok = status == sweep::TrialStatus::kOk;
    require("falsified",
            row.at("falsified") == "true" || row.at("falsified") == (is_ok ? "false" : ""));
    for (const std::string_view column : kNumberColumns) {
      const std::string& cell = row.at(std::string(column));
      const std::optional<double> number = NumberIn<double>(cell);
      require(column, number ? !std::isnan(*number) : cell.empty());
    }
    require("gap_m", IsGap(row.at("gap_m")) || (!is_ok && row.at("gap_m").empty()));
    require("seed", row.at("seed").empty() || NumberIn<std::uint64_t>(row.at("seed")));
  }

  [[noreturn]] void Refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format(
        "{}: {}: no sweep writes that; give the command of the sweep again, which writes the table "
        "anew",
        name_, what));
  }

  std::string_view rest_;
  std::string name_;
  std::vector<std::string> columns_;
  size_t row_ = 0;
};

}  // namespace

std::string TableCsv(const sweep::SweepResult& result) {
  std::string text;
  for (const experiment::Parameter& parameter : result.parameters)
    text += Cell(parameter.Name()) + ',';
  text += fmt::format("{}\n", fmt::join(experiment::kFixedColumns, ","));
  size_t id = 0;
  for (const sweep::TrialRow& row : result.rows) text += RowCsv(row, ++id);
  return text;
}

TableRow FirstTableRow(const std::string& table_csv) {
  return TableReader(table_csv, "table.csv").Next();
}

std::vector<TableRow> TableRows(const std::string& table_csv) {
  TableReader read(table_csv, "table.csv");
  std::vector<TableRow> rows;
  while (!read.IsAtEnd()) rows.push_back(read.Next());
  return rows;
}

TableRow TableRowOf(const std::string& table_csv, const std::string& id, const std::string& name) {
  TableReader read(table_csv, name);
  while (!read.IsAtEnd()) {
    TableRow row = read.Next();
    if (row.at("id") == id) return row;
  }
  throw std::invalid_argument(
      fmt::format("{} has no row with id {}: its ids are 1 to {}", name, id, read.RowsRead()));
}

namespace {

/// NaN of an empty cell.
double CellNumber(const TableRow& row, const char* column) {
  return NumberIn<double>(row.at(column)).value_or(gap::kNotComputed);
}

/// As far as it decides how bad it is.
sweep::TrialRow FailureRow(const TableRow& row) {
  sweep::TrialRow trial;
  trial.status = yaml::ValueNamed<sweep::TrialStatus>(row.at("status")).value();
  trial.falsified = row.at("falsified") == "true";
  trial.comparison.gap_m = CellNumber(row, "gap_m");
  trial.way_gap_m = CellNumber(row, "way_gap_m");
  trial.left_m = CellNumber(row, "left_m");
  return trial;
}

}  // namespace

std::string WorstIdOf(const std::string& table_csv, const std::string& name, double threshold_m) {
  TableReader read(table_csv, name);
  std::vector<std::string> ids;
  std::vector<sweep::TrialFailure> trials;
  while (!read.IsAtEnd()) {
    const TableRow row = read.Next();
    ids.push_back(row.at("id"));
    trials.push_back(sweep::FailureOf(FailureRow(row), threshold_m));
  }
  const std::optional<size_t> worst = sweep::WorstTrial(trials);
  if (!worst) throw std::invalid_argument(name + " has no row with a gap: name a row's id");
  return ids[*worst];
}

sweep::TrialRequest RequestOf(const experiment::Experiment& experiment, const TableRow& row,
                              const std::string& name) {
  sweep::TrialRequest request{.trial = row.at("trial")};
  std::uint64_t seed = 0;
  const std::string& text = row.at("seed");
  std::from_chars(text.data(), text.data() + text.size(), seed);
  request.seed = seed;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    const auto cell = row.find(parameter.Name());
    if (cell == row.end()) {
      throw std::invalid_argument(fmt::format(
          "{} has no column {}, and experiment.yaml beside it a parameter of that name: "
          "they are of two sweeps; give the command of the sweep again, which writes both anew",
          name, parameter.Name()));
    }
    request.theta.push_back(experiment::ParseValue(parameter, cell->second));
  }
  return request;
}

nlohmann::ordered_json ThetaJson(const std::vector<experiment::Parameter>& parameters,
                                 const experiment::Theta& theta) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (size_t i = 0; i < theta.size(); ++i) json[parameters[i].Name()] = sweep::ValueJson(theta[i]);
  return json;
}

}  // namespace rift::report
