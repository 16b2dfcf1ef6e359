// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

SynthesizeOptions small(const std::string& part, Style style) {
  SynthesizeOptions options;
  options.part = part;
  options.rig.views = 3;
  options.rig.resolution = 120;
  options.rig.object_size = 0.6;
  options.render.style = style;
  return options;
}

// Steps between neighbours that see one face, in grey levels, of all views.
std::vector<double> steps_within_faces(const SynthesizeOptions& options) {
  const SyntheticScene scene = synthesize(options);
  std::vector<double> steps;
  for (size_t k = 0; k < scene.views.size(); ++k) {
    const RenderedView view = render_view(scene, int(k));
    const auto whole = [&](int x, int y) { return view.mask.at(x, y) == 1; };
    const auto normal = [&](int x, int y) {
      return Vector3f(view.normal_x.at(x, y), view.normal_y.at(x, y), view.normal_z.at(x, y));
    };
    for (int y = 2; y + 2 < view.mask.height; ++y)
      for (int x = 2; x + 2 < view.mask.width; ++x) {
        bool flat = true;
        for (int v = y - 2; v <= y + 2; ++v)
          for (int u = x - 2; u <= x + 2; ++u)
            flat &= whole(u, v) && (normal(u, v) - normal(x, y)).norm() < 1e-3;
        if (flat)
          steps.push_back(255 *
                          std::abs(view.picture.red.at(x + 1, y) - view.picture.red.at(x, y)));
      }
  }
  return steps;
}

double share_above(const std::vector<double>& steps, double level) {
  return double(std::count_if(steps.begin(), steps.end(), [&](double s) { return s > level; })) /
         double(steps.size());
}

double mean_grey(const SynthesizeOptions& options) {
  const Picture picture = render(synthesize(options), 0);
  double sum = 0, weight = 0;
  for (size_t i = 0; i < picture.red.data.size(); ++i) {
    sum += 255 * picture.red.data[i] * picture.alpha.data[i];
    weight += picture.alpha.data[i];
  }
  return sum / weight;
}

TEST(Textured, StrengthNothingIsPlainToTheByte) {
  SynthesizeOptions options = small("box-hole", Style::kTextured);
  options.render.texture_strength = 0;
  EXPECT_EQ(render(synthesize(options), 1).red.data,
            render(synthesize(small("box-hole", Style::kPlain)), 1).red.data);
}

TEST(Textured, FlatFacesHaveCrispStepsWhoseContrastGrowsWithStrength) {
  SynthesizeOptions options = small("box", Style::kTextured);
  const double full = share_above(steps_within_faces(options), 20);
  options.render.texture_strength = 0.25;
  const double faint = share_above(steps_within_faces(options), 20);
  const double seen = share_above(steps_within_faces(options), 4);
  EXPECT_GT(full, 0.05);
  EXPECT_LT(faint, 0.3 * full);
  EXPECT_GT(seen, 0.05);
  EXPECT_EQ(share_above(steps_within_faces(small("box", Style::kPlain)), 4), 0);
}

// The picture of one place is the same from everywhere: the print sits on the object.
TEST(Textured, PrintStandsStillOnTheObject) {
  SynthesizeOptions options = small("box", Style::kTextured);
  options.rig.kind = RigKind::kOneSided;
  options.rig.spread_deg = 25;
  options.rig.resolution = 300;
  const SyntheticScene scene = synthesize(options);
  const RenderedView a = render_view(scene, 0), b = render_view(scene, 2);
  int same = 0, all = 0;
  for (int y = 0; y < 300; y += 2)
    for (int x = 0; x < 300; x += 2) {
      if (a.depth.at(x, y) == 0) continue;
      const View& from = scene.views[0];
      const Vector3d point =
          from.cam_from_world.inverse() * Vector3d(from.camera.ray({x, y}) * a.depth.at(x, y));
      double depth;
      const Eigen::Vector2d p = scene.views[2].project(point, &depth);
      const int u = int(std::lround(p.x())), v = int(std::lround(p.y()));
      if (u < 0 || v < 0 || u > 299 || v > 299 || std::abs(b.depth.at(u, v) - depth) > 0.02)
        continue;
      ++all;
      same += std::abs(a.picture.red.at(x, y) - b.picture.red.at(u, v)) < 8.0f / 255;
    }
  ASSERT_GT(all, 500);
  EXPECT_GT(double(same) / all, 0.75);  // the rest lies on borders of the print
}

// Stone, not paint: whose face a place is does not matter, nor, in even light, how it is turned.
TEST(Speckled, SpotsRunOnOverEdges) {
  EXPECT_GT(share_above(steps_within_faces(small("box", Style::kSpeckled)), 20), 0.02);
  const SyntheticScene scene = synthesize(small("box", Style::kSpeckled));
  const Shader shader(scene.tracer, nullptr, {Style::kSpeckled, 1, 1}, 1, scene.lift);
  float low = 10, high = 0;
  for (int i = 0; i < 200; ++i) {
    SurfacePoint s;
    s.point = Vector3f(-0.5f + 0.005f * float(i), 0.2f, 0.3f);
    s.to_eye = Vector3f(0, 0.6f, 0.8f);
    s.normal = s.facet_normal = Vector3f::UnitY();
    const float on_one = shader.object(s, 0, 0);
    s.normal = s.facet_normal = Vector3f::UnitZ();
    s.face = 1;
    EXPECT_EQ(shader.object(s, 0, 0), on_one);
    low = std::min(low, on_one), high = std::max(high, on_one);
  }
  EXPECT_LT(low, 0.8f * high);
}

TEST(EvenLight, TakesTheContrastBetweenFaces) {
  double spread[3];
  for (int k = 0; k < 3; ++k) {
    SynthesizeOptions options = small("l-bracket", Style::kPlain);
    options.render.even_light = 0.5 * k;
    const RenderedView view = render_view(synthesize(options), 0);
    float low = 1, high = 0;
    for (size_t i = 0; i < view.mask.data.size(); ++i)
      if (view.mask.data[i] == 1) {
        low = std::min(low, view.picture.red.data[i]);
        high = std::max(high, view.picture.red.data[i]);
      }
    spread[k] = 255 * (high - low);
  }
  EXPECT_GT(spread[0], 20);
  EXPECT_LT(spread[1], 0.8 * spread[0]);
  EXPECT_GT(spread[1], 0.2 * spread[0]);
  EXPECT_LT(spread[2], 1);
}

TEST(Dark, IsAFewTensOfGreyLevelsAndItsFacesStillDiffer) {
  const double dark = mean_grey(small("box", Style::kDark));
  EXPECT_GT(dark, 15);
  EXPECT_LT(dark, 60);
  EXPECT_GT(mean_grey(small("box", Style::kPlain)), 3 * dark);
}

// A matt face looks the same from everywhere, a glossy one does not.
TEST(Glossy, LightOfAPlaceDependsOnTheEye) {
  const SyntheticScene scene = synthesize(small("box", Style::kPlain));
  SurfacePoint s;
  s.point = Vector3f(0, 0, 0.5f);
  s.normal = s.facet_normal = Vector3f::UnitZ();
  for (Style style : {Style::kPlain, Style::kGlossy}) {
    const Shader shader(scene.tracer, nullptr, {style, 1, 0}, 1, scene.lift);
    float low = 10, high = 0;
    for (int i = 0; i < 360; ++i) {
      const float a = float(i * M_PI / 180);
      for (float tilt : {0.3f, 0.7f, 1.1f}) {
        s.to_eye =
            Vector3f(std::sin(tilt) * std::cos(a), std::sin(tilt) * std::sin(a), std::cos(tilt));
        const float light = shader.object(s, 0, 0);
        low = std::min(low, light);
        high = std::max(high, light);
      }
    }
    if (style == Style::kPlain) {
      EXPECT_EQ(low, high);
    } else {
      EXPECT_GT(high, 2 * low);
    }
  }
}

TEST(Shadowed, ShadowsFallOnFlatFacesThatArePlainElsewhere) {
  EXPECT_EQ(share_above(steps_within_faces(small("l-bracket", Style::kPlain)), 4), 0);
  EXPECT_GT(share_above(steps_within_faces(small("l-bracket", Style::kShadowed)), 4), 0.002);
  EXPECT_EQ(share_above(steps_within_faces(small("box", Style::kShadowed)), 4), 0)
      << "a convex part shadows itself";
}

TEST(Clutter, FillsThePictureBehindTheObjectAndChangesNothingInFront) {
  SynthesizeOptions options = small("box-hole", Style::kPlain);
  const RenderedView plain = render_view(synthesize(options), 0);
  options.render.clutter = true;
  const SyntheticScene scene = synthesize(options);
  const RenderedView view = render_view(scene, 0);
  EXPECT_TRUE(view.picture.alpha.empty());
  EXPECT_EQ(view.depth.data, plain.depth.data);
  double mean = 0, square = 0;
  int behind = 0;
  for (size_t i = 0; i < view.mask.data.size(); ++i) {
    // Six by six rays or one where clutter borders on clutter: not the same to the bit.
    EXPECT_NEAR(view.mask.data[i], plain.mask.data[i], 0.03);
    if ((view.mask.data[i] == 1) != (plain.mask.data[i] == 1)) continue;
    const double grey = 255 * view.picture.red.data[i];
    if (view.mask.data[i] == 1) {
      EXPECT_NEAR(grey, 255 * plain.picture.red.data[i], 0.01);
    } else if (view.mask.data[i] == 0) {
      EXPECT_GT(grey, 5);
      mean += grey;
      square += grey * grey;
      ++behind;
    }
  }
  mean /= behind;
  EXPECT_GT(std::sqrt(square / behind - mean * mean), 10);
}

// Nothing of it comes between a camera and the object, for whatever distance and seed.
TEST(Clutter, NeverHidesTheObject) {
  for (std::uint64_t seed : {1, 2, 3})
    for (double distance : {1.6, 4.0, 40.0}) {
      SynthesizeOptions options = small("box", Style::kPlain);
      options.seed = seed;
      options.rig.views = 40;
      options.rig.distance = distance;
      options.render.clutter = true;
      const SyntheticScene scene = synthesize(options);
      for (const View& view : scene.unit_views) {
        const Vector3f eye = view.center_in_world().cast<float>();
        EXPECT_FALSE(scene.clutter->tracer.blocked(eye, Vector3f::Zero()));
        EXPECT_TRUE(scene.clutter->tracer.blocked(eye, -100 * eye));
      }
    }
}

TEST(Rig, OneSidedCamerasStandInACone) {
  RigOptions options;
  options.kind = RigKind::kOneSided;
  options.spread_deg = 20;
  options.views = 60;
  const std::vector<View> views = make_rig(options, 3);
  Vector3d mean = Vector3d::Zero();
  for (const View& view : views) mean += view.center_in_world().normalized();
  mean.normalize();
  double widest = 0;
  for (const View& view : views)
    widest = std::max(widest, std::acos(mean.dot(view.center_in_world().normalized())));
  EXPECT_NEAR(widest * 180 / M_PI, 20, 1.5);
  EXPECT_NEAR(std::asin(mean.z()) * 180 / M_PI, 35, 2);
}

TEST(Rig, RandomCamerasLookEverywhereAndObjectSizeIsWhatItSays) {
  RigOptions options;
  options.kind = RigKind::kRandom;
  options.views = 400;
  options.object_size = 0.5;
  Vector3d mean = Vector3d::Zero();
  for (const View& view : make_rig(options, 3)) {
    mean += view.center_in_world().normalized() / options.views;
    EXPECT_NEAR(view.camera.fx / resolved(options, false).distance, 0.5 * options.resolution, 1e-9);
  }
  EXPECT_LT(mean.norm(), 0.1);
}

}  // namespace
}  // namespace sketchsplat
