// SPDX-License-Identifier: MIT
#include "edges/image/sharpen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "edges/image/detect.h"
#include "edges/image/gradient.h"

namespace sketchsplat {
namespace {

// A vertical step from 0.3 to 0.7 at x, blurred by so much.
double step_at(double x, double blur) { return 0.5 + 0.2 * std::erf(x / (std::sqrt(2) * blur)); }

cv::Mat1f white_noise(int side, double sigma) {
  cv::Mat1f out(side, side);
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(0, sigma);
  for (float& v : out) v = float(normal(rng));
  return out;
}

TEST(Sharpen, ChangesNothingWhereNothingIsBlurred) {
  cv::Mat1f noise = white_noise(50, 0.1);
  const cv::Mat1f before = noise.clone();
  sharpen({}, &noise);
  EXPECT_LT(cv::norm(noise, before, cv::NORM_INF), 1e-5);
  EXPECT_DOUBLE_EQ(Sharpening().noise_left(1.4), 1);
}

TEST(Sharpen, LeavesOfABlurredStepOneThatIsBlurredByLess) {
  cv::Mat1f picture(40, 61);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) picture(y, x) = float(step_at(x - 30.3, 2.5));
  sharpen({2.5, 1.3, 0.02}, &picture);
  for (int x = 12; x < 49; ++x) EXPECT_NEAR(picture(20, x), step_at(x - 30.3, 1.3), 0.02) << x;
}

TEST(Sharpen, KeepsTheMeanWhateverTheNoise) {
  for (const double noise : {0.0, 1.0, 100.0}) EXPECT_EQ((Sharpening{2, 1, noise}).gain(0), 1);
  EXPECT_GT((Sharpening{2, 1, 0}).gain(0.1), (Sharpening{2, 1, 1}).gain(0.1)) << "noise holds back";
}

TEST(Sharpen, TellsWhatItMakesOfNoise) {
  const Sharpening how = {2.5, 1.3, 2};
  for (const double sigma : {1.0, 2.0}) {
    cv::Mat1f noise = white_noise(400, 0.05), x, y;
    sharpen(how, &noise);
    gaussian_gradient(noise, sigma, &x, &y);
    const double measured = std::sqrt((x.dot(x) + y.dot(y)) / (2.0 * double(noise.total())));
    const double told = noise_of_gradient(0.05 * how.noise_left(sigma), sigma);
    EXPECT_NEAR(measured / told, 1, 0.06) << sigma;
  }
}

// The mean square gradient of steps tells their power.
TEST(Sharpen, HoldsBackMoreWhereStepsAreFainterOrNoiseIsStronger) {
  cv::Mat1f strong(80, 80), faint;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 80; ++x) strong(y, x) = float(step_at(x - 40.2, 2));
  faint = 0.5 * strong;
  const double much = sharpening_of(strong, 2, 0.002, 1).noise_of_steps;
  EXPECT_NEAR(sharpening_of(faint, 2, 0.002, 1).noise_of_steps / much, 4, 0.2);
  EXPECT_NEAR(sharpening_of(strong, 2, 0.004, 1).noise_of_steps / much, 4, 0.2);
  EXPECT_EQ(sharpening_of(strong, 2, 0, 1).noise_of_steps,
            sharpening_of(strong, 2, 1e-4, 1).noise_of_steps)
      << "grey levels are whole numbers";
}

TEST(Sharpen, LeavesMoreOfAStrongBlur) {
  const cv::Mat1f noise = white_noise(50, 0.1);
  EXPECT_NEAR(sharpening_of(noise, 1.5, 0.01, 1).left_px, 1.3, 1e-9);
  EXPECT_NEAR(sharpening_of(noise, 5, 0.01, 1).left_px, 3, 1e-9);
}

// Bright bars of 7 px, 40 px apart, blurred, with noise; with a mask, if asked, whose ends are
// sharp.
Picture bars(double blur, bool masked) {
  constexpr int kSide = 200;
  Picture p;
  p.red = p.green = p.blue = Image<float>(kSide, kSide);
  if (masked) p.alpha = Image<float>(kSide, kSide);
  const cv::Mat1f noise = white_noise(kSide, 2.0 / 255);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      double v = 0.3;
      for (double c = 20.3; c < kSide; c += 40)
        v += step_at(x - c + 3.5, blur) - step_at(x - c - 3.5, blur);
      p.red.at(x, y) = p.green.at(x, y) = p.blue.at(x, y) = float(v) + noise(y, x);
      if (masked) p.alpha.at(x, y) = x >= 30 && x < 170 && y >= 30 && y < 170;
    }
  return p;
}

// [px] mean distance of the edgels of the bars from where they should be, and their number.
std::pair<double, int> off_bars(const Picture& picture, double most_blur_px) {
  DetectOptions options;
  options.most_blur_px = most_blur_px;
  const EdgelMap map = detect_edges(picture, options);
  double sum = 0;
  int count = 0;
  for (const Edgel& e : map.edgels) {
    if (e.outline || e.x < 12 || e.x > 188 || e.y < 12 || e.y > 188) continue;
    if (!picture.alpha.empty() && (e.x < 40 || e.x > 160 || e.y < 40 || e.y > 160)) continue;
    const double c = 20.3 + 40 * std::round((e.x - 20.3) / 40);
    sum += std::abs(std::abs(e.x - c) - 3.5), ++count;
  }
  return {sum / count, count};
}

TEST(Sharpen, LetsEdgesOfBlurredBarsBeFoundWhereTheyAre) {
  const auto [far, seen] = off_bars(bars(2.5, false), 0);
  const auto [near, count] = off_bars(bars(2.5, false), 1);
  EXPECT_GT(far, 0.2) << "blur pushes them apart";
  EXPECT_LT(near, 0.12);
  EXPECT_GE(count, seen - 20);
}

TEST(Sharpen, MakesNoEdgesAlongAMaskThatSomebodyDrew) {
  const auto [near, count] = off_bars(bars(2.5, true), 1);
  EXPECT_LT(near, 0.12);
  EXPECT_GT(count, 600) << "of six edges, 120 px each";
}

TEST(Sharpen, SharpPicturesStayAsTheyAre) {
  const EdgelMap same = detect_edges(bars(0.7, false), {});
  DetectOptions never;
  never.most_blur_px = 0;
  const EdgelMap before = detect_edges(bars(0.7, false), never);
  ASSERT_EQ(same.edgels.size(), before.edgels.size());
  for (size_t i = 0; i < same.edgels.size(); ++i) EXPECT_EQ(same.edgels[i].x, before.edgels[i].x);
}

}  // namespace
}  // namespace sketchsplat
