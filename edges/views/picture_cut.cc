// SPDX-License-Identifier: MIT
#include "edges/views/picture_cut.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "edges/image/cut_out.h"
#include "edges/image/mats.h"

namespace sketchsplat {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool ShrunkView::pixel(const Vector3d& point, Vector2d* out, double* depth) const {
  double z;
  const Vector2d ideal = view.project(point, &z);
  if (depth) *depth = z;
  if (!(z > 0) || !view.image_pixel(ideal, out)) return false;
  *out = (*out + Vector2d::Constant(0.5)) / denominator - Vector2d::Constant(0.5);
  return std::abs(out->x()) < 1e5 && std::abs(out->y()) < 1e5;
}

namespace {

// The convex hull of points in a picture; empty if one is not drawn.
cv::Mat1b drawn_hull(const ShrunkView& shrunk, const std::vector<Vector3d>& points) {
  std::vector<cv::Point> pixels, hull;
  for (const Vector3d& p : points) {
    Vector2d q;
    if (!shrunk.pixel(p, &q)) return {};
    pixels.emplace_back(int(std::lround(q.x())), int(std::lround(q.y())));
  }
  cv::Mat1b out = cv::Mat1b::zeros(shrunk.height(), shrunk.width());
  if (pixels.empty()) return out;
  cv::convexHull(pixels, hull);
  cv::fillConvexPoly(out, hull, 1);
  return out;
}

std::vector<Vector3d> corners_of(const Eigen::AlignedBox3d& box) {
  std::vector<Vector3d> out;
  for (int k = 0; k < 8; ++k) out.push_back(box.corner(Eigen::AlignedBox3d::CornerType(k)));
  return out;
}

// The prism of what stands on the table, as high as the box.
std::vector<Vector3d> prism_of(const ObjectRegion& region) {
  std::vector<Vector3d> out;
  double top = 0;
  for (const Vector3d& c : corners_of(region.box))
    top = std::max(top, region.table->signedDistance(c));
  const Vector3d normal = region.table->normal(), on_table = -region.table->offset() * normal;
  for (const Vector2d& corner : region.outline) {
    const Vector3d foot = region.frame.transpose() * corner + on_table;
    out.push_back(foot);
    out.push_back(foot + top * normal);
  }
  return out;
}

// The known edges, and the table below them, which the object hides.
std::vector<Vector3d> known_of(const ObjectRegion& region) {
  std::vector<Vector3d> out = region.edges;
  if (region.table)
    for (const Vector3d& p : region.edges) out.push_back(region.table->projection(p));
  return out;
}

// So that the object's longer side is about so many pixels.
int denominator_of(const View& view, const ObjectRegion& region, double object_px) {
  Eigen::AlignedBox2d box;
  for (const Vector3d& c : corners_of(region.box)) {
    Vector2d q;
    if (!ShrunkView{view, 1}.pixel(c, &q)) return 0;
    box.extend(q);
  }
  return std::max(1, int(std::lround(box.sizes().maxCoeff() / object_px)));
}

}  // namespace

cv::Mat1b may_be(const ShrunkView& shrunk, const ObjectRegion& region) {
  cv::Mat1b inside = drawn_hull(shrunk, corners_of(region.box));
  if (inside.empty()) return inside;
  if (region.table) {
    const cv::Mat1b standing = drawn_hull(shrunk, prism_of(region));
    if (!standing.empty()) inside &= standing;
  }
  const cv::Mat1b likely = drawn_hull(shrunk, known_of(region));
  return likely.empty() ? inside : inside + (inside & likely);
}

PictureCut read_cut(const View& view, const ObjectRegion& region, double object_px,
                    const std::function<Picture(int denominator)>& read) {
  PictureCut cut;
  try {
    cut.denominator = denominator_of(view, region, object_px);
    if (cut.denominator > 0) cut.picture = read(cut.denominator);
  } catch (const InputError&) {
    cut.denominator = 0;  // the detector has said so
  }
  return cut;
}

void cut_again(const std::vector<cv::Mat1b>& maybe, int rounds, std::vector<PictureCut>* cuts) {
  std::vector<const Picture*> pictures;
  std::vector<Image<uint8_t>> where;
  for (size_t v = 0; v < cuts->size(); ++v) {
    pictures.push_back(&(*cuts)[v].picture);
    where.push_back((*cuts)[v].denominator == 0 ? Image<uint8_t>() : image_of(maybe[v]));
  }
  const std::vector<Image<uint8_t>> found = cut_out(pictures, where, rounds);
  parallel_for(int(cuts->size()), 1, [&](int v) {
    PictureCut& cut = (*cuts)[v];
    const Image<uint8_t>& mask = found[size_t(v)];
    cut.mask.release(), cut.distance.release();
    if (mask.empty()) return;
    cut.mask = mat_of(mask).clone();
    cut.distance = distance_to_zero(cut.mask == 0);
  });
}

double PictureCut::distance_px(const View& view, const Vector3d& point, double* depth) const {
  Vector2d q;
  if (!ShrunkView{view, denominator}.pixel(point, &q, depth)) return NAN;
  const int x = int(std::lround(q.x())), y = int(std::lround(q.y()));
  const bool shown = x >= 0 && y >= 0 && x < mask.cols && y < mask.rows;
  return shown ? distance(y, x) : NAN;
}

double PictureCut::share(const View& view, const std::vector<Vector3d>& points) const {
  if (mask.empty()) return 0;
  int shown = 0, held = 0;
  for (const Vector3d& p : points) {
    double depth;
    const double far = distance_px(view, p, &depth);
    shown += !std::isnan(far);
    held += far <= kEndPx + 1;
  }
  return shown == 0 ? 1 : double(held) / shown;
}

}  // namespace sketchsplat
