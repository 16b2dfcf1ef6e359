// SPDX-License-Identifier: MIT
#include "pipelines/adjust/snap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pipelines/adjust/choose_standards.h"
#include "pipelines/adjust/relation_weigher.h"
#include "pipelines/adjust/whitened.h"
#include "sketches/curve/conic.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kBlurPull = 1.5;   // [px^2] over the radius, as SigmaOptions::curvature_px2
constexpr double kSetSigma = 1e-4;  // [px] of a length that is set
constexpr double kRare = 1.6449;    // [sigma] that a normal number exceeds in a case of twenty

// What blur does to all views of a round stroke alike.
std::vector<double> common_errors(const Sketch& sketch, double footprint) {
  std::vector<double> out(sketch.size(), 0);
  for (int s = 0; s < sketch.size(); ++s) {
    const StrokeKind kind = sketch.strokes[s].kind;
    if (kind != StrokeKind::kCircle && kind != StrokeKind::kArc) continue;
    const CircleParameters c = circle_parameters(sketch, s);
    if (!c.straight) out[s] = kBlurPull / std::max(1.0, c.radius / footprint);
  }
  return out;
}

// Exceeded by chi squared in one case of twenty (Wilson & Hilferty 1931).
double rare_chi2(int degrees) {
  const double k = degrees, by = 2 / (9 * k);
  return k * std::pow(1 - by + kRare * std::sqrt(by), 3);
}

// The fit of all that was chosen, and how it is borne out.
class StandardFit {
 public:
  StandardFit(const Regularized& regular, const StrokeObservation& seen, double footprint,
              const RegularizeOptions& options)
      : regular_(regular), seen_(seen), footprint_(footprint), options_(options) {
    relations_ = regular.imposed;
    if (relations_.list.empty())
      relations_.origin = regular.sketch.nodes.size()
                              ? Vector3d(regular.sketch.nodes.rowwise().mean())
                              : Vector3d(Vector3d::Zero());
    SharedQuantity zero;
    zero.kind = SharedKind::kRadius;
    zero.fixed = true;
    relations_.shared.push_back(zero);
    hypotheses_ = length_hypotheses(regular.sketch, regular, zero_radius());
    now_ = evaluate_samples(regular.sketch, seen.layout);
    double cost = 0;
    quadratics_ = moved_to(
        now_, seen.samples,
        whitened(seen, options.sigma_px, footprint, common_errors(regular.sketch, footprint)),
        &cost);
  }

  const std::vector<LengthHypothesis>& hypotheses() const { return hypotheses_; }

  // In world units, times their factors. False: too many strokes, or nothing holds them.
  bool measure(MeasuredLengths* out) {
    RelationWeigher weigher(regular_.sketch,
                            sketch_quadratic(regular_.sketch, seen_.layout, quadratics_),
                            footprint_, options_);
    if (!weigher.ok()) return false;
    for (const SharedQuantity& q : relations_.shared)
      weigher.add_shared(q, q.fixed                            ? 1e-9 * weigher.extent()
                            : q.kind == SharedKind::kDirection ? 1
                                                               : weigher.extent());
    for (const Relation& r : regular_.imposed.list) {
      std::vector<Relation> one = {r};
      weigher.take(one, weigher.weigh(&one, 1, 0), true);
    }
    if (weigher.exhausted()) return false;
    std::vector<Relation> first;
    Eigen::VectorXd factors(hypotheses_.size());
    for (size_t i = 0; i < hypotheses_.size(); ++i) {
      first.push_back(hypotheses_[i].relations[0]);
      factors[i] = hypotheses_[i].factor();
      out->diameter.push_back(hypotheses_[i].kind == LengthKind::kDiameter);
    }
    const RelationWeigher::Joint joint = weigher.joint(first);
    out->value = factors.cwiseProduct(joint.residual);
    out->covariance = factors.asDiagonal() * joint.covariance * factors.asDiagonal();
    return true;
  }

  // The sketch with these lengths [world units, times factors] set, beside it without.
  void set(const std::vector<std::pair<int, double>>& lengths) {
    Relations bound = relations_, free = relations_;
    for (const auto& [h, length] : lengths) {
      const double value = length / hypotheses_[h].factor();
      SharedQuantity radius = relations_.shared[zero_radius()];
      radius.value[0] = value;
      bound.shared.push_back(radius);
      for (Relation r : hypotheses_[h].relations) {
        r.scale = 1 / footprint_;
        r.sigma = kSetSigma;
        if (r.kind == RelationKind::kApart)
          r.distance = value;
        else
          r.shared = int(bound.shared.size()) - 1;
        bound.list.push_back(r);
      }
    }
    sketch_ = refine(&bound);
    without_ = refine(&free);
  }
  const Sketch& sketch() const { return sketch_; }

  // How a stroke bears it that `count` of its lengths were set.
  struct Borne {
    double chi2 = 0, chi2_most = 0, moved_px = 0, noise_px = 0;
    double excess() const { return std::max(chi2 / chi2_most, moved_px / noise_px); }
  };
  Borne borne(int stroke, int count) const {
    Borne b;
    const Samples bound = evaluate_samples(sketch_, seen_.layout),
                  free = evaluate_samples(without_, seen_.layout);
    for (int i = seen_.layout.first[stroke]; i < seen_.layout.first[stroke + 1]; ++i) {
      b.chi2 += cost(i, bound.position.col(i)) - cost(i, free.position.col(i));
      const Vector3d along = free.tangent.col(i).stableNormalized(),
                     move = bound.position.col(i) - free.position.col(i);
      b.moved_px = std::max(b.moved_px, (move - along * along.dot(move)).norm() / footprint_);
    }
    b.chi2_most = rare_chi2(count);
    b.noise_px = std::max(seen_.matches.sigma_px, seen_.strokes[stroke].rms_px);
    return b;
  }

 private:
  int zero_radius() const { return int(regular_.imposed.shared.size()); }
  double cost(int i, const Vector3d& to) const {
    const Vector3d d = to - now_.position.col(i);
    return d.dot(quadratics_.information[i] * d) + 2 * d.dot(quadratics_.slope.col(i));
  }
  Sketch refine(Relations* relations) const {
    return refine_sketch(regular_.sketch, seen_.layout, quadratics_, options_.refine, relations)
        .sketch;
  }

  const Regularized& regular_;
  const StrokeObservation& seen_;
  double footprint_;
  RegularizeOptions options_;
  Relations relations_;  // that are imposed anyway, and the radius 0
  std::vector<LengthHypothesis> hypotheses_;
  Samples now_;
  SampleQuadratics quadratics_;
  Sketch sketch_, without_;
};

// Fills in how the strokes of each bear it; the one to be set free, -1: none.
int unbearable(const StandardFit& fit, std::vector<Snap>* snaps) {
  std::map<int, int> lengths;  // by stroke
  for (const Snap& snap : *snaps)
    for (const int s : snap.strokes) ++lengths[s];
  std::map<int, StandardFit::Borne> borne;
  for (const auto& [stroke, count] : lengths) borne[stroke] = fit.borne(stroke, count);
  int worst = -1;
  double excess = 1;
  for (size_t k = 0; k < snaps->size(); ++k) {
    Snap& snap = (*snaps)[k];
    snap.chi2 = -HUGE_VAL;
    for (const int s : snap.strokes) {
      const StandardFit::Borne& b = borne[s];
      if (b.chi2 > snap.chi2) snap.chi2 = b.chi2, snap.chi2_most = b.chi2_most;
      if (b.moved_px >= snap.moved_px) snap.moved_px = b.moved_px, snap.noise_px = b.noise_px;
      const bool cheaper = worst < 0 || snap.nats < (*snaps)[worst].nats;
      if (b.excess() > excess || (b.excess() == excess && cheaper))
        worst = int(k), excess = b.excess();
    }
  }
  return worst;
}

std::vector<Snap> as_snaps(const StandardChoice& choice, const MeasuredLengths& lengths,
                           const std::vector<LengthHypothesis>& hypotheses) {
  std::vector<Snap> out;
  for (const ChosenStandard& c : choice.lengths) {
    Snap s;
    s.kind = hypotheses[c.length].kind;
    s.strokes = hypotheses[c.length].strokes;
    s.measured = lengths.value[c.length];
    s.sigma = std::hypot(std::sqrt(lengths.covariance(c.length, c.length)),
                         lengths.scale_sigma * s.measured);
    s.standard = c.standard.value;
    s.series = c.standard.series;
    s.nats = c.nats;
    out.push_back(s);
  }
  return out;
}

}  // namespace

Snapped snap_to_standards(const Regularized& regular, const StrokeObservation& seen,
                          double footprint, const SnapScale& scale, StandardSystem system,
                          const RegularizeOptions& options) {
  Snapped out;
  out.sketch = regular.sketch;
  if (regular.sketch.size() == 0 || system == StandardSystem::kNone) return out;
  StandardFit fit(regular, seen, footprint, options);
  out.hypotheses = int(fit.hypotheses().size());
  if (out.hypotheses == 0) return out;
  MeasuredLengths lengths;
  if (!fit.measure(&lengths)) {
    out.why_none = "too many curves to weigh them together";
    return out;
  }
  lengths.value *= scale.per_world;
  lengths.covariance *= scale.per_world * scale.per_world;
  lengths.scale_sigma = scale.sigma_relative;
  const StandardChoice choice = choose_standards(lengths, system, options.price);
  std::vector<Snap> snaps = as_snaps(choice, lengths, fit.hypotheses());
  std::vector<int> which;
  for (const ChosenStandard& c : choice.lengths) which.push_back(c.length);
  while (!snaps.empty()) {
    std::vector<std::pair<int, double>> set;
    for (size_t k = 0; k < snaps.size(); ++k)
      set.push_back({which[k], snaps[k].standard / (scale.per_world * choice.scale)});
    fit.set(set);
    const int worst = unbearable(fit, &snaps);
    if (worst < 0) break;
    snaps.erase(snaps.begin() + worst);
    which.erase(which.begin() + worst);
  }
  if (snaps.empty()) return out;
  out.sketch = fit.sketch();
  out.scale = choice.scale;
  out.scale_sigma = choice.scale_sigma;
  std::stable_sort(snaps.begin(), snaps.end(), [](const Snap& a, const Snap& b) {
    return a.strokes < b.strokes || (a.strokes == b.strokes && a.kind < b.kind);
  });
  out.snaps = snaps;
  return out;
}

}  // namespace sketchsplat
