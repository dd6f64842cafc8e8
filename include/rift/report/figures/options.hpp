#pragma once

namespace rift::report {

/// How figures and the page are laid out; a pixel is 1/96 inch, so 480 px fit a text column.
struct ReportOptions {
  int width_px = 480;
  int font_pt = 11;
  int png_scale = 3;
  int max_bars = 120;
  int max_cells = 1600;
  int worst_settings = 40;
  int max_points = 5000;
  int table_rows = 500;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("width_px", self.width_px, 240, 4000, "width of a figure of one column");
    field("font_pt", self.font_pt, 6, 40, "size of the letters in figures");
    field("png_scale", self.png_scale, 1, 10, "pixels of a PNG for one of the SVG");
    field("max_bars", self.max_bars, 1, 2000, "a bar chart with more bars is left out");
    field("max_cells", self.max_cells, 1, 100'000, "a heat map with more cells is left out");
    field("worst_settings", self.worst_settings, 1, 500,
          "of a larger space only so many settings, the worst, are drawn trial by trial");
    field("max_points", self.max_points, 10, 1'000'000,
          "scatter plots of more trials show median and range instead of points");
    field("table_rows", self.table_rows, 1, 100'000,
          "rows of a table in the page; of more, the worst are shown");
  }
};

}  // namespace rift::report
