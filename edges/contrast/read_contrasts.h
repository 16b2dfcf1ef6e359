// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"

namespace sketchsplat {

/// Pixels near edgels that strokes explain, and near strokes: what a picture shows there says
/// nothing about others. One mask per view, in ideal pixels, of eight bits: near a stroke, of the
/// ways along which it runs, near edgels all; empty for views without a picture.
struct KnownEdges {
  std::vector<Image<uint8_t>> near;
  /// Per view: variance of what the filter reads beside strokes, 4 to 8 px away, less that of the
  /// noise [grey values, 0 to 1, squared]; of a view with too few, that of all together, NaN if
  /// they have too few.
  std::vector<double> clutter;
};
/// `strokes`: of all strokes, points a pixel apart; `explained`: per view and edgel.
KnownEdges known_edges(const EdgeWorld& world, const CurvePoints& strokes,
                       const std::vector<std::vector<char>>& explained);

/// Adds what lies around curves in a view.
void add_known(const EdgeWorld& world, int view, const CurvePoints& curve, KnownEdges* known);

/// What a picture shows of a step across a piece of a curve.
struct ContrastReading {
  bool tells = false;  ///< is enough of the piece in the picture, and beside no known step?
  /// The step, brighter minus darker by the curve's side, less what the surroundings foretell, over
  /// its standard deviation. That is estimated from what the same filter reads on copies of the
  /// piece that are moved aside in the picture, by 4 to 8 px: there slopes, texture and blotches of
  /// compression are the same, the edge is not. 0 where the filter reads more beside the piece than
  /// on it: no peak, so no edge here.
  double z = 0;
  double freedom = 0;  ///< degrees of freedom of Student's distribution that z has without an edge
};

/// Readings of a view, one per piece and last that of all pieces together. The filter is the
/// difference of the means at 1 and 2 px on either side, averaged along the piece. `first`: P + 1,
/// piece p owns points first[p] .. first[p + 1] - 1 of the curve, which lie about a pixel apart;
/// every `every`th is read. `other`: a curve, pixels near which are known as well; null: none.
std::vector<ContrastReading> read_contrasts(const EdgeWorld& world, int view,
                                            const CurvePoints& curve, const std::vector<int>& first,
                                            const KnownEdges& known, int every,
                                            const CurvePoints* other = nullptr);

}  // namespace sketchsplat
