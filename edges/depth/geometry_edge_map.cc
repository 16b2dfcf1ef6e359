// SPDX-License-Identifier: MIT
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/depth/geometry_edges.h"

namespace sketchsplat {
namespace {

// Sobel gradient per px.
cv::Mat1f sobel(const cv::Mat1f& value) {
  cv::Mat1f x, y, magnitude;
  cv::Sobel(value, x, CV_32F, 1, 0, 3, 0.125, 0, cv::BORDER_REPLICATE);
  cv::Sobel(value, y, CV_32F, 0, 1, 3, 0.125, 0, cv::BORDER_REPLICATE);
  cv::magnitude(x, y, magnitude);
  return magnitude;
}

cv::Mat1f as_mat(const Image<float>& image) {
  return cv::Mat1f(image.height, image.width, const_cast<float*>(image.data.data()));
}

}  // namespace

Image<float> geometry_edge_map(const GeometryMaps& maps, const Camera& camera,
                               const ThickOptions& options) {
  Image<float> out(maps.width(), maps.height());
  if (out.empty()) return out;
  const cv::Mat1f depth = as_mat(maps.depth), alpha = as_mat(maps.alpha);
  const cv::Mat1b nothing = ~(depth > 0) | (alpha < 0.5f);
  const cv::Mat1f alpha_slope = sobel(alpha), depth_slope = sobel(depth);
  cv::Mat1f turn(depth.size(), 0.f);
  for (const Image<float>& component : maps.normal) {
    const cv::Mat1f slope = sobel(as_mat(component));
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

}  // namespace sketchsplat
