// SPDX-License-Identifier: MIT
#include "tests/raster/reference.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "scene.h"

namespace sketchsplat {
namespace {

using Jet = ceres::Jet<double, 9>;

ReferenceSplat<Jet> jets(const Splats& s, int i) {
  ReferenceSplat<Jet> j;
  for (int k = 0; k < 3; ++k) {
    j.mean[k] = Jet(s.mean(k, i), k);
    j.tangent[k] = Jet(s.tangent(k, i), 3 + k);
  }
  j.along = Jet(s.along[i], 6);
  j.across = Jet(s.across[i], 7);
  j.opacity = Jet(s.opacity[i], 8);
  return j;
}

// Gradient of the loss by splat i through dual numbers; the others are constants.
Jet loss_by_jets(const Splats& splats, int i, const View& view, const Image<float>& edges,
                 const RasterOptions& options) {
  Splats others = splats;
  others.opacity[i] = 0;
  const Image<double> rest = reference_render(others, kAllVisible, view, options);
  const ReferenceSplat<Jet> splat = jets(splats, i);
  Jet loss(0.0);
  for (int y = 0; y < edges.height; ++y) {
    for (int x = 0; x < edges.width; ++x) {
      const Jet depth = reference_depth(splat, view, x, y, options);
      const Jet value = 1.0 - (1 - rest.at(x, y)) * exp(-depth);
      const Jet off = value - double(edges.at(x, y));
      loss += off * off / 2.0;
    }
  }
  return loss;
}

Eigen::Matrix<double, 9, 1> of_splat(const SplatGradient& g, int i) {
  Eigen::Matrix<double, 9, 1> all;
  all << g.mean.col(i), g.tangent.col(i), g.along[i], g.across[i], g.opacity[i];
  return all;
}

TEST(Profile, IsOneInTheMiddleAndEndsFlat) {
  using Jet1 = ceres::Jet<double, 1>;
  EXPECT_NEAR(reference_profile(0.0, 3.5), 1, 1e-15);
  const Jet1 rim = reference_profile(Jet1(3.5 * 3.5 * (1 - 1e-9), 0), 3.5);
  EXPECT_NEAR(rim.a, 0, 1e-12);
  EXPECT_NEAR(rim.v[0], 0, 1e-10);
  EXPECT_EQ(reference_profile(12.26, 3.5), 0);
}

TEST(Profile, StaysWithinTwoPercentOfTheGaussian) {
  for (double q = 0; q < 16; q += 0.1) {
    EXPECT_NEAR(reference_profile(q, 3.5), std::exp(-q / 2), 0.02);
  }
}

TEST(Gradients, ReferenceAndFastGradientsAreThoseOfDualNumbers) {
  const View view = test_view();
  const Splats splats = test_splats(12);
  const Image<float> edges = test_edges(view);
  SplatGradient reference, fast;
  const double value = reference_loss(splats, kAllVisible, view, edges, {}, &reference);
  render_loss(splats, kAllVisible, view, make_edge_target(edges), {}, &fast);
  for (int i = 0; i < splats.size(); ++i) {
    const Jet expected = loss_by_jets(splats, i, view, edges, {});
    EXPECT_NEAR(value, expected.a, 1e-10 * value);
    EXPECT_LT((of_splat(reference, i) - expected.v).norm(), 1e-11 * expected.v.norm());
    // Floats: the terms of a small gradient are as large as those of a large one.
    EXPECT_LT((of_splat(fast, i) - expected.v).norm(), 1e-6 * flatten(reference).norm());
  }
}

TEST(Gradients, ReferenceGradientIsThatOfCentralDifferences) {
  const View view = test_view(29, 23);
  Splats splats = test_splats(3, 5);
  splats.mean *= 0.3;
  const Eigen::VectorXf visibility = Eigen::Vector3f(1, 0.6f, 0.3f);
  const Image<float> edges = test_edges(view);
  SplatGradient gradient;
  reference_loss(splats, visibility, view, edges, {}, &gradient);
  const auto check = [&](double* parameter, double analytic) {
    const double h = 1e-6, kept = *parameter;
    *parameter = kept + h;
    const double above = reference_loss(splats, visibility, view, edges, {}, nullptr);
    *parameter = kept - h;
    const double below = reference_loss(splats, visibility, view, edges, {}, nullptr);
    *parameter = kept;
    EXPECT_NEAR(analytic, (above - below) / (2 * h), 1e-5 * (1 + std::abs(analytic)));
  };
  for (int i = 0; i < splats.size(); ++i) {
    for (int k = 0; k < 3; ++k) check(&splats.mean(k, i), gradient.mean(k, i));
    for (int k = 0; k < 3; ++k) check(&splats.tangent(k, i), gradient.tangent(k, i));
    check(&splats.along[i], gradient.along[i]);
    check(&splats.across[i], gradient.across[i]);
    check(&splats.opacity[i], gradient.opacity[i]);
  }
}

TEST(Gradients, FastIsTheReference) {
  const View view = test_view();
  const Splats splats = test_splats(60);
  Eigen::VectorXf visibility(60);
  for (int i = 0; i < 60; ++i) visibility[i] = float(i % 4) / 3;
  const Image<float> edges = test_edges(view);
  SplatGradient slow, fast;
  const double expected = reference_loss(splats, visibility, view, edges, {}, &slow);
  const EdgeTarget target = make_edge_target(edges);
  EXPECT_NEAR(render_loss(splats, visibility, view, target, {}, &fast), expected, 1e-6 * expected);
  EXPECT_LT((flatten(fast) - flatten(slow)).cwiseAbs().maxCoeff(),
            1e-5 * flatten(slow).cwiseAbs().maxCoeff());

  const Image<float> image = render(splats, visibility, view, {});
  const Image<double> expected_image = reference_render(splats, visibility, view, {});
  for (size_t k = 0; k < image.data.size(); ++k) {
    ASSERT_NEAR(image.data[k], expected_image.data[k], 1e-5);
  }
}

TEST(Reference, HugeSplatIsTheFastOnes) {
  const View view = test_view();
  Splats splats = one_splat({0, 0, 0});
  splats.along[0] = 0.9;
  splats.across[0] = 0.8;
  const Image<float> edges = test_edges(view);
  SplatGradient slow, fast;
  reference_loss(splats, kAllVisible, view, edges, {}, &slow);
  render_loss(splats, kAllVisible, view, make_edge_target(edges), {}, &fast);
  EXPECT_LT((flatten(fast) - flatten(slow)).norm(), 2e-5 * flatten(slow).norm());
}

}  // namespace
}  // namespace sketchsplat
