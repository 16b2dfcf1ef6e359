// SPDX-License-Identifier: MIT
#include "datasets/synthetic/catalogue/part_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace sketchsplat {

PartParameter::PartParameter(std::string name_, std::string unit_, double low_, double high_)
    : PartParameter(std::move(name_), std::move(unit_), low_, high_, low_, high_) {}

PartParameter::PartParameter(std::string name_, std::string unit_, double low_, double high_,
                             double least_, double most_)
    : name(std::move(name_)),
      unit(std::move(unit_)),
      low(low_),
      high(high_),
      least(least_),
      most(most_) {}

namespace {

const char kLongest[] = "of longest side";

// Parameters that many parts have, and that benchmarks turn until a part cannot be seen any more.
PartParameter gap(double low, double high) { return {"gap", kLongest, low, high, 0.002, 0.2}; }
PartParameter wall(double low, double high) { return {"wall", kLongest, low, high, 0.002, 0.2}; }
PartParameter round_edge(double low, double high) {
  return {"fillet", kLongest, low, high, 0.001, 0.2};
}
// The largest of a part's rounds; thin enough for parts that are round all over.
PartParameter round(double low, double high) { return {"round", kLongest, low, high, 0.002, 0.06}; }
PartParameter crease(double low, double high) { return {"crease", "deg", low, high, 3, 90}; }

const PartParameter kLength = {"length", "mm", 50, 80}, kWidth = {"width", "mm", 30, 50},
                    kHeight = {"height", "mm", 20, 40};

std::vector<PartSpec> make_specs() {
  return {
      {"box", {kLength, kWidth, kHeight}},
      {"box-hole",
       {kLength,
        kWidth,
        kHeight,
        {"radius", "of width", 0.15, 0.35},
        {"place", "of length", 0.42, 0.58}}},
      {"plate-holes",
       {{"thickness", "mm", 6, 12},
        {"width", "mm", 45, 60},
        {"length", "mm", 70, 90},
        {"radius", "mm", 2.5, 5},
        {"inset", "mm", 8, 11},
        {"bore", "mm", 9, 13},
        // What may be wrong with one of them, for inspection: never drawn.
        {"hole-shift", kLongest, 0, 0, 0, 0.01},
        {"bore-error", "%", 0, 0, -5, 5}}},
      {"stepped-shaft",
       {{"radius", "mm", 8, 12},
        {"second-radius", "of radius", 1.5, 1.9},
        {"third-radius", "of radius", 1.2, 1.35},
        {"first-length", "mm", 14, 26},
        {"second-length", "mm", 14, 26},
        {"third-length", "mm", 14, 26},
        {"fourth-length", "mm", 14, 26}}},
      {"l-bracket",
       {{"foot", "mm", 45, 60},
        {"height", "mm", 35, 50},
        {"width", "mm", 28, 40},
        {"thickness", "mm", 6, 10},
        {"radius", "mm", 4, 6}}},
      {"pocket-block",
       {kLength,
        kWidth,
        kHeight,
        {"rim", "mm", 5, 8},
        {"corner", "mm", 2.5, 6},
        {"floor", "of height", 0.3, 0.6}}},
      {"box-fillet", {kLength, kWidth, kHeight, {"radius", "mm", 5, 10}}},
      {"box-chamfer", {kLength, kWidth, kHeight, {"chamfer", "mm", 4, 8}}},
      {"slotted-sheet",
       {{"length", "mm", 70, 90},
        {"width", "mm", 40, 60},
        {"thickness", "mm", 1.2, 2.5},
        {"slots", "count", 2, 4},
        {"radius", "mm", 2, 3.5},
        {"slot-length", "of width", 0.4, 0.6}}},
      {"cut-cylinder",
       {{"radius", "mm", 14, 22}, {"height", "mm", 40, 60}, {"rise", "of diameter", 0.3, 0.8}}},
      {"frustum",
       {{"radius", "mm", 18, 26}, {"top", "of radius", 0.3, 0.7}, {"height", "mm", 30, 50}}},
      {"hex-nut",
       {{"across", "mm", 28, 40},
        {"height", "of across", 0.4, 0.6},
        {"bore", "of across", 0.25, 0.32}}},
      {"dome-plate",
       {{"thickness", "mm", 8, 14},
        {"width", "mm", 50, 60},
        {"length", "mm", 60, 80},
        {"radius", "mm", 14, 20},
        {"sink", "of radius", 0.0, 0.4}}},
      {"flange",
       {{"radius", "mm", 30, 40},
        {"thickness", "mm", 6, 10},
        {"hub", "of radius", 0.35, 0.45},
        {"hub-height", "mm", 15, 25},
        {"hole", "mm", 2.5, 4},
        {"holes", "count", 4, 6},
        {"bore", "of hub", 0.5, 0.7}}},
      {"tee",
       {{"radius", "mm", 12, 16},
        {"length", "mm", 50, 70},
        {"branch", "of radius", 0.6, 0.85},
        {"rise", "of radius", 1.6, 2.2}}},
      {"u-channel",
       {{"width", "mm", 30, 45},
        {"height", "mm", 25, 40},
        {"length", "mm", 55, 75},
        {"thickness", "mm", 4, 7},
        {"radius", "mm", 4, 6}}},
      {"rib-plate",
       {{"length", "mm", 70, 90},
        {"width", "of length", 0.64, 0.75},
        {"base", "of length", 0.08, 0.14},
        {"rib-height", "of length", 0.15, 0.3},
        gap(0.06, 0.16),
        wall(0.03, 0.08)}},
      {"slot-block",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.3, 0.5},
        {"depth", "of height", 0.4, 0.7},
        gap(0.08, 0.16)}},
      {"tray",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.6, 0.85},
        {"height", "of length", 0.3, 0.45},
        wall(0.02, 0.06)}},
      {"bent-sheet",
       {{"length", "mm", 60, 80},
        {"leg", "of length", 0.5, 0.75},
        {"width", "of length", 0.4, 0.6},
        {"bend", "of length", 0.03, 0.08},
        wall(0.02, 0.06)}},
      {"fillet-block",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.75},
        {"height", "of length", 0.35, 0.5},
        round_edge(0.05, 0.12)}},
      {"fillet-step",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.5, 0.7},
        {"step", "of height", 0.4, 0.55},
        round_edge(0.04, 0.12)}},
      {"ridge-block",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.25, 0.4},
        crease(12, 60)}},
      {"pleat-block",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.25, 0.4},
        {"pleats", "count", 2, 3},
        crease(20, 60)}},
      {"crease-disc",
       {{"radius", "mm", 28, 40},
        {"thickness", "of radius", 0.3, 0.5},
        {"ring", "of radius", 0.7, 0.8},
        {"slant", "of radius", 0.3, 0.45},
        crease(15, 60)}},
      {"countersunk-plate",
       {{"length", "mm", 70, 90},
        {"width", "mm", 40, 50},
        {"thickness", "mm", 11, 16},
        {"radius", "mm", 3, 4},
        {"sink", "mm", 3, 4.5},
        {"blind-depth", "of thickness", 0.4, 0.7},
        {"blind-radius", "mm", 5, 7}}},
      {"oblique-hole",
       {kLength, kWidth, kHeight, {"radius", "of width", 0.12, 0.18}, {"tilt", "deg", 15, 30}}},
      {"ellipse-plate",
       {{"length", "mm", 65, 90},
        {"width", "of length", 0.6, 0.75},
        {"thickness", "of length", 0.1, 0.18},
        {"long-axis", "of width", 0.28, 0.36},
        {"short-axis", "of long axis", 0.4, 0.7},
        {"turn", "deg", 10, 70}}},
      {"ridge-cylinder",
       {{"radius", "mm", 14, 20},
        {"height", "of radius", 1.6, 2.2},
        {"left-rise", "of radius", 0.5, 0.9},
        {"right-rise", "of radius", 0.3, 0.7},
        {"ridge", "of radius", -0.3, 0.3, -0.7, 0.7}}},
      {"boss-plate",
       {{"length", "mm", 65, 85},
        {"width", "of length", 0.6, 0.75},
        {"thickness", "mm", 7, 11},
        {"boss", "of width", 0.2, 0.26},
        {"draft", "deg", 4, 12},
        {"boss-height", "mm", 14, 20},
        {"hole", "of boss", 0.35, 0.5},
        {"rib", "mm", 3, 5}}},
      {"corner-block",
       {kLength,
        kWidth,
        kHeight,
        {"corner", "of height", 0.4, 0.6},
        {"notch", "of length", 0.2, 0.3},
        {"notch-depth", "of height", 0.3, 0.6}}},
      {"slot-disc",
       {{"radius", "mm", 30, 42},
        {"thickness", "of radius", 0.2, 0.35},
        {"slots", "count", 2, 4},
        {"pitch", "of radius", 0.6, 0.68},
        {"slot-radius", "of radius", 0.09, 0.15},
        {"sweep", "of the pitch", 0.35, 0.55},
        {"bore", "of radius", 0.18, 0.3}}},
      {"knob",
       {{"radius", "mm", 24, 34},
        {"height", "of radius", 0.6, 0.9},
        {"scallops", "count", 5, 8},
        {"scallop", "of radius", 0.16, 0.22},
        {"chamfer", "of radius", 0.06, 0.1},
        {"bore", "of radius", 0.2, 0.35}}},
      {"keyed-hub",
       {{"radius", "mm", 20, 28},
        {"length", "of radius", 1.1, 1.7},
        {"bore", "of radius", 0.4, 0.55},
        {"key-width", "of bore", 0.4, 0.6},
        {"key-depth", "of bore", 0.25, 0.4},
        {"chamfer", "of radius", 0.08, 0.14}}},
      {"elbow",
       {{"radius", "mm", 8, 11},
        {"bend", "of radius", 2.2, 3},
        {"bore", "of radius", 0.6, 0.8},
        {"straight", "of radius", 1, 2},
        {"collar", "of radius", 1.35, 1.6}}},
      {"groove-shaft",
       {{"radius", "mm", 12, 17},
        {"length", "of radius", 3.5, 4.5},
        {"groove", "of radius", 0.25, 0.4},
        {"place", "of length", 0.35, 0.5},
        {"chamfer", "of radius", 0.15, 0.25}}},
      {"ball-stud",
       {{"radius", "mm", 8, 11},
        {"ball", "of radius", 1.4, 1.7},
        {"stem", "of radius", 2, 3},
        {"flat", "of ball", 0.5, 0.75},
        {"collar", "of radius", 1.6, 2.1}}},
      {"dished-cap",
       {{"radius", "mm", 22, 30},
        {"thickness", "of radius", 0.1, 0.16},
        {"rim", "of radius", 1.3, 1.5},
        {"rim-height", "of radius", 0.12, 0.2},
        {"port", "of radius", 0.25, 0.4}}},
      {"cross-drilled",
       {{"radius", "mm", 13, 18},
        {"length", "of radius", 3, 4},
        {"drill", "of radius", 0.4, 0.7},
        {"blind-bore", "of radius", 0.3, 0.4},
        {"blind-depth", "of length", 0.2, 0.28}}},
      {"spline-plate",
       {{"size", "mm", 30, 40},
        {"wave", "of size", 0.08, 0.2},
        {"lobes", "count", 3, 5},
        {"thickness", "of size", 0.25, 0.45},
        {"bore", "of size", 0.2, 0.35}}},
      {"wave-block",
       {kLength, kWidth, kHeight, {"wave", "of height", 0.1, 0.25}, {"phase", "deg", 0, 360}}},
      {"loft-grip",
       {{"length", "mm", 50, 70},
        {"radius", "mm", 12, 16},
        {"waist", "of radius", 0.55, 0.75},
        {"flare", "of radius", 1.3, 1.7},
        {"bulge", "of radius", 0.1, 0.2},
        {"turn", "deg", 0, 40}}},
      {"swept-rail",
       {{"length", "mm", 60, 80},
        {"sway", "of length", 0.12, 0.25},
        {"rise", "of length", 0.1, 0.25},
        {"width", "of length", 0.12, 0.2},
        {"height", "of length", 0.08, 0.16}}},
      {"freeform-pad",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.6, 0.8},
        {"height", "of length", 0.25, 0.35},
        {"bulge", "of length", 0.06, 0.15},
        {"skew", "of length", -0.05, 0.05}}},
      {"cast-bracket",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.7, 0.9},
        {"leg", kLongest, 0.18, 0.22},
        round(0.02, 0.06)}},
      {"blend-step",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.55, 0.75},
        {"height", "of length", 0.5, 0.7},
        {"step", "of height", 0.4, 0.55},
        round(0.025, 0.06)}},
      {"cast-flange",
       {{"radius", "mm", 30, 40},
        {"thickness", kLongest, 0.11, 0.16},
        {"hub", "of radius", 0.35, 0.42},
        {"hub-height", kLongest, 0.15, 0.25},
        {"hole", "of radius", 0.07, 0.1},
        {"holes", "count", 4, 6},
        round(0.02, 0.06)}},
      {"taper-block",
       {{"length", "mm", 60, 80},
        {"width", "of length", 0.5, 0.7},
        {"height", "of length", 0.35, 0.5},
        {"sharp", "of length", 0.35, 0.65},
        round(0.025, 0.06)}},
  };
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

std::string range(double low, double high) { return number(low) + " to " + number(high); }

double drawn(const PartParameter& p, double u) {
  if (p.unit != "count") return p.low + (p.high - p.low) * u;
  return std::floor(p.low + (p.high - p.low + 0.999) * u);
}

}  // namespace

const std::vector<PartSpec>& part_specs() {
  static const std::vector<PartSpec> specs = make_specs();
  return specs;
}

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const PartSpec& spec : part_specs()) names.push_back(spec.name);
  return names;
}

const PartSpec* find_part(const std::string& name) {
  for (const PartSpec& spec : part_specs())
    if (spec.name == name) return &spec;
  return nullptr;
}

std::string wrong_values(const PartSpec& spec, const PartValues& values) {
  for (const auto& [name, value] : values) {
    const auto p =
        std::find_if(spec.parameters.begin(), spec.parameters.end(),
                     [wanted = name](const PartParameter& q) { return q.name == wanted; });
    const bool known = p != spec.parameters.end();
    const bool whole = !known || p->unit != "count" || value == std::floor(value);
    if (known && whole && value >= p->least && value <= p->most) continue;
    std::string words = known ? name + " of " + spec.name + " cannot be " + number(value)
                              : spec.name + " has no parameter '" + name + "'";
    words += "; its parameters are ";
    for (const PartParameter& q : spec.parameters)
      words += (&q == &spec.parameters[0] ? "" : ", ") + q.name + " (" + range(q.least, q.most) +
               " " + q.unit + ")";
    return words;
  }
  return "";
}

Dimensions draw(const PartSpec& spec, std::uint64_t seed, const PartValues& values) {
  std::mt19937_64 engine(seed);
  std::map<std::string, double> all;
  for (const PartParameter& p : spec.parameters)
    all[p.name] = drawn(p, double(engine() >> 11) * 0x1p-53);
  for (const auto& [name, value] : values) all[name] = value;
  return Dimensions(std::move(all));
}

std::string part_listing(const std::vector<PartSpec>& specs) {
  std::string text;
  for (const PartSpec& spec : specs) {
    text += spec.name + "\n";
    for (const PartParameter& p : spec.parameters) {
      char line[160];
      std::snprintf(line, sizeof line, "  %-14s %-18s %s", p.name.c_str(),
                    range(p.least, p.most).c_str(), p.unit.c_str());
      text += line;
      if (p.least != p.low || p.most != p.high) text += ", drawn from " + range(p.low, p.high);
      text += "\n";
    }
  }
  return text;
}

}  // namespace sketchsplat
