// SPDX-License-Identifier: MIT
#include "edges/depth/geometry_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "datasets/types/degree.h"
#include "datasets/types/median.h"
#include "edges/depth/geometry_places.h"
#include "edges/depth/geometry_sides.h"
#include "edges/image/chain.h"
#include "edges/image/edgel_parabola.h"
#include "edges/image/gradient.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kSharp = 2.5;    // [px] width (one sigma) above which a turn is a round surface
constexpr double kMoves = 1.5;    // [px] a place may move by when it is measured
constexpr double kOneEdge = 2.2;  // [px] within which two kinds of evidence are one edge
constexpr double kFar = 2;        // scale of the sides of shallow creases
constexpr double kShallow = 40 * kDegree;  // turn above which a narrow look is better

struct Thresholds {
  double jump_px = 0, crease = 0;  // [footprints], [rad]
  double depth_noise = 0;          // of a pixel's depth about its plane [footprints]
};

// Steps and turns where there is none to speak of. `crease_deg`: the least turn that is an edge.
Thresholds measure_noise(const GeometryFields& f, double crease_deg, const GeometryOptions& options,
                         GeometryNoise* noise) {
  constexpr int kStride = 6;
  constexpr double kDirections[4][2] = {
      {1, 0}, {0, 1}, {M_SQRT1_2, M_SQRT1_2}, {M_SQRT1_2, -M_SQRT1_2}};
  const double unit = focal(f.camera);
  std::vector<double> jumps, turns, residuals;
  int turn = 0;
  for (int y = kStride / 2; y < f.valid.rows; y += kStride)
    for (int x = kStride / 2; x < f.valid.cols; x += kStride) {
      if (!f.valid(y, x) || f.activity(y, x) > 1) continue;
      const auto& d = kDirections[turn++ % 4];
      const Place p{double(x), double(y), d[0], d[1]};
      const Side a = fit_side(f, p, -1), b = fit_side(f, p, +1);
      if (std::min(a.extent, b.extent) < kLongestSide * f.scale) continue;
      jumps.push_back(jump_of(a, b, unit));
      turns.push_back(turn_of(a, b));
      residuals.push_back(unit * a.residual / a.inverse);
    }
  GeometryNoise measured;
  measured.jump_px = median(jumps) / 0.6745;               // half-normal
  measured.crease_deg = median(turns) / 1.1774 / kDegree;  // Rayleigh
  if (noise) *noise = measured;
  Thresholds t;
  t.jump_px = std::max(options.jump_px, options.noise * measured.jump_px);
  t.crease = kDegree * std::max(crease_deg, options.noise * measured.crease_deg);
  t.depth_noise = median(residuals);
  return t;
}

struct Measured {
  Edgel edgel;
  bool rim = false;
};

Edgel edgel_at(const Place& p, double s, double sigma, double jump, double threshold) {
  Edgel e;
  e.x = float(p.x + s * p.nx), e.y = float(p.y + s * p.ny);
  e.nx = float(p.nx), e.ny = float(p.ny);
  e.strength = float(jump * jump / (jump * jump + threshold * threshold));
  e.width = float(std::hypot(sigma, 1.0));
  return e;
}

bool measure_outline(const GeometryFields& f, const Place& p, Measured* out) {
  std::vector<StepSample> samples;
  for_each_pixel(
      f, p, -kBand, kBand,
      [&](double s, double, const cv::Point& at) {
        samples.push_back({s, f.alpha(at)});
      },
      true);
  const Step step = fit_step(samples);
  const double s = step.ok && std::abs(step.s) < kMoves ? step.s : 0;
  out->edgel = edgel_at(p, s, step.sigma, 1, 0);
  out->edgel.outline = true;
  out->rim = is_rim(f, p, +1);
  return true;
}

bool measure_occlusion(const GeometryFields& f, Place p, const Thresholds& t, Measured* out) {
  Side a = fit_side(f, p, -1), b = fit_side(f, p, +1);
  if (a.samples < 4 || b.samples < 4) return false;
  const double unit = focal(f.camera), jump = jump_of(a, b, unit);
  const double threshold = t.jump_px + bend_of(a, b, unit);
  if (jump < threshold) return false;
  const bool forward = b.inverse > a.inverse;  // s grows towards the nearer side
  const Side &near = forward ? b : a, &far = forward ? a : b;
  std::vector<StepSample> samples;
  for_each_pixel(f, p, -std::min(kBand, a.extent), std::min(kBand, b.extent),
                 [&](double s, double tt, const cv::Point& at) {
                   const double zn = 1 / near.inverse_at(s, tt), zf = 1 / far.inverse_at(s, tt);
                   const double u = (1.0 / f.inverse(at) - zf) / (zn - zf);
                   samples.push_back({forward ? s : -s, std::clamp(u, -0.2, 1.2)});
                 });
  const Step step = fit_step(samples);
  if (!step.ok || std::abs(step.s) > kMoves) return false;
  if (!forward) p.nx = -p.nx, p.ny = -p.ny;
  out->edgel = edgel_at(p, step.s, step.sigma, jump, threshold);
  out->rim = is_rim(f, p, +1);
  return true;
}

// Where the planes of both sides meet, if that is better known than the turn of the normal.
void meet_planes(const Side& a, const Side& b, const Thresholds& t, double unit, double scale,
                 Step* step) {
  const double bend = b.inverse_s - a.inverse_s, slope = bend_of(a, b, unit);
  if (std::min(a.extent, b.extent) < kLinear * scale || slope < 0.1 / scale) return;
  const double s = (a.inverse - b.inverse) / bend;
  const double error = std::max(0.05, t.depth_noise) / slope;  // of extrapolating two planes
  if (std::abs(s - step->s) > scale) return;
  // What smears a step also shifts it, whatever the scatter about it.
  const double shift = std::max({0.1, step->error, scale > 1 ? step->sigma / 4 : 0});
  const double wa = 1 / (error * error), wb = 1 / (shift * shift);
  step->s = (s * wa + step->s * wb) / (wa + wb);
}

bool measure_crease(const GeometryFields& f, const Place& p, const Thresholds& t, Measured* out) {
  const Side a = fit_side(f, p, -1), b = fit_side(f, p, +1);
  if (a.samples < 4 || b.samples < 4) return false;
  const double band = kBand * f.scale;
  // What the steady turn of either side adds over the smeared band is no crease.
  const double turn = turn_of(a, b);
  if (turn < t.crease + f.scale * steady_turn(a, b)) return false;
  const Vector3d d = b.normal - a.normal;
  std::vector<StepSample> samples;
  for_each_pixel(f, p, -std::min(band, a.extent), std::min(band, b.extent),
                 [&](double s, double, const cv::Point& at) {
                   const Vector3d n(f.normal[0](at), f.normal[1](at), f.normal[2](at));
                   const double u = (n - a.normal).dot(d) / d.squaredNorm();
                   samples.push_back({s, std::clamp(u, -0.3, 1.3)});
                 });
  Step step = fit_step(samples);
  if (!step.ok || step.sigma > kSharp * f.scale) return false;
  meet_planes(a, b, t, focal(f.camera), f.scale, &step);
  if (std::abs(step.s) > kMoves * f.scale) return false;
  out->edgel = edgel_at(p, step.s, step.sigma, turn, t.crease);
  return true;
}

// Where both sides are even far enough to tell a turn that a narrower look cannot.
bool measure_shallow(const GeometryFields& f, const Place& p, const Thresholds& t, Measured* out) {
  const Side a = fit_side(f, p, -1), b = fit_side(f, p, +1);
  return std::min(a.extent, b.extent) >= kLinear * f.scale && turn_of(a, b) < kShallow &&
         measure_crease(f, p, t, out);
}

// ---------------------------------------------------------------------------------- collection

// Edgels by the pixel that they lie in.
class Collection {
 public:
  Collection(int width, int height) { c_.at = Image<int>(width, height, -1); }

  // Is this edge known already?
  bool covers(const Place& p, double reach = kOneEdge) const {
    const int cx = int(std::lround(p.x)), cy = int(std::lround(p.y)), r = int(reach) + 1;
    for (int y = std::max(0, cy - r); y <= std::min(c_.at.height - 1, cy + r); ++y)
      for (int x = std::max(0, cx - r); x <= std::min(c_.at.width - 1, cx + r); ++x) {
        if (c_.at.at(x, y) < 0) continue;
        const Edgel& e = c_.edgels[c_.at.at(x, y)];
        if (std::hypot(e.x - p.x, e.y - p.y) < reach && std::abs(e.nx * p.nx + e.ny * p.ny) > 0.7)
          return true;
      }
    return false;
  }

  void add(const Measured& m) {
    const int x = int(std::lround(m.edgel.x)), y = int(std::lround(m.edgel.y));
    if (x < 0 || y < 0 || x >= c_.at.width || y >= c_.at.height) return;
    int& at = c_.at.at(x, y);
    if (at >= 0 && c_.edgels[at].strength >= m.edgel.strength) return;
    at = int(c_.edgels.size());
    c_.edgels.push_back(m.edgel);
    rim_.push_back(m.rim);
  }

  void add(const Collection& other) {
    for (size_t i = 0; i < other.rim_.size(); ++i) add({other.c_.edgels[i], other.rim_[i]});
  }

  const Candidates& candidates() const { return c_; }
  const std::vector<bool>& rims() const { return rim_; }

 private:
  Candidates c_;
  std::vector<bool> rim_;
};

// Measures places of one kind of evidence, but for those where a stronger kind has an edge.
template <typename Measure>
void collect(const std::vector<Place>& places, const Measure& measure, Collection* collection) {
  std::vector<Measured> found;
  for (const Place& place : places) {
    Measured m;
    if (!collection->covers(place) && measure(place, &m)) found.push_back(m);
  }
  for (const Measured& m : found) collection->add(m);
}

// Creases that are too shallow to be told from noise at once, or smeared, but look sharp from
// farther away. Not where an edge is `known`.
Collection shallow_creases(const GeometryFields& fields, const Slopes& depth,
                           const GeometryOptions& options, const Collection& known) {
  GeometryFields f = fields;
  f.scale = kFar;
  const Slopes normal = normal_slopes(f, kFar * options.sigma_px);
  const double low = kPeak / kFar * options.shallow_deg * kDegree;
  cv::magnitude(depth.magnitude / (kPeak * options.jump_px), normal.magnitude / low, f.activity);
  const Thresholds t = measure_noise(f, options.shallow_deg, options, nullptr);
  Collection found(f.valid.cols, f.valid.rows);
  collect(
      find_places(normal, kPeak / kFar * t.crease),
      [&](const Place& p, Measured* m) {
        return !known.covers(p, kFar * kOneEdge) && measure_shallow(f, p, t, m);
      },
      &found);
  return found;
}

// Cuts the rims out of the chains; of neighbours the majority decides.
void drop_rims(const std::vector<bool>& rim, int min_chain, EdgelMap* map) {
  constexpr int kVoters = 5;
  EdgelMap out;
  out.chain.assign(1, 0);
  for (int c = 0; c < map->num_chains(); ++c) {
    const int begin = map->chain[c], end = map->chain[c + 1];
    for (int i = begin; i <= end; ++i) {
      int votes = 0, voters = 0;
      for (int k = std::max(begin, i - kVoters); k <= std::min(end - 1, i + kVoters); ++k)
        votes += rim[k], ++voters;
      if (i < end && 2 * votes <= voters) {
        out.edgels.push_back(map->edgels[i]);
      } else {
        if (int(out.edgels.size()) - out.chain.back() < min_chain)
          out.edgels.resize(out.chain.back());
        else
          out.chain.push_back(int(out.edgels.size()));
      }
    }
  }
  map->edgels = std::move(out.edgels);
  map->chain = std::move(out.chain);
}

// Moves edgels along their normals onto the parabola through their neighbours in the chain: maps
// that are sampled at pixel centres carry up to half a pixel of staircase.
void smooth_chains(EdgelMap* map) {
  constexpr int kNeighbours = 5;
  constexpr double kReach = 5, kMost = 0.6;  // [px]
  const std::vector<Edgel> raw = map->edgels;
  for (int c = 0; c < map->num_chains(); ++c)
    for (int i = map->chain[c]; i < map->chain[c + 1]; ++i) {
      const Edgel& e = raw[i];
      EdgelParabola parabola(e, kReach);
      bool straight = true;
      for (int k = std::max(map->chain[c], i - kNeighbours);
           k <= std::min(map->chain[c + 1] - 1, i + kNeighbours); ++k) {
        if (std::abs(parabola.place(raw[k]).x()) > 1) continue;
        straight &= std::abs(e.nx * raw[k].nx + e.ny * raw[k].ny) > 0.8;
        parabola.add(raw[k]);
      }
      if (parabola.count() < 6 || !straight) continue;  // no parabola through corners
      const double shift = parabola.coefficients()[0];
      if (!(std::abs(shift) < kMost)) continue;
      map->edgels[i].x += float(shift * e.nx), map->edgels[i].y += float(shift * e.ny);
    }
}

EdgelMap edges_of(const GeometryMaps& maps, const Camera& camera, const GeometryOptions& options,
                  GeometryNoise* noise) {
  EdgelMap map;
  map.chain.assign(1, 0);
  GeometryFields f = make_fields(maps, camera);
  map.mask = Image<uint8_t>(maps.width(), maps.height());
  std::copy(f.valid.begin(), f.valid.end(), map.mask.data.begin());
  if (cv::countNonZero(f.valid) == 0) return map;
  cv::Mat1f ax, ay;
  gaussian_gradient(f.alpha, options.sigma_px, &ax, &ay);
  const Slopes depth = depth_slopes(f, options.sigma_px),
               normal = normal_slopes(f, options.sigma_px);
  measure_activity(depth, normal, options.jump_px, options.crease_deg * kDegree, &f);
  const Thresholds t = measure_noise(f, options.crease_deg, options, noise);

  Collection found(maps.width(), maps.height());
  collect(
      find_places(slopes_of(ax, ay), 0.5 * kPeak),
      [&](const Place& p, Measured* m) { return measure_outline(f, p, m); }, &found);
  collect(
      find_places(depth, kPeak * options.jump_px),
      [&](const Place& p, Measured* m) { return measure_occlusion(f, p, t, m); }, &found);
  Collection shallow(maps.width(), maps.height());
  if (options.shallow_deg > 0) shallow = shallow_creases(f, depth, options, found);
  collect(
      find_places(normal, kPeak * t.crease),
      [&](const Place& p, Measured* m) {
        return !shallow.covers(p, kFar * kOneEdge) && measure_crease(f, p, t, m);
      },
      &found);
  found.add(shallow);

  Candidates candidates = found.candidates();
  std::vector<bool> rim;
  for (size_t i = 0; i < candidates.edgels.size(); ++i)  // chains carry the mark through `strength`
    if (found.rims()[i] && !options.rims) candidates.edgels[i].strength += 2;
  chain_edgels(candidates, 0.5f, options.min_chain, false, &map);
  for (Edgel& e : map.edgels) {
    rim.push_back(e.strength > 1.5f);
    if (rim.back()) e.strength -= 2;
  }
  drop_rims(rim, options.min_chain, &map);
  smooth_chains(&map);
  return map;
}

}  // namespace

EdgelMap geometry_edges(const GeometryMaps& maps, const Camera& camera,
                        const GeometryOptions& options, GeometryNoise* noise) {
  EdgelMap map;
  map.width = maps.width(), map.height = maps.height();
  map.chain.assign(1, 0);
  if (map.width < 3 || map.height < 3) return map;
  map.mask = Image<uint8_t>(map.width, map.height);
  const cv::Rect box = object_box(maps);
  if (box.empty()) return map;
  EdgelMap found = edges_of(cut_maps(maps, box), camera.cut(box.x, box.y, box.width, box.height),
                            options, noise);
  mat_of(found.mask).copyTo(mat_of(map.mask)(box));
  for (Edgel& e : found.edgels) e.x += float(box.x), e.y += float(box.y);
  map.edgels = std::move(found.edgels);
  map.chain = std::move(found.chain);
  return map;
}

}  // namespace sketchsplat
