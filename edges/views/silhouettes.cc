// SPDX-License-Identifier: MIT
#include "edges/views/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/image/edgel_map.h"
#include "edges/image/mats.h"
#include "edges/views/cell_groups.h"
#include "edges/views/find_object.h"
#include "edges/views/picture_cut.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCells = 64;  // along the longest side of the region
constexpr double kEndPx = PictureCut::kEndPx;
constexpr double kBeyond = 0.1;  // of the region's longest side, that may be the object's, too
constexpr int kCoarseRounds = 2, kRounds = 3;  // of colours and cuts
constexpr int kAgainPx = 3;     // [px] around what most views hold, where it may be, too
constexpr double kPart = 0.25;  // of the object, less than which is no part that touches it nowhere
constexpr int kFewestViews = 3;
constexpr int kFewestWhole = 1;        // views that show all of the object
constexpr double kObjectPx = 180;      // [px] of the object's longer side in pictures that are cut
constexpr double kMostOutvoted = 0.1;  // share of the views that may leave out what others hold
// Share of a silhouette that all views together do not hold, and the other way round, up to which
// its view is trusted.
constexpr double kMostDisagreement = 0.1;
constexpr double kLeastCut =
    0.8;  // share of the known edges with fewer of which a first cut is wrong
constexpr double kLeastEdges = 0.95;   // of the object's known edges, that silhouettes must hold
constexpr double kLeastTrusted = 0.5;  // of the views, with fewer of which nothing is known

// Places that nearly all views which see them hold, on a grid.
struct Held {
  std::vector<Vector3d> places;
  double cell = 0;
};

Held held_by_most(const std::vector<View>& views, const std::vector<PictureCut>& cuts,
                  const ObjectRegion& region) {
  Held out;
  out.cell = region.box.sizes().maxCoeff() / kCells;
  const Eigen::Array3i n = (region.box.sizes().array() / out.cell).ceil().cast<int>().max(1);
  std::vector<char> held(size_t(n.prod()));
  const auto place = [&](int i) {
    const int x = i % n.x(), y = i / n.x() % n.y(), z = i / (n.x() * n.y());
    return Vector3d(region.box.min() + out.cell * Vector3d(x + 0.5, y + 0.5, z + 0.5));
  };
  parallel_for(int(held.size()), 256, [&](int i) {
    const Vector3d p = place(i);
    int asked = 0, no = 0;
    for (size_t v = 0; v < views.size(); ++v) {
      if (cuts[v].mask.empty()) continue;
      double depth;
      const double far = cuts[v].distance_px(views[v], p, &depth);
      if (std::isnan(far)) continue;
      const double cell_px = out.cell * views[v].camera.fx / (depth * cuts[v].denominator);
      ++asked;
      no += far > kEndPx + 0.5 * cell_px;
    }
    held[size_t(i)] = asked >= kFewestViews && no <= kMostOutvoted * asked;
  });
  for (int i = 0; i < int(held.size()); ++i)
    if (held[size_t(i)]) out.places.push_back(place(i));
  return out;
}

// Which points lie in a held cell or beside one.
std::vector<char> are_held(const std::vector<Vector3d>& points, const Held& held,
                           const Vector3d& low) {
  std::set<Cell> cells;
  for (const Vector3d& p : held.places)
    for (int k = 0; k < 27; ++k) cells.insert(touching(cell_of(p - low, held.cell), k));
  std::vector<char> out;
  for (const Vector3d& p : points) out.push_back(cells.count(cell_of(p - low, held.cell)) > 0);
  return out;
}

// Moves what touches the object nowhere, and is too small for a part of it, to `beside`.
void part_from_things(Held* held, Held* beside) {
  int count = 0;
  const std::vector<int> group = groups_of(held->places, held->cell, &count);
  std::vector<int> size(size_t(count), 0);
  for (const int g : group) ++size[size_t(g)];
  const int most = count == 0 ? 0 : *std::max_element(size.begin(), size.end());
  std::vector<Vector3d> kept;
  for (size_t i = 0; i < group.size(); ++i)
    (size[size_t(group[i])] >= kPart * most ? kept : beside->places).push_back(held->places[i]);
  held->places = std::move(kept);
  beside->cell = held->cell;
}

// Share of the known edges that the object holds, of those that are not of what stands beside it.
double share_held(const std::vector<Vector3d>& edges, const Held& held, const Held& beside,
                  const Vector3d& low) {
  const std::vector<char> own = are_held(edges, held, low), other = are_held(edges, beside, low);
  int of_own = 0, of_neither = 0;
  for (size_t i = 0; i < edges.size(); ++i) of_own += own[i], of_neither += !own[i] && !other[i];
  return of_own + of_neither == 0 ? 1 : double(of_own) / (of_own + of_neither);
}

// What the places cover in a picture, as wide as their cells.
cv::Mat1b covered(const ShrunkView& shrunk, const Held& held) {
  cv::Mat1b out = cv::Mat1b::zeros(shrunk.height(), shrunk.width());
  for (const Vector3d& p : held.places) {
    Vector2d q;
    double depth;
    if (!shrunk.pixel(p, &q, &depth)) continue;
    const double half = 0.87 * held.cell * shrunk.view.camera.fx / (depth * shrunk.denominator);
    const cv::Rect square =
        cv::Rect(cv::Point(int(std::floor(q.x() - half)), int(std::floor(q.y() - half))),
                 cv::Point(int(std::ceil(q.x() + half)) + 1, int(std::ceil(q.y() + half)) + 1)) &
        cv::Rect(0, 0, out.cols, out.rows);
    if (square.area() > 0) out(square) = 1;
  }
  return out;
}

cv::Mat1b grown(const cv::Mat1b& mask, int px) {
  if (px <= 0) return mask;
  cv::Mat1b out;
  const cv::Mat disc =
      cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * px + 1, 2 * px + 1));
  cv::dilate(mask, out, disc);
  return out;
}

cv::Mat1b shrunk_by(const cv::Mat1b& mask, int px) { return 1 - grown(1 - mask, px); }

// The part of it that is as far from its end as cells and cuts err.
cv::Mat1b surely_covered(const ShrunkView& shrunk, const Held& held, const ObjectRegion& region) {
  const double depth = (shrunk.view.cam_from_world * region.box.center()).z();
  const double cell_px = held.cell * shrunk.view.camera.fx / (depth * shrunk.denominator);
  return shrunk_by(covered(shrunk, held), int(std::ceil(1.4 * cell_px + kEndPx)));
}

double share(const cv::Mat1b& part, const cv::Mat1b& whole) {
  return double(cv::countNonZero(part & whole)) / std::max(1, cv::countNonZero(whole));
}

// Blocks of pixels of the image as they were one.
Image<uint8_t> at_full_size(const cv::Mat1b& mask, const Camera& camera, int denominator) {
  Image<uint8_t> out(camera.width, camera.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out.at(x, y) = mask(y / denominator, x / denominator);
  return out;
}

// A silhouette that leaves the picture does not say where the object ends.
bool is_whole(const cv::Mat1b& mask) {
  return cv::countNonZero(mask.row(0)) + cv::countNonZero(mask.row(mask.rows - 1)) +
             cv::countNonZero(mask.col(0)) + cv::countNonZero(mask.col(mask.cols - 1)) ==
         0;
}

// Cuts begin with the colours of all that may be the object, or of what is likely to be.
enum class Start { kMayBe, kLikely };

cv::Mat1b first_of(Start start, const cv::Mat1b& maybe) {
  return start == Start::kLikely || maybe.empty() ? maybe : cv::Mat1b(cv::min(maybe, 1));
}

// Per view a mask of its picture; empty where that tells nothing.
std::vector<cv::Mat1b> for_each(const std::vector<View>& views, const std::vector<PictureCut>& cuts,
                                const std::function<cv::Mat1b(const ShrunkView&)>& mask) {
  std::vector<cv::Mat1b> out(views.size());
  parallel_for(int(views.size()), 1, [&](int v) {
    if (cuts[v].denominator > 0) out[v] = mask({views[v], cuts[v].denominator});
  });
  return out;
}

// First cuts; what leaves out most of the known edges is none.
void cut_first(Start start, const std::vector<View>& views, const ObjectRegion& edges,
               const ObjectRegion& region, std::vector<PictureCut>* cuts) {
  cut_again(for_each(views, *cuts,
                     [&](const ShrunkView& v) { return first_of(start, may_be(v, region)); }),
            kCoarseRounds, cuts);
  parallel_for(int(views.size()), 1, [&](int v) {
    PictureCut& cut = (*cuts)[v];
    if (cut.denominator == 0) return;
    if (cut.share(views[v], edges.edges) < kLeastCut) cut.mask.release();
  });
}

// What others do not hold is no object, whatever its colours: without it these are told better. A
// cut that loses what others hold does not count.
void cut_what_most_hold(Start start, const std::vector<View>& views, const Held& held,
                        const ObjectRegion& region, std::vector<PictureCut>* cuts) {
  const std::vector<PictureCut> before = *cuts;
  const auto again = [&](const ShrunkView& shrunk) {
    const cv::Mat1b likely = covered(shrunk, held);
    return first_of(start, grown(likely, kAgainPx) + likely);
  };
  cut_again(for_each(views, *cuts, again), kRounds, cuts);
  parallel_for(int(views.size()), 1, [&](int v) {
    PictureCut& cut = (*cuts)[v];
    if (cut.denominator == 0) return;
    const cv::Mat1b sure = surely_covered({views[v], cut.denominator}, held, region);
    const bool good =
        !cut.mask.empty() && (cv::countNonZero(sure) == 0 || share(cut.mask, sure) >= kLeastCut);
    if (!good) cut = before[v];
  });
}

// `cuts`: as they were read.
Silhouettes silhouettes_from(Start start, const std::vector<View>& views, const ObjectRegion& edges,
                             const ObjectRegion& region, std::vector<PictureCut> cuts) {
  Silhouettes out;
  const int n = int(views.size());
  cut_first(start, views, edges, region, &cuts);
  Held held = held_by_most(views, cuts, region);
  if (held.places.empty()) return out;
  Held beside;
  part_from_things(&held, &beside);
  cut_what_most_hold(start, views, held, region, &cuts);
  held = held_by_most(views, cuts, region);
  if (held.places.empty()) return out;
  part_from_things(&held, &beside);
  // Views may agree to take a face that looks like the table for it: edges tell.
  if (share_held(edges.edges, held, beside, region.box.min()) < kLeastEdges) return out;
  out.region = region_around(held.places, 2 * held.cell, edges);
  out.mask.resize(n);
  out.slack_px.assign(n, 0);
  std::vector<double> agreement(n, 0);
  std::vector<char> whole(n, 0);
  parallel_for(n, 1, [&](int v) {
    const PictureCut& cut = cuts[v];
    if (cut.mask.empty()) return;
    const ShrunkView shrunk{views[v], cut.denominator};
    const cv::Mat1b all = covered(shrunk, held), sure = surely_covered(shrunk, held, region);
    agreement[v] = share(all, cut.mask);
    if (std::min(agreement[v], share(grown(cut.mask, 1), sure)) < 1 - kMostDisagreement) return;
    const cv::Mat1b silhouette = grown((cut.mask & all) | sure, int(std::ceil(kEndPx)));
    whole[v] = is_whole(silhouette);
    out.mask[v] = at_full_size(silhouette, views[v].camera, cut.denominator);
    out.slack_px[v] = 2 * kEndPx * cut.denominator;
  });
  for (const Image<uint8_t>& mask : out.mask) out.trusted += !mask.empty();
  out.agreement = median(std::move(agreement));
  const bool enough = out.trusted >= std::max<double>(kFewestViews, kLeastTrusted * n) &&
                      std::count(whole.begin(), whole.end(), 1) >= kFewestWhole;
  if (!enough) out.mask.clear();
  return out;
}

}  // namespace

Silhouettes find_silhouettes(const std::vector<View>& views, const ObjectRegion& edges,
                             const std::function<Picture(int view, int denominator)>& read) {
  if (edges.box.isEmpty() || views.size() < size_t(kFewestViews)) return {};
  const ObjectRegion region = wider(edges, kBeyond * edges.box.sizes().maxCoeff());
  std::vector<PictureCut> cuts(views.size());
  parallel_for(int(cuts.size()), 1, [&](int v) {
    cuts[v] = read_cut(views[v], region, kObjectPx, [&](int d) { return read(v, d); });
  });
  // What is likely tells objects among things of many colours, but may be too little of one whose
  // colours the table has, too.
  const Silhouettes likely = silhouettes_from(Start::kLikely, views, edges, region, cuts);
  if (!likely.mask.empty()) return likely;
  return silhouettes_from(Start::kMayBe, views, edges, region, cuts);
}

namespace {

// Edgels on the silhouette alone; those near its end are outlines.
EdgelMap on_silhouette(const EdgelMap& map, const View& view, const Image<uint8_t>& mask,
                       double slack_px) {
  const cv::Mat1f depth = distance_to_zero(mat_of(mask));
  EdgelMap from = map;
  std::vector<char> keep(map.edgels.size());
  for (size_t i = 0; i < map.edgels.size(); ++i) {
    Edgel& e = from.edgels[i];
    Vector2d pixel;
    if (!view.image_pixel({e.x, e.y}, &pixel)) continue;
    const int x = std::clamp(int(std::lround(pixel.x())), 0, mask.width - 1);
    const int y = std::clamp(int(std::lround(pixel.y())), 0, mask.height - 1);
    keep[i] = mask.at(x, y);
    e.outline = depth(y, x) <= slack_px;
  }
  EdgelMap out = runs_of(from, keep, kShortestRun);
  build_lookup(&out);
  return out;
}

}  // namespace

Image<float> alpha_around(const Image<uint8_t>& mask, double px) {
  const cv::Mat1f distance = distance_to_zero(mat_of(mask) == 0);
  Image<float> out(mask.width, mask.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out.at(x, y) = distance(y, x) <= px ? 1.f : 0.f;
  return out;
}

EdgeWorld with_silhouettes(EdgeWorld world, const Silhouettes& found) {
  if (found.mask.empty()) return world;
  parallel_for(int(world.views.size()), 1, [&](int v) {
    if (found.mask[v].empty()) return;
    world.maps[v] = on_silhouette(world.maps[v], world.views[v], found.mask[v], found.slack_px[v]);
    world.plane_normal[v] = plane_normals(world.views[v], world.maps[v]);
  });
  world.object = found.region;
  world.bounds = found.region.box;
  world.silhouettes = std::make_shared<const std::vector<Image<uint8_t>>>(found.mask);
  world.hull = hull_of(world);
  return world;
}

}  // namespace sketchsplat
