// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "edges/contrast/contrast_judge.h"
#include "edges/views/unexplained.h"
#include "pipelines/candidates/candidate.h"

namespace sketchsplat {

/// Candidates that are there or not, all together: floor and walls of a pocket, a pattern of rings,
/// or images of a stroke under the symmetries of the sketch.
struct CandidateGroup {
  bool pattern = false;  ///< of rings, or what a symmetry tells; else of a pocket
  std::vector<int> members;
  std::vector<double> known, known_floor;  ///< [nat] of others that the sketch has already
};

/// Candidates that are not known, and what they and copies of them that are no edges get.
struct JudgedCandidates {
  std::vector<Candidate> candidates;
  std::vector<CurvePoints> points;       ///< a pixel apart
  std::vector<double> nats, nulls;       ///< [nat] of each, at a first look; of copies moved aside
  std::map<int, CandidateGroup> groups;  ///< of more than one
  int singles = 0;                       ///< of these, that are of no pattern; they come first
  int depths = 0, patterns = 0;          ///< that were tried for groups
  int refused = 0;                       ///< candidates that nothing spoke for in a pass before
  int tests() const { return int(candidates.size()) + depths + patterns + refused; }
};

/// Everything that the sketch leads to expect, judged. `explained`: edgels that the sketch
/// explains; `ring_views`: that must agree on a ring that stands alone; `refused`: candidates of
/// passes before that nothing spoke for; these are added. Nothing of a sketch that leads to expect
/// too much.
JudgedCandidates judge_candidates(const Sketch& sketch, const EdgeWorld& world,
                                  const EdgelFlags& explained, const ContrastJudge& judge,
                                  int ring_views, std::vector<CurvePoints>* refused);

}  // namespace sketchsplat
