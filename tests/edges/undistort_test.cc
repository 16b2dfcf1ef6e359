// SPDX-License-Identifier: MIT
#include "edges/image/undistort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace sketchsplat {
namespace {

using Eigen::Vector2d;

View view_with(double k1, double p1) {
  View view;
  view.camera = {400, 300, 320, 330, 201, 148};
  Lens::Terms terms;
  terms.k1 = k1, terms.p1 = p1, terms.k2 = 0.02;
  view.lens = Lens(LensModel::kOpencv, terms);
  return view;
}

// White where the ideal pixel lies beyond the line n.p = c, as the lens draws it: an image pixel
// is the mean of 16 places in it.
Picture bent_step(const View& view, const Vector2d& n, double c) {
  Picture p;
  p.red = Image<float>(view.camera.width, view.camera.height);
  for (int y = 0; y < p.height(); ++y)
    for (int x = 0; x < p.width(); ++x)
      for (int k = 0; k < 16; ++k) {
        Vector2d ideal;
        view.ideal_pixel({x + (k % 4 - 1.5) / 4, y + (k / 4 - 1.5) / 4}, &ideal);
        p.red.at(x, y) += (n.dot(ideal) > c ? 0.7f : 0.3f) / 16;
      }
  p.green = p.blue = p.red;
  return p;
}

TEST(Undistort, EdgelsOfABentLineLieOnTheStraightOne) {
  for (const double k1 : {-0.25, 0.2}) {
    const View view = view_with(k1, 0.003);
    const Vector2d n(0.6, 0.8);
    const double c = n.dot(Vector2d(70, 60));  // far from the axis
    const EdgelMap found = detect_edges(bent_step(view, n, c), {});
    EdgelMap map = undistort_edgels(found, view, 6);
    build_lookup(&map);
    ASSERT_GT(map.edgels.size(), 100u);
    double bent = 0, straight = 0, turned = 0, kept = 0;
    for (const Edgel& e : found.edgels) {
      bent = std::max(bent, std::abs(n.x() * e.x + n.y() * e.y - c));
      turned += std::pow(n.x() * e.ny - n.y() * e.nx, 2) / found.edgels.size();
    }
    for (const Edgel& e : map.edgels) {
      Vector2d image;
      view.image_pixel({e.x, e.y}, &image);
      if (image.minCoeff() < 4) continue;  // the image goes on as it ends
      straight = std::max(straight, std::abs(n.x() * e.x + n.y() * e.y - c));
      kept += std::pow(n.x() * e.ny - n.y() * e.nx, 2) / map.edgels.size();
      EXPECT_GT(n.x() * e.nx + n.y() * e.ny, 0.99);
      EXPECT_NEAR(std::hypot(e.nx, e.ny), 1, 1e-6);
    }
    EXPECT_GT(bent, 3);
    EXPECT_LT(straight, 0.12);
    EXPECT_GT(std::sqrt(turned), 0.03);
    EXPECT_LT(std::sqrt(kept), 0.015);
    const Edgel& near = map.edgels[map.nearest_at(map.edgels[9].x, map.edgels[9].y)];
    EXPECT_LT(std::hypot(near.x - map.edgels[9].x, near.y - map.edgels[9].y), 1) << "ideal pixels";
  }
}

TEST(Undistort, StrengthAndWidthAreThoseOfAnImageWithoutTheLens) {
  View view = view_with(-0.3, 0);
  const Vector2d ideal(20, 148);  // left of the axis: along x the image is smaller
  Vector2d image;
  Eigen::Matrix2d J;
  ASSERT_TRUE(view.image_pixel(ideal, &image, &J));
  EdgelMap found;
  found.width = 400, found.height = 300, found.noise = 0.01f;
  Edgel e;
  e.x = float(image.x()), e.y = float(image.y());
  e.nx = 1, e.strength = 0.2f, e.width = 1;
  found.edgels = {e};
  found.chain = {0, 1};
  const EdgelMap map = undistort_edgels(found, view, 1);
  ASSERT_EQ(map.edgels.size(), 1u);
  EXPECT_NEAR(map.edgels[0].x, 20, 1e-4);
  EXPECT_NEAR(map.edgels[0].width, 1 / J(0, 0), 1e-5);
  EXPECT_GT(map.edgels[0].width, 1.2);
  EXPECT_NEAR(map.edgels[0].strength, 0.2 * J(0, 0), 1e-6);
  EXPECT_EQ(map.noise, 0.01f);
  const EdgelMap back = distort_edgels(map, view);
  EXPECT_NEAR(back.edgels[0].x, e.x, 1e-4);
  EXPECT_NEAR(back.edgels[0].y, e.y, 1e-4);
  EXPECT_NEAR(back.edgels[0].nx, 1, 1e-6);
  EXPECT_NEAR(back.edgels[0].width, 1, 1e-5);
}

TEST(Undistort, WithoutDistortionNotABitChanges) {
  View view = view_with(-0.3, 0);
  const EdgelMap found = detect_edges(bent_step(view, {1, 0}, 90.3), {});
  view.lens = Lens();
  const EdgelMap same = undistort_edgels(found, view, 6);
  ASSERT_EQ(same.edgels.size(), found.edgels.size());
  for (size_t i = 0; i < same.edgels.size(); ++i)
    EXPECT_EQ(std::memcmp(&same.edgels[i].x, &found.edgels[i].x, 6 * sizeof(float)), 0);
  EXPECT_EQ(same.chain, found.chain);
}

TEST(Undistort, EdgelsBeyondTheRangeAreDroppedAndCutTheirChain) {
  const View view = view_with(-0.9, 0);  // draws nothing beyond 0.6 or so
  EdgelMap found;
  found.width = 400, found.height = 300;
  for (int x = 0; x < 400; ++x) {
    Edgel e;
    e.x = float(x), e.y = 150, e.ny = 1, e.strength = 0.1f, e.width = 1;
    found.edgels.push_back(e);
  }
  found.chain = {0, 400};
  const EdgelMap map = undistort_edgels(found, view, 6);
  ASSERT_EQ(map.num_chains(), 1);
  EXPECT_GT(map.edgels.size(), 100u);
  EXPECT_LT(map.edgels.size(), 300u);
  for (const Edgel& e : map.edgels) EXPECT_LT(std::abs(e.x - 201), 320 * view.lens.range());
}

TEST(Undistort, AFisheyeDoesNotMakeAnEndlessPicture) {
  View view;
  view.camera = {640, 640, 204, 204, 319.5, 319.5};  // 180 degrees across
  view.lens = Lens(LensModel::kOpencvFisheye, {});
  EdgelMap found;
  found.width = found.height = 640;
  for (int x = 0; x < 640; ++x) {
    Edgel e;
    e.x = float(x), e.y = 320, e.ny = 1, e.strength = 0.1f, e.width = 1;
    found.edgels.push_back(e);
  }
  found.chain = {0, 640};
  const EdgelMap map = undistort_edgels(found, view, 6);
  EXPECT_GT(map.edgels.size(), 400u);
  EXPECT_LT(map.window_width, 4 * 640);
}

TEST(Undistort, PicturesAreResampledToThePinholeByTheirMask) {
  const View view = view_with(-0.25, 0.003);
  const Vector2d n(0.6, 0.8);
  const double c = n.dot(Vector2d(70, 60));
  Picture bent = bent_step(view, n, c);
  const Picture straight = undistort_picture(bent, view);
  for (int y = 8; y < 292; y += 7)
    for (int x = 8; x < 392; x += 7) {
      const double d = n.dot(Vector2d(x, y)) - c;
      if (std::abs(d) < 2) continue;
      EXPECT_NEAR(straight.red.at(x, y), d > 0 ? 0.7 : 0.3, 1e-5);
    }
  // The mask cuts at the same line, and what is black outside does not darken its edge.
  bent.alpha = bent.red;
  for (size_t i = 0; i < bent.alpha.data.size(); ++i) {
    bent.alpha.data[i] = (bent.red.data[i] - 0.3f) / 0.4f;
    for (Image<float>* colour : {&bent.red, &bent.green, &bent.blue})
      colour->data[i] = bent.alpha.data[i] > 0 ? 0.7f : 0;
  }
  const Picture masked = undistort_picture(bent, view);
  for (size_t i = 0; i < masked.alpha.data.size(); ++i) {
    if (masked.alpha.data[i] > 1e-3f) {
      ASSERT_NEAR(masked.red.data[i], 0.7, 1e-3);
    }
  }
  EXPECT_NEAR(masked.alpha.at(300, 250), 1, 1e-5);
  EXPECT_NEAR(masked.alpha.at(40, 20), 0, 1e-5);
}

}  // namespace
}  // namespace sketchsplat
