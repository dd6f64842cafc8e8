#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rift/experiment/words.hpp"
#include "rift/files/shell_word.hpp"
#include "rift/report/figures/setting_grid.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

json Text(std::string title) { return {{"title", std::move(title)}}; }
json Mark(std::string title) { return {{"title", std::move(title)}, {"mark", true}}; }
json Number(std::string title, int digits) {
  return {{"title", std::move(title)}, {"digits", digits}};
}

json EmptyTable(const sweep::SweepResult& result) {
  json columns = json::array();
  for (const experiment::Parameter& parameter : result.parameters) {
    json column = Text(experiment::LabelOf(parameter.Name()));
    column["name"] = parameter.Name();
    columns.push_back(std::move(column));
  }
  return {{"columns", columns}, {"rows", json::array()}, {"marks", json::array()}};
}

// As the experiment wrote them; the page sorts those that are numbers by their value.
json Theta(const experiment::Theta& theta) {
  json cells = json::array();
  for (const experiment::ParameterValue& value : theta) cells.push_back(value.text);
  return cells;
}

std::string Note(std::size_t shown, std::size_t all, std::string_view what) {
  if (shown == all) return fmt::format("All {} {}. Click a heading to sort.", all, what);
  return fmt::format("The worst {} of {} {}; table.csv holds all. Click a heading to sort.", shown,
                     all, what);
}

const char* MarkOf(gap::Verdict verdict) {
  if (verdict == gap::Verdict::kFalsified) return "fail";
  return verdict == gap::Verdict::kUndecided ? "unknown" : "";
}

/// How the row comes about again: its number for the replay, or what follows `rift gap`.
json AgainCell(const sweep::TrialRow& row, std::ptrdiff_t number, const std::string& gap_flags) {
  if (gap_flags.empty()) return number;
  if (!row.IsOk()) return nullptr;
  return files::ShellWord(row.candidate) + " " + files::ShellWord(row.reference) + gap_flags;
}

json TrialCells(const sweep::TrialRow& row, std::ptrdiff_t number, const std::string& gap_flags) {
  json cells = Theta(row.theta);
  cells.insert(cells.begin(), number);
  const gap::Comparison& c = row.comparison;
  const std::string_view status = EnumNames(row.status)[static_cast<int>(row.status)];
  cells.push_back(row.trial);
  cells.push_back(row.IsOk() ? (row.falsified ? "above threshold" : "holds") : status);
  for (const double value : {c.gap_m, c.gap_u, c.exact_gap_m, c.mean_error_m, c.start_offset_m,
                             c.start_aligned_gap_m, c.shape_gap_m, c.end_error_m, c.length_ratio}) {
    cells.push_back(Value(value));
  }
  cells.push_back(row.reason);
  cells.push_back(AgainCell(row, number, gap_flags));
  return cells;
}

}  // namespace

// Trials without a gap are worst: nothing is known of them.
std::vector<const sweep::TrialRow*> RowsToShow(const sweep::SweepResult& result, int limit) {
  std::vector<const sweep::TrialRow*> rows;
  for (const sweep::TrialRow& row : result.rows) rows.push_back(&row);
  if (static_cast<int>(rows.size()) <= limit) return rows;
  const auto rank = [](const sweep::TrialRow* row) {
    return row->IsOk() ? row->comparison.gap_m : std::numeric_limits<double>::infinity();
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const auto* a, const auto* b) { return rank(a) > rank(b); });
  rows.resize(limit);
  return rows;
}

PageTable SettingsTable(const sweep::SweepResult& result, const ReportOptions& options) {
  json table = EmptyTable(result);
  for (json column : {Mark("verdict"), Number("mean gap (m)", 4), Number("failed", 0),
                      Number("trials", 0), Number("without gap", 0), Number("noise floor (m)", 4),
                      Number("share from (%)", 0), Number("share to (%)", 0)}) {
    table["columns"].push_back(std::move(column));
  }
  auto settings = WorstSettings(result);
  const std::size_t all = settings.size();
  if (static_cast<int>(all) > options.table_rows) settings.resize(options.table_rows);
  for (const sweep::SettingResult* setting : settings) {
    const gap::RepeatVerdict& verdict = setting->verdict;
    json cells = Theta(setting->theta);
    cells.push_back(gap::VerdictText(verdict));
    cells.push_back(Value(setting->mean_gap_m));
    cells.push_back(verdict.above);
    cells.push_back(verdict.repeats);
    cells.push_back(NotMeasured(result, *setting));
    cells.push_back(Value(setting->noise_floor_m));
    cells.push_back(Value(100.0 * verdict.share_low));
    cells.push_back(Value(100.0 * verdict.share_high));
    table["rows"].push_back(std::move(cells));
    table["marks"].push_back(MarkOf(verdict.verdict));
  }
  return {std::move(table), Note(settings.size(), all, "settings, the worst first") +
                                " The worse, the larger is the share of its runs that fail, and "
                                "among equals the mean loss. \"share\" is the interval for the "
                                "share of such runs that fail."};
}

PageTable TrialsTable(const sweep::SweepResult& result, const std::string& gap_flags,
                      const ReportOptions& options) {
  json table = EmptyTable(result);
  table["columns"].insert(table["columns"].begin(), Number("row", 0));
  for (json column :
       {Text("trial"), Mark("result"), Number("gap (m)", 4), Number("at u", 3),
        Number("exact gap (m)", 4), Number("mean error (m)", 4), Number("start offset (m)", 4),
        Number("start-aligned gap (m)", 4), Number("shape gap (m)", 4), Number("end error (m)", 4),
        Number("length ratio", 3), Text("reason"),
        json{{"title", gap_flags.empty() ? "drive it again" : "measure it again"},
             {"again", gap_flags.empty() ? "replay" : "gap"}}}) {
    table["columns"].push_back(std::move(column));
  }
  const auto rows = RowsToShow(result, options.table_rows);
  for (const sweep::TrialRow* row : rows) {
    table["rows"].push_back(TrialCells(*row, row - result.rows.data() + 1, gap_flags));
    table["marks"].push_back(row->falsified ? "fail" : row->IsOk() ? "" : "unknown");
  }
  table["complete"] = rows.size() == result.rows.size();
  const char* again =
      gap_flags.empty()
          ? " The command beside a trial drives it again, bit for bit; a click copies it."
          : " The command beside a trial measures its logs again; a click copies it.";
  return {std::move(table), Note(rows.size(), result.rows.size(), "trials") + again};
}

}  // namespace rift::report
