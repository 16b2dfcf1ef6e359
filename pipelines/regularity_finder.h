// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <vector>

#include "pipelines/regularize.h"
#include "sketches/gaussian.h"
#include "sketches/information.h"
#include "sketches/relations.h"

namespace sketchsplat {

/// One stroke or point that could share a quantity, by itself.
struct RegularityCandidate {
  Relation relation;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< of the quantity
  double sigma = 0;                                 ///< [px] or [rad]
  double range = 1;                                 ///< [px] in which the quantity may lie
};

/// Several relations, tried together.
struct RegularityTrial {
  Gaussian::Rows rows;  ///< over their sigmas
  Eigen::VectorXd residual;
  double nats = 0;  ///< by which the edgels are explained worse
  double gain = 0;  ///< [nat] of parameters that need not be stated
  bool news = false;
  bool pays() const { return news && nats < gain; }
};

/// Greedy search for relations that make the description of a sketch shorter (regularize()): each
/// is weighed against the distribution of the control points and shared quantities, given those
/// taken.
class RegularityFinder {
 public:
  /// `sketch` and its quadratic in squared standard deviations; `footprint`: world length of a
  /// pixel.
  RegularityFinder(const Sketch& sketch, const SketchQuadratic& quadratic, double footprint,
                   const RegularizeOptions& options);

  bool ok() const { return gaussian_.ok(); }  ///< is the quadratic positive definite?

  /// Takes relations that pay: of directions; right angles; planes; axes; radii. The first `stages`
  /// of these five.
  void find(int stages);
  const Sketch& sketch() const { return s_; }  ///< moved by what was taken, in linear steps
  /// Was there more to do than most_work allows? Then nothing that was found counts.
  bool exhausted() const { return work_ > options_.most_work; }
  double gain() const { return gain_; }  ///< [nat] of parameters that need not be stated
  Relations kept() const;
  std::vector<Regularity> regularities() const;

 private:
  struct Direction {
    int shared = -1;
    double sigma = 0;          // [rad] of the first
    std::vector<int> strokes;  // along it
    bool useful = false;       // to more than one stroke
  };

  void find_directions();
  void find_right_angles();
  void find_planes();
  void find_axes();
  void find_radii();
  void apply(const Eigen::VectorXd& move);
  int add_shared(const SharedQuantity& quantity, double range);
  Gaussian::Rows sparse(const RelationRows& rows, bool own) const;
  double own_sigma(const Relation& relation);
  RegularityTrial weigh(std::vector<Relation>* relations, double range_px, double naming);
  void take(const std::vector<Relation>& relations, const RegularityTrial& trial, bool pays);
  RegularityCandidate along(int stroke);
  void group(std::vector<RegularityCandidate> candidates, const SharedQuantity& blank);
  bool is_conic(int stroke) const;
  bool lies_in(int stroke, const Direction& normal, const std::set<int>& held) const;
  bool is_usable(int stroke) const;
  std::vector<RegularityCandidate> points_across(const Direction& direction);

  Sketch s_;
  Relations relations_;     // list: all that were taken, also those that only define a quantity
  std::vector<bool> used_;  // by shared quantity: more than one stroke holds it
  std::vector<std::set<int>> held_;  // by plane: its points; by axis and radius: their strokes
  Gaussian gaussian_;
  RegularizeOptions options_;
  double unit_;
  int points_;
  double extent_;
  double gain_ = 0;
  double work_ = 0;
  std::vector<Direction> directions_;
};

}  // namespace sketchsplat
