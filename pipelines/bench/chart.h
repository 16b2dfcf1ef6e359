// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace sketchsplat {

enum class Marker { kNone, kDot, kRing, kDiamond };

/// Points of one kind in a panel. Points that are not finite, or not positive on a logarithmic
/// axis, are left out.
struct Series {
  std::string legend;  ///< text in the legend; empty: in none. Equal texts appear once
  std::string color;   ///< "#rrggbb"
  Marker marker = Marker::kDot;
  bool line = false;                ///< joins the points, in their order
  bool dashed = false;              ///< the line
  std::vector<double> x, y;         ///< equally many
  std::vector<double> low, high;    ///< a band about the line, as many as y; empty: none
  std::vector<std::string> labels;  ///< beside the points, as many as y; empty: none
};

/// A vertical line with a text at its upper end.
struct Mark {
  double x = 0;
  std::string text, color;
};

/// One pair of axes. Its frame is given in units of the chart, from the top left.
struct Panel {
  double left = 0, top = 0, width = 0, height = 0;
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  bool reversed_x = false;                                                  ///< larger to the left
  double x_low = std::numeric_limits<double>::quiet_NaN(), x_high = x_low;  ///< NaN: as the points
  double y_low = x_low, y_high = x_low;                                     ///< need it
  std::vector<double> x_ticks = {};  ///< empty: round numbers
  std::vector<Series> series = {};
  std::vector<Mark> marks = {};
};

/// A drawing of several panels with one legend below them, which makes it as high as it needs.
struct Chart {
  std::string title;
  double width = 0, height = 0;  ///< [px], without the legend
  std::vector<Panel> panels;
};

/// The panel with its ranges filled in: margins about the points, whole decades where there is no
/// point. Ranges that were given stay.
Panel fitted(Panel panel);

/// Where a value lies in a fitted panel, in units of the chart.
double chart_x(const Panel& panel, double x);
double chart_y(const Panel& panel, double y);

/// Values to label from low to high, at most about `count`: if `log`, as many digits of every
/// decade as there is room for; else multiples of 1, 2 or 5 times a power of ten.
std::vector<double> round_ticks(double low, double high, int count, bool log);

/// Indices of the points that no other point beats: none has both less (or equal) x and more (or
/// equal) y, one of them strictly. Ordered by x; of equal points the first. NaNs beat nothing and
/// are not among them.
std::vector<int> pareto_front(const std::vector<double>& x, const std::vector<double>& y);

/// Both renderings of a chart, as files' bytes. The drawing needs cairo, a plug-in.
struct ChartFiles {
  std::string svg, png;
};
ChartFiles draw_chart(const Chart& chart);

/// Writes path + ".svg" and ".png". Throws OutputError.
void write_chart(const Chart& chart, const std::string& path);

constexpr char kChartPluginFile[] = "sketchsplat_charts.so";
constexpr char kChartPluginSymbol[] = "sketchsplat_draw_chart";
using DrawChart = void(const Chart&, ChartFiles*);

}  // namespace sketchsplat
