// SPDX-License-Identifier: MIT
#include "topology/brep/overlap.h"

#include <BRepAlgoAPI_Common.hxx>
#include <algorithm>
#include <array>
#include <cmath>

#include "topology/brep/check.h"
#include "topology/brep/geometry.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSide = 160;  // lines along an axis: the square of it, one in each cell of a grid

// Where a mesh is entered and left along every line.
using Crossings = std::vector<std::vector<double>>;

class Lines {
 public:
  Lines(int axis, const Eigen::AlignedBox3d& box)
      : axis_(axis), low_(across(box.min())), cell_((across(box.max()) - low_) / kSide) {}

  Crossings cross(const std::vector<MeshedFace>& faces) const {
    Crossings out(size_t(kSide) * kSide);
    for (const MeshedFace& face : faces)
      for (const auto& [a, b, c] : face.triangles())
        add(face.points()[size_t(a)], face.points()[size_t(b)], face.points()[size_t(c)], &out);
    for (std::vector<double>& line : out) std::sort(line.begin(), line.end());
    return out;
  }
  double cell_area() const { return cell_.x() * cell_.y(); }

 private:
  Vector2d across(const Vector3d& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }

  // Scattered in its cell, so that no line runs along a face and sides of boxes are met evenly.
  Vector2d line(int i, int j) const {
    const double n = 1 + i * kSide + j;
    const Vector2d inside(std::fmod(0.7548776662466927 * n, 1.0),
                          std::fmod(0.5698402909980532 * n, 1.0));
    return low_ + cell_.cwiseProduct(Vector2d(i, j) + inside);
  }

  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c, Crossings* out) const {
    const Vector2d p = across(a), q = across(b), r = across(c);
    const Vector2d low = (p.cwiseMin(q).cwiseMin(r) - low_).cwiseQuotient(cell_);
    const Vector2d high = (p.cwiseMax(q).cwiseMax(r) - low_).cwiseQuotient(cell_);
    const auto cross = [](const Vector2d& x, const Vector2d& y) {
      return x.x() * y.y() - x.y() * y.x();
    };
    const double area = cross(q - p, r - p);
    if (area == 0) return;
    for (int i = std::max(0, int(low.x())); i <= std::min(kSide - 1, int(high.x())); ++i)
      for (int j = std::max(0, int(low.y())); j <= std::min(kSide - 1, int(high.y())); ++j) {
        const Vector2d x = line(i, j);
        const double v = cross(x - p, r - p) / area, w = cross(q - p, x - p) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        (*out)[size_t(i) * kSide + size_t(j)].push_back((1 - v - w) * a[axis_] + v * b[axis_] +
                                                        w * c[axis_]);
      }
  }

  int axis_;
  Vector2d low_, cell_;
};

double inside_length(const std::vector<double>& line) {
  double sum = 0;
  for (size_t i = 0; i + 1 < line.size(); i += 2) sum += line[i + 1] - line[i];
  return sum;
}

double common_length(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i + 1 < a.size(); i += 2)
    for (size_t j = 0; j + 1 < b.size(); j += 2)
      sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
  return sum;
}

}  // namespace

double overlap_by_lines(const std::vector<MeshedFace>& a, const std::vector<MeshedFace>& b) {
  Eigen::AlignedBox3d box;
  for (const auto* faces : {&a, &b})
    for (const MeshedFace& face : *faces) box.extend(face.box());
  if (box.isEmpty() || !(box.volume() > 0)) return 0;
  double both = 0, either = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Lines lines(axis, box);
    const Crossings in_a = lines.cross(a), in_b = lines.cross(b);
    for (size_t i = 0; i < in_a.size(); ++i) {
      if (in_a[i].size() % 2 != 0 || in_b[i].size() % 2 != 0) continue;  // along an edge
      const double common = common_length(in_a[i], in_b[i]);
      both += common * lines.cell_area();
      either += (inside_length(in_a[i]) + inside_length(in_b[i]) - common) * lines.cell_area();
    }
  }
  return either > 0 ? both / either : 0;
}

double overlap_by_boolean(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  try {
    return with_refusals([&] {
      BRepAlgoAPI_Common common(a, b);
      if (!common.IsDone() || common.HasErrors()) return -1.0;
      const double both = volume_of(common.Shape());
      const double either = volume_of(a) + volume_of(b) - both;
      return either > 0 ? both / either : -1;
    });
  } catch (const Refused&) {
    return -1;
  }
}

}  // namespace sketchsplat::brep
