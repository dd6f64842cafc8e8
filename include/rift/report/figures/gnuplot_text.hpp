#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace rift::report {

/// Invalid UTF-8 and what XML forbids replaced, control characters turned into blanks.
std::string PlainText(std::string_view text);

/// A gnuplot string that means exactly this text: single quotes know no escapes, no backquotes.
std::string Quoted(std::string_view text);

/// The same for a tic label, where gnuplot would expand `%`. Further lines go below the first.
std::string TicLabel(const std::vector<std::string>& lines);

/// Cut in the middle when it has more than `limit` letters.
std::string Shortened(std::string_view text, std::size_t limit);

/// The same for the labels of one axis, in which texts that differ stay apart: of those that are
/// alike when cut in the middle the begin they share is cut, and what is alike still is numbered,
/// " (2)".
std::vector<std::string> ShortenedApart(const std::vector<std::string>& texts, std::size_t limit);

/// Where the tics of an axis of categories stand: evenly between the sides of the plot.
struct TicRow {
  double first = 0.5;  ///< distance of the first one from the left side, in distances of two tics
  int width_px = 0;    ///< of the figure
  double left_px = 0.0, right_px = 0.0;  ///< margins that the rest of the figure needs
};

/// The command that widens the left margin for labels of so many letters that are slanted by 40
/// degrees and end at their tics; empty where they fit without it.
std::string SlantedMargin(const std::vector<std::size_t>& letters, const TicRow& row);

/// Letters, not bytes.
std::size_t LetterCount(std::string_view text);

/// A named inline data block, "$name << EOD"; rows of numbers.
class DataBlock {
 public:
  explicit DataBlock(std::string name) : name_("$" + std::move(name)) {}
  void Add(const std::vector<double>& row);
  bool IsEmpty() const { return rows_.empty(); }
  const std::string& Name() const { return name_; }
  std::string Text() const { return name_ + " << EOD\n" + rows_ + "EOD\n"; }

 private:
  std::string name_;
  std::string rows_;
};

/// The parts of one plot command, joined with commas.
class PlotCommand {
 public:
  void Add(std::string part) { parts_.push_back(std::move(part)); }
  std::string Text() const;

 private:
  std::vector<std::string> parts_;
};

/// Okabe and Ito's colour-blind-safe colours (2008), those readable on white first; from the ninth
/// on, samples of viridis.
std::string SeriesColour(int index, int count);

/// Viridis (van der Walt and Smith, 2015; CC0) at nine even steps, for `set palette defined`.
std::string ViridisPalette();

inline constexpr std::string_view kFailColour = "#D55E00";
inline constexpr std::string_view kPassColour = "#0072B2";
inline constexpr std::string_view kThresholdColour = "#000000";

/// A number as people write it: six significant digits, no trailing zeros.
std::string Number(double value);

/// A round number at or above the value, for the end of an axis that starts at 0.
double AxisEnd(double largest);

/// The plot element and legend entry of the threshold, "threshold 0.06 m".
std::string ThresholdLine(double threshold_m);

}  // namespace rift::report
