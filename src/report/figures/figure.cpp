#include "rift/report/figures/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "gnuplot_process.hpp"

namespace rift::report {
namespace {

// noenhanced: an underscore in a surface's name is an underscore, not a subscript.
std::string Terminal(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  if (format == FigureFormat::kSvg) {
    return fmt::format(
        "set terminal svg noenhanced size {},{} font 'Arial,{}' background '#ffffff'\n",
        figure.width_px, figure.height_px, options.font_pt);
  }
  const int scale = options.png_scale;
  // cairo draws at 72 points an inch and SVG viewers at 96, hence 0.75 and 4/3.
  return fmt::format(
      "set terminal pngcairo noenhanced size {},{} font 'DejaVu Sans,{}' fontscale {:g} "
      "linewidth {} pointscale {} background '#ffffff'\n",
      scale * figure.width_px, scale * figure.height_px, options.font_pt, 0.75 * scale, scale,
      scale);
}

constexpr std::string_view kStyle =
    "set border 3 lw 0.8 lc rgb '#444444'\n"
    "set tics nomirror out scale 0.5\n"
    "set grid lw 0.5 lc rgb '#DDDDDD'\n"
    "set style fill solid 0.9 noborder\n"
    "set key outside top center horizontal Left reverse samplen 2 spacing 1.1 width -1\n";

bool IsWhole(const std::string& image, FigureFormat format) {
  const std::string_view end = format == FigureFormat::kSvg ? "</svg>" : "IEND";
  const std::string_view tail =
      std::string_view(image).substr(image.size() - std::min<std::size_t>(image.size(), 16));
  return tail.find(end) != std::string_view::npos;
}

}  // namespace

std::string GnuplotScript(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  return fmt::format("set encoding utf8\n{}{}{}", Terminal(figure, format, options), kStyle,
                     figure.plot);
}

std::string Render(const Figure& figure, FigureFormat format, const ReportOptions& options) {
  std::string image;
  try {
    image = RunGnuplot(GnuplotScript(figure, format, options));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("figure {}: {}", figure.name, error.what()));
  }
  if (!IsWhole(image, format)) {
    throw std::runtime_error(fmt::format("figure {}: gnuplot wrote {} bytes that are no whole {}",
                                         figure.name, image.size(),
                                         EnumNames(format)[static_cast<int>(format)]));
  }
  return image;
}

Figure Stack(std::string name, std::string title, const std::vector<Figure>& figures) {
  Figure stack{std::move(name), std::move(title), 0, 0, "set multiplot\n"};
  for (const Figure& figure : figures) {
    stack.width_px = std::max(stack.width_px, figure.width_px);
    stack.height_px += figure.height_px;
  }
  int top_px = stack.height_px;
  for (const Figure& figure : figures) {
    top_px -= figure.height_px;
    stack.plot += fmt::format("reset\n{}set size 1,{:.9g}\nset origin 0,{:.9g}\n{}", kStyle,
                              static_cast<double>(figure.height_px) / stack.height_px,
                              static_cast<double>(top_px) / stack.height_px, figure.plot);
  }
  stack.plot += "unset multiplot\n";
  return stack;
}

}  // namespace rift::report
