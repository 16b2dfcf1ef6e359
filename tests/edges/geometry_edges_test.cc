// SPDX-License-Identifier: MIT
#include "edges/depth/geometry_edges.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <random>

#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSize = 96;

Camera camera() { return {kSize, kSize, 200, 200, 47.5, 47.5}; }

struct Plane {
  Vector3d normal;  // towards the camera
  double offset;    // normal . x
};

// Depth and normal of the plane that `which` names for the pixel's ray; -1: nothing.
GeometryMaps maps_of(const std::vector<Plane>& planes,
                     const std::function<int(const Vector2d&)>& which) {
  GeometryMaps maps;
  maps.depth = maps.alpha = Image<float>(kSize, kSize);
  maps.normal.fill(Image<float>(kSize, kSize));
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const int k = which({double(x), double(y)});
      if (k < 0) continue;
      const Vector3d n = planes[k].normal.normalized();
      maps.depth.at(x, y) = float(planes[k].offset / n.dot(camera().ray({double(x), double(y)})));
      maps.alpha.at(x, y) = 1;
      for (int c = 0; c < 3; ++c) maps.normal[c].at(x, y) = float(n[c]);
    }
  return maps;
}

struct Offsets {
  double mean = 0, rms = 0;
  int n = 0;
};
// Of edgels in the middle of the image from the line normal . p = c.
Offsets offsets(const EdgelMap& map, const Vector2d& normal, double c) {
  Offsets o;
  for (const Edgel& e : map.edgels) {
    if (e.x < 12 || e.y < 12 || e.x > kSize - 13 || e.y > kSize - 13) continue;
    const double d = normal.dot(Vector2d(e.x, e.y)) - c;
    o.mean += d, o.rms += d * d, ++o.n;
  }
  o.mean /= std::max(1, o.n);
  o.rms = std::sqrt(o.rms / std::max(1, o.n));
  return o;
}

TEST(GeometryEdges, FindsADepthStepToAFractionOfAPixelWithItsNearSide) {
  for (double angle : {20.0, 65.0, 110.0, 250.0}) {
    const Vector2d n(std::cos(angle * M_PI / 180), std::sin(angle * M_PI / 180));
    const double c = n.dot(Vector2d(47.2, 48.4));
    const GeometryMaps maps = maps_of({{{0, 0, -1}, -2.2}, {{0.3, 0.1, -1}, -1.8}},
                                      [&](const Vector2d& p) { return n.dot(p) > c ? 1 : 0; });
    const EdgelMap map = geometry_edges(maps, camera(), {});
    const Offsets o = offsets(map, n, c);
    EXPECT_GE(o.n, 50) << angle;
    EXPECT_LT(std::abs(o.mean), 0.06) << angle;
    EXPECT_LT(o.rms, 0.2) << angle;
    for (const Edgel& e : map.edgels) EXPECT_GT(n.dot(Vector2d(e.nx, e.ny)), 0.9);
  }
}

// Two planes, and the line n . p = c of the image where they meet: 1 / depth is affine in the
// pixel.
struct Roof {
  GeometryMaps maps;
  Vector2d n;
  double c;
};
Roof roof(const Plane& a, const Plane& b) {
  const auto inverse = [](const Plane& plane, const Vector2d& p) {
    return plane.normal.normalized().dot(camera().ray(p)) / plane.offset;
  };
  const auto difference = [&](double x, double y) {
    return inverse(a, {x, y}) - inverse(b, {x, y});
  };
  const double at0 = difference(0, 0);
  Vector2d n(difference(1, 0) - at0, difference(0, 1) - at0);
  const double c = -at0 / n.norm();
  n.normalize();
  return {maps_of({a, b}, [&](const Vector2d& p) { return n.dot(p) > c ? 0 : 1; }), n, c};
}

TEST(GeometryEdges, FindsACreaseWherePlanesMeet) {
  const Roof r = roof({{0.4, 0.1, -1}, -2}, {{-0.3, 0.05, -1}, -2});
  const Offsets o = offsets(geometry_edges(r.maps, camera(), {}), r.n, r.c);
  EXPECT_GE(o.n, 50);
  EXPECT_LT(o.rms, 0.1);
}

// Splats that are wider than a pixel turn slowly from one face to the next.
TEST(GeometryEdges, FindsAShallowCreaseThatIsSmeared) {
  for (const double tilt : {0.08, 0.15}) {  // turns of 9 and 17 degrees
    Roof r = roof({{tilt, 0.02, -1}, -2}, {{-tilt, -0.01, -1}, -2});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double d = r.n.dot(Vector2d(x, y)) - r.c, share = 0.5 * std::erfc(-d / 3);
        r.maps.normal[0].at(x, y) = float(tilt * (2 * share - 1));
        r.maps.normal[1].at(x, y) = float(0.03 * share - 0.01);
      }
    GeometryOptions narrow;
    narrow.shallow_deg = 0;
    EXPECT_LT(offsets(geometry_edges(r.maps, camera(), narrow), r.n, r.c).n, 10) << tilt;
    const Offsets o = offsets(geometry_edges(r.maps, camera(), {}), r.n, r.c);
    EXPECT_GE(o.n, 50) << tilt;
    EXPECT_LT(o.rms, 0.3) << tilt;
  }
}

TEST(GeometryEdges, ASlantedPlaneIsNoStepHoweverSteep) {
  for (double slope : {0.5, 2.0, 5.0}) {
    const GeometryMaps maps = maps_of({{{slope, 0, -1}, -2}}, [](const Vector2d&) { return 0; });
    EXPECT_TRUE(geometry_edges(maps, camera(), {}).edgels.empty()) << slope;
  }
}

// A cylinder about the y axis, seen from afar; `wide` [px] is its radius.
GeometryMaps cylinder(double radius_px) {
  GeometryMaps maps = maps_of({{{0, 0, -1}, -20}}, [&](const Vector2d& p) {
    return std::abs(p.x() - 47.5) < radius_px ? 0 : -1;
  });
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double s = (x - 47.5) / radius_px;
      if (std::abs(s) >= 1) continue;
      const double c = std::sqrt(1 - s * s);
      maps.depth.at(x, y) = float(20 - radius_px * 20 / 200 * c);
      maps.normal[0].at(x, y) = float(s), maps.normal[2].at(x, y) = float(-c);
    }
  return maps;
}

TEST(GeometryEdges, TheContourOfARoundSurfaceIsNoEdgeUnlessAskedFor) {
  for (double radius : {15.3, 25.4, 40.2}) {
    EXPECT_TRUE(geometry_edges(cylinder(radius), camera(), {}).edgels.empty()) << radius;
    GeometryOptions keep;
    keep.rims = true;
    const EdgelMap map = geometry_edges(cylinder(radius), camera(), keep);
    EXPECT_GT(map.edgels.size(), 150u) << radius;
    for (const Edgel& e : map.edgels) EXPECT_TRUE(e.outline);
  }
}

TEST(GeometryEdges, TheOutlineOfAPlaneIsAnEdge) {
  const GeometryMaps maps = maps_of({{{0.2, 0.1, -1}, -2}}, [](const Vector2d& p) {
    return (p - Vector2d(47, 48)).norm() < 30.3 ? 0 : -1;
  });
  const EdgelMap map = geometry_edges(maps, camera(), {});
  EXPECT_GT(map.edgels.size(), 150u);
  for (const Edgel& e : map.edgels) {
    EXPECT_TRUE(e.outline);
    EXPECT_NEAR(std::hypot(e.x - 47, e.y - 48), 30.3, 0.6);
  }
}

TEST(GeometryEdges, NoiseOfNormalsAndDepthGivesNextToNothingAndIsMeasured) {
  GeometryMaps maps = maps_of({{{0.3, 0.2, -1}, -2}}, [](const Vector2d&) { return 0; });
  std::mt19937 rng(3);
  std::normal_distribution<float> normal(0, 1);
  for (float& z : maps.depth.data) z *= 1 + 0.5f * normal(rng) / 200;  // half a footprint
  for (Image<float>& c : maps.normal)
    for (float& v : c.data) v += 0.2f * normal(rng);
  GeometryNoise noise;
  EXPECT_LE(geometry_edges(maps, camera(), {}, &noise).edgels.size(), 12u);
  EXPECT_GT(noise.crease_deg, 2);
  EXPECT_GT(noise.jump_px, 0.2);
}

TEST(GeometryEdges, EmptyMapsAndMapsOfNothingGiveNoEdges) {
  EXPECT_TRUE(geometry_edges({}, camera(), {}).edgels.empty());
  const GeometryMaps nothing = maps_of({}, [](const Vector2d&) { return -1; });
  const EdgelMap map = geometry_edges(nothing, camera(), {});
  EXPECT_TRUE(map.edgels.empty());
  EXPECT_EQ(map.num_chains(), 0);
}

// The plain form that 2DGS-SN is published as, thick edges for comparison:
//   E = G_f * (g(A) > t | g(D) > t_d | g(N) > t_n),
// g the Sobel gradient, D in pixel footprints, N in degrees, G_f Gaussian; in [0, 1].
struct ThickOptions {
  double alpha = 0.25;       ///< [1/px]
  double depth = 3.0;        ///< [pixel footprints / px]
  double normal_deg = 12.0;  ///< [deg / px]
  double sigma_px = 1.0;     ///< [px] of G_f; 0: none
};

// Sobel gradient per px.
cv::Mat1f sobel(const cv::Mat1f& value) {
  cv::Mat1f x, y, magnitude;
  cv::Sobel(value, x, CV_32F, 1, 0, 3, 0.125, 0, cv::BORDER_REPLICATE);
  cv::Sobel(value, y, CV_32F, 0, 1, 3, 0.125, 0, cv::BORDER_REPLICATE);
  cv::magnitude(x, y, magnitude);
  return magnitude;
}

Image<float> geometry_edge_map(const GeometryMaps& maps, const Camera& camera,
                               const ThickOptions& options) {
  Image<float> out(maps.width(), maps.height());
  if (out.empty()) return out;
  const cv::Mat1f depth = mat_of(maps.depth), alpha = mat_of(maps.alpha);
  const cv::Mat1b nothing = ~(depth > 0) | (alpha < 0.5f);
  const cv::Mat1f alpha_slope = sobel(alpha), depth_slope = sobel(depth);
  cv::Mat1f turn(depth.size(), 0.f);
  for (const Image<float>& component : maps.normal) {
    const cv::Mat1f slope = sobel(mat_of(component));
    turn += slope.mul(slope);
  }
  cv::sqrt(turn, turn);
  // Against nothing there is no depth and no normal: alpha tells.
  cv::Mat1b unsure;
  cv::dilate(nothing, unsure, cv::Mat());
  cv::Mat1f edge(out.height, out.width, 0.f);
  const double unit = std::sqrt(camera.fx * camera.fy);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const bool jump = unit * depth_slope(y, x) / depth(y, x) > options.depth;
      const bool crease = turn(y, x) > options.normal_deg * M_PI / 180;
      edge(y, x) = alpha_slope(y, x) > options.alpha || (!unsure(y, x) && (jump || crease));
    }
  if (options.sigma_px > 0)
    cv::GaussianBlur(edge, edge, cv::Size(), options.sigma_px, options.sigma_px);
  std::copy(edge.begin(), edge.end(), out.data.begin());
  return out;
}

TEST(GeometryEdgeMap, IsThickAtAStepAndBlackOnAPlane) {
  const GeometryMaps maps = maps_of({{{0, 0, -1}, -2.2}, {{0, 0, -1}, -1.8}},
                                    [](const Vector2d& p) { return p.x() > 47.2 ? 1 : 0; });
  const Image<float> map = geometry_edge_map(maps, camera(), {});
  EXPECT_GT(map.at(47, 48), 0.5f);
  EXPECT_LT(map.at(20, 48), 0.01f);
  EXPECT_LT(map.at(80, 48), 0.01f);
}

}  // namespace
}  // namespace sketchsplat
