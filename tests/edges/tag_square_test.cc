// SPDX-License-Identifier: MIT
#include "edges/tags/tag_square.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSide = 0.31;

struct Shot {
  double broader_px = 0;  // by which black is drawn broader on all sides
  double noise = 1;       // grey levels
  bool by_gamma = true;   // pictures on sRGB's curve; else in linear light
  double blur_px = 0.6;   // standard deviation
  double shadow = 0;      // share of the light that is missing in the middle, less outwards
};

TagSquare true_square(int id) {
  TagSquare s;
  s.id = id;
  s.centre = {0.4, -0.2, 0.7};
  s.axes = Eigen::AngleAxisd(0.8, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  s.side = kSide;
  return s;
}

// Looks at the tag from its front, aslant.
View look(const TagSquare& tag, std::mt19937* rng, bool lens) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double height = 1.2 + 0.2 * unit(*rng);
  const Vector3d eye =
      tag.centre + tag.axes * Vector3d(0.9 * unit(*rng), 0.9 * unit(*rng), -height);
  const Vector3d aim = tag.centre + 0.08 * Vector3d(unit(*rng), unit(*rng), unit(*rng));
  const Vector3d z = (aim - eye).normalized();
  const Vector3d x = z.cross(Vector3d(unit(*rng), unit(*rng), 0.3)).normalized();
  View view;
  view.camera = {240, 200, 330, 332, 118.7, 101.2};
  view.cam_from_world.rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  view.cam_from_world.translation = -view.cam_from_world.rotation * eye;
  Lens::Terms k;
  k.k1 = -0.12, k.k2 = 0.05, k.p1 = 0.002;
  if (lens) view.lens = Lens(LensModel::kOpencv, k);
  return view;
}

// Light from an ideal pixel; black is broader by so many pixels.
double light_at(const View& view, const TagSquare& tag, const TagBitmap& bitmap,
                const Vector2d& ideal, double broader_px, double shadow) {
  const Vector3d eye = view.center_in_world();
  const Vector3d ray = view.cam_from_world.rotation.transpose() * view.camera.ray(ideal);
  const double depth = tag.axes.col(2).dot(tag.centre - eye) / tag.axes.col(2).dot(ray);
  const Vector3d in = tag.axes.transpose() * (eye + depth * ray - tag.centre) / tag.side;
  const int cells = bitmap.cells.width - 2 * bitmap.border;
  const auto colour = [&](double u, double v) {
    const int x = int(std::floor((u + 0.5) * cells)) + bitmap.border,
              y = int(std::floor((v + 0.5) * cells)) + bitmap.border;
    if (x < 0 || y < 0 || x >= bitmap.cells.width || y >= bitmap.cells.height) return 1.0f;
    return bitmap.cells.at(x, y);
  };
  const double b = broader_px * depth / (view.camera.fx * tag.side);
  float darkest = colour(in.x(), in.y());
  for (int k = 0; k < 9 && b > 0; ++k)
    darkest = std::min(darkest, colour(in.x() + (k % 3 - 1) * b, in.y() + (k / 3 - 1) * b));
  const double lit = 1 - shadow * std::exp(-2 * in.head<2>().squaredNorm());
  return lit * (0.06 + 0.6 * double(darkest));
}

Picture draw(const View& view, const TagSquare& tag, const Shot& shot, std::mt19937* rng) {
  const TagBitmap bitmap = tag36h11(tag.id);
  std::normal_distribution<double> gauss;
  constexpr int kRays = 4;
  // One pattern for all pixels: noise of the drawing itself would be that of the edges.
  std::vector<Vector2d> ways;
  for (int j = 0; j < kRays; ++j)
    for (int i = 0; i < kRays; ++i)
      for (const Vector2d& way :
           {Vector2d(1, 1), Vector2d(1, -1), Vector2d(-1, 1), Vector2d(-1, -1)})
        ways.push_back(Vector2d((i + 0.5) / kRays - 0.5, (j + 0.5) / kRays - 0.5) +
                       shot.blur_px * way);
  Image<float> grey(view.camera.width, view.camera.height);
  double depth;
  const Vector2d middle = view.project(tag.centre, &depth);
  const double reach = view.camera.fx * tag.side / depth;
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x) {
      double light = 0.66;
      Vector2d ideal;
      Eigen::Matrix2d J;
      if (view.ideal_pixel(Vector2d(x, y), &ideal, &J) && (ideal - middle).norm() < 1.2 * reach) {
        const Eigen::Matrix2d back = J.inverse();
        light = 0;
        for (const Vector2d& way : ways)
          light += light_at(view, tag, bitmap, ideal + back * way, shot.broader_px, shot.shadow);
        light /= double(ways.size());
      }
      const double value = !shot.by_gamma       ? light
                           : light <= 0.0031308 ? 12.92 * light
                                                : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      grey.at(x, y) =
          float(std::round(std::clamp(255 * value + shot.noise * gauss(*rng), 0.0, 255.0)) / 255);
    }
  Picture picture;
  picture.red = picture.green = picture.blue = grey;
  return picture;
}

struct Photographs {
  std::vector<View> views;
  std::vector<TagPatch> patches;
};

Photographs photograph(int count, int seed, const Shot& shot = {}, bool lens = true) {
  std::mt19937 rng{unsigned(seed)};
  const TagSquare tag = true_square(seed % 50);
  Photographs out;
  for (int v = 0; v < count; ++v) {
    out.views.push_back(look(tag, &rng, lens));
    for (TagPatch& p : tag_patches(draw(out.views.back(), tag, shot, &rng), v))
      out.patches.push_back(std::move(p));
  }
  return out;
}

TEST(TagSquare, IsMeasuredThroughTheLensWithAnHonestSigma) {
  constexpr int kSeeds = 10;
  double squares = 0, stated = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Photographs p = photograph(12, seed);
    ASSERT_GE(p.patches.size(), 10u);
    const std::vector<TagSquare> tags = fit_tags(p.views, p.patches);
    ASSERT_EQ(tags.size(), 1u);
    const TagSquare truth = true_square(seed % 50);
    EXPECT_EQ(tags[0].id, truth.id);
    const double error = tags[0].side / kSide - 1, sigma = tags[0].sigma / tags[0].side;
    EXPECT_LT(std::abs(error), 1e-3);
    EXPECT_LT(std::abs(error), 5 * sigma);
    EXPECT_LT((tags[0].centre - truth.centre).norm(), 2e-3 * kSide);
    EXPECT_LT((tags[0].axes - truth.axes).norm(), 4e-3);
    EXPECT_LT(tags[0].rms_px, 0.1);
    squares += error * error;
    stated += sigma * sigma;
  }
  const double ratio = std::sqrt(squares / stated);
  std::printf("rms error %.3g, stated %.3g\n", std::sqrt(squares / kSeeds),
              std::sqrt(stated / kSeeds));
  EXPECT_GT(ratio, 1 / 2.0);
  EXPECT_LT(ratio, 2.0);
}

// Ink that spreads, light that floods, a camera with a curve of its own.
TEST(TagSquare, DoesNotGrowWithBroaderBlack) {
  Shot ink, curve;
  ink.broader_px = 0.4;
  curve.by_gamma = false;
  for (const Shot& shot : {ink, curve}) {
    const Photographs p = photograph(10, 3, shot);
    const std::vector<TagSquare> tags = fit_tags(p.views, p.patches);
    ASSERT_EQ(tags.size(), 1u);
    EXPECT_NEAR(tags[0].side / kSide, 1, 1e-3);
  }
}

// In all pictures alike, so that no scatter between them would tell.
TEST(TagSquare, DoesNotGrowInAHalfShadow) {
  Shot shot;
  shot.shadow = 0.5;
  const Photographs p = photograph(12, 3, shot);
  const std::vector<TagSquare> tags = fit_tags(p.views, p.patches);
  ASSERT_EQ(tags.size(), 1u);
  const double error = std::abs(tags[0].side / kSide - 1);
  EXPECT_LT(error, 2e-4);
  EXPECT_LT(error, 3 * tags[0].sigma / kSide);
}

TEST(TagSquare, LeavesOutViewsThatSayOtherwise) {
  Photographs p = photograph(10, 4);
  const double good = fit_tags(p.views, p.patches).at(0).side;
  p.views[2].cam_from_world.translation += Vector3d(0.2, 0, 0);
  p.views[7].cam_from_world.translation += Vector3d(0, 0, 0.012);
  const TagSquare tag = fit_tags(p.views, p.patches).at(0);
  EXPECT_EQ(tag.views, int(p.patches.size()) - 2);
  EXPECT_NEAR(tag.side / good, 1, 1e-3);
}

TEST(TagSquare, NeedsThreeViews) {
  const Photographs p = photograph(2, 5);
  ASSERT_EQ(p.patches.size(), 2u);
  EXPECT_TRUE(fit_tags(p.views, p.patches).empty());
}

TEST(TagSquare, CopiesAgreeOnOneSide) {
  TagSquare a, b;
  a.side = 2, a.sigma = 0.01;
  b.side = 2.03, b.sigma = 0.03;
  const TagSide both = common_side({a, b});
  EXPECT_NEAR(both.side, 2.003, 1e-9);
  EXPECT_NEAR(both.sigma, 0.01 * std::sqrt(0.9), 1e-9);
  b.side = 2.6;
  EXPECT_GT(common_side({a, b}).sigma, 0.1) << "they do not";
}

TEST(TagSquare, EdgelsOnItAreLeftOut) {
  std::mt19937 rng(1);
  const TagSquare tag = true_square(1);
  const View view = look(tag, &rng, false);
  EdgelMap map;
  map.width = view.camera.width, map.height = view.camera.height;
  map.chain = {0};
  int outside = 0;
  // Lines across it, from far left to far right.
  for (double down = -0.9; down <= 0.91; down += 0.2) {
    for (double right = -1.5; right <= 1.5; right += 0.01) {
      double depth;
      const Vector2d p = view.project(tag.at(right, down), &depth);
      Edgel e;
      e.x = float(p.x()), e.y = float(p.y()), e.nx = 1;
      map.edgels.push_back(e);
      outside += std::abs(right) > 0.8 || std::abs(down) > 0.8;
    }
    map.chain.push_back(int(map.edgels.size()));
    map.meaning.push_back(float(down));
  }
  const EdgelMap rest = without_tags(map, view, {tag});
  EXPECT_GE(int(rest.edgels.size()), outside);
  EXPECT_EQ(int(rest.meaning.size()), rest.num_chains());
  const Vector2d x_axis = [&] {
    double depth;
    return view.project(tag.at(0, 0), &depth);
  }();
  for (const Edgel& e : rest.edgels) EXPECT_GT((Vector2d(e.x, e.y) - x_axis).norm(), 20);
  EXPECT_EQ(without_tags(map, view, {}).edgels.size(), map.edgels.size());
}

}  // namespace
}  // namespace sketchsplat
