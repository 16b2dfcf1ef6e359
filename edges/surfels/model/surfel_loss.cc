// SPDX-License-Identifier: MIT
#include "edges/surfels/model/surfel_loss.h"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

cv::Mat1f blurred(const cv::Mat1f& m) {
  cv::Mat1f out;
  cv::GaussianBlur(m, out, cv::Size(11, 11), 1.5, 1.5, cv::BORDER_CONSTANT);
  return out;
}

// Sum of 1 - SSIM (Wang et al., TIP 2004) over the mask, and its derivative by `a`. The window is
// symmetric, so that the derivative of a blur is that blur.
double ssim_loss(const cv::Mat1f& a, const cv::Mat1f& b, const Image<std::uint8_t>& mask,
                 cv::Mat1f* by_a) {
  constexpr float kC1 = 0.01f * 0.01f, kC2 = 0.03f * 0.03f;
  const cv::Mat1f ma = blurred(a), mb = blurred(b), aa = blurred(a.mul(a)), bb = blurred(b.mul(b)),
                  ab = blurred(a.mul(b));
  cv::Mat1f by_mean(a.size()), by_square(a.size()), by_product(a.size());
  double sum = 0;
  for (int y = 0; y < a.rows; ++y)
    for (int x = 0; x < a.cols; ++x) {
      by_mean(y, x) = by_square(y, x) = by_product(y, x) = 0;
      if (!mask.at(x, y)) continue;
      const float u = ma(y, x), v = mb(y, x);
      const float l1 = 2 * u * v + kC1, l2 = u * u + v * v + kC1;
      const float s1 = 2 * (ab(y, x) - u * v) + kC2;
      const float s2 = aa(y, x) - u * u + bb(y, x) - v * v + kC2;
      const float ssim = l1 * s1 / (l2 * s2);
      sum += 1 - ssim;
      by_square(y, x) = ssim / s2;             // by the blurred a^2, of 1 - SSIM
      by_product(y, x) = -2 * l1 / (l2 * s2);  // by the blurred a b
      by_mean(y, x) = -(2 * v * s1 / (l2 * s2) - 2 * v * l1 / (l2 * s2) - 2 * u * ssim / l2 +
                        2 * u * ssim / s2);
    }
  *by_a = blurred(by_mean) + 2 * a.mul(blurred(by_square)) + b.mul(blurred(by_product));
  return sum;
}

double photometric(const SurfelImages& images, const TrainingView& target,
                   const Image<std::uint8_t>& mask, double n, const SurfelLossOptions& options,
                   SurfelImages* by_images) {
  const int w = target.alpha.width, h = target.alpha.height;
  double loss = 0;
  const double share = (1 - options.ssim) / (3 * n);
  for (int c = 0; c < 3; ++c) {
    by_images->color[c] = Image<float>(w, h);
    for (size_t i = 0; i < mask.data.size(); ++i) {
      if (!mask.data[i]) continue;
      const double r = images.color[c].data[i] - target.color[c].data[i];
      const double root = std::hypot(r, options.softness);
      loss += share * (root - options.softness);
      by_images->color[c].data[i] = float(share * r / root);
    }
  }
  if (!(options.ssim > 0)) return loss;
  const auto grey = [](const Image<float>* c) -> cv::Mat1f {
    return (mat_of(c[0]) + mat_of(c[1]) + mat_of(c[2])) / 3;
  };
  cv::Mat1f by_grey;
  loss += options.ssim / n * ssim_loss(grey(images.color), grey(target.color), mask, &by_grey);
  for (int c = 0; c < 3; ++c)
    mat_of(by_images->color[c]) += by_grey * float(options.ssim / (3 * n));
  return loss;
}

// 1 - cosine between the rendered normal and that of the surface of depths, at the inner pixels.
double consistency(const SurfelImages& images, const Camera& camera,
                   const Image<std::uint8_t>& mask, double weight, SurfelImages* by_images) {
  const int w = camera.width, h = camera.height;
  by_images->depth = Image<float>(w, h);
  for (Image<float>& image : by_images->normal) image = Image<float>(w, h);
  const auto solid = [&](int x, int y) { return mask.at(x, y) && images.alpha.at(x, y) > 0.5f; };
  const auto point = [&](int x, int y) {
    return Eigen::Vector3d(camera.ray({double(x), double(y)}) * double(images.depth.at(x, y)) /
                           double(images.alpha.at(x, y)));
  };
  double loss = 0;
  for (int y = 1; y + 1 < h; ++y)
    for (int x = 1; x + 1 < w; ++x) {
      if (!solid(x, y) || !solid(x - 1, y) || !solid(x + 1, y) || !solid(x, y - 1) ||
          !solid(x, y + 1))
        continue;
      const Eigen::Vector3d dx = point(x + 1, y) - point(x - 1, y);
      const Eigen::Vector3d dy = point(x, y + 1) - point(x, y - 1);
      const Eigen::Vector3d cross = dy.cross(dx);  // towards the camera
      const double length = cross.norm();
      if (!(length > 0)) continue;
      const Eigen::Vector3d n = cross / length;
      const Eigen::Vector3d N(images.normal[0].at(x, y), images.normal[1].at(x, y),
                              images.normal[2].at(x, y));
      loss += weight * (1 - N.dot(n));
      for (int c = 0; c < 3; ++c) by_images->normal[c].at(x, y) = float(-weight * n[c]);
      const Eigen::Vector3d by_cross = -weight / length * (N - n * n.dot(N));
      const Eigen::Vector3d by_dy = dx.cross(by_cross), by_dx = by_cross.cross(dy);
      const auto add = [&](int u, int v, const Eigen::Vector3d& g) {
        const double a = images.alpha.at(u, v);
        const double by_depth = g.dot(camera.ray({double(u), double(v)})) / a;
        by_images->depth.at(u, v) += float(by_depth);
        by_images->alpha.at(u, v) -= float(by_depth * images.depth.at(u, v) / a);
      };
      add(x + 1, y, by_dx), add(x - 1, y, -by_dx);
      add(x, y + 1, by_dy), add(x, y - 1, -by_dy);
    }
  return loss;
}

}  // namespace

double surfel_loss(const SurfelImages& images, const TrainingView& target,
                   const Image<std::uint8_t>& mask, const SurfelLossOptions& options,
                   SurfelImages* by_images) {
  *by_images = SurfelImages();
  double n = 0;
  for (const std::uint8_t m : mask.data) n += m;
  if (n == 0) return 0;
  double loss = photometric(images, target, mask, n, options, by_images);
  by_images->alpha = Image<float>(mask.width, mask.height);
  for (size_t i = 0; i < mask.data.size(); ++i) {
    if (!mask.data[i]) continue;
    const double r = images.alpha.data[i] - target.alpha.data[i];
    loss += options.alpha / n * r * r;
    by_images->alpha.data[i] = float(2 * options.alpha / n * r);
  }
  if (options.consistency > 0)
    loss += consistency(images, target.view.camera, mask, options.consistency / n, by_images);
  return loss;
}

}  // namespace sketchsplat
