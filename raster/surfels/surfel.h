// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "datasets/types/image.h"
#include "datasets/types/view.h"

// Surfels: flat Gaussians on surfaces, composited front to back (2D Gaussian splatting, Huang et
// al., SIGGRAPH 2024), forward and backward, for who fits them to pictures.
namespace sketchsplat {

/// N surfels, structure of arrays. A surfel is a disk with the axes u and v, the first two columns
/// of its rotation; its normal is the third.
struct SurfelCloud {
  Eigen::Matrix3Xd center;    ///< 3 x N, world units
  Eigen::Matrix4Xd rotation;  ///< 4 x N, quaternions (w, x, y, z), world from surfel; of any length
                              ///< but 0: they are normalised where they are used
  Eigen::Matrix2Xd log_scale;  ///< 2 x N, logarithms of the standard deviations along u and v
  Eigen::VectorXd opacity;     ///< N, logits: the peak of alpha is 1 / (1 + exp(-logit))
  Eigen::Matrix3Xd color;      ///< 3 x N, whatever is to be composited: any real numbers
  Eigen::Matrix2Xd skew;       ///< 2 x N, latent l, unbounded: a = max_skew tanh(|l|) l / |l|
  int size() const { return int(center.cols()); }
  static SurfelCloud zero(int n);
};

enum class SurfelKernel {
  kGaussian,    ///< g = exp(-q/2), q = u^2 + v^2 in standard deviations; skew is not read
  kSkewNormal,  ///< 2 g Phi(a . (u, v)), Phi the normal distribution function; a = 0 is kGaussian
};

/// How surfels are drawn. Along the ray of a pixel a surfel has the alpha
///   min(max_alpha, opacity * max(k(q3) * 2 Phi(a . (u, v)), k(q2))),
/// (u, v) where the ray meets the plane of the surfel exactly, q3 = u^2 + v^2, and q2 = |d|^2 /
/// lowpass_px^2 with d the pixel minus the projected centre: no surfel is thinner than that. k is
/// the Gaussian lowered by its tangent at the cutoff (raster/splats/project.h), so that nothing
/// jumps at the rim. Where k(q2) is the larger one the depth is that of the centre.
/// Not drawn: surfels that are not finite, and those whose disk up to the cutoff reaches the plane
/// through the camera parallel to the image, or `near`.
struct SurfelOptions {
  SurfelKernel kernel = SurfelKernel::kGaussian;
  double cutoff = 3.3;              ///< [standard deviations] where a surfel ends, in [2, 6]
  double lowpass_px = 0.7071;       ///< [px] standard deviation of the smallest footprint, > 0
  double near = 0;                  ///< [world units] least depth of a whole disk, >= 0
  double min_cosine = 1e-3;         ///< seen more edge-on than this only k(q2) is left, > 0
  double max_alpha = 0.99;          ///< alpha is clamped to it (no gradient beyond), in (0, 1)
  double min_transmittance = 1e-4;  ///< a pixel is finished below it, in (0, 1)
  double max_skew = 3;              ///< bound of |a|, in [0, 4]
};

/// What a view shows, W x H each. With weights w_i = alpha_i prod_{j<i} (1 - alpha_j) in the order
/// of the centres' depths z in the camera, ties by index:
struct SurfelImages {
  Image<float> color[3];   ///< sum w_i color_i
  Image<float> normal[3];  ///< sum w_i n_i, camera frame, n_i the unit normal that faces the camera
  Image<float> alpha;      ///< sum w_i, in [0, 1]
  Image<float> depth;      ///< sum w_i z_i: divided by alpha it is the expected depth
  Image<float> median_depth;  ///< z_i of the surfel at which the transmittance falls to 1/2 or
                              ///< below; 0 where it never does
};

/// Gradient of a scalar by every field of the cloud, and what density control asks for, summed over
/// the pixels of one view. Column i is zero if surfel i is not drawn.
struct SurfelGradient : SurfelCloud {
  Eigen::Matrix2Xd in_image;  ///< 2 x N, by a shift of the footprint in the image [1/px]
  /// 2 x N, the same, but the absolute values of the pixels summed (Ye et al., AbsGS, 2024): does
  /// not cancel where a surfel covers an edge.
  Eigen::Matrix2Xd in_image_abs;
  /// 3 x N (uu, uv, vv): splitting matrix S = sum_pixels dL/dg Hess g of the kernel g by (u, v),
  /// thus by positions in the plane in standard deviations (Wang et al., Steepest Descent Density
  /// Control, CVPR 2025). Only if its smallest eigenvalue is negative a split lowers the loss: to
  /// +- that eigenvector, opacity halved.
  Eigen::Matrix3Xd splitting;
  Eigen::VectorXd weight;  ///< N, sum of w_i over the pixels: how much of the image it makes
  static SurfelGradient zero(int n);
};

/// Weights w_i of one view, surfel by surfel: those of surfel i are first[i] .. first[i + 1] - 1,
/// in ascending order of the pixel.
struct SurfelInfluence {
  std::vector<int> first;     ///< N + 1
  std::vector<int> pixel;     ///< y * width + x
  std::vector<float> weight;  ///< > 0
};

/// Renders one cloud after another and keeps what backward needs. All threads of OpenMP for
/// pictures that are worth it, one when called from a parallel region; the same bytes for any
/// number of them. Where several views are at hand, a renderer for each and a parallel loop over
/// them is faster. Float inside the images, double in the surfels. Not for use by two threads at
/// once.
class SurfelRenderer {
 public:
  explicit SurfelRenderer(const SurfelOptions& options);
  ~SurfelRenderer();
  SurfelRenderer(SurfelRenderer&&) noexcept;
  SurfelRenderer& operator=(SurfelRenderer&&) noexcept;

  /// `mask` (size of the camera, or empty: all): pixels with 0 are left out; they stay 0 in every
  /// image. The result lives until the next call.
  const SurfelImages& forward(const SurfelCloud& cloud, const View& view,
                              const Image<std::uint8_t>& mask = {});

  /// Gradient of a scalar L by the cloud of the last forward, given that by its images (empty ones
  /// count as zero). The depth order, the choice between k(q2) and k(q3) and that of the median are
  /// constants. Precondition: `cloud` and `view` are those of forward.
  void backward(const SurfelCloud& cloud, const View& view, const SurfelImages& by_images,
                SurfelGradient* gradient) const;

  /// Weights of the last forward.
  SurfelInfluence influence() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Cosine of the angle between the weights of two surfels, all pixels of all views taken as one
/// vector, in [0, 1]; 0 if one of them is invisible. Near 1 they do the same work: a candidate to
/// be merged (PINGS-X merges above 0.9). `views`: influences of the same cloud.
Eigen::VectorXd influence_cosines(const std::vector<SurfelInfluence>& views,
                                  const std::vector<std::pair<int, int>>& pairs);

}  // namespace sketchsplat
