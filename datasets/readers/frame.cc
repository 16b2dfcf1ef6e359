// SPDX-License-Identifier: MIT
#include "datasets/readers/frame.h"

#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <filesystem>

#include "datasets/io/image_planes.h"
#include "datasets/types/dense.h"
#include "datasets/types/errors.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

constexpr double kLargest = 1e100;   // cubes of it overflow
constexpr double kTolerance = 1e-3;  // of entries that are 0 or 1 in a rigid transform or a K

std::string complaint_about_pose(const Eigen::Matrix4d& pose) {
  if (!pose.allFinite()) return "its pose is not finite";
  if (pose.cwiseAbs().maxCoeff() > kLargest) return "its pose holds numbers that are too large";
  const Eigen::Matrix3d R = pose.topLeftCorner<3, 3>();
  if ((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance) {
    return "its pose is no rotation";
  }
  if (R.determinant() < 0) return "its pose is a reflection";
  if ((pose.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kTolerance) {
    return "the last row of its pose is not 0 0 0 1";
  }
  return "";
}

std::string complaint_about_intrinsics(const Eigen::Matrix3d& K) {
  if (!K.allFinite()) return "its intrinsics are not finite";
  if (K(0, 0) <= 0 || K(1, 1) <= 0) return "its focal length is not positive";
  if (std::abs(K(0, 1)) > kTolerance * K(0, 0) || K(1, 0) != 0) return "its intrinsics are skewed";
  if ((K.row(2) - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff() > kTolerance) {
    return "the last row of its intrinsics is not 0 0 1";
  }
  return "";
}

/// File name of the image; with its folders if another view has that name already. Empty: a view
/// of the same image is there.
std::string unique_name(const Frame& frame, const Scene& scene) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(scene.views.begin(), scene.views.end(),
                       [&](const View& view) { return view.name == name; });
  };
  for (const View& view : scene.views) {
    if (view.image_path == frame.image_path) return "";
  }
  const fs::path path(frame.image_path);
  const std::string name = path.filename().string();
  if (!taken(name)) return name;
  std::string longer = path.lexically_relative(scene.folder).string();
  std::replace(longer.begin(), longer.end(), '/', '_');
  return taken(longer) ? "" : longer;
}

}  // namespace

bool complete_size(Frame* frame) {
  if (frame->size.width > 0 && frame->size.height > 0) return true;
  try {
    frame->size = read_image_size(frame->image_path);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

bool add_frame(const Frame& frame, Scene* scene) {
  Frame f = frame;
  std::string complaint;
  const std::string name = f.image_path.empty() ? "" : unique_name(f, *scene);
  if (f.is_outside) {
    complaint = "its image lies outside of the scene's folder (--allow-outside reads it)";
  } else if (f.image_path.empty()) {
    complaint = "its image is missing";
  } else if (name.empty()) {
    complaint = "its image is that of another frame";
  } else if (!complete_size(&f)) {
    complaint = "its image cannot be read";
  } else if (double(f.size.width) * f.size.height > double(kMostPixels)) {
    complaint =
        "its image has more than " + std::to_string(kMostPixels / 1000000) + " million pixels";
  } else {
    complaint = complaint_about_pose(f.world_from_cam);
    if (complaint.empty()) complaint = complaint_about_intrinsics(f.intrinsics);
    if (complaint.empty() && !f.lens.is_finite()) complaint = "its distortion is not finite";
  }
  if (!complaint.empty()) {
    scene->warnings.push_back("frame " + f.name + " is left out: " + complaint);
    return false;
  }
  const Eigen::Matrix3d& K = f.intrinsics;
  Pose world_from_cam;
  world_from_cam.rotation = nearest_rotation(f.world_from_cam.topLeftCorner<3, 3>());
  world_from_cam.translation = f.world_from_cam.topRightCorner<3, 1>();
  View view;
  view.name = name;
  view.image_path = f.image_path;
  view.camera = {f.size.width, f.size.height, K(0, 0), K(1, 1), K(0, 2), K(1, 2)};
  view.cam_from_world = world_from_cam.inverse();
  view.lens = f.lens;
  view.mask_path = f.mask_path;
  scene->views.push_back(view);
  return true;
}

void check_frame_count(const std::string& path, std::uint64_t count) {
  if (count > kMostFrames)
    throw InputError(path, "at most " + std::to_string(kMostFrames) + " frames",
                     std::to_string(count));
}

std::vector<JsonValue> frames_of(const JsonValue& root) {
  return root["frames"].elements(kMostFrames);
}

bool may_reach(const SceneSource& source, const std::string& path) {
  if (source.allow_outside) return true;
  const auto normal = [](const std::string& p) {
    return (fs::absolute(p) / "").lexically_normal();  // with a slash at its end
  };
  const fs::path inner = normal(path).lexically_relative(normal(source.folder));
  return !inner.empty() && *inner.begin() != "..";
}

void find_image_of(const SceneSource& source, const std::string& folder, const std::string& name,
                   Frame* frame) {
  frame->is_outside = !may_reach(source, (fs::path(folder) / name).string());
  if (!frame->is_outside) frame->image_path = find_image(folder, name);
}

std::string find_image(const std::string& folder, const std::string& name) {
  std::error_code none;
  const fs::path path = (fs::path(folder) / name).lexically_normal();
  for (const char* extension : {"", ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG", ".tif"}) {
    const fs::path candidate = path.string() + extension;
    if (fs::is_regular_file(candidate, none)) return candidate.string();
  }
  return "";
}

std::string find_mask(const std::string& folder, const std::string& name) {
  const fs::path path = (fs::path(folder) / name).lexically_normal();
  std::error_code none;
  for (const fs::path& candidate :
       {path, fs::path(path.string() + ".png"), fs::path(path).replace_extension(".png")}) {
    if (fs::is_regular_file(candidate, none)) return candidate.string();
  }
  return "";
}

std::vector<std::string> list_images(const std::string& folder, bool deep) {
  std::vector<std::string> names;
  const auto look_at = [&](const fs::directory_entry& entry) {
    std::string ending = entry.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    std::error_code none;
    for (const char* known : {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp"})
      if (ending == known && entry.is_regular_file(none))
        names.push_back(entry.path().lexically_relative(folder).string());
  };
  std::error_code none;
  if (deep) {
    for (auto it = fs::recursive_directory_iterator(folder, none);
         !none && it != fs::recursive_directory_iterator(); it.increment(none))
      look_at(*it);
  } else {
    for (auto it = fs::directory_iterator(folder, none); !none && it != fs::directory_iterator();
         it.increment(none))
      look_at(*it);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void warn_of(const std::string& what, const std::vector<std::string>& names, Scene* scene) {
  constexpr size_t kMost = 3;
  if (names.empty()) return;
  std::string some;
  for (size_t i = 0; i < std::min(names.size(), kMost); ++i) some += (i ? ", " : "") + names[i];
  if (names.size() > kMost) some += ", ...";
  scene->warnings.push_back(what + ": " + std::to_string(names.size()) + " (" + some + ")");
}

}  // namespace sketchsplat
