// SPDX-License-Identifier: MIT
#include "edges/contrast/read_contrasts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

constexpr int kReach = 8;             // [px] of the farthest copy
constexpr int kNearCopy = 4;          // [px] of the nearest
constexpr int kArm = 2;               // [px] of the filter
constexpr int kSide = kReach + kArm;  // [px] that is read on either side
constexpr int kKnownPx = 2;           // [px] around edgels that are explained
constexpr double kLeastShare = 0.5;   // of the points that must tell
constexpr int kFewestCopies = 5;
constexpr double kFreedom = 4;          // that copies which overlap leave
constexpr double kPrior = 10;           // more, where the picture's noise tells the scale
constexpr double kCalm = 2.5;           // times what noise makes: the variance of copies, then
constexpr double kSharp = 0.6;          // share of a step that the filter may read 3 px beside it
constexpr double kInside = 0.8;         // of the way to the centre of curvature, that copies may go
constexpr int kTurn = 3;                // points before and after, that tell the curvature
constexpr int kPiece = 24, kEvery = 2;  // points of which copies tell the clutter of a view
constexpr size_t kFewestReadings = 100;  // readings of copies
constexpr double kLeastNoise = 0.3;      // [grey levels of 255] of whole numbers alone

using Taps = std::array<float, 2 * kSide + 1>;  // grey values across; NaN: unknown

// Grey value at a pixel of the image, bilinear; NaN outside.
float grey_at(const GreyPart& g, double x, double y) {
  const double u = x - g.x0, v = y - g.y0;
  if (!(u >= 0 && v >= 0 && u < g.value.width - 1 && v < g.value.height - 1)) return NAN;
  const int i = int(u), j = int(v);
  const float a = float(u - i), b = float(v - j);
  const uint16_t *p = g.value.row(j) + i, *q = p + g.value.width;
  return ((1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1])) / GreyPart::kOne;
}

// Ways along which strokes run, eight in half a turn, as bits.
uint8_t way_bits(const Eigen::Vector2d& along, int beside) {
  const int way = int(std::floor((std::atan2(along.y(), along.x()) / M_PI + 1) * 8 + 0.5));
  uint8_t bits = 0;
  for (int k = way - beside; k <= way + beside; ++k) bits |= uint8_t(1 << ((k + 8) % 8));
  return bits;
}

bool is_known(const Image<uint8_t>& near, const Eigen::Vector2d& p, uint8_t ways) {
  const int x = int(std::lround(p.x())), y = int(std::lround(p.y()));
  return x >= 0 && y >= 0 && x < near.width && y < near.height && (near.at(x, y) & ways);
}

// Pixel of a point and the way along which a curve runs there, in pixels per footprint; false where
// it is not in front of the camera, or seen from its end.
bool project(const EdgeWorld& world, const View& v, const Eigen::Vector3d& x,
             const Eigen::Vector3d& tangent, Eigen::Vector2d* pixel, Eigen::Vector2d* along) {
  double depth, beyond;
  *pixel = v.project(x, &depth);
  *along = 2 * (v.project(x + 0.5 * world.footprint * tangent, &beyond) - *pixel);
  return depth > 0 && along->norm() > 0.2;
}

// Copies of a curve that turns are moved aside up to near its centre of curvature: beyond, they are
// on the other side of a small hole.
class Turn {
 public:
  // Points before, at and after (Menger's curvature); the way across.
  Turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
       const Eigen::Vector2d& across) {
    const Eigen::Vector2d u = b - a, w = c - b;
    const double lengths = u.norm() * w.norm() * (c - a).norm();
    if (lengths > 0)
      curvature_ =
          2 * std::abs(u.x() * w.y() - u.y() * w.x()) / lengths * (across.dot(w - u) < 0 ? -1 : 1);
  }
  bool reaches(int offset) const { return offset * curvature_ < kInside; }

 private:
  double curvature_ = 0;  // [1/px], positive if the centre lies across
};

// The filter's sums at all offsets, over the points of a piece.
struct Sums {
  std::array<double, 2 * kReach + 1> sum = {};
  std::array<int, 2 * kReach + 1> count = {};
  int points = 0;

  void add(const Taps& t) {
    for (int o = -kReach; o <= kReach; ++o) {
      const int c = o + kSide;
      const float d = 0.5f * (t[c + 1] + t[c + 2] - t[c - 1] - t[c - 2]);
      if (std::isnan(d) || std::isnan(t[c])) continue;
      sum[o + kReach] += d;
      ++count[o + kReach];
    }
  }
  void add(const Sums& other) {
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += other.sum[k], count[k] += other.count[k];
    points += other.points;
  }
  bool tells(int offset) const {
    return count[offset + kReach] >= std::max(3, int(std::ceil(kLeastShare * points)));
  }
  double mean(int offset) const { return sum[offset + kReach] / count[offset + kReach]; }
};

// What copies foretell of the piece: a straight line through what they read.
struct Foretold {
  double level = 0, slope = 0;  // per px aside
  double variance = 0;          // of the level, for readings of variance 1
  double squares = 0;           // of what it misses
  int copies = 0;
};
Foretold foretell(const Sums& s) {
  Foretold out;
  double o1 = 0, o2 = 0, d0 = 0, d1 = 0, d2 = 0;
  for (int o = kNearCopy; o <= kReach; ++o)
    for (const int at : {-o, o}) {
      if (!s.tells(at)) continue;
      const double d = s.mean(at);
      ++out.copies, o1 += at, o2 += at * at, d0 += d, d1 += at * d, d2 += d * d;
    }
  const double n = out.copies, det = n * o2 - o1 * o1;
  if (out.copies < kFewestCopies || !(det > 0)) return out;
  out.level = (o2 * d0 - o1 * d1) / det;
  out.slope = (n * d1 - o1 * d0) / det;
  out.variance = o2 / det;
  out.squares = std::max(0.0, d2 - out.level * d0 - out.slope * d1);
  return out;
}

// `clutter`: what copies beside the strokes of the view read, NaN if too few are known.
ContrastReading reading(const Sums& s, double noise, double clutter) {
  ContrastReading out;
  if (!s.tells(0)) return out;
  Foretold f = foretell(s);
  const double here = noise * noise / s.count[kReach], n = f.copies - 2;
  double variance = f.squares / n;
  out.freedom = kFreedom;
  if (f.copies < kFewestCopies) {  // there is no room beside it: as elsewhere in the view
    if (std::isnan(clutter)) return out;
    f = {};
    variance = here + clutter;
  } else if (variance < kCalm * here) {  // nothing but noise, whose size is known well
    variance = (kPrior * here + f.squares) / (kPrior + n), out.freedom = kPrior + kFreedom;
  }
  const double step = s.mean(0) - f.level;
  out.tells = true;
  out.z = step / std::sqrt(variance * (1 + f.variance));
  for (const int o : {-3, -2, 2, 3}) {
    const double most = std::abs(o) == 3 ? kSharp : 1;
    if (s.tells(o) && std::abs(s.mean(o) - f.level - o * f.slope) > most * std::abs(step))
      out.z = 0;
  }
  return out;
}

Turn turn_at(const View& v, const CurvePoints& curve, int i, const Eigen::Vector2d& q,
             const Eigen::Vector2d& across) {
  const int n = int(curve.position.cols());
  const int step = std::min(kTurn, std::max(1, n / 8));
  int a = i - step, c = i + step;
  if (closes(curve)) a = (a + n) % n, c %= n;
  if (a < 0 || c >= n) return Turn(q, q, q, across);
  double depth;
  const Eigen::Vector2d before = v.project(curve.position.col(a), &depth);
  return Turn(before, q, v.project(curve.position.col(c), &depth), across);
}

// Pixels of a view that say nothing.
struct Masked {
  const Image<uint8_t>& near;
  std::vector<Eigen::Vector2d> other = {};  // points on a curve around which they do not either

  bool masks(const Eigen::Vector2d& p, uint8_t ways) const {
    return is_known(near, p, ways) ||
           std::any_of(other.begin(), other.end(), [&](const Eigen::Vector2d& o) {
             return (p - o).lpNorm<Eigen::Infinity>() < kKnownPx + 0.5;
           });
  }
};

// Of the points from `first` to `end`.
Sums read_piece(const EdgeWorld& world, int view, const CurvePoints& curve, int first, int end,
                const Masked& masked, int every) {
  const View& v = world.views[view];
  Sums sums;
  for (int i = first; i < end; i += every) {
    ++sums.points;
    Eigen::Vector2d q, along;
    if (!project(world, v, curve.position.col(i), curve.tangent.col(i), &q, &along)) continue;
    const uint8_t ways = way_bits(along, 1);
    const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
    const Turn turn = turn_at(v, curve, i, q, across);
    Taps taps;
    for (int o = -kSide; o <= kSide; ++o) {
      const Eigen::Vector2d ideal = q + o * across;
      Eigen::Vector2d image;
      taps[o + kSide] =
          !turn.reaches(o) || masked.masks(ideal, ways) || !v.image_pixel(ideal, &image)
              ? NAN
              : grey_at(*world.maps[view].grey, image.x(), image.y());
    }
    sums.add(taps);
  }
  return sums;
}

double noise_of(const EdgelMap& map) { return std::max<double>(map.noise, kLeastNoise / 255); }

// What copies beside strokes read, of one view or several.
struct Clutter {
  std::vector<double> readings;  // absolute
  double noise = 0;              // sum of the variances that noise alone makes

  void add(const Clutter& other) {
    readings.insert(readings.end(), other.readings.begin(), other.readings.end());
    noise += other.noise;
  }
  // Their variance, less the noise; NaN if there are too few.
  double variance() const {
    const double n = double(readings.size());
    if (readings.size() < kFewestReadings) return NAN;
    return std::max(0.0, std::pow(normal_sigma(readings), 2) - noise / n);
  }
};

Clutter clutter_of(const EdgeWorld& world, int view, const CurvePoints& strokes,
                   const Image<uint8_t>& near) {
  const double noise = noise_of(world.maps[view]);
  Clutter out;
  for (size_t s = 0; s + 1 < strokes.first.size(); ++s) {
    const int last = strokes.first[s + 1];
    for (int at = strokes.first[s]; at < last; at += kPiece) {
      const Sums sums =
          read_piece(world, view, strokes, at, std::min(at + kPiece, last), {near}, kEvery);
      for (int o = -kReach; o <= kReach; ++o)
        if (std::abs(o) >= kNearCopy && sums.tells(o)) {
          out.readings.push_back(std::abs(sums.mean(o)));
          out.noise += noise * noise / sums.count[o + kReach];
        }
    }
  }
  return out;
}

// Of each view; where one alone has too few readings, those of all together.
std::vector<double> clutter_of_views(const std::vector<Clutter>& views) {
  Clutter all;
  for (const Clutter& c : views) all.add(c);
  const double together = all.variance();
  std::vector<double> out;
  for (const Clutter& c : views) {
    const double alone = c.variance();
    out.push_back(std::isnan(alone) ? together : alone);
  }
  return out;
}

void mark_around(double x, double y, uint8_t ways, Image<uint8_t>* near) {
  const int cx = int(std::lround(x)), cy = int(std::lround(y));
  for (int v = std::max(0, cy - kKnownPx); v <= std::min(near->height - 1, cy + kKnownPx); ++v)
    for (int u = std::max(0, cx - kKnownPx); u <= std::min(near->width - 1, cx + kKnownPx); ++u)
      near->at(u, v) |= ways;
}

}  // namespace

void add_known(const EdgeWorld& world, int view, const CurvePoints& curve, KnownEdges* known) {
  if (known->near[view].empty()) return;
  for (int i = 0; i < curve.position.cols(); ++i) {
    Eigen::Vector2d p, along;
    const View& v = world.views[view];
    if (project(world, v, curve.position.col(i), curve.tangent.col(i), &p, &along) &&
        v.camera.contains(p))
      mark_around(p.x(), p.y(), way_bits(along, 0), &known->near[view]);
  }
}

KnownEdges known_edges(const EdgeWorld& world, const CurvePoints& strokes,
                       const std::vector<std::vector<char>>& explained) {
  KnownEdges out;
  out.near.resize(world.maps.size());
  std::vector<Clutter> clutter(world.maps.size());
  parallel_for(int(world.maps.size()), 1, [&](int v) {
    const EdgelMap& map = world.maps[v];
    if (!map.grey) return;
    out.near[v] = Image<uint8_t>(map.width, map.height);
    for (size_t i = 0; i < map.edgels.size(); ++i)
      if (explained[v][i]) mark_around(map.edgels[i].x, map.edgels[i].y, 255, &out.near[v]);
    add_known(world, v, strokes, &out);
    clutter[v] = clutter_of(world, v, strokes, out.near[v]);
  });
  out.clutter = clutter_of_views(clutter);
  return out;
}

std::vector<ContrastReading> read_contrasts(const EdgeWorld& world, int view,
                                            const CurvePoints& curve, const std::vector<int>& first,
                                            const KnownEdges& known, int every,
                                            const CurvePoints* other) {
  const int pieces = int(first.size()) - 1;
  std::vector<ContrastReading> out(pieces + 1);
  const EdgelMap& map = world.maps[view];
  if (!map.grey) return out;
  Sums whole;
  const double noise = noise_of(map);
  Masked masked{known.near[view]};
  double depth;
  if (other)
    for (int i = 0; i < other->position.cols(); ++i)
      masked.other.push_back(world.views[view].project(other->position.col(i), &depth));
  for (int p = 0; p < pieces; ++p) {
    const Sums sums = read_piece(world, view, curve, first[p], first[p + 1], masked, every);
    out[p] = reading(sums, noise, known.clutter[view]);
    whole.add(sums);
  }
  out[pieces] = reading(whole, noise, known.clutter[view]);
  return out;
}

}  // namespace sketchsplat
