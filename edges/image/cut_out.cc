// SPDX-License-Identifier: MIT
#include "edges/image/cut_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
// The graph of cv::grabCut, which itself can neither be told what other pictures know nor have
// colours that are no mixture of five.
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "datasets/types/parallel.h"
#include "edges/image/colours.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

constexpr int kLeastSurroundings = 8;  // [px]
constexpr uint8_t kLikely = 2;
constexpr double kSmooth = 10;  // [nat] that a cut between two pixels of one colour costs
constexpr double kNever = 1e3;  // [nat]
constexpr double kOwn = 0.5;    // of the colours, those of the picture itself

// The part of a picture about where the object may be; coordinates are its own.
struct Part {
  cv::Rect box;  // empty: the picture is left out
  Picture picture;
  Image<int> bin;
  Image<uint8_t> maybe, object;
  Colours on_object, around;  // of this picture alone
};

Picture cut(const Picture& from, const cv::Rect& box) {
  const auto channel = [&](const Image<float>& c) {
    return cut(c, box.x, box.y, box.width, box.height);
  };
  Picture out;
  out.red = channel(from.red), out.green = channel(from.green), out.blue = channel(from.blue);
  return out;
}

Part part_of(const Picture& picture, const Image<uint8_t>& maybe) {
  Part part;
  if (maybe.empty()) return part;
  const cv::Mat1b inside = mat_of(maybe);
  const cv::Rect box = cv::boundingRect(inside);
  const int around =
      std::max(kLeastSurroundings, int(kAroundObject * std::max(box.width, box.height)));
  const cv::Rect wide =
      cv::Rect(box.x - around, box.y - around, box.width + 2 * around, box.height + 2 * around) &
      cv::Rect(0, 0, maybe.width, maybe.height);
  const int may = cv::countNonZero(inside);
  if (may < kFewestColoured || wide.area() - may < kFewestColoured) return part;
  part.box = wide;
  part.picture = cut(picture, wide);
  part.bin = Colours::bins_of(part.picture);
  part.maybe = part.object = cut(maybe, wide.x, wide.y, wide.width, wide.height);
  const int first = cv::countNonZero(inside == kLikely) < kFewestColoured ? 1 : kLikely;
  for (uint8_t& here : part.object.data) here = here >= first;
  return part;
}

void learn_colours(Part* part) {
  part->on_object = part->around = Colours();
  for (size_t i = 0; i < part->bin.data.size(); ++i)
    (part->object.data[i] ? part->on_object : part->around).add(part->bin.data[i]);
}

// Squared difference of two neighbours' colours.
class Contrast {
 public:
  explicit Contrast(const Picture& picture) : p_(picture) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < p_.height(); ++y)
      for (int x = 0; x < p_.width(); ++x) {
        if (x > 0) sum += between(x, y, x - 1, y), ++n;
        if (y > 0) sum += between(x, y, x, y - 1), ++n;
      }
    beta_ = sum > 0 ? n / (2 * sum) : 0;
  }
  double cost_of_cut(int x, int y, int u, int v) const {
    return kSmooth * std::exp(-beta_ * between(x, y, u, v)) / std::hypot(x - u, y - v);
  }

 private:
  double between(int x, int y, int u, int v) const {
    double out = 0;
    for (const Image<float>* c : {&p_.red, &p_.green, &p_.blue}) {
      const double d = c->at(x, y) - c->at(u, v);
      out += d * d;
    }
    return out;
  }
  const Picture& p_;
  double beta_ = 0;
};

// The least dear cut through a part of a picture; `nats`: that a pixel is the object's.
template <typename Nats>
void cut_part(const Nats& nats, Part* part) {
  const int w = part->box.width, h = part->box.height;
  const Contrast contrast(part->picture);
  constexpr std::array<std::array<int, 2>, 4> kBefore = {{{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  cv::detail::GCGraph<double> graph(unsigned(w * h), unsigned(2 * kBefore.size() * w * h));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int here = graph.addVtx();
      const double n = part->maybe.at(x, y) ? nats(part->bin.at(x, y)) : -kNever;
      graph.addTermWeights(here, std::max(0.0, n), std::max(0.0, -n));
      for (const auto& [dx, dy] : kBefore) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= w) continue;
        const double cost = contrast.cost_of_cut(x, y, u, v);
        graph.addEdges(here, v * w + u, cost, cost);
      }
    }
  graph.maxFlow();
  for (int i = 0; i < w * h; ++i) part->object.data[size_t(i)] = graph.inSourceSegment(i);
}

void cut_again(std::vector<Part>* parts) {
  Colours on_object, around;
  parallel_for(int(parts->size()), 1, [&](int k) {
    if (!(*parts)[size_t(k)].box.empty()) learn_colours(&(*parts)[size_t(k)]);
  });
  for (const Part& part : *parts) on_object.add(part.on_object), around.add(part.around);
  on_object.spread(), around.spread();
  parallel_for(int(parts->size()), 1, [&](int k) {
    Part& part = (*parts)[size_t(k)];
    if (part.box.empty()) return;
    part.on_object.spread(), part.around.spread();
    const auto share = [](const Colours& own, const Colours& all, int bin) {
      return kOwn * own.share(bin) + (1 - kOwn) * all.share(bin);
    };
    cut_part(
        [&](int bin) {
          return nats_of(share(part.on_object, on_object, bin), share(part.around, around, bin));
        },
        &part);
  });
}

}  // namespace

std::vector<Image<uint8_t>> cut_out(const std::vector<const Picture*>& pictures,
                                    const std::vector<Image<uint8_t>>& maybe, int rounds) {
  std::vector<Part> parts(pictures.size());
  parallel_for(int(parts.size()), 1,
               [&](int k) { parts[size_t(k)] = part_of(*pictures[size_t(k)], maybe[size_t(k)]); });
  for (int round = 0; round < rounds; ++round) cut_again(&parts);
  std::vector<Image<uint8_t>> out(parts.size());
  for (size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    if (part.box.empty()) continue;
    out[k] = Image<uint8_t>(maybe[k].width, maybe[k].height);
    mat_of(part.object).copyTo(mat_of(out[k])(part.box));
  }
  return out;
}

}  // namespace sketchsplat
