// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/adjust/regularize.h"
#include "sketches/solve/gaussian.h"
#include "sketches/solve/information.h"
#include "sketches/solve/relations.h"

namespace sketchsplat {

/// Several relations, tried together.
struct RelationTrial {
  Gaussian::Rows rows;  ///< over their sigmas
  Eigen::VectorXd residual;
  double nats = 0;  ///< by which the edgels are explained worse
  double gain = 0;  ///< [nat] of parameters that need not be stated
  bool news = false;
  bool pays() const { return news && nats < gain; }
};

/// What relations cost and save (regularize()), by the distribution of the control points and
/// shared quantities, given those taken before.
class RelationWeigher {
 public:
  /// `quadratic`: of the sketch, in squared standard deviations; `footprint`: world length of a
  /// pixel.
  RelationWeigher(const Sketch& sketch, const SketchQuadratic& quadratic, double footprint,
                  const RegularizeOptions& options);

  bool ok() const { return gaussian_.ok(); }   ///< is the quadratic positive definite?
  const Sketch& sketch() const { return s_; }  ///< moved by what was taken, in linear steps
  const RegularizeOptions& options() const { return options_; }
  double unit() const { return unit_; }      ///< world length of a pixel
  double extent() const { return extent_; }  ///< of the sketch, world units

  /// Was there more to do than most_work allows? Then nothing more is found or taken.
  bool exhausted() const { return work_ > options_.most_work; }
  double gain() const { return gain_; }  ///< [nat] of parameters that need not be stated

  /// Adds a quantity that may lie within `range` [world units, or 1] of its value; its index.
  int add_shared(const SharedQuantity& quantity, double range);
  const SharedQuantity& shared(int index) const { return relations_.shared[index]; }
  int num_shared() const { return int(relations_.shared.size()); }
  /// Has more than one stroke or point taken it?
  bool is_used(int shared) const { return used_[shared]; }
  /// All that were taken, also those that only define a quantity.
  const Relations& relations() const { return relations_; }

  /// Residual [px], and its largest standard deviation, of a relation to a quantity that is only
  /// asked about: of the stroke or the point by itself.
  struct Own {
    Eigen::VectorXd residual;
    double sigma = 0;  ///< [px]
  };
  Own ask(Relation relation, const SharedQuantity& quantity);

  /// Sets the relations' sigmas, and asks what they cost and save. `naming`: log of the number of
  /// candidates among which they were found, less the log of the odds of what is expected. What a
  /// relation tells, log(range / deviation), must exceed the price of a parameter, lest chance
  /// agreement pays.
  RelationTrial weigh(std::vector<Relation>* relations, double range_px, double naming);
  /// `pays`: something is shared from now on; else the relations only define a quantity.
  void take(const std::vector<Relation>& relations, const RelationTrial& trial, bool pays);

 private:
  void apply(const Eigen::VectorXd& move);
  Gaussian::Rows sparse(const RelationRows& rows, bool own) const;
  Own own(const Relation& relation) const;

  Sketch s_;
  Relations relations_;
  std::vector<bool> used_;  // by shared quantity
  Gaussian gaussian_;
  RegularizeOptions options_;
  double unit_;
  int points_;
  double extent_;
  double gain_ = 0;
  double work_ = 0;
};

}  // namespace sketchsplat
