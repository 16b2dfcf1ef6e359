// SPDX-License-Identifier: MIT
// Draws charts with cairo: one drawing, written as SVG and as PNG. A plug-in, because cairo brings
// a dozen shared objects that only `bench` needs.
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "pipelines/bench/chart.h"

namespace sketchsplat {
namespace {

constexpr double kFont = 12, kSmall = 11, kTitle = 14;
constexpr double kPngScale = 2;
const char kInk[] = "#333333", kGrid[] = "#e3e3e3", kFrame[] = "#999999";

struct Box {
  double left, top, width, height;
  bool meets(const Box& b) const {
    return left < b.left + b.width && b.left < left + width && top < b.top + b.height &&
           b.top < top + height;
  }
  bool holds(const Box& b) const {
    return b.left >= left && b.top >= top && b.left + b.width <= left + width &&
           b.top + b.height <= top + height;
  }
};

std::string text_of(double value) {
  char text[32];
  const double size = std::abs(value);
  std::snprintf(text, sizeof text, size >= 1e4 && size < 1e6 ? "%.0f" : "%.4g", value);
  return text;
}

// A thin layer over cairo: colours by name, text by its box.
class Pen {
 public:
  explicit Pen(cairo_t* cr) : cr_(cr) {
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }
  cairo_t* cr() const { return cr_; }

  void color(const std::string& hex, double alpha = 1) {
    unsigned r = 0, g = 0, b = 0;
    std::sscanf(hex.c_str(), "#%2x%2x%2x", &r, &g, &b);
    cairo_set_source_rgba(cr_, r / 255.0, g / 255.0, b / 255.0, alpha);
  }
  double width(const std::string& text, double size) {
    cairo_set_font_size(cr_, size);
    cairo_text_extents_t e;
    cairo_text_extents(cr_, text.c_str(), &e);
    return e.x_advance;
  }
  // `anchor`: the share of the text that lies left of x. y is the base line.
  void text(double x, double y, double anchor, const std::string& text, double size) {
    cairo_move_to(cr_, x - anchor * width(text, size), y);
    cairo_show_text(cr_, text.c_str());
    cairo_new_path(cr_);
  }
  void line(double x0, double y0, double x1, double y1, double width) {
    cairo_set_line_width(cr_, width);
    cairo_move_to(cr_, x0, y0);
    cairo_line_to(cr_, x1, y1);
    cairo_stroke(cr_);
  }
  void dash(bool on) {
    const double pattern[] = {5, 4};
    cairo_set_dash(cr_, pattern, on ? 2 : 0, 0);
  }

 private:
  cairo_t* cr_;
};

void draw_marker(Pen* pen, Marker marker, double x, double y, const std::string& color) {
  cairo_t* cr = pen->cr();
  cairo_new_path(cr);
  pen->color(color, marker == Marker::kDot ? 0.75 : 1);
  cairo_set_line_width(cr, marker == Marker::kRing ? 2.5 : 1.5);
  if (marker == Marker::kDot) {
    cairo_arc(cr, x, y, 3.5, 0, 2 * M_PI);
    cairo_fill(cr);
  } else if (marker == Marker::kRing) {
    cairo_arc(cr, x, y, 7, 0, 2 * M_PI);
    cairo_stroke(cr);
  } else if (marker == Marker::kDiamond) {
    cairo_move_to(cr, x, y - 6);
    cairo_line_to(cr, x + 6, y);
    cairo_line_to(cr, x, y + 6);
    cairo_line_to(cr, x - 6, y);
    cairo_close_path(cr);
    cairo_stroke(cr);
  }
}

bool drawable(const Panel& p, const Series& s, size_t i) {
  return std::isfinite(s.x[i]) && std::isfinite(s.y[i]) && (!p.log_x || s.x[i] > 0) &&
         (!p.log_y || s.y[i] > 0);
}

// The numbers along x; those that would touch their neighbour are left out, their lines are not.
void draw_x_axis(Pen* pen, const Panel& p) {
  std::vector<double> ticks = p.x_ticks;
  if (ticks.empty())
    ticks = round_ticks(p.x_low, p.x_high, std::max(2, int(p.width / 45)), p.log_x);
  std::sort(ticks.begin(), ticks.end(),
            [&](double a, double b) { return chart_x(p, a) < chart_x(p, b); });
  double free_from = -1e9;
  for (const double tick : ticks) {
    if (tick < p.x_low || tick > p.x_high) continue;
    const double x = chart_x(p, tick);
    pen->color(kGrid);
    pen->line(x, p.top, x, p.top + p.height, 1);
    const std::string text = text_of(tick);
    const double half = pen->width(text, kSmall) / 2;
    if (x - half < free_from) continue;
    pen->color(kInk);
    pen->text(x, p.top + p.height + 15, 0.5, text, kSmall);
    free_from = x + half + 5;
  }
  pen->color(kInk);
  pen->text(p.left + p.width / 2, p.top + p.height + 32, 0.5, p.x_label, kFont);
}

void draw_y_axis(Pen* pen, const Panel& p) {
  double widest = 0;
  for (const double tick :
       round_ticks(p.y_low, p.y_high, std::max(2, int(p.height / 32)), p.log_y)) {
    const double y = chart_y(p, tick);
    pen->color(kGrid);
    pen->line(p.left, y, p.left + p.width, y, 1);
    pen->color(kInk);
    pen->text(p.left - 6, y + 4, 1, text_of(tick), kSmall);
    widest = std::max(widest, pen->width(text_of(tick), kSmall));
  }
  cairo_save(pen->cr());
  cairo_translate(pen->cr(), p.left - widest - 16, p.top + p.height / 2);
  cairo_rotate(pen->cr(), -M_PI / 2);
  pen->text(0, 0, 0.5, p.y_label, kFont);
  cairo_restore(pen->cr());
}

void draw_band(Pen* pen, const Panel& p, const Series& s) {
  if (s.low.empty()) return;
  std::vector<size_t> seen;
  for (size_t i = 0; i < s.x.size(); ++i)
    if (drawable(p, s, i) && std::isfinite(s.low[i]) && std::isfinite(s.high[i])) seen.push_back(i);
  if (seen.size() < 2) return;
  cairo_t* cr = pen->cr();
  cairo_new_path(cr);
  for (const size_t i : seen) cairo_line_to(cr, chart_x(p, s.x[i]), chart_y(p, s.low[i]));
  for (auto i = seen.rbegin(); i != seen.rend(); ++i)
    cairo_line_to(cr, chart_x(p, s.x[*i]), chart_y(p, s.high[*i]));
  cairo_close_path(cr);
  pen->color(s.color, 0.15);
  cairo_fill(cr);
}

void draw_series(Pen* pen, const Panel& p, const Series& s) {
  cairo_t* cr = pen->cr();
  draw_band(pen, p, s);
  cairo_new_path(cr);
  if (s.line) {
    for (size_t i = 0; i < s.x.size(); ++i)
      if (drawable(p, s, i)) cairo_line_to(cr, chart_x(p, s.x[i]), chart_y(p, s.y[i]));
    pen->color(s.color);
    pen->dash(s.dashed);
    cairo_set_line_width(cr, 1.8);
    cairo_stroke(cr);
    pen->dash(false);
  }
  for (size_t i = 0; i < s.x.size(); ++i)
    if (drawable(p, s, i))
      draw_marker(pen, s.marker, chart_x(p, s.x[i]), chart_y(p, s.y[i]), s.color);
}

// Texts beside points: each takes the first of the places around its point that is free.
void draw_labels(Pen* pen, const Panel& p, std::vector<Box> taken) {
  const Box frame = {p.left, p.top, p.width, p.height};
  for (const Series& s : p.series)
    for (size_t i = 0; i < s.x.size(); ++i)
      if (drawable(p, s, i) && s.marker != Marker::kNone)
        taken.push_back({chart_x(p, s.x[i]) - 5, chart_y(p, s.y[i]) - 5, 10, 10});
  for (const Series& s : p.series) {
    for (size_t i = 0; i < s.labels.size(); ++i) {
      if (!drawable(p, s, i)) continue;
      const double w = pen->width(s.labels[i], kSmall), h = kSmall + 2;
      const double x = chart_x(p, s.x[i]), y = chart_y(p, s.y[i]), gap = 9;
      const Box places[] = {{x + gap, y - h / 2, w, h},         {x - gap - w, y - h / 2, w, h},
                            {x - w / 2, y - gap - h, w, h},     {x - w / 2, y + gap, w, h},
                            {x + 4, y - gap - h, w, h},         {x + 4, y + gap, w, h},
                            {x - 4 - w, y - gap - h, w, h},     {x - 4 - w, y + gap, w, h},
                            {x - w / 2, y - gap - 2 * h, w, h}, {x - w / 2, y + gap + h, w, h}};
      for (const Box& box : places) {
        const bool met =
            std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.meets(box); });
        if (met || !frame.holds(box)) continue;
        pen->color(s.color);
        pen->text(box.left, box.top + kSmall - 1, 0, s.labels[i], kSmall);
        taken.push_back(box);
        break;
      }
    }
  }
}

// Marks' texts stand inside of the frame, one below the other where they would meet.
std::vector<Box> draw_marks(Pen* pen, const Panel& p) {
  std::vector<Box> taken;
  for (const Mark& mark : p.marks) {
    if (mark.x < p.x_low || mark.x > p.x_high) continue;
    const double x = chart_x(p, mark.x), w = pen->width(mark.text, kSmall), h = kSmall + 3;
    pen->color(mark.color);
    pen->dash(true);
    pen->line(x, p.top, x, p.top + p.height, 1.2);
    pen->dash(false);
    const bool right = x + 6 + w < p.left + p.width;
    Box box = {right ? x + 5 : x - 5 - w, p.top + p.height - 6 - h, w, h};
    while (std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.meets(box); }))
      box.top -= h;
    pen->text(box.left, box.top + kSmall, 0, mark.text, kSmall);
    taken.push_back(box);
  }
  return taken;
}

void draw_panel(Pen* pen, const Panel& given) {
  const Panel p = fitted(given);
  cairo_t* cr = pen->cr();
  draw_x_axis(pen, p);
  draw_y_axis(pen, p);
  pen->color(kFrame);
  cairo_set_line_width(cr, 1);
  cairo_rectangle(cr, p.left, p.top, p.width, p.height);
  cairo_stroke(cr);
  pen->color(kInk);
  pen->text(p.left, p.top - 8, 0, p.title, kFont);
  cairo_save(cr);
  // Markers may stand out of the frame by their own size.
  cairo_rectangle(cr, p.left - 8, p.top - 8, p.width + 16, p.height + 16);
  cairo_clip(cr);
  for (const Series& s : p.series) draw_series(pen, p, s);
  draw_labels(pen, p, draw_marks(pen, p));
  cairo_restore(cr);
}

std::vector<Series> legend_entries(const Chart& chart) {
  std::vector<Series> entries;
  for (const Panel& panel : chart.panels)
    for (const Series& s : panel.series) {
      const bool known = std::any_of(entries.begin(), entries.end(),
                                     [&](const Series& e) { return e.legend == s.legend; });
      if (!s.legend.empty() && !known) entries.push_back(s);
    }
  return entries;
}

// Returns the height that it takes; measures only if not `draw`.
double legend(Pen* pen, const Chart& chart, bool draw) {
  const double margin = 20, row = 20;
  double x = margin, y = 6;
  for (const Series& s : legend_entries(chart)) {
    const double w = 30 + pen->width(s.legend, kFont) + 18;
    if (x > margin && x + w > chart.width - margin) x = margin, y += row;
    if (draw) {
      const double top = chart.height + y;
      pen->color(s.color);
      pen->dash(s.dashed);
      if (s.line) pen->line(x, top + 6, x + 22, top + 6, 1.8);
      pen->dash(false);
      draw_marker(pen, s.marker, x + 11, top + 6, s.color);
      pen->color(kInk);
      pen->text(x + 30, top + 10, 0, s.legend, kFont);
    }
    x += w;
  }
  return y + row + 4;
}

void draw(cairo_t* cr, const Chart& chart, double height) {
  Pen pen(cr);
  pen.color("#ffffff");
  cairo_rectangle(cr, 0, 0, chart.width, height);
  cairo_fill(cr);
  pen.color(kInk);
  pen.text(20, 22, 0, chart.title, kTitle);
  for (const Panel& panel : chart.panels) draw_panel(&pen, panel);
  legend(&pen, chart, true);
}

cairo_status_t append(void* text, const unsigned char* data, unsigned size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cairo: ") + cairo_status_to_string(status));
}

double whole_height(const Chart& chart) {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1),
                        cairo_surface_destroy);
  const Context cr(cairo_create(surface.get()), cairo_destroy);
  Pen pen(cr.get());
  return std::ceil(chart.height + legend(&pen, chart, false));
}

void draw_files(const Chart& chart, ChartFiles* files) {
  const double height = whole_height(chart);
  {
    const Surface surface(
        cairo_svg_surface_create_for_stream(append, &files->svg, chart.width, height),
        cairo_surface_destroy);
    {
      const Context cr(cairo_create(surface.get()), cairo_destroy);
      draw(cr.get(), chart, height);
      check(cairo_status(cr.get()));
    }
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(kPngScale * chart.width),
                                                   int(kPngScale * height)),
                        cairo_surface_destroy);
  const Context cr(cairo_create(surface.get()), cairo_destroy);
  cairo_scale(cr.get(), kPngScale, kPngScale);
  draw(cr.get(), chart, height);
  check(cairo_status(cr.get()));
  check(cairo_surface_write_to_png_stream(surface.get(), append, &files->png));
}

}  // namespace
}  // namespace sketchsplat

extern "C" void sketchsplat_draw_chart(const sketchsplat::Chart& chart,
                                       sketchsplat::ChartFiles* files) {
  sketchsplat::draw_files(chart, files);
}
