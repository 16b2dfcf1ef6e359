// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <vector>

#include "pipelines/adjust/relation_weigher.h"

namespace sketchsplat {

/// One stroke or point that could share a quantity, by itself.
struct RegularityCandidate {
  Relation relation;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< of the quantity
  double sigma = 0;                                 ///< [px] or [rad]
  double range = 1;                                 ///< [px] in which the quantity may lie
};

/// Greedy search for relations that make the description of a sketch shorter (regularize()): each
/// is weighed given those taken.
class RegularityFinder {
 public:
  /// As RelationWeigher.
  RegularityFinder(const Sketch& sketch, const SketchQuadratic& quadratic, double footprint,
                   const RegularizeOptions& options)
      : weigher_(sketch, quadratic, footprint, options) {}

  const RelationWeigher& weigher() const { return weigher_; }

  /// Takes relations that pay: of directions; right angles; planes; axes; radii; mirrors;
  /// tangents. The first `stages` of these seven.
  void find(int stages);
  Relations kept() const;
  std::vector<Regularity> regularities() const;

 private:
  static constexpr double kGate = 4;  // [sigma] beyond which nothing is tried
  struct Direction {
    int shared = -1;
    double sigma = 0;          // [rad] of the first
    std::vector<int> strokes;  // along it
    bool useful = false;       // to more than one stroke
  };
  // A plane across a direction, and the pairs of points that it may mirror.
  struct Mirror {
    double offset = 0;  // of the plane, world units
    std::vector<Relation> pairs;
    int candidates = 0;  // pairs across all planes
  };

  void find_directions();
  void find_right_angles();
  void find_planes();
  void find_axes();
  void find_radii();
  void find_mirrors();
  void find_tangents();
  RegularityCandidate along(int stroke);
  void group(std::vector<RegularityCandidate> candidates, const SharedQuantity& blank);
  bool share(const Relation& relation, double range, double naming);
  void define(const Relation& relation, double range);
  void hold(int shared, const Relation& relation);
  bool is_conic(int stroke) const;
  bool holds_all(const std::set<int>& held, int stroke, bool inner) const;
  bool is_usable(int stroke) const;
  std::set<int> points_of(int stroke, bool inner) const;
  std::vector<RegularityCandidate> points_across(const Direction& direction);
  Mirror best_mirror(const Direction& direction);
  bool is_sure(const RegularityCandidate& candidate) const;
  Eigen::Vector3d place_of(int point) const;
  const Sketch& sketch() const { return weigher_.sketch(); }

  RelationWeigher weigher_;
  std::vector<std::set<int>> held_;  // by shared quantity: points of planes, strokes of the others
  std::vector<Direction> directions_;
  std::set<int> mirrors_;                // shared planes that mirror
  std::vector<std::set<int>> tangents_;  // pairs of strokes
};

}  // namespace sketchsplat
