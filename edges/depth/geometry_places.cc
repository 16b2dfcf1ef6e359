// SPDX-License-Identifier: MIT
#include "edges/depth/geometry_places.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/image/gradient.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Values beyond the object: those of its nearest pixel.
void extend(const cv::Mat1b& valid, const std::vector<cv::Mat1f*>& values) {
  cv::Mat1f distance;
  cv::Mat1i label;
  cv::distanceTransform(valid == 0, distance, label, cv::DIST_L2, 5, cv::DIST_LABEL_PIXEL);
  double most = 0;
  cv::minMaxLoc(label, nullptr, &most);
  std::vector<cv::Point> nearest(size_t(most) + 1);
  for (int y = 0; y < valid.rows; ++y)
    for (int x = 0; x < valid.cols; ++x)
      if (valid(y, x)) nearest[label(y, x)] = {x, y};
  for (cv::Mat1f* value : values)
    for (int y = 0; y < valid.rows; ++y)
      for (int x = 0; x < valid.cols; ++x)
        if (!valid(y, x)) (*value)(y, x) = (*value)(nearest[label(y, x)]);
}

bool holds_object(const GeometryMaps& m, size_t i) {
  const float x = m.normal[0].data[i], y = m.normal[1].data[i], z = m.normal[2].data[i];
  const float length = x * x + y * y + z * z;
  return m.alpha.data[i] >= 0.5f && std::isfinite(m.depth.data[i]) && m.depth.data[i] > 0 &&
         std::isfinite(length) && length > 0.01f;
}

// Maximum along the direction of the quadratic through the 3 x 3 log magnitudes.
bool localise(const Slopes& s, const cv::Mat1f& log, int x, int y, Place* place) {
  const float *a = log[y - 1] + x, *b = log[y] + x, *c = log[y + 1] + x;
  const double nx = s.x(y, x), ny = s.y(y, x);
  const double slope = 0.5 * ((b[1] - b[-1]) * nx + (c[0] - a[0]) * ny);
  const double xx = b[1] - 2 * b[0] + b[-1], yy = c[0] - 2 * b[0] + a[0];
  const double xy = 0.25 * (c[1] - c[-1] - a[1] + a[-1]);
  const double bend = xx * nx * nx + 2 * xy * nx * ny + yy * ny * ny;
  if (!(bend < -0.02)) return false;
  const double shift = -slope / bend;
  if (std::abs(shift * nx) > 0.6 || std::abs(shift * ny) > 0.6) return false;
  *place = {x + shift * nx, y + shift * ny, nx, ny};
  return true;
}

}  // namespace

double focal(const Camera& camera) { return std::sqrt(camera.fx * camera.fy); }

cv::Rect object_box(const GeometryMaps& maps) {
  constexpr int kMargin = 16;  // [px]
  const int w = maps.width(), h = maps.height();
  const cv::Rect object = cv::boundingRect(mat_of(maps.alpha) > 0);
  if (object.empty()) return object;
  const cv::Rect wider(object.x - kMargin, object.y - kMargin, object.width + 2 * kMargin,
                       object.height + 2 * kMargin);
  return wider & cv::Rect(0, 0, w, h);
}

GeometryMaps cut_maps(const GeometryMaps& maps, const cv::Rect& box) {
  const auto part = [&box](const Image<float>& image) {
    return cut(image, box.x, box.y, box.width, box.height);
  };
  GeometryMaps out{part(maps.depth), {}, part(maps.alpha)};
  for (int c = 0; c < 3; ++c) out.normal[c] = part(maps.normal[c]);
  return out;
}

void measure_activity(const Slopes& depth, const Slopes& normal, double jump_px, double crease,
                      GeometryFields* fields) {
  cv::magnitude(depth.magnitude / (kPeak * jump_px), normal.magnitude / (kPeak * crease),
                fields->activity);
}

GeometryFields make_fields(const GeometryMaps& maps, const Camera& camera) {
  GeometryFields f;
  f.camera = camera;
  f.alpha = mat_of(maps.alpha).clone();
  f.inverse = mat_of(maps.depth).clone();
  f.valid.create(maps.height(), maps.width());
  for (int c = 0; c < 3; ++c) f.normal[c] = mat_of(maps.normal[c]).clone();
  for (size_t i = 0; i < maps.depth.data.size(); ++i) {
    const int y = int(i / maps.width()), x = int(i % maps.width());
    f.valid(y, x) = holds_object(maps, i);
    if (!f.valid(y, x)) continue;
    f.inverse(y, x) = 1 / maps.depth.data[i];
    const float length =
        std::hypot(maps.normal[0].data[i], maps.normal[1].data[i], maps.normal[2].data[i]);
    for (int c = 0; c < 3; ++c) f.normal[c](y, x) = maps.normal[c].data[i] / length;
  }
  if (cv::countNonZero(f.valid) > 0)
    extend(f.valid, {&f.inverse, &f.normal[0], &f.normal[1], &f.normal[2]});
  return f;
}

Slopes slopes_of(const cv::Mat1f& gx, const cv::Mat1f& gy) {
  Slopes s;
  cv::magnitude(gx, gy, s.magnitude);
  const cv::Mat1f safe = cv::max(s.magnitude, 1e-12f);
  s.x = gx / safe, s.y = gy / safe;
  return s;
}

Slopes depth_slopes(const GeometryFields& f, double sigma) {
  cv::Mat1f gx, gy, n[3];
  gaussian_gradient(f.inverse, sigma, &gx, &gy);
  for (int c = 0; c < 3; ++c) cv::GaussianBlur(f.normal[c], n[c], cv::Size(), sigma, sigma);
  const double unit = focal(f.camera);
  for (int y = 0; y < gx.rows; ++y)
    for (int x = 0; x < gx.cols; ++x) {
      const Vector3d normal(n[0](y, x), n[1](y, x), n[2](y, x));
      const double facing = std::min(normal.dot(f.camera.ray({double(x), double(y)})), -0.2);
      gx(y, x) = float(unit * (gx(y, x) / f.inverse(y, x) - normal.x() / f.camera.fx / facing));
      gy(y, x) = float(unit * (gy(y, x) / f.inverse(y, x) - normal.y() / f.camera.fy / facing));
    }
  return slopes_of(gx, gy);
}

Slopes normal_slopes(const GeometryFields& f, double sigma) {
  const cv::Size size = f.valid.size();
  cv::Mat1f xx(size, 0.f), xy(size, 0.f), yy(size, 0.f);
  for (int c = 0; c < 3; ++c) {
    cv::Mat1f gx, gy;
    gaussian_gradient(f.normal[c], sigma, &gx, &gy);
    xx += gx.mul(gx), xy += gx.mul(gy), yy += gy.mul(gy);
  }
  Slopes s;
  s.magnitude.create(size), s.x.create(size), s.y.create(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double a = xx(y, x), b = xy(y, x), c = yy(y, x);
      const double root = std::hypot(0.5 * (a - c), b);
      const double angle = 0.5 * std::atan2(2 * b, a - c);
      s.magnitude(y, x) = float(std::sqrt(std::max(0.0, 0.5 * (a + c) + root)));
      s.x(y, x) = float(std::cos(angle)), s.y(y, x) = float(std::sin(angle));
    }
  return s;
}

std::vector<Place> find_places(const Slopes& slopes, double low) {
  cv::Mat1f log;
  cv::log(cv::max(slopes.magnitude, 1e-6f), log);
  std::vector<Place> places;
  for (int y = 1; y + 1 < log.rows; ++y)
    for (int x = 1; x + 1 < log.cols; ++x) {
      Place place;
      if (slopes.magnitude(y, x) >= low && localise(slopes, log, x, y, &place))
        places.push_back(place);
    }
  return places;
}

}  // namespace sketchsplat
