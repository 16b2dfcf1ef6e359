// SPDX-License-Identifier: MIT
#include "pipelines/surfel_detector.h"

#include <cmath>
#include <cstdio>
#include <exception>

#include "datasets/errors.h"
#include "edges/lift.h"
#include "edges/training_view.h"

namespace sketchsplat {
namespace {

constexpr double kAlongDeg = 30;  // largest turn between an edge of the picture and of the geometry
constexpr int kFewestViews = 3;

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
  explicit SurfelDetector(const DetectionOptions& options) : options_(options) {}

  void prepare(const Scene& scene, RunReport* report, Progress* progress) override {
    Stage stage("surfels", options_.surfels.renderings, report, progress);
    const std::vector<TrainingView> views = look(scene);
    field_ =
        train_surfels(views, world_.bounds, options_.surfels, sights(), [&stage] { stage.step(); });
    if (field_.surfels.size() == 0)
      throw TooLittleError(scene.folder + ": expected an object inside all masks, found nothing");
    if (report) {
      report->counts.push_back({"surfels", double(field_.surfels.size())});
      report->counts.push_back({"surfel_renderings", double(field_.renderings)});
      report->counts.push_back({"surfel_loss", field_.losses.back()});
    }
    char text[160];
    std::snprintf(text, sizeof text, "%d surfels of %d, %d split, %d merged, %d pruned, loss %.4f",
                  field_.surfels.size(), field_.first_count, field_.split, field_.merged,
                  field_.pruned, field_.losses.back());
    stage.result(text);
  }

  EdgelMap detect(const Scene&, const View& view) const override {
    const Picture picture = read_masked(view);
    GeometryMaps maps = render_geometry(field_, view, options_.surfels.mode_deg);
    maps.alpha = picture.alpha;  // sharper than that of surfels
    EdgelMap map = geometry_edges(maps, view.camera, options_.geometry);
    if (options_.surfel_snap_px > 0)
      map = snap_edgels(map, edges_of(view, picture), options_.surfel_snap_px);
    return map;
  }

  bool geometry(const Scene&, const View& view, GeometryMaps* maps) const override {
    *maps = render_geometry(field_, view, options_.surfels.mode_deg);
    return true;
  }
  bool learns() const override { return true; }
  std::string surfels() const override { return surfel_ply(field_); }

 private:
  // Of the picture: found when the surfels were fitted to it, if they were.
  EdgelMap edges_of(const View& view, const Picture& picture) const {
    for (size_t i = 0; i < world_.views.size(); ++i)
      if (world_.views[i].image_path == view.image_path) return world_.maps[i];
    return detect_edges(picture, options_.detect);
  }

  // What the edges of the pictures, printed ones too, say about where nothing is.
  std::vector<SightLine> sights() const {
    if (options_.surfels.hull.sights == 0) return {};
    LiftOptions options;
    options.stride_px = 6, options.sweep_views = 16, options.min_views = 5;
    return sight_lines(world_, lift_edges(world_, options));
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
    std::vector<std::string> complaints(n);
    std::vector<std::exception_ptr> failures(n);
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < n; ++i) {
      try {
        const Picture picture = read_masked(scene.views[i]);
        maps[i] = detect_edges(picture, options_.detect);
        views[i] = make_training_view(scene.views[i], picture, options_.surfels.side_px);
      } catch (const InputError& e) {
        complaints[i] = e.what();
      } catch (...) {
        failures[i] = std::current_exception();  // must not leave the parallel loop
      }
    }
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
    std::vector<TrainingView> good;
    std::vector<View> good_views;
    std::vector<EdgelMap> good_maps;
    for (int i = 0; i < n; ++i) {
      if (!complaints[i].empty()) continue;
      good.push_back(std::move(views[i]));
      good_views.push_back(scene.views[i]);
      good_maps.push_back(std::move(maps[i]));
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
  EdgeWorld world_;  // of the pictures
  SurfelField field_;
};

}  // namespace

EdgelMap snap_edgels(const EdgelMap& geometry, const EdgelMap& picture, double reach_px) {
  EdgelMap out;
  out.width = picture.width, out.height = picture.height;
  out.noise = picture.noise;
  out.mask = picture.mask;
  constexpr int kMinChain = 4;  // [px] shorter pieces are chance
  append_runs(picture, beside(picture, geometry, reach_px, true), kMinChain, &out);
  build_lookup(&out, std::max(4.0, reach_px));
  std::vector<char> alone = beside(geometry, out, reach_px, false);
  for (char& a : alone) a = !a;
  append_runs(geometry, alone, kMinChain, &out);
  build_lookup(&out, 4.0);
  return out;
}

std::unique_ptr<Detector> make_surfel_detector(const DetectionOptions& options) {
  return std::make_unique<SurfelDetector>(options);
}

}  // namespace sketchsplat
