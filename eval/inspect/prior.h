// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/inspect/association.h"
#include "eval/inspect/sigma_model.h"
#include "eval/inspect/tolerance.h"

namespace sketchsplat {

// What a measurement says of a part depends on what was to be expected of it (JCGM 106:2012,
// Evaluation of measurement data - The role of measurement uncertainty in conformity assessment,
// sections 6 and 7). With nothing expected - any deviation as likely as any other - a curve that
// was measured where it should be, with an error as large as the tolerance, would be told to lie
// outside of it, because there is more room outside. So deviations have a scale, which is not
// known: one of some, from far below the tolerance to far above it; and how likely each is, all
// edges of the part say together (empirical Bayes: Efron & Morris 1973; scales by the EM algorithm,
// Laird 1978).

/// Standard deviations that deviations of a part may have, and how likely each is.
struct DeviationPrior {
  std::vector<double> scales;
  std::vector<double> weights;  ///< sum 1
};

/// Scales from an eighth of the tolerance to 32 times it, by doubling; all equally likely.
DeviationPrior vague_prior(double tolerance);

/// Weights that explain what was measured best; each scale also counts as a part of one thing, so
/// that nothing is impossible. `log_evidence`: of every thing that was measured, by scale.
DeviationPrior learn_prior(const DeviationPrior& vague,
                           const std::vector<std::vector<double>>& log_evidence);

/// What a small similarity of an edge - shifts, turns, growth - does at places of it, across it:
/// 2 P x 7 in the frames across the edge (frame_across), standard deviation about 1 at a place if
/// each column is taken by a standard normal number.
Eigen::MatrixXd rigid_deviations(const std::vector<EdgePlace>& places);

/// The likelihood of the true deviation of a piece of an edge, from what was measured. Of what was
/// measured, that which a small similarity explains is held against the prior. A scale is that of
/// the whole similarity, or of its shift, turn or growth alone (a hole in the wrong place, a bore
/// of the wrong size); what of it does not deviate so has the least scale. The rest, a wave, is
/// shrunk by the size of its errors (James & Stein 1961); of a stroke that is of a simpler kind
/// than the edge, it says nothing.
class PieceLikelihood {
 public:
  /// `rigid`: rigid_deviations(). A hundredth of the tolerance is always added to the errors.
  PieceLikelihood(const PieceErrors& errors, const Eigen::MatrixXd& rigid, double tolerance);

  /// Of what was measured, up to a constant, if true deviations have this scale.
  double log_evidence(double scale) const;

  /// What the true deviation is, then.
  DeviationMixture posterior(const DeviationPrior& prior) const;

  /// What was measured less what is there.
  DeviationMixture errors() const;

 private:
  struct Kind {  // of errors, by size
    double size, share;
    Eigen::MatrixXd covariance;  // K x K
  };
  static constexpr int kWays = 4;  // to be wrong: in all, place, direction, size
  double log_evidence(double scale, int wrong, const Kind& kind) const;
  DeviationModel posterior(double scale, int wrong, const Kind& kind) const;

  Eigen::MatrixXd prior_moves(double scale, int wrong) const;  // K x M

  DeviationModel measured_;
  int stated_;                          // of its modes, see PieceErrors
  Eigen::MatrixXd basis_;               // 2 P x K, orthonormal: of rigid deviations
  std::vector<Eigen::MatrixXd> moves_;  // K x M: what may deviate, by way; at scale 1
  Eigen::MatrixXd little_;              // K x 7: what of the similarity always may
  Eigen::VectorXd known_;               // K: of what was measured
  Eigen::VectorXd wave_;                // 2 P: of the rest, what errors do not explain
  std::vector<Kind> kinds_;
};

/// The same of a number: log evidence, and the probability that it lies within +- half of nominal.
/// `off`: as measured less nominal.
struct NumberError {
  double sigma = 0;  ///< standard deviation of the error, of sizes with these shares
  ErrorShares shares = {};
  double stated = 0;  ///< of another error, which is normal
};
double number_log_evidence(double off, const NumberError& error, double scale);
double number_probability(double off, const NumberError& error, double half,
                          const DeviationPrior& prior);

}  // namespace sketchsplat
