// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/geometry_maps.h"
#include "datasets/types/parallel.h"

namespace sketchsplat::test {

/// Depth, normals and alpha of a view, one ray per pixel's centre.
inline GeometryMaps exact_maps(const SyntheticScene& scene, int k) {
  const View& view = scene.unit_views[k];
  const int w = view.camera.width, h = view.camera.height;
  GeometryMaps maps;
  maps.depth = maps.alpha = Image<float>(w, h);
  maps.normal.fill(Image<float>(w, h));
  const Eigen::Matrix3d R = view.cam_from_world.rotation;
  const Eigen::Vector3f eye = view.center_in_world().cast<float>();
  parallel_for(h, 8, [&](int y) {
    for (int x = 0; x < w; ++x) {
      const Eigen::Vector3d ray = R.transpose() * view.camera.ray({double(x), double(y)});
      const Hit hit = scene.tracer.cast(eye, ray.cast<float>());
      if (hit.face < 0) continue;
      const Eigen::Vector3d n = R * hit.normal.cast<double>();
      maps.depth.at(x, y) = hit.depth;
      maps.alpha.at(x, y) = 1;
      for (int c = 0; c < 3; ++c) maps.normal[c].at(x, y) = float(n[c]);
    }
  });
  return maps;
}

struct Degradation {
  double blur_px = 1.25;    ///< of everything, alpha-weighted: what a splat's width does
  double normal_deg = 4.5;  ///< of each component, over `patch_px`
  double patch_px = 4.0;    ///< correlation of the noise of normals
  double depth_px = 0.5;    ///< white, pixel footprints
};

/// The same maps as a splat renderer that is not quite sure would give them: values are means
/// weighed by alpha, normals are noisy over patches, depth by pixel. Depends on the seed alone.
inline GeometryMaps degraded(const GeometryMaps& exact, const Camera& camera, const Degradation& d,
                             std::uint64_t seed) {
  const int w = exact.width(), h = exact.height();
  const auto mat = [&](const Image<float>& image) {
    return cv::Mat1f(h, w, const_cast<float*>(image.data.data())).clone();
  };
  cv::RNG rng(seed);
  const auto blur = [](cv::Mat1f m, double sigma) {
    cv::GaussianBlur(m, m, cv::Size(), sigma, sigma, cv::BORDER_REPLICATE);
    return m;
  };
  const cv::Mat1f alpha = mat(exact.alpha), wide = blur(alpha.clone(), d.blur_px);
  GeometryMaps out = exact;
  std::copy(wide.begin(), wide.end(), out.alpha.data.begin());
  cv::Mat1f z = blur(mat(exact.depth), d.blur_px) / cv::max(wide, 1e-6f);
  cv::Mat1f white(h, w);
  rng.fill(white, cv::RNG::NORMAL, 0, d.depth_px / camera.fx);
  z = z.mul(1 + white);
  for (int i = 0; i < w * h; ++i)
    out.depth.data[i] = wide(i / w, i % w) > 0.01f ? z(i / w, i % w) : 0;
  cv::Mat1f n[3], length(h, w, 0.f);
  for (int c = 0; c < 3; ++c) {
    n[c] = blur(mat(exact.normal[c]), d.blur_px) / cv::max(wide, 1e-6f);
    rng.fill(white, cv::RNG::NORMAL, 0, 1);
    // A blur leaves 1 / (2 sqrt(pi) sigma) of white noise.
    const cv::Mat1f patches = blur(white.clone(), d.patch_px) * (2 * std::sqrt(M_PI) * d.patch_px);
    n[c] += patches * (d.normal_deg * M_PI / 180);
    length += n[c].mul(n[c]);
  }
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < w * h; ++i) {
      const float l = std::sqrt(length(i / w, i % w));
      out.normal[c].data[i] = out.depth.data[i] > 0 && l > 0 ? n[c](i / w, i % w) / l : 0;
    }
  return out;
}

}  // namespace sketchsplat::test
