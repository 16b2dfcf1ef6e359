// SPDX-License-Identifier: MIT
// What a sketch leads to expect, by one rule each. Candidates may be known already.
#pragma once

#include <vector>

#include "edges/contrast/contrast_judge.h"
#include "edges/views/lift.h"
#include "edges/views/unexplained.h"
#include "pipelines/candidates/levels.h"

namespace sketchsplat {

/// What is in one level, in the other ones: the other rim of a hole, the floor of a pocket whose
/// depth others share, the far side of a plate. Copies go to main levels.
std::vector<Candidate> level_copies(const Sketch& sketch, const std::vector<Levels>& levels);

/// Closed loops inside of one level that no other level has a copy of, at the depths where the
/// judge finds most, seen from anywhere or through the loop: floors of pockets and of blind holes.
/// And the edges in which walls meet, from the corners of the loop to those of its copy. `depths`:
/// adds the number of those that were tried.
std::vector<Candidate> depth_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                    const KnownCurves& known, const ContrastJudge& judge,
                                    const EdgeWorld& world, int* depths);

/// Mirror images of all strokes in the planes half-way between the outermost levels.
std::vector<Candidate> mirror_copies(const Sketch& sketch, const std::vector<Levels>& levels);

/// What goes on where circles of one size and level repeat: along a line, at the fourth corner of a
/// parallelogram, and around the axis of another circle. `tolerance`: of radii and levels, world
/// units.
std::vector<Candidate> circle_patterns(const Sketch& sketch, double tolerance);

/// A circle in a known level, and the number of views whose chains of edgels agree on it.
struct LevelRing {
  Candidate ring;
  int views = 0;
};

/// Circles in the known levels: small holes, of which edgels are too few to match them without
/// their plane. Of every direction in the eight levels that hold the most strokes; those of a level
/// that most views agree on first. `explained`: edgels that tell of something else. None if they
/// are more than `most` in all: texture has rings, too, and views agree on speckles of paint.
std::vector<LevelRing> level_rings(const std::vector<Levels>& levels, const EdgeWorld& world,
                                   const EdgelFlags& explained, size_t most);

/// Circles that repeat around an axis: rings of one size in one level, at equal distances from the
/// axis of a circle of the sketch and at equal angles, of which at least half, and three, are among
/// `rings` or in the sketch. Those of one pattern are a group, from `first_group` on, seen from
/// either side of their plane as the judge finds likelier. `tolerance`: of radii, distances and
/// levels, world units. `tried`: adds the number of patterns.
std::vector<Candidate> ring_patterns(const Sketch& sketch, const std::vector<LevelRing>& rings,
                                     double tolerance, const EdgeWorld& world,
                                     const ContrastJudge& judge, int first_group, int* tried);

/// What a sketch lacks of its symmetry. Turns about the axis of a circle in its middle and mirrors
/// half-way between its outermost levels are symmetries if a third of what they move, by length,
/// lies on strokes again. All images of a stroke, of which a third is known but not all, are a
/// group, from `first_group` on, the known among them, too. An arc whose images cover its circle
/// stands for the circle. `tolerance`: of axes and levels, world units; `px`: world length of a
/// pixel. `tried`: adds the number of groups.
std::vector<Candidate> symmetry_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                       const KnownCurves& known, double tolerance, double px,
                                       int first_group, int* tried);

}  // namespace sketchsplat
