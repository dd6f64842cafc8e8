#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

#include "columns.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::trajectory {
namespace {

/// A sum of columns, each times a factor.
struct Term {
  size_t column;
  double factor;
};
struct Quantity {
  std::string name;
  std::vector<Term> terms;
};

/// The column, from 0, that a number from 1 names.
std::optional<size_t> NumberedColumn(std::string_view text) {
  size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && number > 0 ? std::optional(number - 1) : std::nullopt;
}

/// The columns of the sources where all are named by their numbers; else nothing.
std::vector<size_t> NumberedColumns(const Sources& sources) {
  std::vector<size_t> columns;
  for (const auto& [quantity, source] : sources) {
    for (std::string part : TrimmedParts(source, '+')) {
      if (part.starts_with('-')) part.erase(0, 1);
      const std::optional<size_t> column = NumberedColumn(part.substr(0, part.rfind(':')));
      if (!column) return {};
      columns.push_back(*column);
    }
  }
  return columns;
}

/// Finds the columns of a source in a header.
class SourceResolver {
 public:
  SourceResolver(const std::vector<std::string>& header, const Units& units, std::string where)
      : header_(header), units_(units), where_(std::move(where)) {}

  std::vector<Quantity> Resolve(const Sources& sources) const {
    std::vector<Quantity> quantities;
    for (const auto& [quantity, source] : sources) {
      quantities.push_back(Resolve(quantity, source));
      for (size_t i = 0; i + 1 < quantities.size(); ++i) {
        RefuseSame(quantities[i], quantities.back());
      }
    }
    return quantities;
  }

 private:
  Quantity Resolve(const std::string& quantity, const std::string& source) const {
    if (const std::optional<Term> whole = TermOf(quantity, source)) return {quantity, {*whole}};
    Quantity resolved{quantity, {}};
    for (const std::string& part : TrimmedParts(source, '+')) {
      std::optional<Term> term = TermOf(quantity, part);
      if (!term && part.starts_with('-')) {
        term = TermOf(quantity, part.substr(1));
        if (term) term->factor = -term->factor;
      }
      if (!term) Refuse(quantity, part);
      resolved.terms.push_back(*term);
    }
    std::sort(resolved.terms.begin(), resolved.terms.end(),
              [](const Term& a, const Term& b) { return a.column < b.column; });
    return resolved;
  }

  std::optional<size_t> ColumnOf(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found != header_.end()) return found - header_.begin();
    const std::optional<size_t> column = NumberedColumn(name);
    return column && *column < header_.size() ? column : std::nullopt;
  }

  std::optional<Term> TermOf(const std::string& quantity, const std::string& text) const {
    if (const auto column = ColumnOf(text)) return Term{*column, StandardUnit(quantity, units_)};
    const size_t colon = text.rfind(':');
    if (colon == text.npos) return std::nullopt;
    const auto column = ColumnOf(text.substr(0, colon));
    if (!column) return std::nullopt;
    const std::string unit = text.substr(colon + 1);
    const std::optional<double> factor = UnitFor(quantity, unit);
    if (!factor) {
      throw std::invalid_argument(
          fmt::format("{}: columns: '{}' is no unit of {}", where_, unit, quantity));
    }
    return Term{*column, *factor};
  }

  [[noreturn]] void Refuse(const std::string& quantity, const std::string& part) const {
    const char* const difference =
        part.find('-', 1) == part.npos ? "" : " (a difference is written A+-B)";
    throw std::invalid_argument(fmt::format(
        "{}: columns: {} is to be '{}', and there is no such column{}: there are {}", where_,
        quantity, part, difference, csv::Shown(fmt::format("{}", fmt::join(header_, ", ")), 400)));
  }

  /// One is the other in another unit or with another sign: no pose has two values alike.
  void RefuseSame(const Quantity& a, const Quantity& b) const {
    const auto is_multiple = [&](const Term& of_a, const Term& of_b) {
      const double one = of_a.factor * b.terms.front().factor,
                   other = of_b.factor * a.terms.front().factor;
      return of_a.column == of_b.column && std::abs(one - other) <= 1e-9 * std::abs(one);
    };
    if (!std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(), is_multiple)) {
      return;
    }
    std::vector<std::string> names;
    for (const Term& term : a.terms) names.push_back(header_[term.column]);
    throw std::invalid_argument(fmt::format("{}: columns: {} and {} are both column '{}'", where_,
                                            a.name, b.name,
                                            csv::Shown(fmt::format("{}", fmt::join(names, "+")))));
  }

  const std::vector<std::string>& header_;
  const Units& units_;
  const std::string where_;
};

class PoseReader {
 public:
  PoseReader(const TextTable& table, const Sources& sources, const Units& units,
             const std::string& name)
      : name_(name),
        quantities_(
            SourceResolver(table.Columns(), units, fmt::format("{}:{}", name, table.FirstLine()))
                .Resolve(sources)) {}

  /// Nothing for a row that has no position at all: another topic's.
  std::optional<StampedPose> PoseOf(const TextTable& table) const {
    std::map<std::string_view, double> values;
    for (const Quantity& quantity : quantities_) values[quantity.name] = Sum(quantity, table);
    if (std::isnan(values["x"]) && std::isnan(values["y"])) return std::nullopt;
    for (const Quantity& quantity : quantities_) {
      const bool is_needed = quantity.name == "t" || quantity.name == "x" || quantity.name == "y";
      if (!is_needed || !std::isnan(values[quantity.name])) continue;
      throw std::invalid_argument(fmt::format("{}:{}: column {} is empty", name_, table.Line(),
                                              table.Columns()[quantity.terms.front().column]));
    }
    return FromValues(values, fmt::format("{}:{}", name_, table.Line()));
  }

 private:
  double Sum(const Quantity& quantity, const TextTable& table) const {
    double sum = 0.0;
    for (const Term& term : quantity.terms) {
      const std::optional<double> number = table.Number(term.column);
      if (!number) {
        throw std::invalid_argument(fmt::format(
            "{}:{}: column {} is '{}': a finite number is expected", name_, table.Line(),
            csv::Shown(table.Columns()[term.column]), csv::Shown(table.Cell(term.column))));
      }
      sum += *number * term.factor;
    }
    return sum;
  }

  static StampedPose FromValues(const std::map<std::string_view, double>& values,
                                const std::string& where) {
    const auto value = [&](std::string_view name, double otherwise = StampedPose::kNotLogged) {
      const auto found = values.find(name);
      return found == values.end() ? otherwise : found->second;
    };
    StampedPose pose{.t_s = value("t"),
                     .x_m = value("x"),
                     .y_m = value("y"),
                     .z_m = value("z"),
                     .roll_rad = value("roll"),
                     .pitch_rad = value("pitch"),
                     .yaw_rad = value("yaw"),
                     .target_x_m = value("target_x"),
                     .target_y_m = value("target_y")};
    const double qx = value("qx", 0.0), qy = value("qy", 0.0), qz = value("qz"), qw = value("qw");
    const bool is_logged = !std::isnan(qx + qy + qz + qw);  // no cell of it is empty
    if (is_logged) SetAngles(pose, qx, qy, qz, qw, where);
    return pose;
  }

  const std::string& name_;
  std::vector<Quantity> quantities_;
};

/// The cells of a column that rift track writes, where a log has it. Text is somebody else's.
class OptionalColumn {
 public:
  OptionalColumn(const TextTable& table, std::string_view name)
      : column_(std::find(table.Columns().begin(), table.Columns().end(), name) -
                table.Columns().begin()),
        is_there_(column_ < table.Columns().size()) {}

  std::optional<double> NumberIn(const TextTable& table) const {
    return is_there_ ? table.Number(column_) : std::nullopt;
  }

 private:
  size_t column_;
  bool is_there_;
};

}  // namespace

LogRows ReadColumns(std::string_view text, const std::string& name, const ReadOptions& options) {
  LogRows rows;
  std::string columns = options.columns;
  if (columns.empty()) {
    const ColumnGuess guess = GuessColumns(text, name, options.units);
    if (guess.columns.empty()) {
      throw std::invalid_argument(fmt::format(
          "{}: units are given, and no columns are found for time, x and y: name them with {}t=..."
          ",x=...,y=...{}",
          name, options.columns_flag, guess.unclear));
    }
    columns = rows.guessed = guess.columns;
  }
  const Sources sources = ParseColumns(columns);
  TextTable table(text, name, NumberedColumns(sources));
  const Units units = ParseUnits(options.units);
  const PoseReader reader(table, sources, units, name);
  const OptionalColumn state(table, "track_state"), tag(table, "tag_id");
  std::vector<double> tags;
  while (table.Next()) {
    const std::optional<double> state_of_row = state.NumberIn(table);
    if (state_of_row && !IsTracked(*state_of_row)) {
      ++rows.untracked;
      continue;
    }
    const std::optional<StampedPose> pose = reader.PoseOf(table);
    if (!pose) {
      ++rows.without_position;
      continue;
    }
    AddPose(rows, *pose, name, table.Line());
    if (const auto tag_of_row = tag.NumberIn(table)) tags.push_back(*tag_of_row);
  }
  RequireOneRobot(std::move(tags), name);
  return rows;
}

}  // namespace rift::trajectory
