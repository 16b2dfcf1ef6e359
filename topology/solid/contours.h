// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// A line of sight through a place of a contour that no stroke explains: a round surface, whose
/// contour wanders over it from view to view, touches the line.
struct ContourLine {
  Eigen::Vector3d from, direction;  ///< camera centre; unit
};

/// The part of a surface that lines may touch.
struct RoundPatch {
  Surface surface;
  Eigen::Vector3d middle;                             ///< of a ball around the part,
  double reach = 0;                                   ///< and its radius
  std::function<bool(const Eigen::Vector3d&)> holds;  ///< a place at the surface
};

/// A surface as a function of one parameter; nothing where there is none.
using RoundFamily = std::function<std::optional<RoundPatch>(double)>;

class Contours {
 public:
  /// `tolerance` [world units]: of a line from the surface that it touches.
  Contours(std::vector<ContourLine> lines, double tolerance)
      : lines_(std::move(lines)), tolerance_(tolerance) {}

  int size() const { return int(lines_.size()); }
  /// Lines that touch a part, ascending.
  std::vector<int> touching(const RoundPatch& patch) const;
  /// Passes over these lines from now on.
  void remove(const std::vector<int>& lines);

  struct Fit {
    double parameter = 0;
    std::vector<int> lines;  ///< that touch this member of the family
  };
  /// The parameter between low and high on which the most lines agree, each of which says for
  /// itself which members of the family it touches; nothing if they are fewer than `least`, or of
  /// fewer than three cameras. `steps`: of the search, small enough that no line is touched twice
  /// within one.
  std::optional<Fit> fit(const RoundFamily& family, double low, double high, int steps,
                         int least) const;

 private:
  std::optional<Fit> touched(const RoundFamily& family, double parameter, int least) const;

  std::vector<ContourLine> lines_;
  double tolerance_;
};

}  // namespace sketchsplat
