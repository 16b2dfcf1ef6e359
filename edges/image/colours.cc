// SPDX-License-Identifier: MIT
#include "edges/image/colours.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr int kBins = 32;         // a channel
constexpr double kMostNats = 3;   // that a pixel tells
constexpr double kUnseen = 1e-6;  // share of a bin: a thirtieth of it, if all were alike

int level_of(float value) { return std::clamp(int(value * kBins), 0, kBins - 1); }

}  // namespace

Colours::Colours() : count_(size_t(kBins) * kBins * kBins) {}

Image<int> Colours::bins_of(const Picture& picture) {
  Image<int> out(picture.width(), picture.height());
  for (size_t i = 0; i < out.data.size(); ++i)
    out.data[i] =
        (level_of(picture.blue.data[i]) * kBins + level_of(picture.green.data[i])) * kBins +
        level_of(picture.red.data[i]);
  return out;
}

void Colours::add(const Colours& others) {
  for (size_t i = 0; i < count_.size(); ++i) count_[i] += others.count_[i];
  total_ += others.total_;
}

void Colours::spread() {
  for (const int step : {1, kBins, kBins * kBins}) {
    const std::vector<float> from = count_;
    for (int i = 0; i < int(from.size()); ++i) {
      const int at = i / step % kBins;
      const auto there = [&](int by) {
        return at + by < 0 || at + by >= kBins ? 0.f : from[size_t(i + by * step)];
      };
      count_[size_t(i)] =
          (6 * from[size_t(i)] + 4 * (there(-1) + there(1)) + there(-2) + there(2)) / 16;
    }
  }
}

double Colours::share(int bin) const {
  return count_[size_t(bin)] / std::max(1.0, total_) + kUnseen;
}

double nats_of(double share_on_object, double share_around) {
  return std::clamp(std::log(share_on_object / share_around), -kMostNats, kMostNats);
}

Picture odds_by_colours(const Picture& picture, const Image<Side>& side) {
  const Image<int> bin = Colours::bins_of(picture);
  Colours object, around;
  for (size_t i = 0; i < bin.data.size(); ++i) {
    if (side.data[i] == Side::kObject) object.add(bin.data[i]);
    if (side.data[i] == Side::kAround) around.add(bin.data[i]);
  }
  if (std::min(object.total(), around.total()) < kFewestColoured) return {};
  object.spread(), around.spread();
  Picture out;
  out.red = Image<float>(bin.width, bin.height);
  for (size_t i = 0; i < bin.data.size(); ++i) {
    const double nats = nats_of(object.share(bin.data[i]), around.share(bin.data[i]));
    out.red.data[i] = float(0.5 + 0.5 * nats / kMostNats);
  }
  out.green = out.blue = out.red;
  return out;
}

}  // namespace sketchsplat
