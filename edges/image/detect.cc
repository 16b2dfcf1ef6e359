// SPDX-License-Identifier: MIT
// Canny, J.: A computational approach to edge detection, PAMI 1986 (smoothing, hysteresis);
// Immerkaer, J.: Fast noise variance estimation, CVIU 1996 (the mask; here with a median).
#include "edges/image/detect.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "datasets/types/median.h"
#include "edges/image/chain.h"
#include "edges/image/coarser.h"
#include "edges/image/gradient.h"
#include "edges/image/mats.h"
#include "edges/image/meaningful.h"
#include "edges/image/sharpen.h"

namespace sketchsplat {
namespace {

// Grey levels of 255 per px: where an edge starts, and down to where it goes on, without noise,
// see steps_left.
constexpr double kHighFloor = 1.5, kLowFloor = 0.6;
constexpr double kScale = M_SQRT2;  // from one scale to the next coarser one
constexpr double kPedestal = 0.5;  // contrast between object and background where alpha is the mask

// The part of the picture that can hold edges, as one channel.
struct Composite {
  cv::Mat1f grey, alpha;
  cv::Mat1f value;   // alpha * (grey + pedestal), or, without alpha, grey itself
  cv::Mat1b inside;  // fully opaque: 255, else 0
  int x0 = 0, y0 = 0;

  // The outline is where alpha says, whatever colour hides outside it.
  void put_mask_on() { value = alpha.empty() ? grey : cv::Mat1f(alpha.mul(grey + kPedestal)); }
};

Composite composite(const Picture& picture, const DetectOptions& options) {
  Composite c;
  cv::Rect box(0, 0, picture.width(), picture.height());
  if (!picture.alpha.empty()) {
    const cv::Mat1f alpha = mat_of(picture.alpha);
    const int border = int(std::ceil(4 * options.sigma_px)) + 2;
    const cv::Rect opaque = cv::boundingRect(alpha > 0);
    if (opaque.empty()) return c;
    // An object that leaves the image does not end at its frame.
    box &= cv::Rect(opaque.x - border, opaque.y - border, opaque.width + 2 * border,
                    opaque.height + 2 * border);
    c.alpha = alpha(box).clone();
    c.inside = c.alpha >= 1;
  } else {
    c.inside = cv::Mat1b(box.size(), 255);
  }
  c.x0 = box.x, c.y0 = box.y;
  c.grey.create(box.size());
  for (int v = 0; v < box.height; ++v) {
    const float* red = picture.red.row(v + box.y) + box.x;
    const float* green = picture.green.row(v + box.y) + box.x;
    const float* blue = picture.blue.row(v + box.y) + box.x;
    float* grey = c.grey[v];
    for (int u = 0; u < box.width; ++u)
      grey[u] = 0.299f * red[u] + 0.587f * green[u] + 0.114f * blue[u];
  }
  c.put_mask_on();
  return c;
}

std::shared_ptr<const GreyPart> grey_part(const Composite& c) {
  GreyPart part;
  part.x0 = c.x0, part.y0 = c.y0;
  part.value = Image<uint16_t>(c.value.cols, c.value.rows);
  for (int y = 0; y < c.value.rows; ++y)
    std::transform(c.value[y], c.value[y] + c.value.cols, part.value.row(y), [](float v) {
      return uint16_t(int(std::clamp(v * GreyPart::kOne + 0.5f, 0.f, 65535.f)));
    });
  return std::make_shared<const GreyPart>(std::move(part));
}

float measure_noise(const cv::Mat1f& value, const cv::Mat1b& inside) {
  std::vector<float> r;
  r.reserve(size_t(value.rows) * value.cols / 2);
  for (int y = 1; y + 1 < value.rows; y += 1)
    for (int x = 1 + y % 2; x + 1 < value.cols; x += 2) {
      const float *a = value[y - 1] + x, *b = value[y] + x, *d = value[y + 1] + x;
      const uchar *ia = inside[y - 1] + x, *id = inside[y + 1] + x;
      if (!(ia[-1] && ia[1] && id[-1] && id[1])) continue;
      r.push_back(std::abs(a[-1] - 2 * a[0] + a[1] - 2 * (b[-1] - 2 * b[0] + b[1]) + d[-1] -
                           2 * d[0] + d[1]));
    }
  if (r.size() < 16) return 0;
  return median(std::move(r)) / (0.6745f * 6.f);
}

struct Noise {
  double fine = 0;    // of pixels, grey values in [0, 1]
  double coarse = 0;  // of white noise that is as strong as this in squares of 2 x 2 pixels
};

Noise measure_noise(const Composite& c) {
  cv::Mat1f value;
  cv::Mat1b inside;
  cv::resize(c.value, value, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  cv::resize(c.inside, inside, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  inside = inside == 255;
  return {measure_noise(c.value, c.inside), 2.0 * measure_noise(value, inside)};
}

// Pixels whose gradient the end of the mask makes, or that of an object which ends up to
// `beyond_px` inside of it.
cv::Mat1b outline_band(const Composite& c, double sigma_px, double beyond_px) {
  const double reach = 3 * sigma_px;
  const auto square = [](double px) {
    const int side = 2 * int(std::ceil(px)) + 1;
    return cv::Mat::ones(side, side, CV_8U);
  };
  cv::Mat1b wide, narrow;
  cv::dilate(c.inside, wide, square(reach));
  cv::erode(c.inside, narrow, square(reach + beyond_px));
  return wide & ~narrow;
}

struct Gradient {
  cv::Mat1f x, y, magnitude;
  cv::Mat1f log;  // of the magnitude: across a blurred step it is a parabola, exactly
};

Gradient gradient_of(const cv::Mat1f& value, double sigma) {
  Gradient g;
  gaussian_gradient(value, sigma, &g.x, &g.y);
  cv::magnitude(g.x, g.y, g.magnitude);
  cv::log(cv::max(g.magnitude, 1e-5f), g.log);
  return g;
}

// Maximum along the gradient of the quadratic through the 3 x 3 log magnitudes.
bool localise(const Gradient& g, int x, int y, Edgel* e) {
  const float *a = g.log[y - 1] + x, *b = g.log[y] + x, *c = g.log[y + 1] + x;
  const float m = g.magnitude(y, x);
  const float nx = g.x(y, x) / m, ny = g.y(y, x) / m;
  const float lx = 0.5f * (b[1] - b[-1]), ly = 0.5f * (c[0] - a[0]);
  const float lxx = b[1] - 2 * b[0] + b[-1], lyy = c[0] - 2 * b[0] + a[0];
  const float lxy = 0.25f * (c[1] - c[-1] - a[1] + a[-1]);
  const float slope = lx * nx + ly * ny;
  const float bend = lxx * nx * nx + 2 * lxy * nx * ny + lyy * ny * ny;
  if (!(bend < -0.02f)) return false;  // flatter than a blur of 7 px
  const float shift = -slope / bend;
  const float dx = shift * nx, dy = shift * ny;
  if (std::abs(dx) > 0.6f || std::abs(dy) > 0.6f) return false;
  e->x = x + dx, e->y = y + dy;
  e->nx = nx, e->ny = ny;
  e->strength = m * std::exp(0.5f * slope * shift);
  e->width = 1 / std::sqrt(-bend);
  return true;
}

Candidates find_candidates(const Gradient& g, float low) {
  constexpr size_t kPixels = 4;  // per edgel, in pictures of nothing but edges
  Candidates c;
  c.at = Image<int>(g.magnitude.cols, g.magnitude.rows, -1);
  c.edgels.reserve(g.magnitude.total() / kPixels);
  for (int y = 1; y + 1 < g.magnitude.rows; ++y) {
    const float* magnitude = g.magnitude[y];
    for (int x = 1; x + 1 < g.magnitude.cols; ++x) {
      Edgel e;
      if (magnitude[x] < low || !localise(g, x, y, &e)) continue;
      c.at.at(x, y) = int(c.edgels.size());
      c.edgels.push_back(e);
    }
  }
  return c;
}

float median_width(const EdgelMap& map) {
  std::vector<float> widths;
  for (const Edgel& e : map.edgels) widths.push_back(e.width);
  return median(std::move(widths));
}

void mark_outline(const Image<float>& alpha, EdgelMap* map) {
  map->mask = Image<uint8_t>(alpha.width, alpha.height);
  for (size_t i = 0; i < alpha.data.size(); ++i) map->mask.data[i] = alpha.data[i] >= 0.5f;
  for (Edgel& e : map->edgels) {
    const int x = int(std::lround(e.x - 1.5f * e.nx)), y = int(std::lround(e.y - 1.5f * e.ny));
    const bool in = x >= 0 && y >= 0 && x < alpha.width && y < alpha.height;
    e.outline = !in || !map->mask.at(x, y);  // the dark side is no object
  }
}

// Grey levels are whole numbers, so slow shading becomes steps, which thresholds have to exceed;
// but noise dithers them: on the mean the steps of a quantizer of step 1 are as high as
// exp(-2 pi^2 n^2) after noise of standard deviation n (Widrow, Kollar: Quantization noise, 2008),
// and quantizing by itself is noise of variance 1 / 12. Not so after compression, where noise is
// not white: it leaves steps of its own.
double steps_left(const Noise& noise) {
  constexpr double kWhite = 2;  // white noise has a ratio of 1, what JPEG left of it a larger one
  if (noise.coarse > kWhite * noise.fine) return 1;
  const double levels = 255 * noise.fine, own = std::max(levels * levels - 1.0 / 12, 0.0);
  return std::exp(-2 * M_PI * M_PI * own);
}

// What a picture is searched for edges with.
struct Search {
  DetectOptions options;
  double beyond_px = 0;  // see Picture
  double noise = 0;      // as if it were white, grey values in [0, 1]
  double floor = 1;      // of kHighFloor and kLowFloor
  Sharpening sharpening = {};

  double noise_left() const { return noise * sharpening.noise_left(options.sigma_px); }
  double sigma_of_gradient() const { return noise_of_gradient(noise_left(), options.sigma_px); }
};

// Edgels of one scale, in pixels of the composite.
void detect_at(const Composite& c, const Search& search, EdgelMap* map) {
  const DetectOptions& o = search.options;
  const Gradient g = gradient_of(c.value, o.sigma_px);
  const double noise = search.sigma_of_gradient(), floor = search.floor / 255;
  const float low = float(std::max(kLowFloor * floor, o.low_sigma * noise));
  const float high = float(std::max(kHighFloor * floor, o.high_sigma * noise));
  chain_edgels(find_candidates(g, low), high, o.min_chain, true, map);
  keep_meaningful(g.magnitude, outline_band(c, o.sigma_px, search.beyond_px), o.meaning, map);
}

// Coarser scales show fainter edges, for noise averages out; not where the floor was the threshold.
void detect_coarser(const Composite& c, const Search& finest, EdgelMap* map) {
  const DetectOptions& o = finest.options;
  Search at = finest;
  for (int k = 0; k < o.coarser; ++k) {
    if (o.high_sigma * at.sigma_of_gradient() < kHighFloor * at.floor / 255) return;
    at.options.sigma_px *= kScale;
    at.options.min_chain = int(std::ceil(o.min_chain * at.options.sigma_px / o.sigma_px));
    EdgelMap found;
    detect_at(c, at, &found);
    add_coarser(std::move(found), at.options.sigma_px, o.sigma_px, at.options.min_chain, map);
  }
}

EdgelMap detect_in(const Composite& c, const Picture& picture, const Search& search) {
  EdgelMap map;
  map.width = picture.width(), map.height = picture.height();
  map.noise = float(search.noise_left());
  detect_at(c, search, &map);
  detect_coarser(c, search, &map);
  for (Edgel& e : map.edgels) e.x += c.x0, e.y += c.y0;
  map.blur = median_width(map);
  if (!picture.alpha.empty()) mark_outline(picture.alpha, &map);
  return map;
}

// [px] that the camera blurred edgels by which a detector of `sigma_px` found, as this share of
// them tells; 0 if few do.
double blur_of(std::vector<float> widths, double share, double sigma_px) {
  constexpr size_t kFew = 50;
  if (widths.size() < kFew) return 0;
  const double width = quantile(std::move(widths), share);
  return std::sqrt(std::max(0.0, width * width - sigma_px * sigma_px));
}

// Makes a picture sharper in which edgels were found; false if a tenth of them say that it is
// sharp: rounds are not, and neither are edges that hide from one another. A mask that somebody
// drew, or made of a silhouette, is sharp, however blurred what it lies on is, and stays as it is.
bool sharpen_blurred(const EdgelMap& found, Search* search, Composite* c) {
  constexpr double kSharpest = 0.1, kHalf = 0.5;  // of the edgels
  const DetectOptions& o = search->options;
  if (o.most_blur_px <= 0) return false;
  std::vector<float> outline, inside;
  for (const Edgel& e : found.edgels) (e.outline ? outline : inside).push_back(e.width);
  const bool drawn = !c->alpha.empty() && blur_of(outline, kHalf, o.sigma_px) <= o.most_blur_px;
  if (!drawn) inside.insert(inside.end(), outline.begin(), outline.end());
  if (blur_of(inside, kSharpest, o.sigma_px) <= o.most_blur_px) return false;
  const double blur = blur_of(std::move(inside), kHalf, o.sigma_px);
  cv::Mat1f* what = drawn ? &c->grey : &c->value;
  search->sharpening = sharpening_of(*what, blur, search->noise, o.sigma_px);
  sharpen(search->sharpening, what);
  if (drawn) c->put_mask_on();
  return true;
}

}  // namespace

EdgelMap detect_edges(const Picture& picture, const DetectOptions& options) {
  EdgelMap map;
  map.width = picture.width(), map.height = picture.height();
  Composite c = composite(picture, options);
  if (c.value.rows < 3 || c.value.cols < 3) return map;
  const Noise noise = measure_noise(c);
  Search search = {options, picture.beyond_px, noise.fine, steps_left(noise)};
  map = detect_in(c, picture, search);
  if (sharpen_blurred(map, &search, &c)) map = detect_in(c, picture, search);
  map.grey = grey_part(c);
  return map;
}

Image<float> draw_edge_map(const EdgelMap& map, double sigma_px) {
  Image<float> out(map.width, map.height);
  const int r = int(std::ceil(3 * sigma_px));
  for (const Edgel& e : map.edgels) {
    const int cx = int(std::lround(e.x)), cy = int(std::lround(e.y));
    for (int y = std::max(0, cy - r); y <= std::min(map.height - 1, cy + r); ++y)
      for (int x = std::max(0, cx - r); x <= std::min(map.width - 1, cx + r); ++x) {
        const float across = (x - e.x) * e.nx + (y - e.y) * e.ny;
        const float along = -(x - e.x) * e.ny + (y - e.y) * e.nx;
        if (std::abs(along) > 1.f) continue;  // its own piece of the ridge, not a blob
        out.at(x, y) =
            std::max(out.at(x, y), float(std::exp(-0.5 * across * across / (sigma_px * sigma_px))));
      }
  }
  return out;
}

}  // namespace sketchsplat
