// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/surfels/model/surfel_smooth.h"
#include "edges/surfels/model/surfel_target.h"

namespace sketchsplat {
namespace {

constexpr double kMaxLogit = 4.4;  // beyond it alpha would be clamped and get no gradient
constexpr double kFirstLogit = 3.0;
constexpr double kScale = 0.6;  // standard deviation of the first surfels, in their spacing
constexpr double kMinAlpha = 0.05;
constexpr int kNeighbours = 8;
constexpr double kSmoothDeg = 20;     // turn between neighbours that is an edge
constexpr double kMergeCosine = 0.9;  // of what two surfels do, from which on they are one
constexpr int kHalvings = 1;          // of the pictures' sides at the start
// [px] See SurfelOptions; a wider one swells outlines, so that faces sink.
constexpr double kLowpassPx = 0.35;

// Adam (Kingma and Ba, 2015) with a rate per row.
struct Adam {
  Eigen::MatrixXd m, v;
  int steps = 0;

  void step(const Eigen::MatrixXd& gradient, const Eigen::VectorXd& rate, Eigen::MatrixXd* values) {
    if (m.size() == 0) m = v = Eigen::MatrixXd::Zero(gradient.rows(), gradient.cols());
    ++steps;
    m = 0.9 * m + 0.1 * gradient;
    v = 0.99 * v + 0.01 * gradient.cwiseAbs2();
    const double cm = 1 - std::pow(0.9, steps), cv = 1 - std::pow(0.99, steps);
    values->array() -=
        ((m.array() / cm) / ((v.array() / cv).sqrt() + 1e-12)).colwise() * rate.array();
  }
};

struct BatchSum {
  double loss = 0;
  SurfelGradient gradient;
};

// Do normals and light explain the greys of the surfels (1) or is it print (0)? Then what is dark
// would be taken for what is turned away.
double evenness(const SurfelCloud& cloud, const Eigen::VectorXd& grey, const Illumination& light) {
  constexpr double kPrint = 0.02;  // departure from the mean grey that halves the say of normals
  const Eigen::Matrix3Xd shades = shade(cloud, Eigen::Matrix3Xd::Ones(3, cloud.size()), light);
  std::vector<double> off(grey.size());
  for (int i = 0; i < grey.size(); ++i) off[i] = std::abs(grey[i] - shades(0, i));
  const double part = median(std::move(off)) / std::max(1e-6, grey.mean());
  return 1 / (1 + std::pow(part / kPrint, 4));
}

// Of the whole cloud, where only some of it was drawn.
SurfelInfluence spread_influence(SurfelInfluence part, const std::vector<int>& indices, int n) {
  std::vector<int> first(n + 1, 0);
  for (size_t k = 0; k < indices.size(); ++k)
    first[indices[k] + 1] = part.first[k + 1] - part.first[k];
  for (int i = 0; i < n; ++i) first[i + 1] += first[i];
  part.first = std::move(first);
  return part;
}

class Trainer {
 public:
  Trainer(const std::vector<TrainingView>& views, const Eigen::AlignedBox3d& bounds,
          const SurfelFieldOptions& options, const SureEdges& sure,
          const std::function<void()>& step)
      : views_(views), bounds_(bounds), options_(options), sure_(sure), on_step_(step) {}

  SurfelField run() {
    field_.drawing.kernel = options_.kernel;
    seed();
    if (field_.surfels.size() == 0) return field_;
    const int total = std::max(1, options_.renderings / options_.batch);
    const double share[3] = {0.3, 0.35, 0.35};
    const int side = field_.side_px = enough_side();
    for (int level = 0; level < 3; ++level) {
      // The same smallest footprint in space at all levels: a wider one would bulge over the
      // outline, and surfaces sink to make up for it.
      const int halvings = std::max(0, kHalvings - level);
      field_.drawing.lowpass_px = kLowpassPx * side / options_.side_px / (1 << halvings);
      targets_ = make_targets(views_, std::max(16, side >> halvings), bounds_.center());
      if (level == 0) color_from_views();
      move_to_planes();
      run_level(std::max(1, int(share[level] * total)), total, level);
    }
    field_.drawing.lowpass_px = kLowpassPx;
    lay_on_shapes();
    return field_;
  }

 private:
  // [px] longer side at which the object has no more pixels than surfels need.
  int enough_side() const {
    double pixels = 0;
    for (const TrainingView& v : views_) {
      const double scale = double(options_.side_px) / std::max(v.alpha.width, v.alpha.height);
      const double sum = std::accumulate(v.alpha.data.begin(), v.alpha.data.end(), 0.0);
      pixels += std::min(1.0, scale * scale) * sum / views_.size();
    }
    if (pixels <= options_.pixels) return options_.side_px;
    return std::max(1, int(options_.side_px * std::sqrt(options_.pixels / pixels)));
  }

  void seed() {
    const SurfaceSamples samples =
        photo_hull_surface(views_, bounds_, options_.surfels, options_.hull, sure_);
    const int n = int(samples.position.cols());
    field_.spacing = samples.spacing;
    field_.first_count = n;
    field_.planes = samples.planes, field_.emptied = samples.emptied;
    Eigen::MatrixXd& values = field_.surfels.values;
    values = Eigen::MatrixXd::Zero(SurfelSet::kRows, n);
    for (int i = 0; i < n; ++i) {
      values.col(i).segment<3>(SurfelSet::kCenter) = samples.position.col(i);
      values.col(i).segment<4>(SurfelSet::kRotation) = rotation_to(samples.normal.col(i));
    }
    values.middleRows<2>(SurfelSet::kLogScale).setConstant(std::log(kScale * samples.spacing));
    values.row(SurfelSet::kOpacity).setConstant(kFirstLogit);
    values.bottomRows<3>().setConstant(1);
  }

  // Greys that the views show where the first surfels are, and the light that makes them.
  void color_from_views() {
    const int n = field_.surfels.size();
    const SurfelCloud cloud = field_.surfels.cloud(Eigen::Matrix3Xd::Zero(3, n));
    std::vector<Eigen::Matrix4Xd> sums(targets_.size());
    parallel_for(int(targets_.size()), 1, [&](int v) {
      SurfelRenderer renderer(field_.drawing);
      const SurfelTarget& t = targets_[v];
      std::vector<int> facing;
      renderer.forward(facing_surfels(cloud, t.view.view, &facing), t.view.view, t.mask);
      const SurfelInfluence influence = renderer.influence();
      sums[v] = Eigen::Matrix4Xd::Zero(4, n);
      for (size_t f = 0; f < facing.size(); ++f)
        for (int k = influence.first[f]; k < influence.first[f + 1]; ++k) {
          const int i = facing[f];
          const double w = influence.weight[k];
          const int p = influence.pixel[k];
          for (int c = 0; c < 3; ++c) sums[v](c, i) += w * t.view.color[c].data[p];
          sums[v](3, i) += w * t.view.alpha.data[p];
        }
    });
    Eigen::Matrix4Xd sum = Eigen::Matrix4Xd::Zero(4, n);
    for (const Eigen::Matrix4Xd& s : sums) sum += s;
    const Eigen::VectorXd weight = sum.row(3);
    Eigen::Matrix3Xd color(3, n);
    for (int i = 0; i < n; ++i)
      color.col(i) = weight[i] > 1e-9 ? Eigen::Vector3d(sum.col(i).head<3>() / weight[i])
                                      : Eigen::Vector3d::Constant(0.5);
    Eigen::Vector3d mean = (color * weight) / std::max(1e-9, weight.sum());
    const double level = std::max(1e-3, mean.mean());
    common_ = (mean / level).cwiseMax(0.05);
    const Eigen::VectorXd grey = color.colwise().mean();
    const Illumination light = fit_illumination(cloud, grey, weight, bounds_);
    field_.evenness = evenness(cloud, grey, light);
    if (options_.shading) {
      field_.illumination = light;
      field_.surfels.values.bottomRows<3>() = common_.replicate(1, n);
    } else {
      field_.surfels.values.bottomRows<3>() = color;
    }
  }
  // Correlation works on print; without it, shading and outlines are all that it can compare.
  void move_to_planes() {
    if (options_.moves.rounds == 0 || field_.evenness > kEven) return;
    const std::vector<int> moved =
        move_surfels(targets_, field_.drawing, field_.spacing, options_.moves, &field_.surfels);
    field_.moved += int(moved.size());
    if (adam_.m.size() == 0) return;
    for (const int i : moved) adam_.m.col(i).setZero(), adam_.v.col(i).setZero();
  }

  void lay_on_shapes() {
    const std::vector<char> flat =
        flatten_surfels(field_.spacing, options_.planes, &field_.surfels);
    field_.flat = int(std::count(flat.begin(), flat.end(), 1));
    field_.round = round_surfels(field_.spacing, options_.cylinders, flat, &field_.surfels);
  }

  Eigen::VectorXd rates(double progress) const {
    const double fade = std::pow(0.1, progress);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(SurfelSet::kRows);
    r.segment<3>(SurfelSet::kCenter).setConstant(0.03 * field_.spacing * fade);
    r.segment<4>(SurfelSet::kRotation).setConstant(0.015 * fade);
    r.segment<2>(SurfelSet::kLogScale).setConstant(0.015 * fade);
    r[SurfelSet::kOpacity] = 0.05 * fade;
    r.segment<2>(SurfelSet::kSkew)
        .setConstant(options_.kernel == SurfelKernel::kSkewNormal ? 0.02 * fade : 0);
    r.segment<3>(SurfelSet::kAlbedo).setConstant(0.01 * fade);
    // Skewed kernels: everything together at first; then what the kernel is, and where, by turns.
    if (options_.kernel == SurfelKernel::kSkewNormal && progress > 0.4) {
      if (step_ / 10 % 2)
        r.segment<2>(SurfelSet::kSkew).setZero();
      else
        r.segment<9>(SurfelSet::kCenter).setZero();
    }
    return r;
  }

  // The views of a step, spread over all directions; each comes once before any comes twice.
  int view_of(int k) const {
    const int n = int(targets_.size());
    int stride = std::max(1, int(std::lround(0.618 * n)));
    const auto shares_factor = [n](int a) {
      int b = n;
      while (b) std::swap(a %= b, b);
      return a != 1;
    };
    while (shares_factor(stride)) ++stride;
    return int((long(k % n) * stride) % n);
  }

  BatchSum render_batch(const SurfelCloud& cloud) {
    const int batch = std::min<int>(options_.batch, targets_.size());
    std::vector<BatchSum> each(batch);
    parallel_for(batch, 1, [&](int b) {
      SurfelRenderer renderer(field_.drawing);
      const SurfelTarget& t = targets_[view_of(rendered_ + b)];
      std::vector<int> facing;
      const SurfelCloud seen = facing_surfels(cloud, t.view.view, &facing);
      const SurfelImages& images = renderer.forward(seen, t.view.view, t.mask);
      SurfelImages by_images;
      SurfelGradient gradient;
      each[b].loss = surfel_loss(images, t.view, t.mask, loss_, &by_images);
      renderer.backward(seen, t.view.view, by_images, &gradient);
      each[b].gradient = spread_gradient(gradient, facing, cloud.size());
    });
    rendered_ += batch;
    for (int b = 1; b < batch; ++b) {  // in the order of the views, whoever drew them
      SurfelGradient &to = each[0].gradient, &from = each[b].gradient;
      each[0].loss += each[b].loss;
      to.center += from.center, to.rotation += from.rotation, to.log_scale += from.log_scale;
      to.opacity += from.opacity, to.color += from.color, to.skew += from.skew;
      to.in_image_abs += from.in_image_abs, to.splitting += from.splitting;
      to.weight += from.weight;
    }
    for (int b = 0; on_step_ && b < batch; ++b) on_step_();
    return std::move(each[0]);
  }

  // Of the surfels' albedo from the common one; softly, that prints may differ.
  void pull_albedo(double batch, Eigen::Matrix3Xd* by_albedo) const {
    const int n = field_.surfels.size();
    const double w = batch * field_.evenness * options_.common_albedo / (3.0 * n);
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) {
        const double d = field_.surfels.values(SurfelSet::kAlbedo + c, i) - common_[c];
        (*by_albedo)(c, i) += w * d / std::hypot(d, 0.02);
      }
  }

  double train_step(double progress) {
    SurfelSet& set = field_.surfels;
    const int batch = std::min<int>(options_.batch, targets_.size());
    const SurfelCloud cloud = field_.cloud();
    BatchSum sum = render_batch(cloud);
    splitting_ += sum.gradient.splitting;
    pull_ += sum.gradient.in_image_abs;
    weight_ += sum.gradient.weight;
    Eigen::Matrix3Xd by_albedo = sum.gradient.color;
    Eigen::Matrix<double, kShadingTerms, 4> by_light;
    if (options_.shading) {
      const Eigen::Matrix4Xd rotation = sum.gradient.rotation;
      const Eigen::Matrix3Xd center = sum.gradient.center;
      shade_backward(cloud, set.albedo(), field_.illumination, &sum.gradient, &by_albedo,
                     &by_light);
      const double share = field_.evenness;
      sum.gradient.rotation = rotation + share * (sum.gradient.rotation - rotation);
      sum.gradient.center = center + share * (sum.gradient.center - center);
      pull_albedo(batch, &by_albedo);
    }
    if (options_.smoothness > 0)
      smooth_gradient(cloud, pairs_, field_.spacing, kSmoothDeg, batch * options_.smoothness,
                      &sum.gradient);
    adam_.step(SurfelSet::gradient(sum.gradient, by_albedo), rates(progress), &set.values);
    set.values.row(SurfelSet::kOpacity) = set.values.row(SurfelSet::kOpacity).cwiseMin(kMaxLogit);
    if (options_.shading) {
      Eigen::MatrixXd light = field_.illumination.light;
      light_adam_.step(by_light,
                       Eigen::VectorXd::Constant(kShadingTerms, 0.002 * std::pow(0.1, progress)),
                       &light);
      field_.illumination.light = light;
    }
    return sum.loss / batch;
  }

  void run_level(int steps, int total, int level) {
    const int window = std::max<int>(10, 2 * targets_.size() / options_.batch);
    const int rest = std::max(10, total / 10);
    double before = 1e300, sum = 0;
    int count = 0;
    renew();
    loss_ = options_.loss;
    // Depths mean little before the surfels have found their places.
    if (level == 0) loss_.consistency = 0.2 * options_.loss.consistency;
    for (int k = 0; k < steps; ++k, ++step_) {
      const double progress = std::min(1.0, double(step_) / total);
      const double loss = train_step(progress);
      sum += loss, ++count;
      if (step_ % 20 == 19) find_pairs();
      if (step_ % rest == rest - 1 && progress > 0.15 && progress < 0.8) control_density();
      if (count == window) {
        field_.losses.push_back(sum / count);
        const bool still = field_.losses.back() > 0.998 * before;
        before = field_.losses.back(), sum = 0, count = 0;
        if (still) break;
      }
    }
    if (count) field_.losses.push_back(sum / count);
    field_.renderings = rendered_;
    step_ = std::max(step_, int(std::lround(total * (level == 0 ? 0.3 : 0.65))));
  }

  void renew() {
    const int n = field_.surfels.size();
    splitting_ = Eigen::Matrix3Xd::Zero(3, n);
    pull_ = Eigen::Matrix2Xd::Zero(2, n);
    weight_ = Eigen::VectorXd::Zero(n);
    find_pairs();
  }

  void find_pairs() {
    pairs_ = neighbour_pairs(field_.surfels, kNeighbours, 2.5 * field_.spacing, 1.5 * kSmoothDeg);
  }

  void apply(const DensityChange& change) {
    field_.split += change.split, field_.merged += change.merged, field_.pruned += change.pruned;
    field_.surfels.values = apply_change(field_.surfels.values, change, change.added);
    adam_.m = apply_change(adam_.m, change);
    adam_.v = apply_change(adam_.v, change);
  }

  void control_density() {
    if (options_.density != SurfelDensity::kFixed) {
      const int room = std::max(0, options_.most_surfels - field_.surfels.size());
      const int most = std::min(room, field_.surfels.size() / 10);
      const bool steep = options_.density == SurfelDensity::kSteep;
      apply(steep ? steep_split(field_.surfels, splitting_, weight_, kMinAlpha, 1e-3, most)
                  : clone_split(field_.surfels, pull_, weight_, kMinAlpha, 1e-3, most));
    }
    if (options_.merge) merge();
    renew();
  }

  void merge() {
    const std::vector<std::pair<int, int>> pairs =
        neighbour_pairs(field_.surfels, 2, 0.7 * field_.spacing, 15);
    if (pairs.empty()) return;
    const SurfelCloud cloud = field_.cloud();
    std::vector<SurfelInfluence> influences(std::min<size_t>(12, targets_.size()));
    parallel_for(int(influences.size()), 1, [&](int k) {
      SurfelRenderer renderer(field_.drawing);
      const SurfelTarget& t = targets_[view_of(k)];
      std::vector<int> facing;
      renderer.forward(facing_surfels(cloud, t.view.view, &facing), t.view.view, t.mask);
      influences[k] = spread_influence(renderer.influence(), facing, cloud.size());
    });
    apply(merge_pairs(field_.surfels, pairs, influence_cosines(influences, pairs), kMergeCosine));
  }

  const std::vector<TrainingView>& views_;
  const Eigen::AlignedBox3d bounds_;
  const SurfelFieldOptions options_;
  const SureEdges& sure_;
  const std::function<void()> on_step_;
  SurfelField field_;
  SurfelLossOptions loss_;
  std::vector<SurfelTarget> targets_;
  Eigen::Vector3d common_ = Eigen::Vector3d::Ones();
  Adam adam_, light_adam_;
  Eigen::Matrix3Xd splitting_;
  Eigen::Matrix2Xd pull_;
  Eigen::VectorXd weight_;
  std::vector<std::pair<int, int>> pairs_;
  int step_ = 0, rendered_ = 0;
};

}  // namespace

SurfelCloud SurfelField::cloud() const {
  SurfelCloud c = surfels.cloud(surfels.albedo());
  if (!illumination.light.isZero(0)) c.color = shade(c, surfels.albedo(), illumination);
  return c;
}

SurfelField train_surfels(const std::vector<TrainingView>& views, const Eigen::AlignedBox3d& bounds,
                          const SurfelFieldOptions& options, const SureEdges& sure,
                          const std::function<void()>& step) {
  return Trainer(views, bounds, options, sure, step).run();
}

}  // namespace sketchsplat
