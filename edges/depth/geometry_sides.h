// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "datasets/types/camera.h"

namespace sketchsplat {

// What lies on the two sides of a place in the maps of a view, outside of the band that a renderer
// smears. Coordinates about the place: s along its normal, t along the edge [px].

/// The maps of a view, ready for filters: pixels without an object hold the nearest value.
struct GeometryFields {
  Camera camera;
  cv::Mat1b valid;    ///< 1 where the object is
  cv::Mat1f inverse;  ///< 1 / depth: affine in the pixel on every plane
  cv::Mat1f normal[3];
  cv::Mat1f alpha;
  cv::Mat1f activity;  ///< how much changes, 1 at the weakest edge: sides end where it rises again
  double scale = 1;    ///< sides begin so much farther away, and are so much longer and broader
};

/// A place and the direction across the edge that may be there.
struct Place {
  double x = 0, y = 0, nx = 0, ny = 0;
};

/// One side, fitted up to `extent` from the place. Values at s = t = 0 and slopes per px.
struct Side {
  double extent = 0;  ///< [px]
  int samples = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), normal_slope = Eigen::Vector3d::Zero();
  double inverse = 0, inverse_s = 0, inverse_t = 0;
  double residual = 0;  ///< root mean square of 1 / depth about the plane
  double inverse_at(double s, double t) const { return inverse + inverse_s * s + inverse_t * t; }
};

constexpr double kBand = 3.0;         // [px] at scale 1, about a place where its step is fitted
constexpr double kLongestSide = 7.0;  // [px] at scale 1
constexpr double kLinear = 4.5;       // [px] at scale 1, from which slopes can be told from noise

/// Fits the side of negative (-1) or positive (+1) s.
Side fit_side(const GeometryFields& fields, const Place& place, int sign);

/// Angle between the normals [rad].
double turn_of(const Side& a, const Side& b);
/// What the steady turn of either side adds to it over the smeared band: a round surface [rad].
double steady_turn(const Side& a, const Side& b);
/// Step of depth from one side's plane to the other's, in footprints of the nearer one; `unit`: the
/// focal length [px].
double jump_of(const Side& a, const Side& b, double unit);
/// Difference of the slopes of both sides [footprints per px]: what a place that is one pixel off
/// takes for a step.
double bend_of(const Side& a, const Side& b, double unit);

/// Does a round surface turn away from the line of sight here (its contour, which moves with the
/// view)? Towards a contour the squared cosine between normal and line of sight falls linearly to
/// nothing; at an edge it does not reach nothing. Both the normals and the slopes of depth vote.
bool is_rim(const GeometryFields& fields, const Place& place, int sign);

/// A value across an edge that goes from 0 to 1.
struct StepSample {
  double s, value;
};
struct Step {
  double s = 0, sigma = 0;  ///< position and width of the cumulative Gaussian [px]
  double error = 0;         ///< standard deviation of s, from the scatter of the samples
  bool ok = false;
};
Step fit_step(const std::vector<StepSample>& samples);

/// Calls f(s, t, pixel) for the pixels with s in [from, to] and |t| <= 2.5 scales, on the object
/// only or `anywhere`.
template <typename F>
void for_each_pixel(const GeometryFields& fields, const Place& p, double from, double to,
                    const F& f, bool anywhere = false) {
  const double half = 2.5 * fields.scale;
  const double reach = std::hypot(std::max(std::abs(from), std::abs(to)), half);
  const int x0 = std::max(0, int(std::ceil(p.x - reach)));
  const int y0 = std::max(0, int(std::ceil(p.y - reach)));
  const int x1 = std::min(fields.valid.cols - 1, int(std::floor(p.x + reach)));
  const int y1 = std::min(fields.valid.rows - 1, int(std::floor(p.y + reach)));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double s = (x - p.x) * p.nx + (y - p.y) * p.ny;
      const double t = (y - p.y) * p.nx - (x - p.x) * p.ny;
      if (s < from || s > to || std::abs(t) > half || !(anywhere || fields.valid(y, x))) continue;
      f(s, t, cv::Point(x, y));
    }
}

}  // namespace sketchsplat
