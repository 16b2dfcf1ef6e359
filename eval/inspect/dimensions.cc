// SPDX-License-Identifier: MIT
#include "eval/inspect/dimensions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "datasets/types/parallel.h"
#include "eval/inspect/neighbours.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kSame = 1e-4;  // [extents] offsets and radii that are one
constexpr double kLeastArc = 30 * kDegree, kRoundArc = 180 * kDegree;
constexpr double kConcyclic = 1e-3;  // [extents]

class Finder {
 public:
  Finder(const Nominal& nominal, const Association& association)
      : nominal_(nominal), association_(association) {}

  std::vector<Dimension> find() {
    find_radii();
    find_plane_distances();
    for (size_t p = 0; p < nominal_.planes.size(); ++p) find_in_plane(nominal_.planes[p]);
    find_centres();
    find_plane_angles();
    return std::move(list_);
  }

 private:
  Feature feature(FeatureKind kind, int index) const {
    return nominal_feature(nominal_, association_, {kind, index});
  }

  const std::string& name_of(const FeatureRef& ref) const {
    return ref.kind == FeatureKind::kPlane ? nominal_.planes[ref.index].name
                                           : nominal_.edges[ref.index].name;
  }

  void add(DimensionKind kind, const std::vector<FeatureRef>& features, double leg = 0,
           bool supplement = false) {
    Dimension d;
    d.kind = kind;
    d.features = features;
    d.leg = leg;
    d.supplement = supplement;
    d.name = dimension_name(kind);
    std::vector<Feature> values;
    for (const FeatureRef& ref : features) {
      d.name += " " + name_of(ref);
      values.push_back(feature(ref.kind, ref.index));
      if (!values.back().ok) return;
    }
    d.nominal = dimension_value(d, values);
    if (std::isfinite(d.nominal)) list_.push_back(d);
  }

  void find_radii() {
    for (size_t e = 0; e < nominal_.edges.size(); ++e) {
      NominalCircle c;
      if (!circle_of(nominal_, int(e), &c) || c.angle < kLeastArc) continue;
      const bool whole = nominal_.edges[e].kind == StrokeKind::kCircle;
      add(whole ? DimensionKind::kDiameter : DimensionKind::kRadius,
          {{FeatureKind::kCircle, int(e)}});
    }
  }

  void find_plane_distances() {
    std::vector<int> all;
    for (size_t p = 0; p < nominal_.planes.size(); ++p) all.push_back(int(p));
    const auto direction = [&](int p) { return nominal_.planes[p].normal; };
    const auto offset = [&](int a, int b) {
      return (nominal_.planes[b].point - nominal_.planes[a].point).dot(nominal_.planes[a].normal);
    };
    for (const auto& [a, b] : parallel_neighbours(all, direction, offset, kSame * nominal_.extent))
      add(DimensionKind::kPlaneDistance, {{FeatureKind::kPlane, a}, {FeatureKind::kPlane, b}});
  }

  // Ends of an edge that is a line.
  void ends_of(int edge, Vector3d* a, Vector3d* b) const {
    const auto& places = association_.edges[edge].places;
    *a = places.front().nominal, *b = places.back().nominal;
  }

  void find_in_plane(const NominalPlane& plane) {
    std::vector<int> lines;
    for (const int e : plane.edges)
      if (nominal_.edges[e].kind == StrokeKind::kLine) lines.push_back(e);
    const auto direction = [&](int e) {
      Vector3d a, b;
      ends_of(e, &a, &b);
      return (b - a).normalized();
    };
    const auto offset = [&](int a, int b) {
      Vector3d pa, pb, end;
      ends_of(a, &pa, &end), ends_of(b, &pb, &end);
      return (pb - pa).dot(plane.normal.cross(direction(a)));
    };
    for (const auto& [a, b] :
         parallel_neighbours(lines, direction, offset, kSame * nominal_.extent))
      add(DimensionKind::kEdgeDistance, {{FeatureKind::kLine, a}, {FeatureKind::kLine, b}});
    for (size_t i = 0; i < lines.size(); ++i)
      for (size_t k = i + 1; k < lines.size(); ++k) find_corner(lines[i], lines[k]);
  }

  void find_corner(int a, int b) {
    Vector3d pa[2], pb[2];
    ends_of(a, &pa[0], &pa[1]), ends_of(b, &pb[0], &pb[1]);
    for (const int i : {0, 1})
      for (const int k : {0, 1}) {
        if ((pa[i] - pb[k]).norm() > kSame * nominal_.extent) continue;
        if (parallel((pa[1] - pa[0]).normalized(), (pb[1] - pb[0]).normalized())) return;
        const double leg = std::min(nominal_.edges[a].length, nominal_.edges[b].length);
        add(DimensionKind::kEdgeAngle, {{FeatureKind::kLine, a}, {FeatureKind::kLine, b}}, leg,
            i != k);
        return;
      }
  }

  struct Centre {
    int edge;
    NominalCircle circle;
  };

  void find_centres() {
    std::vector<Centre> circles;
    for (size_t e = 0; e < nominal_.edges.size(); ++e) {
      NominalCircle c;
      if (circle_of(nominal_, int(e), &c) && c.angle >= kRoundArc) circles.push_back({int(e), c});
    }
    std::set<int> done;
    for (const Centre& a : circles) {
      if (done.count(a.edge)) continue;
      std::vector<Centre> in_plane;
      for (const Centre& b : circles) {
        const double aside = (b.circle.centre - a.circle.centre).dot(a.circle.normal);
        if (done.count(b.edge) || !parallel(a.circle.normal, b.circle.normal) ||
            std::abs(aside) > kSame * nominal_.extent)
          continue;
        done.insert(b.edge);
        in_plane.push_back(b);
      }
      add_spanning_tree(in_plane);
      add_pitch_circles(in_plane);
    }
  }

  // Concentric circles have no distance.
  void add_spanning_tree(const std::vector<Centre>& circles) {
    const auto distance = [&](int i, int k) {
      return (circles[i].circle.centre - circles[k].circle.centre).norm();
    };
    for (const auto& [from, to] : spanning_tree(int(circles.size()), distance))
      if (distance(from, to) > kSame * nominal_.extent)
        add(DimensionKind::kCentreDistance,
            {{FeatureKind::kCircle, circles[from].edge}, {FeatureKind::kCircle, circles[to].edge}});
  }

  void add_pitch_circles(const std::vector<Centre>& circles) {
    std::set<int> done;
    for (const Centre& a : circles) {
      if (done.count(a.edge)) continue;
      std::vector<FeatureRef> equal;
      std::vector<Vector3d> centres;
      for (const Centre& b : circles) {
        if (std::abs(a.circle.radius - b.circle.radius) > kSame * nominal_.extent) continue;
        done.insert(b.edge);
        const bool is_new = std::none_of(centres.begin(), centres.end(), [&](const Vector3d& c) {
          return (c - b.circle.centre).norm() < kSame * nominal_.extent;
        });
        if (!is_new) continue;
        equal.push_back({FeatureKind::kCircle, b.edge});
        centres.push_back(b.circle.centre);
      }
      if (centres.size() >= 3 && on_a_circle(centres, a.circle.normal))
        add(DimensionKind::kPitchDiameter, equal);
    }
  }

  bool on_a_circle(const std::vector<Vector3d>& points, const Vector3d& normal) const {
    Eigen::Matrix3Xd all(3, points.size());
    for (size_t i = 0; i < points.size(); ++i) all.col(i) = points[i];
    const Feature f = fit_feature(FeatureKind::kCircle, all,
                                  Eigen::VectorXd::Ones(Eigen::Index(points.size())), normal);
    return f.ok && std::all_of(points.begin(), points.end(), [&](const Vector3d& p) {
             return std::abs((p - f.point).norm() - f.radius) < kConcyclic * nominal_.extent;
           });
  }

  // Width of a plane's points across an edge of it.
  double width_across(int plane, const Vector3d& along) const {
    const Vector3d across = nominal_.planes[plane].normal.cross(along);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int e : nominal_.planes[plane].edges)
      for (const EdgePlace& p : association_.edges[e].places) {
        low = std::min(low, p.nominal.dot(across));
        high = std::max(high, p.nominal.dot(across));
      }
    return high - low;
  }

  void find_plane_angles() {
    for (size_t a = 0; a < nominal_.planes.size(); ++a)
      for (size_t b = a + 1; b < nominal_.planes.size(); ++b) {
        const std::vector<int>&x = nominal_.planes[a].edges, &y = nominal_.planes[b].edges;
        std::vector<int> common;
        std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(common));
        const Vector3d along = nominal_.planes[a].normal.cross(nominal_.planes[b].normal);
        if (common.empty() || along.norm() < std::sin(kDegree)) continue;
        const Vector3d u = along.normalized();
        add(DimensionKind::kPlaneAngle,
            {{FeatureKind::kPlane, int(a)}, {FeatureKind::kPlane, int(b)}},
            std::min(width_across(int(a), u), width_across(int(b), u)));
      }
  }

  const Nominal& nominal_;
  const Association& association_;
  std::vector<Dimension> list_;
};

double pitch_diameter(const std::vector<Feature>& features) {
  Eigen::Matrix3Xd centres(3, features.size());
  for (size_t i = 0; i < features.size(); ++i) centres.col(i) = features[i].point;
  const Feature f =
      fit_feature(FeatureKind::kCircle, centres,
                  Eigen::VectorXd::Ones(Eigen::Index(features.size())), features[0].direction);
  return f.ok ? 2 * f.radius : std::numeric_limits<double>::quiet_NaN();
}

double angle_of(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

}  // namespace

const char* dimension_name(DimensionKind kind) {
  constexpr const char* kNames[] = {"diameter",      "radius",          "plane distance",
                                    "edge distance", "centre distance", "pitch diameter",
                                    "plane angle",   "edge angle"};
  return kNames[int(kind)];
}

double dimension_value(const Dimension& dimension, const std::vector<Feature>& f) {
  const auto mean_direction = [&]() -> Vector3d {
    return f[0].direction + (f[0].direction.dot(f[1].direction) < 0 ? -1 : 1) * f[1].direction;
  };
  switch (dimension.kind) {
    case DimensionKind::kDiameter:
      return 2 * f[0].radius;
    case DimensionKind::kRadius:
      return f[0].radius;
    case DimensionKind::kPlaneDistance:
      return std::abs((f[1].point - f[0].point).dot(mean_direction().normalized()));
    case DimensionKind::kEdgeDistance:
    case DimensionKind::kCentreDistance: {
      const Vector3d u = mean_direction().normalized(), d = f[1].point - f[0].point;
      return (d - u * u.dot(d)).norm();
    }
    case DimensionKind::kPitchDiameter:
      return pitch_diameter(f);
    case DimensionKind::kPlaneAngle:
    case DimensionKind::kEdgeAngle: {
      const double angle = angle_of(f[0].direction, f[1].direction);
      return dimension.supplement ? 180 - angle : angle;
    }
  }
  return 0;
}

std::vector<Dimension> find_dimensions(const Nominal& nominal, const Association& association) {
  return Finder(nominal, association).find();
}

namespace {

DimensionCheck measure(const Dimension& dimension,
                       const std::vector<const MeasuredFeature*>& features,
                       const SigmaModel& sigma) {
  DimensionCheck out;
  out.dimension = dimension;
  std::vector<Feature> values;
  for (const MeasuredFeature* f : features) {
    if (!f->value.ok) return out;
    values.push_back(f->value);
    out.shares = worse_of(out.shares, f->shares);
  }
  out.value = dimension_value(dimension, values);
  out.measured = std::isfinite(out.value);
  std::map<std::pair<int, bool>, double> effects;  // of an error, on all features together
  for (size_t i = 0; i < features.size(); ++i)
    for (const MeasuredFeature::Error& e : features[i]->errors) {
      std::vector<Feature> moved = values;
      moved[i] = e.moved;
      effects[{e.id, e.systematic}] += dimension_value(dimension, moved) - out.value;
    }
  double own = 0, other = 0;
  for (const auto& [error, effect] : effects) (error.second ? other : own) += effect * effect;
  if (!is_angle(dimension.kind))
    out.stated = sigma.options.scale_percent / 100 * std::abs(out.value);
  if (!is_angle(dimension.kind) && sigma.alignment)
    other += std::pow(spread(out.shares) * sigma.alignment->scale_sigma * out.value, 2);
  out.sigma = std::sqrt(own);
  out.systematic = std::hypot(std::sqrt(other), out.stated);
  return out;
}

}  // namespace

std::vector<DimensionCheck> measure_dimensions(const std::vector<Dimension>& dimensions,
                                               const Nominal& nominal,
                                               const Association& association,
                                               const Sketch& measured, const SigmaModel& sigma) {
  using Key = std::pair<FeatureKind, int>;
  std::map<Key, size_t> index;
  std::vector<FeatureRef> refs;
  for (const Dimension& d : dimensions)
    for (const FeatureRef& ref : d.features)
      if (index.emplace(Key{ref.kind, ref.index}, refs.size()).second) refs.push_back(ref);
  std::vector<MeasuredFeature> features(refs.size());
  const int n = int(refs.size());
  parallel_for(n, 1, [&](int i) {
    features[i] = measured_feature(nominal, association, measured, sigma, refs[i]);
  });
  std::vector<DimensionCheck> out;
  for (const Dimension& d : dimensions) {
    std::vector<const MeasuredFeature*> used;
    for (const FeatureRef& ref : d.features)
      used.push_back(&features[index[{ref.kind, ref.index}]]);
    out.push_back(measure(d, used, sigma));
  }
  return out;
}

}  // namespace sketchsplat
