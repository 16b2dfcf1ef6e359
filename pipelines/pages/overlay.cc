// SPDX-License-Identifier: MIT
#include "pipelines/pages/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sketches/curve/curve.h"

namespace sketchsplat {
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

std::array<float, 3> kind_color(StrokeKind kind) {
  switch (kind) {
    case StrokeKind::kLine:
      return {0.15f, 0.39f, 0.92f};
    case StrokeKind::kArc:
      return {0.92f, 0.35f, 0.05f};
    case StrokeKind::kCircle:
      return {0.86f, 0.15f, 0.15f};
    case StrokeKind::kEllipse:
      return {0.58f, 0.20f, 0.92f};
    case StrokeKind::kBezier:
      return {0.09f, 0.64f, 0.29f};
    case StrokeKind::kEllipticArc:
      return {0.86f, 0.15f, 0.60f};
  }
  return {0, 0, 0};
}

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

Picture draw_overlay(const Sketch& sketch, const View& view, const Picture& picture, int longest) {
  std::vector<PaintedLine> lines;
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    if (!(length > 0)) continue;
    // Lines too are sampled: a part of them may lie behind the camera.
    lines.push_back({sample_stroke(sketch, s, length / 96), kind_color(sketch.strokes[s].kind)});
  }
  return draw_overlay(lines, view, picture, longest);
}

}  // namespace sketchsplat
