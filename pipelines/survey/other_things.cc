// SPDX-License-Identifier: MIT
#include "pipelines/survey/other_things.h"

#include <algorithm>
#include <cmath>

#include "edges/views/cell_groups.h"
#include "edges/views/convex_hull.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSpacingPx = 4;  // [px] of the places that stand for strokes
constexpr double kTouchPx = 8;    // [px] within which strokes touch
constexpr double kBesidePx = 16;  // [px] around the outline of the object, that are its own
constexpr double kNear = 0.25;    // of the region's diagonal: how far from its middle things count
constexpr double kWithin = 0.5;   // share of a piece that stands within the object's outline
constexpr double kMost = 0.6;     // of all, that is the object where the rest is told from it
constexpr double kPart = 0.25;    // of the object, which no thing beside it has

// Strokes that touch, seen from above, as places.
using Piece = std::vector<Vector2d>;

int piece_of_object(const std::vector<Piece>& pieces, const Vector2d& middle, double near) {
  std::vector<double> weight;
  for (const Piece& piece : pieces) {
    double sum = 0;
    for (const Vector2d& p : piece)
      sum += std::exp(-0.5 * (p - middle).squaredNorm() / (near * near));
    weight.push_back(sum);
  }
  return int(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

// The object's pieces: one of them, and what belongs to it.
std::vector<char> grown_from(int first, const std::vector<Piece>& pieces, double margin) {
  std::vector<char> own(pieces.size());
  std::vector<Vector2d> object;
  std::vector<int> next = {first};
  while (!next.empty()) {
    for (const int k : next) {
      own[k] = 1;
      object.insert(object.end(), pieces[k].begin(), pieces[k].end());
    }
    next.clear();
    const std::vector<Vector2d> outline = convex_hull(widened(object, margin));
    for (int k = 0; k < int(pieces.size()); ++k) {
      if (own[k]) continue;
      const auto within = std::count_if(pieces[k].begin(), pieces[k].end(),
                                        [&](const Vector2d& p) { return is_inside(outline, p); });
      if (double(within) >= kWithin * double(pieces[k].size()) ||
          double(pieces[k].size()) >= kPart * double(object.size()))
        next.push_back(k);
    }
  }
  return own;
}

}  // namespace

std::vector<char> of_other_things(const Sketch& sketch, const EdgeWorld& world) {
  std::vector<char> out(sketch.size());
  if (!world.object.table || sketch.size() == 0) return out;
  const SampleLayout layout = plan_samples(sketch, kSpacingPx * world.footprint);
  const Samples samples = evaluate_samples(sketch, layout);
  const Eigen::Matrix<double, 2, 3>& frame = world.object.frame;
  std::vector<Vector3d> places;  // in the plane
  for (int i = 0; i < samples.position.cols(); ++i) {
    const Vector2d p = frame * samples.position.col(i);
    places.emplace_back(p.x(), p.y(), 0);
  }
  int count = 0;
  const double touch = kTouchPx * world.footprint;
  const std::vector<int> piece = groups_of(places, touch, &count);
  std::vector<Piece> pieces(count);
  for (size_t i = 0; i < places.size(); ++i) pieces[piece[i]].push_back(places[i].head<2>());
  const Vector2d middle = frame * meeting_point(world.views);
  const double near = kNear * world.object.box.diagonal().norm();
  const std::vector<char> own =
      grown_from(piece_of_object(pieces, middle, near), pieces, kBesidePx * world.footprint);
  size_t of_object = 0;
  for (int k = 0; k < count; ++k)
    if (own[k]) of_object += pieces[k].size();
  if (double(of_object) < kMost * double(places.size())) return out;
  for (int s = 0; s < sketch.size(); ++s) out[s] = !own[piece[layout.first[s]]];
  return out;
}

}  // namespace sketchsplat
