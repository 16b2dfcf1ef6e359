// SPDX-License-Identifier: MIT
#include "pipelines/detectors/surfel_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "edges/image/undistort.h"
#include "edges/surfels/model/training_view.h"
#include "edges/surfels/start/edge_tracks.h"
#include "edges/views/lift.h"

namespace sketchsplat {
namespace {

constexpr double kSnapPx = 3;     // [px] from an edge of the geometry to that of the picture
constexpr double kAlongDeg = 30;  // largest turn between an edge of the picture and of the geometry
constexpr int kFewestViews = 3;
constexpr int kFewestPoints = 2;  // of a track that is judged
constexpr int kEvery = 2;         // points of a track of which one is looked at
constexpr int kAlong = 6;         // edgels to the next one
constexpr double kOffPx = 3;      // [pixel footprints] from the surfels to what they have a say in

// Per edgel of `a`: does one of `b` within reach run along it?
std::vector<char> beside(const EdgelMap& a, const EdgelMap& b, double reach_px, bool along) {
  const double least = std::cos(kAlongDeg * M_PI / 180);
  std::vector<char> out(a.edgels.size(), 0);
  for (size_t i = 0; i < a.edgels.size(); ++i) {
    const Edgel& e = a.edgels[i];
    const int k = b.nearest_at(e.x, e.y);
    if (k < 0) continue;
    const Edgel& f = b.edgels[k];
    out[i] = std::hypot(e.x - f.x, e.y - f.y) <= reach_px &&
             (!along || std::abs(e.nx * f.nx + e.ny * f.ny) >= least);
  }
  return out;
}

class SurfelDetector : public Detector {
 public:
  explicit SurfelDetector(const DetectionOptions& options) : options_(options) {
    options_.surfels.hull.seed = options_.surfels.cylinders.seed = options_.seed;
  }

  void prepare(const Scene& scene, const RunLog& log) override {
    fit_surfels(scene, log);
    look_at_surfels(log);
  }

  EdgelMap detect(const Scene&, const View& view) const override {
    for (size_t i = 0; i < world_.views.size(); ++i)
      if (world_.views[i].image_path == view.image_path)
        return snap_edgels(shape_[i], world_.maps[i], kinds_[i], field_.evenness > kEven, kSnapPx);
    read_masked(view);  // says what is wrong with it
    throw InputError(view.image_path, "a picture that surfels were fitted to", "another one");
  }

  bool geometry(const Scene&, const View& view, GeometryMaps* maps) const override {
    *maps = render_geometry(field_, view, options_.surfels.mode_deg);
    return true;
  }
  std::vector<EdgeKind> judge(const CurvePoints& curves) const override {
    const std::vector<TrackSightings> sightings = track_sightings(world_, curves, 1);
    return judge_tracks(curves, sightings, support_of(sightings), kOffPx);
  }

  bool learns() const override { return true; }
  std::string surfels() const override { return surfel_ply(field_); }

 private:
  void fit_surfels(const Scene& scene, const RunLog& log) {
    Stage stage("surfels", log, options_.surfels.renderings);
    const std::vector<TrainingView> views = look(scene);
    field_ =
        train_surfels(views, world_.bounds, options_.surfels, sure(), [&stage] { stage.step(); });
    if (field_.surfels.size() == 0)
      throw TooLittleError(scene.folder + ": expected an object inside all masks, found nothing");
    log.count("surfels", field_.surfels.size());
    log.count("surfel_edge_planes", field_.planes);
    log.count("surfel_cells_emptied", field_.emptied);
    log.count("surfel_renderings", field_.renderings);
    log.count("surfel_loss", field_.losses.back());
    char text[300];
    std::snprintf(text, sizeof text,
                  "%d cells empty between %d planes of edges; "
                  "%d surfels of %d, %d split, %d merged, %d pruned, %d moved, "
                  "%d on planes, %d on cylinders, loss %.4f",
                  field_.emptied, field_.planes, field_.surfels.size(), field_.first_count,
                  field_.split, field_.merged, field_.pruned, field_.moved, field_.flat,
                  field_.round, field_.losses.back());
    stage.result(text);
  }

  // What the surfels show in every view, and what the edges of the pictures are by that.
  void look_at_surfels(const RunLog& log) {
    const int n = int(world_.views.size());
    Stage stage("surfel edges", log, n);
    maps_.resize(n), shape_.resize(n);
    for_each_view([&](int i) {
      const View& view = world_.views[i];
      GeometryMaps maps = render_geometry(field_, view, options_.surfels.mode_deg);
      maps.alpha = std::move(alpha_[i]);  // sharper than that of surfels
      shape_[i] = geometry_edges(maps, view.camera, options_.geometry);
      build_lookup(&shape_[i]);
      maps_[i] = object_maps(maps, view.camera);
      stage.step();
    });
    alpha_.clear();
    LiftOptions options;
    options.follow = false;
    const CurvePoints tracks =
        track_points(lift_edges(world_, options), world_.footprint, kFewestPoints);
    const std::vector<TrackSightings> sightings = track_sightings(world_, tracks, kEvery);
    const std::vector<std::vector<EdgelSupport>> support = support_of(sightings);
    const std::vector<EdgeKind> kinds = judge_tracks(tracks, sightings, support, kOffPx);
    kinds_ = edgel_kinds(world_, sightings, support, kinds, kOffPx, kAlong);
    const auto count = [&kinds](EdgeKind kind) {
      return std::count(kinds.begin(), kinds.end(), kind);
    };
    stage.result(std::to_string(count(EdgeKind::kShape)) + " points of tracks on edges, " +
                 std::to_string(count(EdgeKind::kPrint)) + " on print");
  }

  std::vector<std::vector<EdgelSupport>> support_of(
      const std::vector<TrackSightings>& sightings) const {
    std::vector<std::vector<EdgelSupport>> support(sightings.size());
    for_each_view([&](int i) {
      support[i] = edgel_support(maps_[i], world_.maps[i], sightings[i].place, options_.geometry);
    });
    return support;
  }

  // In parallel; f(index of the view).
  template <typename F>
  void for_each_view(const F& f) const {
    parallel_for(int(world_.views.size()), 1, f);
  }

  // What the edges of the pictures, printed ones too, say about where nothing is.
  SureEdges sure() const {
    if (options_.surfels.hull.sights == 0) return {};
    LiftOptions options;
    options.stride_px = 6, options.sweep_views = 16, options.min_views = 5;
    options.follow = false;  // edges that few views see tell most
    const CurvePoints tracks =
        track_points(lift_edges(world_, options), world_.footprint, SureEdgeOptions().run);
    return sure_edges(world_, tracks);
  }

  static Picture read_masked(const View& view) {
    Picture picture = read_picture(view);
    if (picture.alpha.empty())
      throw InputError(view.image_path, "an alpha channel, the mask of the object", "none");
    return picture;
  }

  // Pictures at the size of the training, and the box of their edges in space.
  std::vector<TrainingView> look(const Scene& scene) {
    const int n = int(scene.views.size());
    std::vector<TrainingView> views(n);
    std::vector<EdgelMap> maps(n);
    std::vector<Image<float>> alpha(n);
    std::vector<std::string> complaints(n);
    parallel_for(n, 1, [&](int i) {
      try {
        Picture picture = read_masked(scene.views[i]);
        View view = scene.views[i];
        maps[i] = undistort_edgels(detect_edges(picture, options_.detect), view,
                                   options_.detect.min_chain);
        picture = undistort_picture(std::move(picture), view);  // surfels are seen by pinholes
        view.lens = Lens();
        views[i] = make_training_view(view, picture, options_.surfels.side_px);
        alpha[i] = std::move(picture.alpha);
      } catch (const InputError& e) {
        complaints[i] = e.what();
      }
    });
    std::vector<TrainingView> good;
    std::vector<View> good_views;
    std::vector<EdgelMap> good_maps;
    for (int i = 0; i < n; ++i) {
      if (!complaints[i].empty()) continue;
      good.push_back(std::move(views[i]));
      good_views.push_back(scene.views[i]);
      good_maps.push_back(std::move(maps[i]));
      alpha_.push_back(std::move(alpha[i]));
    }
    if (int(good.size()) < kFewestViews) {
      for (const std::string& complaint : complaints)
        if (!complaint.empty())
          throw InputError(scene.folder, "three views with a mask", complaint);
      throw TooLittleError(scene.folder + ": expected at least three views, found " +
                           std::to_string(n));
    }
    world_ = make_edge_world(std::move(good_views), std::move(good_maps));
    return good;
  }

  DetectionOptions options_;
  EdgeWorld world_;                  // of the pictures
  std::vector<Image<float>> alpha_;  // of the pictures, until maps_ have them
  SurfelField field_;
  std::vector<ObjectMaps> maps_;              // per view: what the surfels look like
  std::vector<EdgelMap> shape_;               // per view: edges that the surfels show
  std::vector<std::vector<EdgeKind>> kinds_;  // per view: what the edgels of the picture are
};

}  // namespace

EdgelMap snap_edgels(const EdgelMap& geometry, const EdgelMap& picture,
                     const std::vector<EdgeKind>& kinds, bool even, double reach_px) {
  EdgelMap out;
  out.width = picture.width, out.height = picture.height;
  out.noise = picture.noise;
  out.mask = picture.mask;
  constexpr int kMinChain = 4;  // [px] shorter pieces are chance
  std::vector<char> keep = beside(picture, geometry, reach_px, true);
  for (size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i] == EdgeKind::kShape || (even && kinds[i] == EdgeKind::kUnknown))
      keep[i] = true;
    else if (kinds[i] == EdgeKind::kPrint && !picture.edgels[i].outline)
      keep[i] = false;
  append_runs(picture, keep, kMinChain, &out);
  build_lookup(&out, std::max(kLookupPx, reach_px));
  std::vector<char> alone = beside(geometry, out, reach_px, false);
  for (char& a : alone) a = !a;
  append_runs(geometry, alone, kMinChain, &out);
  return out;
}

std::unique_ptr<Detector> make_surfel_detector(const DetectionOptions& options) {
  return std::make_unique<SurfelDetector>(options);
}

}  // namespace sketchsplat
