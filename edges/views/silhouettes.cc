// SPDX-License-Identifier: MIT
#include "edges/views/silhouettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <set>

#include "datasets/types/errors.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/image/cut_out.h"
#include "edges/views/find_object.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCells = 64;       // along the longest side of the region
constexpr double kEndPx = 1;     // [px] of shrunk pictures by which cuts miss the object's end
constexpr double kBeyond = 0.1;  // of the region's longest side, that may be the object's, too
constexpr int kCoarseRounds = 2, kRounds = 3;  // of colours and cuts
constexpr int kAgainPx = 3;  // [px] around what most views hold, where it may be, too
constexpr int kFewestViews = 3;
constexpr double kLookupPx = 4;  // as the detectors'
constexpr int kMinChain = 3;     // edgels of a chain that leaves the silhouette

// A view of a picture that is some times smaller.
struct Shrunk {
  const View& view;
  int denominator;
  int width() const { return view.camera.shrunk(denominator).width; }
  int height() const { return view.camera.shrunk(denominator).height; }
  // Pixel where a world point is drawn; false behind the camera, or where the lens draws nothing.
  bool pixel(const Vector3d& point, Vector2d* out, double* depth = nullptr) const {
    double z;
    const Vector2d ideal = view.project(point, &z);
    if (depth) *depth = z;
    if (!(z > 0) || !view.image_pixel(ideal, out)) return false;
    *out = (*out + Vector2d::Constant(0.5)) / denominator - Vector2d::Constant(0.5);
    return std::abs(out->x()) < 1e5 && std::abs(out->y()) < 1e5;
  }
};

// The convex hull of points in a picture; empty if one is not drawn.
cv::Mat1b drawn_hull(const Shrunk& shrunk, const std::vector<Vector3d>& points) {
  std::vector<cv::Point> pixels, hull;
  for (const Vector3d& p : points) {
    Vector2d q;
    if (!shrunk.pixel(p, &q)) return {};
    pixels.emplace_back(int(std::lround(q.x())), int(std::lround(q.y())));
  }
  cv::Mat1b out = cv::Mat1b::zeros(shrunk.height(), shrunk.width());
  if (pixels.empty()) return out;
  cv::convexHull(pixels, hull);
  cv::fillConvexPoly(out, hull, 1);
  return out;
}

std::vector<Vector3d> corners_of(const Eigen::AlignedBox3d& box) {
  std::vector<Vector3d> out;
  for (int k = 0; k < 8; ++k) out.push_back(box.corner(Eigen::AlignedBox3d::CornerType(k)));
  return out;
}

// The prism of what stands on the table, as high as the box.
std::vector<Vector3d> prism_of(const ObjectRegion& region) {
  std::vector<Vector3d> out;
  double top = 0;
  for (const Vector3d& c : corners_of(region.box))
    top = std::max(top, region.table->signedDistance(c));
  const Vector3d normal = region.table->normal(), on_table = -region.table->offset() * normal;
  for (const Vector2d& corner : region.outline) {
    const Vector3d foot = region.frame.transpose() * corner + on_table;
    out.push_back(foot);
    out.push_back(foot + top * normal);
  }
  return out;
}

// The known edges, and the table below them, which the object hides.
std::vector<Vector3d> known_of(const ObjectRegion& region) {
  std::vector<Vector3d> out = region.edges;
  if (region.table)
    for (const Vector3d& p : region.edges) out.push_back(region.table->projection(p));
  return out;
}

// Where in the picture the object may be, and, within what is known of it, where that is likely, as
// of cut_out; empty if nobody knows.
cv::Mat1b may_be(const Shrunk& shrunk, const ObjectRegion& region) {
  cv::Mat1b inside = drawn_hull(shrunk, corners_of(region.box));
  if (inside.empty()) return inside;
  if (region.table) {
    const cv::Mat1b standing = drawn_hull(shrunk, prism_of(region));
    if (!standing.empty()) inside &= standing;
  }
  const cv::Mat1b likely = drawn_hull(shrunk, known_of(region));
  return likely.empty() ? inside : inside + (inside & likely);
}

Image<uint8_t> image_of(const cv::Mat1b& mask) {
  Image<uint8_t> out(mask.cols, mask.rows);
  for (int y = 0; y < out.height; ++y) std::copy_n(mask[y], out.width, out.row(y));
  return out;
}

// So that the object's longer side is about so many pixels.
int denominator_of(const View& view, const ObjectRegion& region, double object_px) {
  Eigen::AlignedBox2d box;
  for (const Vector3d& c : corners_of(region.box)) {
    Vector2d q;
    if (!Shrunk{view, 1}.pixel(c, &q)) return 0;
    box.extend(q);
  }
  return std::max(1, int(std::lround(box.sizes().maxCoeff() / object_px)));
}

// A picture, shrunk, and what is cut out of it.
struct Cut {
  int denominator = 0;  // 0: the picture tells nothing
  Picture picture;
  cv::Mat1b mask;      // 1 on the object; empty: unknown
  cv::Mat1f distance;  // [px] to the nearest pixel of it
};

Cut read_cut(const View& view, const ObjectRegion& region, double object_px,
             const std::function<Picture(int denominator)>& read) {
  Cut cut;
  try {
    cut.denominator = denominator_of(view, region, object_px);
    if (cut.denominator > 0) cut.picture = read(cut.denominator);
  } catch (const InputError&) {
    cut.denominator = 0;  // the detector has said so
  }
  return cut;
}

// `maybe`: where the object may be, empty if nobody knows.
void cut_again(const cv::Mat1b& maybe, int rounds, Cut* cut) {
  cut->mask.release(), cut->distance.release();
  if (cut->denominator == 0 || maybe.empty()) return;
  const Image<uint8_t> found = cut_out(cut->picture, image_of(maybe), rounds);
  if (found.empty()) return;
  cut->mask = cv::Mat1b(found.height, found.width, const_cast<uint8_t*>(found.data.data())).clone();
  cv::distanceTransform(cut->mask == 0, cut->distance, cv::DIST_L2, 3);
}

// Share of the points whose pixels a cut holds, of those that the picture shows; 1 of none.
double share_cut(const std::vector<Vector3d>& points, const View& view, const Cut& cut) {
  if (cut.mask.empty()) return 0;
  int shown = 0, held = 0;
  for (const Vector3d& p : points) {
    Vector2d q;
    if (!Shrunk{view, cut.denominator}.pixel(p, &q)) continue;
    const int x = int(std::lround(q.x())), y = int(std::lround(q.y()));
    if (x < 0 || y < 0 || x >= cut.mask.cols || y >= cut.mask.rows) continue;
    ++shown;
    held += cut.distance(y, x) <= kEndPx + 1;
  }
  return shown == 0 ? 1 : double(held) / shown;
}

// Places that nearly all views which see them hold, on a grid.
struct Held {
  std::vector<Vector3d> places;
  double cell = 0;
};

Held held_by_most(const std::vector<View>& views, const std::vector<Cut>& cuts,
                  const ObjectRegion& region, double most_outvoted) {
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
      Vector2d q;
      double depth;
      if (!Shrunk{views[v], cuts[v].denominator}.pixel(p, &q, &depth)) continue;
      const int x = int(std::lround(q.x())), y = int(std::lround(q.y()));
      if (x < 0 || y < 0 || x >= cuts[v].mask.cols || y >= cuts[v].mask.rows) continue;
      const double cell_px = out.cell * views[v].camera.fx / (depth * cuts[v].denominator);
      ++asked;
      no += cuts[v].distance(y, x) > kEndPx + 0.5 * cell_px;
    }
    held[size_t(i)] = asked >= kFewestViews && no <= most_outvoted * asked;
  });
  for (int i = 0; i < int(held.size()); ++i)
    if (held[size_t(i)]) out.places.push_back(place(i));
  return out;
}

// Share of the points that lie in a held cell or beside one.
double share_held(const std::vector<Vector3d>& points, const Held& held, const Vector3d& low) {
  using Cell = std::array<int, 3>;
  const auto cell_of = [&](const Vector3d& p) {
    const Eigen::Array3d c = ((p - low) / held.cell).array().floor();
    return Cell{int(c.x()), int(c.y()), int(c.z())};
  };
  std::set<Cell> cells;
  for (const Vector3d& p : held.places) {
    const Cell c = cell_of(p);
    for (int k = 0; k < 27; ++k)
      cells.insert({c[0] + k / 9 - 1, c[1] + k / 3 % 3 - 1, c[2] + k % 3 - 1});
  }
  const auto in = [&](const Vector3d& p) { return cells.count(cell_of(p)) > 0; };
  const auto n = std::count_if(points.begin(), points.end(), in);
  return points.empty() ? 1 : double(n) / double(points.size());
}

// What the places cover in a picture, as wide as their cells.
cv::Mat1b covered(const Shrunk& shrunk, const Held& held) {
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
cv::Mat1b surely_covered(const Shrunk& shrunk, const Held& held, const ObjectRegion& region) {
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
bool is_whole(const Image<uint8_t>& mask) {
  if (mask.empty()) return false;
  for (int x = 0; x < mask.width; ++x)
    if (mask.at(x, 0) || mask.at(x, mask.height - 1)) return false;
  for (int y = 0; y < mask.height; ++y)
    if (mask.at(0, y) || mask.at(mask.width - 1, y)) return false;
  return true;
}

// Cuts begin with the colours of all that may be the object, or of what is likely to be.
enum class Start { kMayBe, kLikely };

cv::Mat1b first_of(Start start, const cv::Mat1b& maybe) {
  return start == Start::kLikely || maybe.empty() ? maybe : cv::Mat1b(cv::min(maybe, 1));
}

// `cuts`: as they were read.
Silhouettes silhouettes_from(Start start, const std::vector<View>& views, const ObjectRegion& edges,
                             const ObjectRegion& region, const SilhouetteOptions& options,
                             std::vector<Cut> cuts) {
  Silhouettes out;
  const int n = int(views.size());
  parallel_for(n, 1, [&](int v) {
    if (cuts[v].denominator == 0) return;
    const cv::Mat1b maybe = may_be({views[v], cuts[v].denominator}, region);
    cut_again(first_of(start, maybe), kCoarseRounds, &cuts[v]);
    if (share_cut(edges.edges, views[v], cuts[v]) < options.least_cut) cuts[v].mask.release();
  });
  Held held = held_by_most(views, cuts, region, options.most_outvoted);
  if (held.places.empty()) return out;
  // What others do not hold is no object, whatever its colours: without it these are told better.
  parallel_for(n, 1, [&](int v) {
    if (cuts[v].denominator == 0) return;
    const Shrunk shrunk{views[v], cuts[v].denominator};
    const cv::Mat1b likely = covered(shrunk, held), sure = surely_covered(shrunk, held, region);
    const Cut before = cuts[v];
    cut_again(first_of(start, grown(likely, kAgainPx) + likely), kRounds, &cuts[v]);
    const bool good = !cuts[v].mask.empty() && (cv::countNonZero(sure) == 0 ||
                                                share(cuts[v].mask, sure) >= options.least_cut);
    if (!good) cuts[v] = before;
  });
  held = held_by_most(views, cuts, region, options.most_outvoted);
  if (held.places.empty()) return out;
  // Views may agree to take a face that looks like the table for it: edges tell.
  if (share_held(edges.edges, held, region.box.min()) < options.least_edges) return out;
  out.region = region_around(held.places, 2 * held.cell, edges);
  out.mask.resize(n);
  out.slack_px.assign(n, 0);
  std::vector<double> agreement(n, 0);
  parallel_for(n, 1, [&](int v) {
    const Cut& cut = cuts[v];
    if (cut.mask.empty()) return;
    const Shrunk shrunk{views[v], cut.denominator};
    const cv::Mat1b all = covered(shrunk, held);
    const cv::Mat1b sure = surely_covered(shrunk, held, region);
    const double others = share(grown(cut.mask, 1), sure);
    agreement[v] = share(all, cut.mask);
    if (std::min(agreement[v], others) < 1 - options.most_disagreement) return;
    out.mask[v] = at_full_size(grown((cut.mask & all) | sure, int(std::ceil(kEndPx))),
                               views[v].camera, cut.denominator);
    out.slack_px[v] = 2 * kEndPx * cut.denominator;
  });
  int whole = 0;
  for (const Image<uint8_t>& mask : out.mask) {
    out.trusted += !mask.empty();
    whole += is_whole(mask);
  }
  out.agreement = median(std::move(agreement));
  if (out.trusted < std::max<double>(kFewestViews, options.least_trusted * n) ||
      whole < kFewestViews)
    out.mask.clear();
  return out;
}

}  // namespace

Silhouettes find_silhouettes(const std::vector<View>& views, const ObjectRegion& edges,
                             const std::function<Picture(int view, int denominator)>& read,
                             const SilhouetteOptions& options) {
  if (edges.box.isEmpty() || views.size() < size_t(kFewestViews)) return {};
  const ObjectRegion region = wider(edges, kBeyond * edges.box.sizes().maxCoeff());
  std::vector<Cut> cuts(views.size());
  parallel_for(int(cuts.size()), 1, [&](int v) {
    cuts[v] = read_cut(views[v], region, options.object_px, [&](int d) { return read(v, d); });
  });
  // What is likely tells objects among things of many colours, but may be too little of one whose
  // colours the table has, too.
  const Silhouettes wide = silhouettes_from(Start::kMayBe, views, edges, region, options, cuts);
  if (!wide.mask.empty()) return wide;
  return silhouettes_from(Start::kLikely, views, edges, region, options, cuts);
}

namespace {

// Edgels on the silhouette alone; those near its end are outlines.
EdgelMap on_silhouette(const EdgelMap& map, const View& view, const Image<uint8_t>& mask,
                       double slack_px) {
  const cv::Mat1b inside(mask.height, mask.width, const_cast<uint8_t*>(mask.data.data()));
  cv::Mat1f depth;  // [px] to the nearest pixel outside
  cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
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
  EdgelMap out;
  out.width = map.width, out.height = map.height;
  out.noise = map.noise, out.blur = map.blur;
  out.grey = map.grey;
  append_runs(from, keep, kMinChain, &out);
  build_lookup(&out, kLookupPx);
  return out;
}

}  // namespace

Image<float> alpha_around(const Image<uint8_t>& mask, double px) {
  const cv::Mat1b inside(mask.height, mask.width, const_cast<uint8_t*>(mask.data.data()));
  cv::Mat1f distance;
  cv::distanceTransform(inside == 0, distance, cv::DIST_L2, 3);
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
