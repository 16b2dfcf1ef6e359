// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A place on a true edge, and what a view makes of it.
struct Spot {
  Vector3d point, outward;
  Vector2d pixel = Vector2d::Zero();
  bool seen = false;
};

class EdgeTracer {
 public:
  EdgeTracer(const View& view, const Tracer& tracer, double lift)
      : view_(view), tracer_(tracer), lift_(lift) {}

  void add(const TruthCurve& curve, int index) {
    index_ = index;
    Spot before = spot(curve.points.col(0), curve.outward.col(0));
    append(before);
    for (int i = 1; i < curve.points.cols(); ++i) {
      const Spot end = spot(curve.points.col(i), curve.outward.col(i));
      const Spot begin = before;
      const int pieces =
          std::clamp(int(std::ceil((end.pixel - begin.pixel).norm())), 1, kMostPieces);
      for (int k = 1; k <= pieces; ++k) {
        const Spot next = k == pieces ? end : between(begin, end, double(k) / pieces);
        if (before.seen != next.seen) append(border(before, next));
        append(next);
        before = next;
      }
    }
    finish();
  }

  VisibleEdges take() { return std::move(edges_); }

 private:
  static constexpr double kShortest = 0.25;  // [px]
  static constexpr int kMostPieces = 20000;  // an edge may pass beside the camera

  Spot spot(const Vector3d& point, const Vector3d& outward) const {
    Spot s{point, outward};
    double depth;
    s.pixel = view_.project(point, &depth);
    s.seen = sees(view_, tracer_, point, outward, lift_);
    return s;
  }

  Spot between(const Spot& a, const Spot& b, double t) const {
    const Vector3d outward = (1 - t) * a.outward + t * b.outward;
    return spot((1 - t) * a.point + t * b.point,
                outward.norm() > 1e-6 ? Vector3d(outward.normalized()) : Vector3d::Zero());
  }

  // The last spot that is seen between one that is and one that is not.
  Spot border(Spot a, Spot b) const {
    for (int i = 0; i < 5; ++i) {
      const Spot middle = between(a, b, 0.5);
      (middle.seen == a.seen ? a : b) = middle;
    }
    return a.seen ? a : b;
  }

  void append(const Spot& s) {
    if (s.seen) {
      if (is_needless_before(s.pixel)) run_.pop_back();
      if (run_.empty() || run_.back() != s.pixel) run_.push_back(s.pixel);
    } else {
      finish();
    }
  }

  // The last point lies between the one before it and the next, which are near.
  bool is_needless_before(const Vector2d& next) const {
    if (run_.size() < 2) return false;
    const Vector2d a = run_[run_.size() - 2], b = run_.back(), chord = next - a, to = b - a;
    if (!(chord.norm() > 0) || chord.norm() > 0.9) return false;
    return std::abs(chord.x() * to.y() - chord.y() * to.x()) < 0.01 * chord.norm();
  }

  double length() const {
    double sum = 0;
    for (size_t i = 1; i < run_.size(); ++i) sum += (run_[i] - run_[i - 1]).norm();
    return sum;
  }

  // Rays that start above a corner see a little of the edges behind it: no piece of its own.
  void finish() {
    if (length() > kShortest) {
      Eigen::Matrix2Xd polyline(2, run_.size());
      for (size_t i = 0; i < run_.size(); ++i) polyline.col(i) = run_[i];
      edges_.polylines.push_back(std::move(polyline));
      edges_.curve.push_back(index_);
    }
    run_.clear();
  }

  const View& view_;
  const Tracer& tracer_;
  double lift_;
  int index_ = 0;
  std::vector<Vector2d> run_;
  VisibleEdges edges_;
};

void draw_segment(const Vector2d& a, const Vector2d& b, Image<float>* image) {
  const Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b), along = b - a;
  const double length2 = along.squaredNorm();
  for (int y = std::max(0, int(std::ceil(low.y() - 1)));
       y <= std::min(image->height - 1, int(std::floor(high.y() + 1))); ++y)
    for (int x = std::max(0, int(std::ceil(low.x() - 1)));
         x <= std::min(image->width - 1, int(std::floor(high.x() + 1))); ++x) {
      const Vector2d p(x, y);
      const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
      const float covered = float(1 - (p - a - t * along).norm());
      image->at(x, y) = std::max(image->at(x, y), covered);
    }
}

}  // namespace

bool sees(const View& view, const Tracer& tracer, const Vector3d& point, const Vector3d& outward,
          double lift) {
  double depth;
  Vector2d pixel;
  if (!view.image_pixel(view.project(point, &depth), &pixel) || !(depth > 0) ||
      !view.camera.contains(pixel))
    return false;
  const Vector3d eye = view.center_in_world();
  const Vector3d way = outward.isZero() ? Vector3d((eye - point).normalized()) : outward;
  const Vector3d start = point + lift * way;
  return !tracer.blocked(start.cast<float>(), eye.cast<float>());
}

void count_views(const Tracer& tracer, const std::vector<View>& views, double lift,
                 TruthCurve* curve) {
  curve->visible_views.assign(curve->points.cols(), 0);
  for (int i = 0; i < curve->points.cols(); ++i)
    for (const View& view : views)
      curve->visible_views[i] +=
          sees(view, tracer, curve->points.col(i), curve->outward.col(i), lift);
}

VisibleEdges visible_edges(const View& view, const Tracer& tracer,
                           const std::vector<TruthCurve>& curves, double lift) {
  EdgeTracer edges(view, tracer, lift);
  for (size_t i = 0; i < curves.size(); ++i) edges.add(curves[i], int(i));
  return edges.take();
}

Image<float> draw(const VisibleEdges& edges, int width, int height) {
  Image<float> image(width, height, 0.0f);
  for (const Eigen::Matrix2Xd& polyline : edges.polylines)
    for (int i = 1; i < polyline.cols(); ++i)
      draw_segment(polyline.col(i - 1), polyline.col(i), &image);
  return image;
}

std::string to_json(const VisibleEdges& edges) {
  // By hand: a thousand views hold millions of numbers.
  std::string out = "{\"polylines\": [";
  char text[64];
  for (size_t k = 0; k < edges.polylines.size(); ++k) {
    const Eigen::Matrix2Xd& polyline = edges.polylines[k];
    out += k > 0 ? ", [" : "[";
    for (int i = 0; i < polyline.cols(); ++i) {
      std::snprintf(text, sizeof text, "%s[%.3f, %.3f]", i > 0 ? ", " : "", polyline(0, i),
                    polyline(1, i));
      out += text;
    }
    out += "]";
  }
  out += "], \"curve\": [";
  for (size_t k = 0; k < edges.curve.size(); ++k)
    out += (k > 0 ? ", " : "") + std::to_string(edges.curve[k]);
  return out + "]}\n";
}

}  // namespace sketchsplat
