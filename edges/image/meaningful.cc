// SPDX-License-Identifier: MIT
#include "edges/image/meaningful.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "edges/image/hatching.h"

namespace sketchsplat {
namespace {

constexpr double kStep = 3;         // [px] along a chain from place to place
constexpr double kCell = 24;        // [px] of the histograms; three by three make a neighbourhood
constexpr int kBins = 64;           // of the logarithm of the magnitude
constexpr double kBinsPerE = 8;     // bins per factor e
constexpr double kFirstBin = -9.2;  // logarithm of 1e-4
constexpr double kMostTurn = 100;   // [deg] change of turn per step, beyond which all are alike
constexpr double kLeastTurn = 1;    // [deg] what localisation makes of a straight edge
constexpr double kEvidence = 1.3;   // [nat] of a place, above which it lengthens a piece
constexpr double kDrop = 4;         // [nat] of evidence against that ends a piece
// Places of a chain that stand for one independent one: turns share their chords, and the strength
// of a blob is that of its whole outline.
constexpr double kTurnsPerOne = 1.5, kContrastsPerOne = 3;
constexpr double kMaxima = 4;    // edgels are maxima: the strongest of about as many pixels
constexpr double kOwnWidth = 2;  // [px] of the pixels around an edge that are as strong as it is
constexpr double kPieces = 30;   // pieces that begin at a place and end differently

// How many pixels of the neighbourhood of a place, three by three cells, are at least so strong.
class Neighbourhood {
 public:
  Neighbourhood(const cv::Mat1f& magnitude, const cv::Mat1b& outline)
      : nx_(int(magnitude.cols / kCell) + 1), ny_(int(magnitude.rows / kCell) + 1) {
    std::vector<Histogram> cells(size_t(nx_) * ny_, Histogram{});
    std::vector<int> column(magnitude.cols);
    for (int x = 0; x < magnitude.cols; ++x) column[x] = cell(x, 0);
    for (int y = 0; y < magnitude.rows; ++y) {
      Histogram* row = &cells[cell(0, y)];
      const float* here = magnitude[y];
      const uchar* leave = outline[y];
      for (int x = 0; x < magnitude.cols; ++x)
        if (!leave[x]) ++row[column[x]][bin(here[x])];
    }
    for (Histogram& c : cells)
      for (int b = kBins - 2; b >= 0; --b) c[b] += c[b + 1];
    around_.assign(cells.size(), Histogram{});
    own_.assign(cells.size(), 0);
    for (int k = 0; k < int(cells.size()); ++k)
      each_around(k, [&](int j) {
        for (int b = 0; b < kBins; ++b) around_[j][b] += cells[k][b];
      });
  }

  int cell(double x, double y) const {
    const int i = std::clamp(int(x / kCell), 0, nx_ - 1);
    return std::clamp(int(y / kCell), 0, ny_ - 1) * nx_ + i;
  }
  // The cells of the edgels of the chain that is asked about next.
  void set_own(std::vector<int> cells) {
    const auto count = [&](int sign) {
      for (const int k : own_cells_) each_around(k, [&](int j) { own_[j] += sign; });
    };
    count(-1);
    own_cells_ = std::move(cells);
    count(1);
  }
  // Share of the pixels around a cell that are at least so strong, without those of the chain
  // itself and of the outline.
  double share(int cell, float strength) const {
    const double all = around_[cell][0], strong = around_[cell][bin(strength)];
    const double mine = kOwnWidth * own_[cell];
    return (std::max(0.0, strong - mine) + 1) / (std::max(0.0, all - mine) + 1);
  }

 private:
  using Histogram = std::array<int, kBins>;  // from a bin on

  static int exact_bin(float strength) {
    const double log = std::log(std::max(strength, 1e-6f));
    return std::clamp(int((log - kFirstBin) * kBinsPerE), 0, kBins - 1);
  }
  // Most floats that begin with the same 16 bits are in one bin. Not negative.
  static int bin(float strength) {
    constexpr uint32_t kTail = 0xffff;
    static const std::vector<int8_t> common = [] {
      std::vector<int8_t> bins(1 << 15);
      for (uint32_t head = 0; head < bins.size(); ++head) {
        const uint32_t ends[2] = {head << 16, head << 16 | kTail};
        float from, to;
        std::memcpy(&from, &ends[0], sizeof from), std::memcpy(&to, &ends[1], sizeof to);
        bins[head] = int8_t(exact_bin(from) == exact_bin(to) ? exact_bin(from) : -1);
      }
      return bins;
    }();
    uint32_t bits;
    std::memcpy(&bits, &strength, sizeof bits);
    const int found = common[bits >> 16];
    return found >= 0 ? found : exact_bin(strength);
  }
  template <typename Visit>
  void each_around(int cell, const Visit& visit) const {
    const int cx = cell % nx_, cy = cell / nx_;
    for (int y = std::max(0, cy - 1); y <= std::min(ny_ - 1, cy + 1); ++y)
      for (int x = std::max(0, cx - 1); x <= std::min(nx_ - 1, cx + 1); ++x) visit(y * nx_ + x);
  }

  int nx_, ny_;
  std::vector<Histogram> around_;
  std::vector<int> own_, own_cells_;  // edgels of the chain around a cell, and where they are
};

// A place on a chain, and how unlikely [nat] it would be in texture.
struct Place {
  int edgel = 0;
  double turn = 0, contrast = 0;
  bool turns = false;  // is there a turn before and after it?
};

double degrees_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) * 180 / M_PI;
}

std::vector<Place> places_of(const EdgelMap& map, int chain, const cv::Mat1b& outline,
                             const Hatching& hatching, Neighbourhood* around) {
  const int begin = map.chain[chain], end = map.chain[chain + 1];
  std::vector<int> own;
  for (int i = begin; i < end; ++i) {
    const Edgel& e = map.edgels[i];  // maxima lie within the picture, off its last pixels
    if (!outline(int(std::lround(e.y)), int(std::lround(e.x))))
      own.push_back(around->cell(e.x, e.y));
  }
  around->set_own(std::move(own));
  std::vector<Place> out;
  std::vector<Eigen::Vector2d> at;
  double since = kStep;
  for (int i = begin; i < end; ++i) {
    const Edgel& e = map.edgels[i];
    if (i > begin) since += std::hypot(e.x - map.edgels[i - 1].x, e.y - map.edgels[i - 1].y);
    if (since < kStep) continue;
    since -= kStep;
    const double share = kMaxima * around->share(around->cell(e.x, e.y), e.strength);
    out.push_back({i, 0, -std::log(std::min(1.0, share)), false});
    at.emplace_back(e.x, e.y);
  }
  for (size_t k = 1; k + 2 < at.size(); ++k) {
    const double before = degrees_between(at[k] - at[k - 1], at[k + 1] - at[k]);
    const double after = degrees_between(at[k + 1] - at[k], at[k + 2] - at[k + 1]);
    const double change = std::abs(std::remainder(after - before, 360));
    const double random = std::clamp(change, kLeastTurn, kMostTurn) / kMostTurn;
    const double hatched = hatching.chance(map.edgels[out[k].edgel]);
    out[k].turns = true;
    out[k].turn = -std::log(hatched + (1 - hatched) * random);
  }
  return out;
}

// A run of places, and how meaningful it is.
struct Piece {
  int begin = 0, end = 0;  // edgels
  double meaning = 0;
};

// Minus the decimal logarithm of the number of pieces as good that texture makes in the image: sums
// of exponential variables have Gamma's tail, bounded by Chernoff.
double meaning_of(const std::vector<Place>& places, size_t begin, size_t end, double tests) {
  double shape = 0, sum = 0;
  for (size_t k = begin; k < end; ++k) {
    shape += 1 / kContrastsPerOne + (places[k].turns ? 1 / kTurnsPerOne : 0);
    sum += places[k].contrast / kContrastsPerOne + places[k].turn / kTurnsPerOne;
  }
  const double nats = sum > shape ? sum - shape - shape * std::log(sum / shape) : 0;
  return (nats - std::log(tests)) / std::log(10.0);
}

// The pieces of a chain: what evidence against lies between, or at its ends, may be worth kDrop (as
// in Altschul et al.: Basic local alignment search tool, J. Mol. Biol. 1990).
void cut(const std::vector<Place>& places, int last_edgel, double tests, double least,
         std::vector<Piece>* out) {
  const size_t n = places.size();
  const auto close = [&](size_t begin, size_t end) {
    const double meaning = meaning_of(places, begin, end, tests);
    if (meaning >= least)
      out->push_back({places[begin].edgel, end < n ? places[end].edgel : last_edgel, meaning});
  };
  double sum = 0, best = -INFINITY;
  size_t begin = 0, end = 0;
  for (size_t k = 0; k < n; ++k) {
    const Place& p = places[k];
    sum += (p.contrast - kEvidence) / kContrastsPerOne +
           (p.turns ? (p.turn - kEvidence) / kTurnsPerOne : 0);
    if (sum > best) best = sum, end = k + 1;
    if (sum > std::max(best, 0.0) - kDrop) continue;
    if (best > 0) close(begin, end);
    begin = k + 1, sum = 0, best = -INFINITY;
  }
  if (begin < n && best > 0) close(begin, n);
}

}  // namespace

void keep_meaningful(const cv::Mat1f& magnitude, const cv::Mat1b& outline,
                     const MeaningOptions& options, EdgelMap* map) {
  Neighbourhood around(magnitude, outline);
  const Hatching hatching(*map, magnitude.size());
  const double tests = kPieces * std::max(1.0, double(map->edgels.size()) / kStep);
  const double least = options.most_false > 0 ? -std::log10(options.most_false) : -double(INFINITY);
  std::vector<Piece> pieces;
  for (int c = 0; c < map->num_chains(); ++c) {
    const std::vector<Place> places = places_of(*map, c, outline, hatching, &around);
    if (options.most_false > 0) {
      cut(places, map->chain[c + 1], tests, least, &pieces);
    } else {
      pieces.push_back(
          {map->chain[c], map->chain[c + 1], meaning_of(places, 0, places.size(), tests)});
    }
  }
  EdgelMap out;
  out.chain.push_back(0);
  for (const Piece& p : pieces) {
    out.edgels.insert(out.edgels.end(), map->edgels.begin() + p.begin, map->edgels.begin() + p.end);
    out.chain.push_back(int(out.edgels.size()));
    out.meaning.push_back(float(p.meaning));
  }
  map->edgels = std::move(out.edgels);
  map->chain = std::move(out.chain);
  map->meaning = std::move(out.meaning);
}

}  // namespace sketchsplat
