// SPDX-License-Identifier: MIT
#include "topology/core/draft.h"

#include <algorithm>
namespace sketchsplat {
namespace {

// A stroke that nobody believes in still has a place when it is all there is.
constexpr double kLeastOpacity = 1e-3;

}  // namespace

double Piece::trust() const {
  return evidence.opacity > kLeastOpacity ? std::min(evidence.opacity, 1.0) : kLeastOpacity;
}

double Piece::support() const { return samples.length * trust(); }

Draft::Draft(const Sketch& sketch, const StrokePoints& points) {
  for (int n = 0; n < sketch.nodes.cols(); ++n) nodes.push_back(sketch.nodes.col(n));
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    Piece piece;
    piece.curve = plain_curve(sketch, s);
    piece.begin = stroke.begin;
    piece.end = stroke.end;
    piece.evidence = sketch.evidence[s];
    pieces.push_back(piece);
    if (!points.empty()) pieces.back().points = points[s];
    if (is_sound(piece.curve))
      pieces.back().samples = sample_curve(piece.curve);
    else
      remove(s);
  }
}

void Draft::remove(int piece) {
  pieces[piece].alive = false;
  pieces[piece].into = -1;
  ++changes;
}

void Draft::replace(int piece, const PlainCurve& curve, int begin, int end) {
  Piece& p = pieces[piece];
  p.curve = curve;
  p.begin = begin;
  p.end = end;
  if (!is_sound(curve)) return remove(piece);
  if (begin >= 0) nodes[begin] = curve.begin();
  if (end >= 0) nodes[end] = curve.end();
  p.samples = sample_curve(curve);
}

std::vector<int> Draft::degrees() const {
  std::vector<int> degree(nodes.size(), 0);
  for (const Piece& p : pieces) {
    if (!p.alive || p.begin < 0) continue;
    ++degree[p.begin];
    ++degree[p.end];
  }
  return degree;
}

PassResult Draft::finish() const {
  PassResult out;
  out.changes = changes;
  std::vector<int> node(nodes.size(), -1), index(pieces.size(), -1);
  const auto renumber = [&](int old) {
    if (old >= 0 && node[old] < 0) node[old] = out.sketch.add_node(nodes[old]);
    return old < 0 ? -1 : node[old];
  };
  for (int i = 0; i < size(); ++i) {
    const Piece& p = pieces[i];
    if (!p.alive) continue;
    const int first = p.curve.closed() ? 0 : 1;
    std::vector<Eigen::Vector3d> handles(p.curve.p.begin() + first,
                                         p.curve.p.begin() + first + num_handles(p.curve.kind));
    const int begin = renumber(p.begin), end = renumber(p.end);
    index[i] = out.sketch.add_stroke(p.curve.kind, begin, end, handles, p.evidence);
    out.points.push_back(p.points);
  }
  for (int i = 0; i < size(); ++i) {
    int k = i;
    while (k >= 0 && !pieces[k].alive) k = pieces[k].into;
    out.remap.stroke.push_back(k < 0 ? -1 : index[k]);
  }
  return out;
}

}  // namespace sketchsplat
