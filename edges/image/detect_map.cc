// SPDX-License-Identifier: MIT
#include "edges/image/detect_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "datasets/types/median.h"
#include "edges/image/chain.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

// Edges are few: if most of the map is bright, it is drawn black on white.
bool is_inverted(const Image<float>& map) {
  double sum = 0;
  for (float v : map.data) sum += v;
  return sum > 0.5 * double(map.data.size());
}

// Ridge point of the quadratic through the 3 x 3 logarithms: exact for a Gaussian profile.
bool localise(const cv::Mat1f& m, const cv::Mat1f& log, int x, int y, Edgel* e) {
  const float *a = log[y - 1] + x, *b = log[y] + x, *c = log[y + 1] + x;
  const float gx = 0.5f * (b[1] - b[-1]), gy = 0.5f * (c[0] - a[0]);
  const float xx = b[1] - 2 * b[0] + b[-1], yy = c[0] - 2 * b[0] + a[0];
  const float xy = 0.25f * (c[1] - c[-1] - a[1] + a[-1]);
  const float angle = 0.5f * std::atan2(2 * xy, xx - yy);  // of the larger eigenvalue
  const float nx = -std::sin(angle), ny = std::cos(angle);
  const float bend = xx * nx * nx + 2 * xy * nx * ny + yy * ny * ny;
  if (!(bend < -0.02f)) return false;  // flatter than a ridge of 7 px
  const float shift = -(gx * nx + gy * ny) / bend;
  if (std::abs(shift * nx) > 0.6f || std::abs(shift * ny) > 0.6f) return false;
  e->x = x + shift * nx, e->y = y + shift * ny;
  e->nx = nx, e->ny = ny;
  e->strength = m(y, x);
  e->width = 1 / std::sqrt(-bend);
  return true;
}

}  // namespace

EdgelMap detect_ridges(const Image<float>& map, const MapOptions& options) {
  EdgelMap out;
  out.width = map.width, out.height = map.height;
  if (map.width < 3 || map.height < 3) return out;
  const cv::Mat1f bright = is_inverted(map) ? cv::Mat1f(1 - mat_of(map)) : mat_of(map);
  cv::Mat1f m;
  cv::GaussianBlur(bright, m, cv::Size(), options.sigma_px, options.sigma_px, cv::BORDER_REPLICATE);
  cv::Mat1f log;
  cv::log(cv::max(m, 1e-4f), log);
  Candidates c;
  c.at = Image<int>(map.width, map.height, -1);
  std::vector<float> strength;
  for (int y = 1; y + 1 < m.rows; ++y)
    for (int x = 1; x + 1 < m.cols; ++x) {
      Edgel e;
      if (m(y, x) < 1.f / 255 || !localise(m, log, x, y, &e)) continue;
      c.at.at(x, y) = int(c.edgels.size());
      c.edgels.push_back(e);
      strength.push_back(e.strength);
    }
  if (strength.empty()) return out;
  const float top = quantile(std::move(strength), 0.99);
  const float low = float(options.low) * top;
  for (int& k : c.at.data)
    if (k >= 0 && c.edgels[k].strength < low) k = -1;
  chain_edgels(c, float(options.high) * top, options.min_chain, false, &out);
  return out;
}

}  // namespace sketchsplat
