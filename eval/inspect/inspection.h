// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/inspect/alignment.h"
#include "eval/inspect/association.h"
#include "eval/inspect/dimensions.h"
#include "eval/inspect/edge_check.h"
#include "eval/inspect/iso2768.h"
#include "eval/inspect/sigma_model.h"

namespace sketchsplat {

struct InspectOptions {
  /// Radius of the tube around every nominal edge, and +- of every length; of angles, what it is at
  /// the end of the shorter side. Unit of the nominal; 0: the table says.
  double tolerance = 0;
  Iso2768 iso = Iso2768::kNone;  ///< tolerances of dimensions by their size
  double unit_mm = 1;            ///< millimetres of the nominal's unit, for the table
  AlignOptions align;
  AssociateOptions associate;
  /// How large deviations are is learned from all edges of the part (eval/inspect/prior.h); else
  /// every scale is as likely as any other.
  bool learn_prior = true;
  SigmaOptions sigma;
};

struct DimensionResult {
  DimensionCheck check;
  double tolerance = 0;    ///< +-
  double probability = 0;  ///< that the dimension lies within it; exact for normal errors
  Judgement verdict = Judgement::kNotJudged;
};

/// A result against its nominal part. Everything in the nominal's frame and unit.
struct Inspection {
  Alignment alignment;
  Sketch measured;
  Association association;         ///< of nominal.edges; its places without the pull of blur
  double pull_px2 = 0;             ///< that was taken off them, see SigmaOptions::curvature_px2
  DeviationPrior prior;            ///< of the edges' deviations
  DeviationPrior dimension_prior;  ///< of dimensions, scales in tolerances
  std::vector<EdgeCheck> edges;    ///< of nominal.edges
  std::vector<DimensionResult> dimensions;
  std::vector<std::string> warnings;
  Judgement verdict = Judgement::kIn;  ///< out if anything is, else undecided if anything is
};

/// How many views see each place of each edge, when the measured sketch is put by `pose`.
using Visibility = std::function<std::vector<std::vector<int>>(
    const Similarity& pose, const std::vector<std::vector<EdgePlace>>& places)>;

/// `measured`: in the nominal's unit, in a frame of its own, with evidence; `footprint`: length of
/// a pixel at the part [unit], 0 if unknown. `visibility` may be empty. Throws InputError (see
/// align).
Inspection inspect(const Nominal& nominal, const Sketch& measured, double footprint,
                   const InspectOptions& options, const Visibility& visibility = {});

/// Of edges and dimensions with this verdict.
struct JudgementCounts {
  int edges = 0, dimensions = 0;
};
JudgementCounts count_verdicts(const Inspection& inspection, Judgement verdict);

}  // namespace sketchsplat
