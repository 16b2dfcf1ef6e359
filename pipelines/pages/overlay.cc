// SPDX-License-Identifier: MIT
#include "pipelines/pages/overlay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "sketches/graph/kind_color.h"

namespace sketchsplat {
namespace fs = std::filesystem;
namespace {

constexpr int kSubPixelBits = 4;
constexpr double kFarOutside = 20000;  // [px]: beyond, OpenCV's integers are at risk

Image<float> channel_on_white(const Image<float>& channel, const Image<float>& alpha) {
  Image<float> out = channel;
  for (size_t i = 0; i < out.data.size() && !alpha.empty(); ++i)
    out.data[i] = out.data[i] * alpha.data[i] + 1 - alpha.data[i];
  return out;
}

// Paled, so that the curves stand out; 8 bit RGB.
cv::Mat canvas_of(const Picture& picture, const Camera& camera, double scale) {
  const cv::Size size(std::max(1, int(std::lround(camera.width * scale))),
                      std::max(1, int(std::lround(camera.height * scale))));
  if (picture.red.empty()) return cv::Mat(size, CV_8UC3, cv::Scalar::all(255));
  std::vector<cv::Mat> channels;
  for (const Image<float>* source : {&picture.red, &picture.green, &picture.blue}) {
    Image<float> flat = channel_on_white(*source, picture.alpha);
    const cv::Mat view(flat.height, flat.width, CV_32F, flat.data.data());
    cv::Mat small, bytes;
    cv::resize(view, small, size, 0, 0, cv::INTER_AREA);
    small.convertTo(bytes, CV_8U, 255 * 0.55, 255 * 0.45);
    channels.push_back(bytes);
  }
  cv::Mat canvas;
  cv::merge(channels, canvas);
  return canvas;
}

struct Pen {
  const View* view;
  double scale;  // canvas px per image px
};

// Runs of points that can be drawn: in front of the camera and not absurdly far outside.
std::vector<std::vector<cv::Point>> project_runs(const Eigen::Matrix3Xd& points, const Pen& pen) {
  std::vector<std::vector<cv::Point>> runs(1);
  for (int i = 0; i < points.cols(); ++i) {
    double depth;
    Eigen::Vector2d pixel = pen.view->project(points.col(i), &depth);
    const bool drawn = depth > 0 && pen.view->image_pixel(pixel, &pixel);
    // The centre of the top-left pixel is (0, 0) before and after scaling.
    const Eigen::Vector2d at = ((pixel.array() + 0.5) * pen.scale - 0.5).matrix();
    if (drawn && at.allFinite() && at.cwiseAbs().maxCoeff() < kFarOutside) {
      const Eigen::Vector2d fixed = at * (1 << kSubPixelBits);
      runs.back().emplace_back(int(std::lround(fixed.x())), int(std::lround(fixed.y())));
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
  }
  return runs;
}

Picture picture_of(const cv::Mat& canvas) {
  Picture out;
  out.red = out.green = out.blue = Image<float>(canvas.cols, canvas.rows);
  for (int y = 0; y < canvas.rows; ++y) {
    const cv::Vec3b* row = canvas.ptr<cv::Vec3b>(y);
    for (int x = 0; x < canvas.cols; ++x) {
      out.red.at(x, y) = row[x][0] / 255.0f;
      out.green.at(x, y) = row[x][1] / 255.0f;
      out.blue.at(x, y) = row[x][2] / 255.0f;
    }
  }
  return out;
}

}  // namespace

std::vector<int> spread_views(const std::vector<View>& views, const Eigen::Vector3d& target,
                              int count) {
  std::vector<int> chosen;
  if (views.empty() || count <= 0) return chosen;
  std::vector<Eigen::Vector3d> direction;
  for (const View& view : views)
    direction.push_back((view.center_in_world() - target).normalized());
  chosen.push_back(0);
  std::vector<double> nearest(views.size(), -2);  // largest cosine to a chosen view
  while (int(chosen.size()) < std::min<int>(count, int(views.size()))) {
    int best = -1;
    for (size_t i = 0; i < views.size(); ++i) {
      nearest[i] = std::max(nearest[i], direction[i].dot(direction[chosen.back()]));
      const bool taken = std::find(chosen.begin(), chosen.end(), int(i)) != chosen.end();
      if (!taken && (best < 0 || nearest[i] < nearest[best])) best = int(i);
    }
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Picture draw_overlay(const std::vector<PaintedLine>& lines, const View& view,
                     const Picture& picture, int longest) {
  const int size = std::max({view.camera.width, view.camera.height, 1});
  const Pen pen = {&view, std::min(1.0, double(longest) / size)};
  cv::Mat canvas = canvas_of(picture, view.camera, pen.scale);
  for (const PaintedLine& line : lines) {
    const auto& c = line.color;
    cv::polylines(canvas, project_runs(line.points, pen), false, cv::Scalar(c[0], c[1], c[2]) * 255,
                  line.width, cv::LINE_AA, kSubPixelBits);
  }
  return picture_of(canvas);
}

std::vector<PaintedLine> painted_curves(const Sketch& sketch) {
  std::vector<PaintedLine> lines;
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    if (!(length > 0)) continue;
    // Lines too are sampled: a part of them may lie behind the camera.
    lines.push_back({sample_stroke(sketch, s, length / 96), kind_color(sketch.strokes[s].kind)});
  }
  return lines;
}

std::vector<std::string> write_overlays(const std::string& folder, const std::string& prefix,
                                        const std::vector<PaintedLine>& lines,
                                        const std::vector<View>& views,
                                        const Eigen::Vector3d& target, int count,
                                        const std::function<void(const std::string&)>& warn,
                                        int longest) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename().string().rfind(prefix + "_", 0) == 0 &&
        entry.path().extension() == ".png")
      fs::remove(entry.path(), ignored);
  std::vector<std::string> paths;
  for (const int v : spread_views(views, target, count)) {
    Picture picture;
    try {
      picture = read_picture(views[v].image_path);
    } catch (const InputError& e) {
      warn(e.what());
    }
    paths.push_back(folder + "/" + prefix + "_" + fs::path(views[v].name).stem().string() + ".png");
    write_png(paths.back(), draw_overlay(lines, views[v], picture, longest));
  }
  return paths;
}

}  // namespace sketchsplat
