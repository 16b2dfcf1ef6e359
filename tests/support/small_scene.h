// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "datasets/io/float_image_io.h"
#include "datasets/io/image_io.h"
#include "tests/support/colmap_files.h"

namespace sketchsplat::test {

// The smallest of everything that is read: three views of 32 x 24 of a white square, in each
// format of scenes, and files of edges. The cameras stand side by side and look along z.
constexpr int kSmallViews = 3, kSmallWidth = 32, kSmallHeight = 24;

inline std::string small_pose(int k, bool opengl) {
  const std::string x = std::to_string(0.5 * k);
  return opengl ? "[[1,0,0," + x + "],[0,-1,0,0],[0,0,-1,-4],[0,0,0,1]]"
                : "[[1,0,0," + x + "],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]";
}

/// The scene file of abc-nef, nerf or nerfstudio.
inline std::string small_scene_json(const std::string& format) {
  std::string frames;
  for (int k = 0; k < kSmallViews; ++k) {
    const std::string name = std::to_string(k);
    frames += k ? ",\n" : "";
    if (format == "abc-nef")
      frames += R"({"rgb_path": ")" + name + R"(.png", "camtoworld": )" + small_pose(k, false) +
                R"(, "intrinsics": [[40,0,15.5],[0,40,11.5],[0,0,1]]})";
    else if (format == "nerf")
      frames += R"({"file_path": "./train/)" + name + R"(", "transform_matrix": )" +
                small_pose(k, true) + "}";
    else
      frames += R"({"file_path": "images/)" + name + R"(.png", "mask_path": "masks/)" + name +
                R"(.png", "transform_matrix": )" + small_pose(k, true) + "}";
  }
  const std::string head =
      format == "abc-nef"
          ? R"("width": 32, "height": 24, "worldtogt": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])"
      : format == "nerf"
          ? R"("camera_angle_x": 0.76)"
          : R"("camera_model": "OPENCV", "w": 32, "h": 24, "fl_x": 40, "fl_y": 40, "cx": 16, "cy": 12, "k1": 0.01, "k4": 0)";
  return "{" + head + ", \"frames\": [\n" + frames + "]}\n";
}

inline ColmapFiles small_colmap() {
  ColmapFiles m;
  m.cameras = {{1, "PINHOLE", 1, kSmallWidth, kSmallHeight, {40, 40, 16, 12}}};
  for (std::uint32_t k = 0; k < kSmallViews; ++k)
    m.images.push_back(
        {k + 1, {1, 0, 0, 0}, {-0.5 * k, 0, 4}, 1, std::to_string(k) + ".png", {{3, 4}, {5, 6}}});
  m.points = {{1, {0, 0, 0}, {1, 2}}, {2, {0.1, 0, 0}, {2, 3}}};
  return m;
}

inline Picture small_picture() {
  Picture picture;
  picture.red = Image<float>(kSmallWidth, kSmallHeight, 0.1f);
  for (int y = 6; y < 18; ++y)
    for (int x = 8; x < 24; ++x) picture.red.at(x, y) = 0.9f;
  picture.green = picture.blue = picture.red;
  return picture;
}

inline std::string small_step() {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n"
         "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=DIRECTION('',(0.,0.,1.));\n"
         "#3=DIRECTION('',(1.,0.,0.));\n#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n"
         "#5=CIRCLE('',#4,1.);\nENDSEC;\nEND-ISO-10303-21;\n";
}

inline std::string small_sketch() {
  return R"({"format_version": 1, "nodes": [[0,0,0],[1,0,0],[1,1,0]], "strokes": [
{"kind": "line", "nodes": [0,1], "handles": [], "opacity": 1, "support_views": 3, "rms_px": 0.2},
{"kind": "arc", "nodes": [1,2], "handles": [[1.2,0.5,0]], "views": [0,1]},
{"kind": "bezier", "nodes": [0,2], "handles": [[0,0.5,0],[0.2,1,0],[0.4,1,0],[0.6,1,0],[0.8,1,0]]},
{"kind": "circle", "nodes": [], "handles": [[0.5,0.5,0],[0,0,0.2]]}]})";
}
inline std::string small_truth() {
  return R"([{"type": "line", "points": [[0,0,0],[1,0,0]]},
{"type": "line", "points": [[1,0,0],[1,1,0]], "visible_views": [3,2]}])";
}
inline std::string small_emap() {
  return R"({"curves_ctl_pts": [[[0,0,0],[0,0.5,0],[0.2,1,0],[1,1,0]]], "lines_end_pts": [[0,0,0,1,0,0]]})";
}
inline std::string small_nef() {
  return R"({"scene_name": "a", "curves_ctl_pts": [[[128,128,128],[140,128,128],[150,140,128],[160,160,128]]]})";
}
inline std::string small_ply() {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
         "float z\n"
         "property int stroke_index\nend_header\n0 0 0 0\n0.5 0 0 0\n1 0 0 1\n";
}
inline std::string small_obj() {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\no stroke_0\nl 1 2\no stroke_1\nl 2 3\n";
}
inline std::string small_features() {
  return "curves:\n- sharp: true\n  type: Line\n  vert_indices: [0, 1]\n  vert_parameters: [0.0, "
         "1.0]\n"
         "  location: [0.0, 0.0, 0.0]\n  direction: [1.0, 0.0, 0.0]\n- sharp: false\n  type: "
         "Circle\n"
         "  vert_indices: [1, 2]\n  vert_parameters: [0.0, 1.0]\n  location: [0.0, 0.0, 0.0]\n"
         "  radius: 1.0\n  x_axis: [1.0, 0.0, 0.0]\n  y_axis: [0.0, 1.0, 0.0]\nsurfaces:\n- type: "
         "Plane\n";
}

/// A scene, and whatever may lie in it. `format`: abc-nef, nerf, nerfstudio, colmap-text,
/// colmap-binary, or anything else for files of edges.
inline void write_small_scene(const std::string& folder, const std::string& format) {
  std::filesystem::create_directories(folder);
  const auto images = [&](const std::string& name, const Picture& picture) {
    std::filesystem::create_directories(folder + "/" + name);
    for (int k = 0; k < kSmallViews; ++k)
      write_png(folder + "/" + name + "/" + std::to_string(k) + ".png", picture);
  };
  if (format == "abc-nef") {
    images("color", small_picture());
    write_file(folder + "/meta_data.json", small_scene_json(format));
  } else if (format == "nerf") {
    images("train", small_picture());
    write_file(folder + "/transforms_train.json", small_scene_json(format));
  } else if (format == "nerfstudio") {
    images("images", small_picture());
    images("masks", small_picture());
    write_file(folder + "/transforms.json", small_scene_json(format));
  } else if (format == "colmap-text" || format == "colmap-binary") {
    images("images", small_picture());
    format == "colmap-text" ? write_colmap_text(small_colmap(), folder + "/sparse/0")
                            : write_colmap_binary(small_colmap(), folder + "/sparse/0");
  } else {
    write_file(folder + "/sketch.json", small_sketch());
    write_file(folder + "/gt.json", small_truth());
    write_file(folder + "/emap.json", small_emap());
    write_file(folder + "/nef.json", small_nef());
    write_file(folder + "/points.ply", small_ply());
    write_file(folder + "/lines.obj", small_obj());
    write_file(folder + "/abc/a_features_0.yml", small_features());
    write_file(folder + "/abc/a_trimesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n");
    write_file(folder + "/part.step", small_step());
  }
}

}  // namespace sketchsplat::test
