// SPDX-License-Identifier: MIT
// Makes the picture of README.md: the same square out of the middle of several pictures, side by
// side. Not part of the program; see ./run picture.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <string>

#include "datasets/io/image_io.h"

namespace sketchsplat {
namespace {

constexpr int kPanel = 420, kGap = 6;  // [px]

// The middle `share` of a channel, on white where it is transparent, kPanel px wide and high.
cv::Mat panel(Image<float> channel, const Image<float>& alpha, double share) {
  for (size_t i = 0; i < channel.data.size() && !alpha.empty(); ++i)
    channel.data[i] = channel.data[i] * alpha.data[i] + 1 - alpha.data[i];
  const cv::Mat whole(channel.height, channel.width, CV_32F, channel.data.data());
  const int side = int(share * std::min(channel.width, channel.height));
  const cv::Rect middle((channel.width - side) / 2, (channel.height - side) / 2, side, side);
  cv::Mat out;
  cv::resize(whole(middle), out, {kPanel, kPanel}, 0, 0, cv::INTER_AREA);
  return out;
}

void place(const cv::Mat& part, int x, Image<float>* out) {
  cv::Mat whole(out->height, out->width, CV_32F, out->data.data());
  part.copyTo(whole(cv::Rect(x, 0, kPanel, kPanel)));
}

void join(const std::string& path, double share, const std::vector<std::string>& inputs) {
  const int n = int(inputs.size());
  Picture out;
  out.red = out.green = out.blue = Image<float>(n * kPanel + (n - 1) * kGap, kPanel, 1.0f);
  for (int i = 0; i < n; ++i) {
    const Picture in = read_picture(inputs[i]);
    const int x = i * (kPanel + kGap);
    place(panel(in.red, in.alpha, share), x, &out.red);
    place(panel(in.green, in.alpha, share), x, &out.green);
    place(panel(in.blue, in.alpha, share), x, &out.blue);
  }
  write_png(path, out);
}

}  // namespace
}  // namespace sketchsplat

int main(int argc, char** argv) {
  const double share = argc > 3 ? std::atof(argv[2]) : 0;
  if (!(share > 0 && share <= 1)) {
    std::fprintf(stderr,
                 "usage: picture_tool OUT.png SHARE IN.png...  (SHARE of the middle, 0 to 1)\n");
    return 2;
  }
  try {
    sketchsplat::join(argv[1], share, {argv + 3, argv + argc});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "picture_tool: %s\n", e.what());
    return 1;
  }
  return 0;
}
