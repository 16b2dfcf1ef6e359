// SPDX-License-Identifier: MIT
#include "raster/splats/project.h"

#include <gtest/gtest.h>

#include "scene.h"

namespace sketchsplat {
namespace {

Eigen::Matrix2d covariance(const Footprint& f) {
  Eigen::Matrix2d U;
  U << f.u00, f.u01, 0, f.u11;
  return (U.transpose() * U).inverse();
}

View straight_view() {
  View view;
  view.camera = {101, 81, 100, 100, 50, 40};
  return view;
}

TEST(Project, MeanIsThePixelOfThePointAndPeakTheVisibleOpacity) {
  const Splats splats = one_splat({0.5, -0.25, 5});
  const auto f = project_splats(splats, Eigen::VectorXf::Constant(1, 0.5f), straight_view(), {});
  ASSERT_EQ(f.size(), 1u);
  EXPECT_TRUE(f[0].mean.isApprox(Eigen::Vector2d(60, 35), 1e-14));
  EXPECT_DOUBLE_EQ(f[0].peak, 0.5);
}

TEST(Project, CovarianceOnTheAxisIsThatOfSizeTimesFocalOverDepth) {
  const auto f = project_splats(one_splat({0, 0, 5}), kAllVisible, straight_view(), {});
  ASSERT_EQ(f.size(), 1u);
  const Eigen::Matrix2d S = covariance(f[0]);
  EXPECT_NEAR(S(0, 0), 4 + 0.09, 1e-12);  // along: 0.1 * 100 / 5 = 2 px
  EXPECT_NEAR(S(1, 1), 1 + 0.09, 1e-12);  // across: 1 px
  EXPECT_NEAR(S(0, 1), 0, 1e-12);
  EXPECT_EQ(f[0].x0, 43);  // 50 - 3.5 * 2.022
  EXPECT_EQ(f[0].y1, 43);  // 40 + 3.5 * 1.044
}

TEST(Project, ZeroTangentIsRoundWhateverAlongIs) {
  Splats splats = one_splat({0, 0, 5});
  splats.tangent.setZero();
  splats.along[0] = 0.7;
  const auto f = project_splats(splats, kAllVisible, straight_view(), {});
  ASSERT_EQ(f.size(), 1u);
  EXPECT_TRUE(covariance(f[0]).isApprox(1.09 * Eigen::Matrix2d::Identity(), 1e-12));
}

TEST(Project, SplatOfNoSizeIsThePixelFilter) {
  Splats splats = one_splat({0, 0, 5});
  splats.along[0] = splats.across[0] = 0;
  const auto f = project_splats(splats, kAllVisible, straight_view(), {});
  ASSERT_EQ(f.size(), 1u);
  EXPECT_TRUE(covariance(f[0]).isApprox(0.09 * Eigen::Matrix2d::Identity(), 1e-12));
}

TEST(Project, BoxIsThatOfTheEllipseInTheImage) {
  const RasterOptions options;
  const View view = test_view();
  for (const Footprint& f : project_splats(test_splats(40), kAllVisible, view, options)) {
    bool outside = false;
    for (int y = 0; y < view.camera.height; ++y) {
      for (int x = 0; x < view.camera.width; ++x) {
        const Eigen::Vector2d d = Eigen::Vector2d(x, y) - f.mean;
        const double u = f.u00 * d.x() + f.u01 * d.y(), v = f.u11 * d.y();
        if (u * u + v * v >= options.cutoff * options.cutoff) continue;
        outside |= x < f.x0 || x > f.x1 || y < f.y0 || y > f.y1;
      }
    }
    EXPECT_FALSE(outside);
    const Eigen::Vector2d half = options.cutoff * covariance(f).diagonal().cwiseSqrt();
    EXPECT_LE(f.x1 - f.x0, 2 * half.x()) << "box is wider than the ellipse";
    EXPECT_LE(f.y1 - f.y0, 2 * half.y()) << "box is higher than the ellipse";
    EXPECT_GE(f.x0, 0);
    EXPECT_LT(f.x1, view.camera.width);
    EXPECT_GE(f.y0, 0);
    EXPECT_LT(f.y1, view.camera.height);
  }
}

TEST(Project, HugeSplatIsClippedToTheImage) {
  Splats splats = one_splat({0, 0, 5});
  splats.along[0] = splats.across[0] = 1.2;
  const auto f = project_splats(splats, kAllVisible, straight_view(), {});
  ASSERT_EQ(f.size(), 1u);
  EXPECT_EQ(f[0].x0, 0);
  EXPECT_EQ(f[0].x1, 100);
  EXPECT_EQ(f[0].y0, 0);
  EXPECT_EQ(f[0].y1, 80);
}

struct Hopeless {
  const char* why;
  Splats splats;
};

std::vector<Hopeless> hopeless_splats() {
  std::vector<Hopeless> all = {{"behind the camera", one_splat({0, 0, -5})},
                               {"in the camera", one_splat({0, 0, 0})},
                               {"too near for its size", one_splat({0, 0, 0.39})},
                               {"left of the image", one_splat({-3, 0, 5})},
                               {"just outside, too far to reach in", one_splat({-2.9, 0, 5})},
                               {"below the image", one_splat({0, 30, 5})},
                               {"infinitely far", one_splat({0, 0, 1e308})}};
  for (int field = 0; field < 5; ++field) {
    Splats s = one_splat({0, 0, 5});
    double* const fields[] = {&s.mean(1, 0), &s.tangent(2, 0), &s.along[0], &s.across[0],
                              &s.opacity[0]};
    *fields[field] = kNaN;
    all.push_back({"NaN", s});
  }
  all.back().why = "NaN opacity";
  return all;
}

TEST(Project, LeavesOutWhatCannotBeSeen) {
  for (const Hopeless& h : hopeless_splats()) {
    const auto f = project_splats(h.splats, kAllVisible, straight_view(), {});
    if (std::string(h.why) == "infinitely far") {
      // Legal: a point in the middle of the image, as small as the pixel filter.
      ASSERT_EQ(f.size(), 1u);
      EXPECT_TRUE(std::isfinite(f[0].u00 + f[0].u01 + f[0].u11));
    } else {
      EXPECT_TRUE(f.empty()) << h.why;
    }
  }
}

TEST(Project, SplatsThatAreLeftOutGetNoGradient) {
  for (const Hopeless& h : hopeless_splats()) {
    const View view = straight_view();
    const EdgeTarget target = make_edge_target(Image<float>(101, 81, 0.5f));
    SplatGradient gradient;
    const double loss = render_loss(h.splats, kAllVisible, view, target, {}, &gradient);
    EXPECT_TRUE(std::isfinite(loss)) << h.why;
    EXPECT_TRUE(flatten(gradient).allFinite()) << h.why;
    if (std::string(h.why) == "infinitely far") continue;
    EXPECT_EQ(loss, target.empty_loss) << h.why;
    EXPECT_EQ(flatten(gradient).norm(), 0) << h.why;
  }
}

}  // namespace
}  // namespace sketchsplat
