// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"
#include "sketches/solve/family.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {

/// One member of a family, somewhere.
struct Sibling {
  Eigen::VectorXd numbers;  ///< see Family
  Similarity pose;          ///< of the family's frame in the world
};

/// Fits members of a family to the edgels of a scene.
class FamilyFit {
 public:
  /// Both must outlive it. At most `most_views` of the views are looked at, all but for the last
  /// steps.
  FamilyFit(const Family& family, const EdgeWorld& world, int most_views);
  ~FamilyFit();

  /// The mean, every sibling, and the mean moved along the strongest modes; where they are, and
  /// moved to the middle and the size of what the views see. Those nearest to the edgels first.
  std::vector<Sibling> starts() const;

  /// Gauss-Newton on pose and numbers, by the distances to edgels that run the same way within a
  /// reach that shrinks from a tenth of the object to 1.5 px, with the family's covariance as
  /// prior. Places of a stroke in a view count as few: their errors go together. Where the first
  /// steps lead to a place where hardly any edgel lies, the last ones are left out.
  Sibling fit(Sibling start) const;

  Sketch sketch(const Sibling& sibling) const;

  /// Share of the edgels that lie along its strokes, within `reach_px`; those fainter than the
  /// median of their picture count less, shading is no sign of another part. Outlines that lie
  /// along none do not count if some stroke is curved: round surfaces have contours that are no
  /// edges.
  double explained(const Sketch& sketch, double reach_px = 2) const;

 private:
  class Lookup;
  Sibling step(const Sibling& now, double reach_px) const;
  std::vector<SampleMatch> far_matches(const CurvePoints& samples, double reach_px) const;
  double misfit(const Sibling& sibling) const;

  const Family& family_;
  const EdgeWorld& world_;
  std::vector<int> views_;
  std::vector<std::unique_ptr<Lookup>> lookups_;  // of views_
  Eigen::MatrixXd precision_;
  double widest_px_ = 0;
};

}  // namespace sketchsplat
