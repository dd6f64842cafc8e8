#include "rift/report/figures/gnuplot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace rift::report {
namespace {

constexpr std::array<std::string_view, 8> kOkabeIto = {"#0072B2", "#E69F00", "#009E73", "#CC79A7",
                                                       "#56B4E9", "#D55E00", "#F0E442", "#999999"};

constexpr std::array<std::string_view, 9> kViridis = {"#440154", "#472D7B", "#3B528B",
                                                      "#2C728E", "#21918C", "#28AE80",
                                                      "#5EC962", "#ADDC30", "#FDE725"};

bool StartsLetter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

// Byte position of the letter with this index.
std::size_t LetterStart(std::string_view text, std::size_t letter) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (StartsLetter(text[i]) && seen++ == letter) return i;
  }
  return text.size();
}

}  // namespace

std::string PlainText(std::string_view text) {
  using nlohmann::json;
  const std::string replaced =
      json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace))
          .get<std::string>();
  std::string plain = replaced;
  for (char& c : plain) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  // No character of XML 1.0 (section 2.2), so none of an SVG file: U+FFFD instead.
  for (const std::string_view forbidden : {"\uFFFE", "\uFFFF"}) {
    for (std::size_t at = plain.find(forbidden); at != plain.npos; at = plain.find(forbidden, at)) {
      plain.replace(at, forbidden.size(), "\uFFFD");
    }
  }
  return plain;
}

std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : PlainText(text)) {
    quoted += c;
    if (c == '\'') quoted += c;
  }
  return quoted + "'";
}

std::string TicLabel(const std::vector<std::string>& lines) {
  std::string label;
  for (const std::string& line : lines) {
    std::string doubled;
    for (const char c : line) doubled += c == '%' ? std::string("%%") : std::string(1, c);
    if (!label.empty()) label += ".\"\\n\".";
    label += Quoted(doubled);
  }
  return label;
}

std::string Shortened(std::string_view text, std::size_t limit) {
  const std::string plain = PlainText(text);
  const std::size_t letters = LetterCount(plain);
  if (letters <= limit) return plain;
  const std::size_t head = limit / 2, tail = limit - head - 1;
  return plain.substr(0, LetterStart(plain, head)) + "…" +
         plain.substr(LetterStart(plain, letters - tail));
}

std::vector<std::string> ShortenedApart(const std::vector<std::string>& texts, std::size_t limit) {
  const std::size_t letters_before = limit / 4;  // that stay of what texts of one label share
  std::map<std::string, std::set<std::string>> texts_of;
  for (const std::string& text : texts) texts_of[Shortened(text, limit)].insert(text);
  std::map<std::string, std::string> label_of;
  std::set<std::string> taken;
  for (const auto& [label, alike] : texts_of) {
    if (alike.size() > 1) continue;
    label_of[*alike.begin()] = label;
    taken.insert(label);
  }
  for (const auto& [label, alike] : texts_of) {
    if (alike.size() == 1) continue;
    const std::string &first = *alike.begin(), &last = *alike.rbegin();  // in the order of bytes
    const auto part = std::mismatch(first.begin(), first.end(), last.begin(), last.end());
    const std::size_t common = LetterCount(std::string_view(first.begin(), part.first));
    const std::size_t skipped = common - std::min(common, letters_before);
    for (const std::string& text : alike) {
      const std::string rest = text.substr(LetterStart(text, skipped));
      const std::string cut = Shortened(skipped > 0 ? "…" + rest : rest, limit);
      std::string name = cut;
      for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{} ({})", cut, n);
      label_of[text] = name;
    }
  }
  std::vector<std::string> labels;
  for (const std::string& text : texts) labels.push_back(label_of.at(text));
  return labels;
}

std::string SlantedMargin(const std::vector<std::size_t>& letters, const TicRow& row) {
  constexpr double kLetter_px = 5.4;  // along the axis: 7 px times the cosine of 40 degrees
  const double most_px = 0.5 * row.width_px;
  double margin_px = row.left_px;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const double place = (static_cast<double>(i) + row.first) / static_cast<double>(letters.size());
    // What stands left of the tic: the margin, and that share of the plot that it leaves.
    const double label_px = kLetter_px * static_cast<double>(letters[i] + 1);
    const double needed_px =
        (label_px - place * (row.width_px - row.right_px)) / std::max(0.1, 1.0 - place);
    margin_px = std::max(margin_px, std::min(needed_px, most_px));
  }
  if (margin_px <= row.left_px) return "";
  return fmt::format("set lmargin at screen {:.4f}\n", margin_px / row.width_px);
}

std::size_t LetterCount(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), StartsLetter));
}

void DataBlock::Add(const std::vector<double>& row) {
  for (const double value : row) {
    rows_ += std::isfinite(value) ? fmt::format("{:.7g} ", value) : std::string("NaN ");
  }
  rows_ += '\n';
}

std::string PlotCommand::Text() const {
  return fmt::format("plot {}\n", fmt::join(parts_, ", \\\n  "));
}

std::string SeriesColour(int index, int count) {
  if (count <= static_cast<int>(kOkabeIto.size())) return std::string(kOkabeIto[index]);
  const std::size_t step = static_cast<std::size_t>(index) * kViridis.size() / count;
  return std::string(kViridis[step]);
}

std::string ViridisPalette() {
  std::string text = "set palette defined (";
  for (std::size_t i = 0; i < kViridis.size(); ++i) {
    text += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, kViridis[i]);
  }
  return text + ")\n";
}

std::string Number(double value) { return fmt::format("{:.6g}", value); }

double AxisEnd(double largest) {
  if (!(largest > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double round : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
    if (largest <= round * decade * (1.0 + 1e-12)) return round * decade;
  }
  return 10.0 * decade;
}

std::string ThresholdLine(double threshold_m) {
  return fmt::format("{:.9g} with lines lw 1.2 dt 2 lc rgb '{}' title {}", threshold_m,
                     kThresholdColour, Quoted(fmt::format("threshold {} m", Number(threshold_m))));
}

}  // namespace rift::report
