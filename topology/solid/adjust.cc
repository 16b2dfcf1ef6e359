// SPDX-License-Identifier: MIT
#include "topology/solid/adjust.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A surface as unknowns: origin, axis (any length), radius, slope, minor radius.
using Unknowns = std::array<double, 9>;

Unknowns unknowns_of(const Surface& s) {
  return {s.origin.x(), s.origin.y(), s.origin.z(), s.axis.x(),    s.axis.y(),
          s.axis.z(),   s.radius,     s.slope,      s.minor_radius};
}

void copy_back(const Unknowns& u, Surface* s) {
  s->origin = Vector3d(u[0], u[1], u[2]);
  // A plane's distances do not tell its sides apart, so that a long step may turn its axis about;
  // which side is outside hangs on it.
  const double sign = s->axis.dot(Vector3d(u[3], u[4], u[5])) < 0 ? -1 : 1;
  s->axis = sign * Vector3d(u[3], u[4], u[5]).normalized();
  s->radius = u[6];
  s->slope = sign * u[7];
  s->minor_radius = u[8];
}

// How much more it counts that a curve lies on its surface than that it stays where it is: what is
// measured gives way by about the square of this over one.
constexpr double kHard = 1e4;

// Can a curve of this kind lie on a surface exactly? Cubics follow where round surfaces meet, and
// arcs a hyperbola, as well as they can.
bool fits(const Sketch& sketch, int stroke, const Surface& s) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  if (s.kind == SurfaceKind::kPlane || s.kind == SurfaceKind::kSphere) return true;
  if (kind == StrokeKind::kBezier) return false;
  if (kind != StrokeKind::kArc && kind != StrokeKind::kCircle) return true;
  const CircleParameters c = circle_parameters(sketch, stroke);
  if (c.straight || s.kind == SurfaceKind::kTorus) return true;
  return std::abs(c.normal.dot(s.axis)) > 0.99 &&
         s.axis.cross(c.centre - s.origin).norm() < 0.1 * c.radius;
}

// Distances of places along a curve from a surface.
struct OnSurface {
  StrokeKind kind;
  SurfaceKind surface;
  std::vector<double> t;
  double weight;
  std::vector<int> block;  // of each control point: a loop through one node has that twice

  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const T* u = blocks[0];
    const Vec3<T> origin(u[0], u[1], u[2]), axis = Vec3<T>(u[3], u[4], u[5]).normalized();
    Vec3<T> control[4], position, derivative;
    for (size_t k = 0; k < block.size(); ++k) {
      const T* p = blocks[block[k]];
      control[k] = Vec3<T>(p[0], p[1], p[2]);
    }
    for (size_t i = 0; i < t.size(); ++i) {
      evaluate_curve<T>(kind, control, t[i], &position, &derivative);
      residuals[i] =
          T(weight) * surface_distance<T>(surface, origin, axis, u[6], u[7], u[8], position);
    }
    return true;
  }
};

// A control point of one rim of an extrusion lies over that of the other; ends of axes of ellipses
// (vectors) are the same.
struct Over {
  bool vector;
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const T* u = blocks[0];
    const Vec3<T> axis = Vec3<T>(u[3], u[4], u[5]).normalized();
    const Vec3<T> off(blocks[2][0] - blocks[1][0], blocks[2][1] - blocks[1][1],
                      blocks[2][2] - blocks[1][2]);
    const Vec3<T> across = vector ? off : off.cross(axis);
    for (int i = 0; i < 3; ++i) residuals[i] = T(kHard) * across[i];
    return true;
  }
};

// An unknown stays where it is.
struct Stay {
  std::vector<double> value;
  double weight;
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    for (size_t i = 0; i < value.size(); ++i) residuals[i] = (blocks[0][i] - value[i]) * T(weight);
    return true;
  }
};

// Axes are parallel (three residuals), or square to one another (one).
struct Aligned {
  bool square;
  double weight;
  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const Vec3<T> a = Vec3<T>(blocks[0][3], blocks[0][4], blocks[0][5]).normalized(),
                  b = Vec3<T>(blocks[1][3], blocks[1][4], blocks[1][5]).normalized();
    if (square) {
      residuals[0] = a.dot(b) * T(weight);
      return true;
    }
    const Vec3<T> cross = a.cross(b);
    for (int i = 0; i < 3; ++i) residuals[i] = cross[i] * T(weight);
    return true;
  }
};

std::vector<double*> controls_of(Sketch* sketch, int stroke) {
  const Stroke& s = sketch->strokes[stroke];
  std::vector<double*> out;
  if (!is_closed(s.kind)) out.push_back(sketch->nodes.col(s.begin).data());
  for (int k = 0; k < num_handles(s.kind); ++k)
    out.push_back(sketch->handles.col(s.handle + k).data());
  if (!is_closed(s.kind)) out.push_back(sketch->nodes.col(s.end).data());
  return out;
}

class Adjustment {
 public:
  explicit Adjustment(Solid* solid) : solid_(solid), extent_(largest_extent(solid->edges)) {
    for (const Surface& s : solid->surfaces) unknowns_.push_back(unknowns_of(s));
    for (const SolidFace& face : solid->faces)
      for (const Loop& loop : face.loops)
        for (const LoopStroke& s : loop) bounds_.insert({s.stroke, face.surface});
    exact_.assign(solid->edges.size(), true);
    for (const auto& [stroke, surface] : bounds_)
      exact_[stroke] = exact_[stroke] && fits(solid->edges, stroke, solid->surfaces[surface]);
  }

  void run() {
    for (const auto& [stroke, surface] : bounds_)
      if (!is_extrusion(surface)) tie(stroke, surface);
    for (int i = 0; i < int(solid_->surfaces.size()); ++i)
      if (is_extrusion(i)) tie_rims(i);
    for (Unknowns& u : unknowns_) stay(u.data(), 9, 1e-2);
    for (int i = 0; i < solid_->edges.nodes.cols(); ++i)
      stay(solid_->edges.nodes.col(i).data(), 3, 1);
    for (int i = 0; i < solid_->edges.handles.cols(); ++i)
      stay(solid_->edges.handles.col(i).data(), 3, 1);
    align();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 50;
    options.function_tolerance = 1e-12;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    for (size_t i = 0; i < unknowns_.size(); ++i) copy_back(unknowns_[i], &solid_->surfaces[i]);
    for (int i = 0; i < int(solid_->surfaces.size()); ++i)
      if (is_extrusion(i) && !rims_of(i).empty()) set_profile(rims_of(i)[0], i);
  }

  double gap() const {
    double gap = 0;
    Vector3d p, d;
    for (const auto& [stroke, surface] : bounds_)
      for (int i = 0; i <= 32; i += exact_[stroke] ? 1 : 32) {
        evaluate_stroke(solid_->edges, stroke, i / 32.0, &p, &d);
        gap = std::max(gap, std::abs(surface_distance(solid_->surfaces[surface], p)));
      }
    return gap;
  }

 private:
  bool is_extrusion(int surface) const {
    return solid_->surfaces[surface].kind == SurfaceKind::kExtrusion;
  }

  // Strokes of a profile's kind that bound the faces on an extrusion.
  std::vector<int> rims_of(int surface) const {
    std::vector<int> out;
    for (const auto& [stroke, on] : bounds_)
      if (on == surface &&
          solid_->edges.strokes[stroke].kind == solid_->surfaces[surface].profile_kind)
        out.push_back(stroke);
    return out;
  }

  void tie_rims(int surface) {
    const std::vector<int> rims = rims_of(surface);
    for (size_t i = 1; i < rims.size(); ++i) {
      const bool closed = is_closed(solid_->edges.strokes[rims[0]].kind);
      const std::vector<double*> first = controls_of(&solid_->edges, rims[0]),
                                 other = controls_of(&solid_->edges, rims[i]);
      for (size_t k = 0; k < first.size(); ++k) {
        if (first[k] == other[k]) continue;  // rims that meet
        auto* cost = new ceres::DynamicAutoDiffCostFunction<Over, 9>(new Over{closed && k > 0});
        cost->AddParameterBlock(9);
        cost->AddParameterBlock(3);
        cost->AddParameterBlock(3);
        cost->SetNumResiduals(3);
        problem_.AddResidualBlock(
            cost, nullptr, std::vector<double*>{unknowns_[surface].data(), first[k], other[k]});
      }
    }
  }

  void set_profile(int stroke, int surface) {
    const ControlPoints c = control_points(solid_->edges, stroke);
    solid_->surfaces[surface].profile.assign(c.p.begin(), c.p.begin() + c.count);
  }

  void tie(int stroke, int surface) {
    const StrokeKind kind = solid_->edges.strokes[stroke].kind;
    const int places = kind == StrokeKind::kLine ? 3 : 9;
    std::vector<double> t;
    for (int i = 0; i < places; ++i) t.push_back(i / (places - 1.0));
    if (exact_[stroke]) return tie(stroke, surface, t, kHard);
    tie(stroke, surface, t, 1);
    if (!is_closed(kind)) tie(stroke, surface, {0, 1}, kHard);
  }

  void tie(int stroke, int surface, const std::vector<double>& t, double weight) {
    const StrokeKind kind = solid_->edges.strokes[stroke].kind;
    auto* residual = new OnSurface{kind, solid_->surfaces[surface].kind, t, weight, {}};
    auto* cost = new ceres::DynamicAutoDiffCostFunction<OnSurface, 9>(residual);
    std::vector<double*> blocks = {unknowns_[surface].data()};
    cost->AddParameterBlock(9);
    for (double* control : controls_of(&solid_->edges, stroke)) {
      const auto same = std::find(blocks.begin(), blocks.end(), control);
      residual->block.push_back(int(same - blocks.begin()));
      if (same != blocks.end()) continue;
      blocks.push_back(control);
      cost->AddParameterBlock(3);
    }
    cost->SetNumResiduals(int(t.size()));
    problem_.AddResidualBlock(cost, nullptr, blocks);
  }

  void stay(double* block, int size, double weight) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Stay, 9>(
        new Stay{std::vector<double>(block, block + size), weight});
    cost->AddParameterBlock(size);
    cost->SetNumResiduals(size);
    problem_.AddResidualBlock(cost, nullptr, block);
  }

  void align() {
    const double within = std::sin(0.25 * M_PI / 180);
    for (size_t i = 0; i < unknowns_.size(); ++i)
      for (size_t k = i + 1; k < unknowns_.size(); ++k) {
        const Vector3d &a = solid_->surfaces[i].axis, &b = solid_->surfaces[k].axis;
        const bool parallel = a.cross(b).norm() < within, square = std::abs(a.dot(b)) < within;
        if (!parallel && !square) continue;
        auto* cost = new ceres::DynamicAutoDiffCostFunction<Aligned, 9>(
            new Aligned{square, kHard * extent_});
        cost->AddParameterBlock(9);
        cost->AddParameterBlock(9);
        cost->SetNumResiduals(square ? 1 : 3);
        problem_.AddResidualBlock(cost, nullptr, unknowns_[i].data(), unknowns_[k].data());
      }
  }

  Solid* solid_;
  double extent_;
  std::vector<Unknowns> unknowns_;
  std::set<std::pair<int, int>> bounds_;  // stroke, surface
  std::vector<bool> exact_;               // per stroke: its kind can lie on its surfaces
  ceres::Problem problem_;
};

}  // namespace

void adjust(Solid* solid) {
  Adjustment adjustment(solid);
  adjustment.run();
  solid->gap = adjustment.gap();
}

}  // namespace sketchsplat
