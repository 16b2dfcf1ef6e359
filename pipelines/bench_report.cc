// SPDX-License-Identifier: MIT
#include "pipelines/bench_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace sketchsplat {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of_number(double value, const char* format) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// As many digits as mean something.
const char* format_of_number(const std::string& name) {
  if (name == "strokes" || name == "peak_mb") return "%.0f";
  if (name.rfind("F", 0) == 0 || name.rfind("fine_F", 0) == 0 || name == "structure_F" ||
      name == "total_per_decode")
    return "%.1f";
  return "%.2f";
}

double value_of(const BenchRow& row, const std::string& name) {
  for (const auto& [n, value] : row.numbers)
    if (n == name) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> number_names(const std::vector<BenchRow>& rows) {
  std::vector<std::string> names;
  if (!rows.empty())
    for (const auto& [name, value] : rows[0].numbers) names.push_back(name);
  return names;
}

std::string padded(const std::string& text, size_t width, bool left) {
  const std::string space(width > text.size() ? width - text.size() : 0, ' ');
  return left ? text + space : space + text;
}

// ------------------------------------------------------------------------------------ chart

struct Panel {
  std::string quantity;
  double left, top, width, height;          // [px]
  double log_low, log_high, y_low, y_high;  // decades of seconds; per cent

  double x(double seconds) const {
    return left + width * (std::log10(seconds) - log_low) / (log_high - log_low);
  }
  double y(double value) const { return top + height * (y_high - value) / (y_high - y_low); }
};

bool drawable(const BenchRow& row, const Panel& panel) {
  return std::isfinite(value_of(row, panel.quantity)) && value_of(row, "total") > 0;
}

// Fits the axes to the rows.
Panel make_panel(const std::string& quantity, double left, const std::vector<BenchRow>& rows) {
  Panel p = {quantity, left, 40, 330, 300, 1e9, -1e9, 0, 100};
  double lowest = 100;
  for (const BenchRow& row : rows) {
    if (!drawable(row, p)) continue;
    const double decade = std::log10(value_of(row, "total"));
    p.log_low = std::min(p.log_low, decade - 0.1);
    p.log_high = std::max(p.log_high, decade + 0.1);
    lowest = std::min(lowest, value_of(row, quantity));
  }
  if (p.log_low > p.log_high) p.log_low = -1, p.log_high = 1;
  p.y_low = std::max(0.0, 5 * std::floor((lowest - 2) / 5));
  return p;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  std::ostringstream svg;
  svg << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << text
      << "</text>\n";
  return svg.str();
}

std::string axes(const Panel& p) {
  std::ostringstream svg;
  svg << "<rect x=\"" << p.left << "\" y=\"" << p.top << "\" width=\"" << p.width << "\" height=\""
      << p.height << "\" fill=\"none\" stroke=\"#888\"/>\n";
  for (int decade = -3; decade <= 5; ++decade) {
    for (const int digit : {1, 2, 5}) {
      const double seconds = digit * std::pow(10, decade);
      if (std::log10(seconds) < p.log_low || std::log10(seconds) > p.log_high) continue;
      svg << "<path d=\"M" << p.x(seconds) << " " << p.top << "v" << p.height
          << "\" stroke=\"#ddd\"/>\n"
          << text_at(p.x(seconds), p.top + p.height + 18, "middle",
                     text_of_number(seconds, "%g") + " s");
    }
  }
  const double step = p.y_high - p.y_low > 40 ? 20 : p.y_high - p.y_low > 15 ? 5 : 1;
  for (double v = p.y_high; v >= p.y_low; v -= step)
    svg << "<path d=\"M" << p.left << " " << p.y(v) << "h" << p.width << "\" stroke=\"#ddd\"/>\n"
        << text_at(p.left - 6, p.y(v) + 4, "end", text_of_number(v, "%g"));
  svg << text_at(p.left, p.top - 12, "start", p.quantity + " [%] against total time");
  return svg.str();
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string points(const Panel& p, const std::vector<BenchRow>& rows, const std::string& color,
                   const std::string& variant, bool rings) {
  std::ostringstream svg;
  for (const BenchRow& row : rows) {
    if (row.variant != variant || !drawable(row, p)) continue;
    svg << "<circle cx=\"" << p.x(value_of(row, "total")) << "\" cy=\""
        << p.y(value_of(row, p.quantity)) << "\" r=\"" << (rings ? 9 : 4) << "\" "
        << (rings ? "fill=\"none\" stroke-width=\"2.5\" stroke" : "fill-opacity=\"0.7\" fill")
        << "=\"" << color << "\"><title>" << escaped(row.scene + ", " + variant)
        << "</title></circle>\n";
  }
  return svg.str();
}

}  // namespace

std::string bench_table(const std::vector<BenchRow>& rows,
                        const std::vector<std::string>& columns) {
  const std::vector<std::string> names = columns.empty() ? number_names(rows) : columns;
  std::vector<std::vector<std::string>> lines = {{"scene", "variant"}};
  lines[0].insert(lines[0].end(), names.begin(), names.end());
  for (const BenchRow& row : rows) {
    lines.push_back({row.scene, row.variant});
    for (const std::string& name : names)
      lines.back().push_back(text_of_number(value_of(row, name), format_of_number(name)));
  }
  std::vector<size_t> width(lines[0].size());
  for (const auto& line : lines)
    for (size_t c = 0; c < line.size(); ++c) width[c] = std::max(width[c], line[c].size());
  std::string table;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (i > 1 && lines[i][0] != lines[i - 1][0]) table += "\n";
    for (size_t c = 0; c < lines[i].size(); ++c)
      table += (c ? "  " : "") + padded(lines[i][c], width[c], c < 2);
    table += "\n";
  }
  return table;
}

std::string bench_csv(const std::vector<BenchRow>& rows) {
  const auto quoted = [](const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  std::string csv = "scene,variant";
  for (const std::string& name : number_names(rows)) csv += "," + name;
  csv += "\n";
  for (const BenchRow& row : rows) {
    csv += quoted(row.scene) + "," + quoted(row.variant);
    for (const auto& [name, value] : row.numbers)
      csv += "," + (std::isfinite(value) ? text_of_number(value, "%.9g") : "");
    csv += "\n";
  }
  return csv;
}

std::string bench_json(const std::vector<BenchRow>& rows, const OptionTexts& options) {
  Json out = {
      {"version", SKETCHSPLAT_VERSION}, {"options", Json::object()}, {"rows", Json::array()}};
  for (const auto& [name, text] : options) out["options"][name] = text;
  for (const BenchRow& row : rows) {
    Json object = {{"scene", row.scene}, {"variant", row.variant}};
    for (const auto& [name, value] : row.numbers)
      object[name] = std::isfinite(value) ? Json(value) : Json();
    out["rows"].push_back(object);
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string bench_chart(const std::vector<BenchRow>& rows) {
  const char* const kColors[] = {"#2563eb", "#ea580c", "#16a34a", "#9333ea", "#dc2626", "#0891b2",
                                 "#ca8a04", "#db2777", "#4b5563", "#65a30d", "#7c2d12"};
  const std::vector<BenchRow> means = mean_rows(rows);
  std::ostringstream svg;
  const double height = 380 + 18 * double(means.size());
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 " << height
      << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"800\" height=\"" << height
      << "\" fill=\"#fff\"/>\n";
  for (const Panel& panel : {make_panel("F5", 50, rows), make_panel("F1", 440, rows)}) {
    svg << axes(panel);
    for (size_t v = 0; v < means.size(); ++v) {
      const std::string color = kColors[v % std::size(kColors)];
      svg << points(panel, rows, color, means[v].variant, false)
          << points(panel, means, color, means[v].variant, true);
    }
  }
  for (size_t v = 0; v < means.size(); ++v) {
    const double y = 385 + 18 * double(v);
    svg << "<circle cx=\"56\" cy=\"" << y - 4 << "\" r=\"5\" fill=\""
        << kColors[v % std::size(kColors)] << "\"/>"
        << text_at(68, y, "start",
                   escaped(means[v].variant) + ": mean F5 " +
                       text_of_number(value_of(means[v], "F5"), "%.1f") + ", F1 " +
                       text_of_number(value_of(means[v], "F1"), "%.1f") + ", " +
                       text_of_number(value_of(means[v], "total"), "%.2f") + " s" +
                       (v ? "" : " (dots: scenes, rings: means)"));
  }
  svg << "</svg>\n";
  return svg.str();
}

}  // namespace sketchsplat
