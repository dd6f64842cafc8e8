#pragma once

namespace rift::report {

/// How figures and the page are laid out; a pixel is 1/96 inch, so 480 px fit a text column.
struct ReportOptions {
  int width_px = 480;       ///< of a figure of one column
  int font_pt = 11;         ///< letters in figures
  int png_scale = 3;        ///< pixels of a PNG for one of the SVG
  int max_bars = 120;       ///< a bar chart with more is left out
  int max_cells = 1600;     ///< a heat map with more is left out
  int worst_settings = 40;  ///< of a larger space only so many are drawn trial by trial, the worst
  int max_points = 5000;    ///< scatter plots of more trials show median and range instead
  int table_rows = 500;     ///< in the page; of more, the worst are shown
};

}  // namespace rift::report
