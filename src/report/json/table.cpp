#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "rift/sweep/explain/worst_trial.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

/// RFC 4180: quoted when it must be.
std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string NumberCell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string RowCsv(const sweep::TrialRow& row, size_t id) {
  std::string text;
  for (const experiment::ParameterValue& value : row.theta) text += CsvCell(value.text) + ',';
  const std::string falsified = row.IsOk() || row.falsified ? fmt::format("{}", row.falsified) : "";
  text += fmt::format("{},{},{},{}", CsvCell(row.trial), NumberCell(row.comparison.gap_m),
                      falsified, yaml::NameOf(row.status));
  const gap::Comparison& c = row.comparison;
  for (const double value : {c.gap_u, c.exact_gap_m, c.mean_error_m, c.rms_error_m,
                             c.start_offset_m, c.start_aligned_gap_m, c.shape_gap_m, c.length_ratio,
                             c.end_error_m, row.way_gap_m, row.left_m}) {
    text += ',' + NumberCell(value);
  }
  return text + ',' + CsvCell(row.reason) + ',' + CsvCell(row.candidate) + ',' +
         CsvCell(row.reference) + ',' + (row.seed ? fmt::format("{}", *row.seed) : "") +
         fmt::format(",{}\n", id);
}

/// RFC 4180. Takes one record off the front of the text.
std::vector<std::string> NextRecord(std::string_view& text) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  size_t at = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    const bool is_double = is_quoted && c == '"' && text.substr(at + 1).starts_with('"');
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
  text.remove_prefix(std::min(text.size(), at + 1));
  return cells;
}

TableRow RowOf(const std::vector<std::string>& columns, const std::vector<std::string>& cells) {
  TableRow row;
  for (size_t i = 0; i < std::min(columns.size(), cells.size()); ++i) row[columns[i]] = cells[i];
  return row;
}

}  // namespace

std::string TableCsv(const sweep::SweepResult& result) {
  std::string text;
  for (const experiment::Parameter& parameter : result.parameters)
    text += CsvCell(parameter.Name()) + ',';
  text += fmt::format("{}\n", fmt::join(experiment::kFixedColumns, ","));
  size_t id = 0;
  for (const sweep::TrialRow& row : result.rows) text += RowCsv(row, ++id);
  return text;
}

TableRow FirstTableRow(const std::string& table_csv) {
  std::string_view text = table_csv;
  const std::vector<std::string> columns = NextRecord(text);
  return RowOf(columns, NextRecord(text));
}

std::vector<TableRow> TableRows(const std::string& table_csv) {
  std::string_view text = table_csv;
  const std::vector<std::string> columns = NextRecord(text);
  std::vector<TableRow> rows;
  while (!text.empty()) rows.push_back(RowOf(columns, NextRecord(text)));
  return rows;
}

TableRow TableRowOf(const std::string& table_csv, const std::string& id, const std::string& name) {
  std::string_view text = table_csv;
  const std::vector<std::string> columns = NextRecord(text);
  size_t rows = 0;
  for (; !text.empty(); ++rows) {
    const std::vector<std::string> cells = NextRecord(text);
    TableRow row = RowOf(columns, cells);
    if (row.contains("id") && row["id"] == id) return row;
  }
  throw std::invalid_argument(
      fmt::format("{} has no row with id {}: its ids are 1 to {}", name, id, rows));
}

std::string WorstIdOf(const std::string& table_csv, const std::string& name) {
  std::string_view text = table_csv;
  const std::vector<std::string> columns = NextRecord(text);
  std::vector<std::string> ids;
  std::vector<sweep::TrialFailure> trials;
  while (!text.empty()) {
    const TableRow row = RowOf(columns, NextRecord(text));
    if (!row.contains("id") || !row.contains("gap_m")) continue;
    ids.push_back(row.at("id"));
    trials.push_back({.falsified = row.contains("falsified") && row.at("falsified") == "true"});
    if (row.at("status") != "ok") continue;
    trials.back().gap_m = std::strtod(row.at("gap_m").c_str(), nullptr);
  }
  const std::optional<size_t> worst = sweep::WorstTrial(trials);
  if (!worst) throw std::invalid_argument(name + " has no row with a gap: name a row's id");
  return ids[*worst];
}

sweep::TrialRequest RequestOf(const experiment::Experiment& experiment, const TableRow& row) {
  sweep::TrialRequest request{.trial = row.at("trial")};
  std::uint64_t seed = 0;
  const std::string& text = row.at("seed");
  std::from_chars(text.data(), text.data() + text.size(), seed);
  request.seed = seed;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    request.theta.push_back(experiment::ParseValue(parameter, row.at(parameter.Name())));
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
