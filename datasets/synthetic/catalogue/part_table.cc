// SPDX-License-Identifier: MIT
#include "datasets/synthetic/catalogue/part_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

namespace sketchsplat {

namespace {

// PART: PARAMETER LOW HIGH [(LEAST MOST)] [UNIT], ... Drawn evenly from low to high; users may set
// what lies between least and most, without them between low and high. Without a unit, mm. "block"
// is the three sides of one; what many parts have and benchmarks turn (kTurned) has the same unit
// and limits in all of them. Of plate-holes, hole-shift and bore-error are what may be wrong with
// one of them, for inspection, and never drawn.
constexpr char kTable[] = R"(
box: block
box-hole: block, radius 0.15 0.35 of width, place 0.42 0.58 of length
plate-holes: thickness 6 12, width 45 60, length 70 90, radius 2.5 5, inset 8 11, bore 9 13,
  hole-shift 0 0 (0 0.01) of longest side, bore-error 0 0 (-5 5) %
stepped-shaft: radius 8 12, second-radius 1.5 1.9 of radius, third-radius 1.2 1.35 of radius,
  first-length 14 26, second-length 14 26, third-length 14 26, fourth-length 14 26
l-bracket: foot 45 60, height 35 50, width 28 40, thickness 6 10, radius 4 6
pocket-block: block, rim 5 8, corner 2.5 6, floor 0.3 0.6 of height
box-fillet: block, radius 5 10
box-chamfer: block, chamfer 4 8
slotted-sheet: length 70 90, width 40 60, thickness 1.2 2.5, slots 2 4 count, radius 2 3.5,
  slot-length 0.4 0.6 of width
cut-cylinder: radius 14 22, height 40 60, rise 0.3 0.8 of diameter
frustum: radius 18 26, top 0.3 0.7 of radius, height 30 50
hex-nut: across 28 40, height 0.4 0.6 of across, bore 0.25 0.32 of across
dome-plate: thickness 8 14, width 50 60, length 60 80, radius 14 20, sink 0 0.4 of radius
flange: radius 30 40, thickness 6 10, hub 0.35 0.45 of radius, hub-height 15 25, hole 2.5 4,
  holes 4 6 count, bore 0.5 0.7 of hub
tee: radius 12 16, length 50 70, branch 0.6 0.85 of radius, rise 1.6 2.2 of radius
u-channel: width 30 45, height 25 40, length 55 75, thickness 4 7, radius 4 6
rib-plate: length 70 90, width 0.64 0.75 of length, base 0.08 0.14 of length,
  rib-height 0.15 0.3 of length, gap 0.06 0.16, wall 0.03 0.08
slot-block: length 60 80, width 0.5 0.7 of length, height 0.3 0.5 of length,
  depth 0.4 0.7 of height, gap 0.08 0.16
tray: length 60 80, width 0.6 0.85 of length, height 0.3 0.45 of length, wall 0.02 0.06
bent-sheet: length 60 80, leg 0.5 0.75 of length, width 0.4 0.6 of length,
  bend 0.03 0.08 of length, wall 0.02 0.06
fillet-block: length 60 80, width 0.5 0.75 of length, height 0.35 0.5 of length, fillet 0.05 0.12
fillet-step: length 60 80, width 0.5 0.7 of length, height 0.5 0.7 of length,
  step 0.4 0.55 of height, fillet 0.04 0.12
ridge-block: length 60 80, width 0.5 0.7 of length, height 0.25 0.4 of length, crease 12 60
pleat-block: length 60 80, width 0.5 0.7 of length, height 0.25 0.4 of length, pleats 2 3 count,
  crease 20 60
crease-disc: radius 28 40, thickness 0.3 0.5 of radius, ring 0.7 0.8 of radius,
  slant 0.3 0.45 of radius, crease 15 60
countersunk-plate: length 70 90, width 40 50, thickness 11 16, radius 3 4, sink 3 4.5,
  blind-depth 0.4 0.7 of thickness, blind-radius 5 7
oblique-hole: block, radius 0.12 0.18 of width, tilt 15 30 deg
ellipse-plate: length 65 90, width 0.6 0.75 of length, thickness 0.1 0.18 of length,
  long-axis 0.28 0.36 of width, short-axis 0.4 0.7 of long axis, turn 10 70 deg
ridge-cylinder: radius 14 20, height 1.6 2.2 of radius, left-rise 0.5 0.9 of radius,
  right-rise 0.3 0.7 of radius, ridge -0.3 0.3 (-0.7 0.7) of radius
boss-plate: length 65 85, width 0.6 0.75 of length, thickness 7 11, boss 0.2 0.26 of width,
  draft 4 12 deg, boss-height 14 20, hole 0.35 0.5 of boss, rib 3 5
corner-block: block, corner 0.4 0.6 of height, notch 0.2 0.3 of length,
  notch-depth 0.3 0.6 of height
slot-disc: radius 30 42, thickness 0.2 0.35 of radius, slots 2 4 count, pitch 0.6 0.68 of radius,
  slot-radius 0.09 0.15 of radius, sweep 0.35 0.55 of the pitch, bore 0.18 0.3 of radius
knob: radius 24 34, height 0.6 0.9 of radius, scallops 5 8 count, scallop 0.16 0.22 of radius,
  chamfer 0.06 0.1 of radius, bore 0.2 0.35 of radius
keyed-hub: radius 20 28, length 1.1 1.7 of radius, bore 0.4 0.55 of radius,
  key-width 0.4 0.6 of bore, key-depth 0.25 0.4 of bore, chamfer 0.08 0.14 of radius
elbow: radius 8 11, bend 2.2 3 of radius, bore 0.6 0.8 of radius, straight 1 2 of radius,
  collar 1.35 1.6 of radius
groove-shaft: radius 12 17, length 3.5 4.5 of radius, groove 0.25 0.4 of radius,
  place 0.35 0.5 of length, chamfer 0.15 0.25 of radius
ball-stud: radius 8 11, ball 1.4 1.7 of radius, stem 2 3 of radius, flat 0.5 0.75 of ball,
  collar 1.6 2.1 of radius
dished-cap: radius 22 30, thickness 0.1 0.16 of radius, rim 1.3 1.5 of radius,
  rim-height 0.12 0.2 of radius, port 0.25 0.4 of radius
cross-drilled: radius 13 18, length 3 4 of radius, drill 0.4 0.7 of radius,
  blind-bore 0.3 0.4 of radius, blind-depth 0.2 0.28 of length
spline-plate: size 30 40, wave 0.08 0.2 of size, lobes 3 5 count, thickness 0.25 0.45 of size,
  bore 0.2 0.35 of size
wave-block: block, wave 0.1 0.25 of height, phase 0 360 deg
loft-grip: length 50 70, radius 12 16, waist 0.55 0.75 of radius, flare 1.3 1.7 of radius,
  bulge 0.1 0.2 of radius, turn 0 40 deg
swept-rail: length 60 80, sway 0.12 0.25 of length, rise 0.1 0.25 of length,
  width 0.12 0.2 of length, height 0.08 0.16 of length
freeform-pad: length 60 80, width 0.6 0.8 of length, height 0.25 0.35 of length,
  bulge 0.06 0.15 of length, skew -0.05 0.05 of length
cast-bracket: length 60 80, width 0.5 0.7 of length, height 0.7 0.9 of length,
  leg 0.18 0.22 of longest side, round 0.02 0.06
blend-step: length 60 80, width 0.55 0.75 of length, height 0.5 0.7 of length,
  step 0.4 0.55 of height, round 0.025 0.06
cast-flange: radius 30 40, thickness 0.11 0.16 of longest side, hub 0.35 0.42 of radius,
  hub-height 0.15 0.25 of longest side, hole 0.07 0.1 of radius, holes 4 6 count, round 0.02 0.06
taper-block: length 60 80, width 0.5 0.7 of length, height 0.35 0.5 of length,
  sharp 0.35 0.65 of length, round 0.025 0.06
)";

constexpr char kBlock[] = "length 50 80, width 30 50, height 20 40";

const struct {
  const char *name, *unit;
  double least, most;  // rounds stay thin enough for parts that are round all over
} kTurned[] = {{"gap", "of longest side", 0.002, 0.2},
               {"wall", "of longest side", 0.002, 0.2},
               {"fillet", "of longest side", 0.001, 0.2},
               {"round", "of longest side", 0.002, 0.06},
               {"crease", "deg", 3, 90}};

PartParameter parse_parameter(const std::string& text) {
  std::istringstream in(text);
  PartParameter p;
  in >> p.name >> p.low >> p.high >> std::ws;
  p.least = p.low, p.most = p.high;
  if (in.peek() == '(') {
    char bracket;
    in >> bracket >> p.least >> p.most >> bracket;
  }
  std::getline(in >> std::ws, p.unit);
  if (p.unit.empty()) p.unit = "mm";
  for (const auto& turned : kTurned)
    if (p.name == turned.name) p.unit = turned.unit, p.least = turned.least, p.most = turned.most;
  return p;
}

void parse_parameters(const std::string& list, std::vector<PartParameter>* parameters) {
  std::istringstream in(list);
  for (std::string text; std::getline(in >> std::ws, text, ',');) {
    if (text == "block")
      parse_parameters(kBlock, parameters);
    else
      parameters->push_back(parse_parameter(text));
  }
}

std::vector<PartSpec> make_specs() {
  std::vector<PartSpec> specs;
  std::istringstream in(kTable);
  for (std::string line; std::getline(in >> std::ws, line);) {
    const size_t colon = line.find(':');
    if (colon != std::string::npos) specs.push_back({line.substr(0, colon), {}});
    parse_parameters(line.substr(colon + 1), &specs.back().parameters);
  }
  return specs;
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

Dimensions in_model_units(const PartSpec& spec, const Dimensions& dimensions) {
  std::map<std::string, double> all;
  // What a length is relative to, by its unit; it stands before it in the table.
  const auto length_of = [&all](std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    const auto found = all.find(name == "longest-side" ? "length" : name);
    if (found != all.end()) return found->second;
    return name == "diameter" || name == "longest-side" ? 2 * all.at("radius") : 1;
  };
  for (const PartParameter& p : spec.parameters) {
    double& value = all[p.name] = dimensions[p.name.c_str()];
    if (p.unit == "deg") value *= M_PI / 180;
    if (p.unit.compare(0, 3, "of ") == 0) value *= length_of(p.unit.substr(3));
  }
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
