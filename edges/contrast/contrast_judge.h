// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/contrast/read_contrasts.h"
#include "edges/contrast/window.h"

namespace sketchsplat {

struct ContrastOptions {
  double piece_px = 24;      ///< [px] of a piece, along which a step may change its sign
  double sure_rate = 0.75;   ///< views that show an edge that nothing hides, by the hull
  double piece_rate = 0.85;  ///< pieces that a view shows which shows any
  double accident = 0.05;    ///< views in which something else lies along a candidate
};

/// What one view says of a candidate.
struct ViewSays {
  int view = 0;
  double ratio = 1;   ///< likelihood ratio of an edge and of none, if the view would show an edge
  bool sure = false;  ///< nothing hides the candidate from it, as the hull tells
};

/// What the pictures of all views say about one candidate.
struct ContrastEvidence {
  /// [nat] logarithm of the likelihood ratio of an edge and of none. By Markov's inequality a
  /// candidate that is none exceeds x with a probability of at most exp(-x).
  double nats = 0;
  std::vector<double> piece_nats;  ///< of each piece, of the views that show the whole
  int views = 0;                   ///< that show it rather than not
  std::vector<ViewSays> says;      ///< of the views that say something
};

/// Judges candidates for edges by the pictures, without edgels: a matched filter along the whole
/// candidate in every view (read_contrasts), pooled over the views. Readings of a place where no
/// edge is follow Student's distribution, for their scale is estimated from few copies; those of an
/// edge the same, 1 to 16 times as wide. Pieces may have steps of one sign or each its own, both
/// are as likely. A view may not show what is there (something hides it, or both sides are equally
/// bright) and may show what is not (something else lies there), so that no view says more than
/// -log(accident). With a hull, views that nothing hides the candidate from must show it at a known
/// rate; of all other views, all rates are as likely.
class ContrastJudge {
 public:
  /// `strokes`: points on those that are known, a pixel apart; `explained`: edgels that they
  /// explain. `world` must outlive the judge.
  ContrastJudge(const EdgeWorld& world, const CurvePoints& strokes,
                const std::vector<std::vector<char>>& explained, const ContrastOptions& options);

  /// `curve`: one curve, points about a pixel apart. `every`: of which points are read, for haste.
  /// `windows`: openings through one of which a view must see a piece of the curve to tell of it,
  /// as the curve is in a pocket or a hole; none: nobody knows from where it is seen.
  ContrastEvidence judge(const CurvePoints& curve, int every = 1,
                         const std::vector<Window>& windows = {}) const;

  /// The nats of the views alone that see a point of the candidate through a window.
  double nats_through(const ContrastEvidence& evidence, const Window& window,
                      const Eigen::Vector3d& point) const;

  /// What the curve shows from now on tells of nothing else.
  void take(const CurvePoints& curve);

  /// The most that copies of the curve say which are moved aside in space, by 5 px in four
  /// directions [nat]: what texture or a neighbour says that is there. A closed curve less than 30
  /// px across they cross: what lies around it is left out.
  double beside(const CurvePoints& curve, const std::vector<Window>& windows = {}) const;

 private:
  ContrastEvidence judge_without(const CurvePoints* other, const CurvePoints& curve, int every,
                                 const std::vector<Window>& windows) const;

  const EdgeWorld& world_;
  ContrastOptions options_;
  KnownEdges known_;
};

/// Logarithm of the likelihood ratio of a reading on an edge and on none.
double contrast_ratio(double z, double freedom);

}  // namespace sketchsplat
