// SPDX-License-Identifier: MIT
#include "sketchsplat/reconstruct.h"

#include <omp.h>

#include <algorithm>
#include <stdexcept>

#include "datasets/types/errors.h"
#include "library/access.h"
#include "library/memory_scene.h"
#include "pipelines/method/reconstruct.h"
#include "sketchsplat/version.h"

namespace sketchsplat {
namespace {

// Of the calling thread's parallel regions, until it goes.
class ScopedThreads {
 public:
  explicit ScopedThreads(int count) : before_(omp_get_max_threads()) {
    if (count > 0) omp_set_num_threads(count);
  }
  ~ScopedThreads() { omp_set_num_threads(before_); }
  ScopedThreads(const ScopedThreads&) = delete;
  ScopedThreads& operator=(const ScopedThreads&) = delete;

 private:
  int before_;
};

ReconstructOptions method_options(const Options& options) {
  ReconstructOptions method;
  OptionTexts texts = {{"preset", options.preset}, {"detector", options.detector}};
  for (const auto& [name, value] : options.expert) texts.push_back({name, value});
  try {
    set_options(texts, &method);
  } catch (const UsageError& e) {
    throw std::invalid_argument(e.what());
  }
  method.min_confidence = std::max(method.min_confidence, options.min_confidence);
  return method;
}

CurveSketch ended(Ending ending, const std::string& message) {
  CurveSketch out;
  out.ending = ending, out.message = message;
  return out;
}

CurveSketch run(const Scene& scene, Detector* detector, const ReconstructOptions& method,
                const Options& options) {
  const ScopedThreads threads(options.threads);
  Progress progress(Progress::Mode::kSilent);
  if (options.progress)
    progress.watch([&](const std::string& stage, int done, int total) {
      return options.progress({stage, done, total});
    });
  try {
    Reconstruction result = reconstruct(scene, detector, method, &progress);
    CurveSketch out = CurveSketchAccess::make(std::move(result.sketch));
    std::string why;
    if (result.solid.solid) out.solid = CurveSketchAccess::make(*result.solid.solid, &why);
    out.views = std::move(result.views);
    out.warnings = std::move(result.report.warnings);
    if (result.solid.solid && !out.solid) out.warnings.push_back("no solid: " + why);
    return out;
  } catch (const TooLittleError& e) {
    return ended(Ending::kTooLittle, e.what());
  } catch (const CancelledError&) {
    return ended(Ending::kCancelled, "cancelled");
  }
}

}  // namespace

CurveSketch reconstruct(const std::vector<InputView>& views, const Options& options) {
  const ReconstructOptions method = method_options(options);
  const Scene scene = scene_of(views);
  const bool pictures =
      std::any_of(views.begin(), views.end(), [](const InputView& v) { return v.pixels; });
  if (pictures) {
    for (const View& view : scene.views)
      if (!view.make_picture) throw std::invalid_argument(view.name + ": expected pixels");
    if (method.detector != "image" && method.detector != "2dgs-sn")
      throw std::invalid_argument(
          "detector: expected image or 2dgs-sn for views in memory, found " + method.detector);
  }
  const auto detector = pictures ? make_detector(method) : make_given_edges(views);
  return run(scene, detector.get(), method, options);
}

CurveSketch reconstruct(const std::string& scene_folder, const Options& options) {
  const ReconstructOptions method = method_options(options);
  const Scene scene = open_scene(scene_folder);
  return run(scene, make_detector(method).get(), method, options);
}

std::string library_version() { return SKETCHSPLAT_VERSION; }

}  // namespace sketchsplat
