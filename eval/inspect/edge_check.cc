// SPDX-License-Identifier: MIT
#include "eval/inspect/edge_check.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

// Places of a curved piece. A deviation is about a polynomial of low degree along the curve: a
// parabola that is largest between two of 13 places is 1.4 % less there, a cubic 4.2 %.
constexpr int kPlaces = 13;
constexpr double kBetween = 0.95;

// Places beside one stroke, a few of many. Two lines are farthest apart at an end.
std::vector<EdgePlace> few_places(const EdgeMatch& match, int stroke, bool straight) {
  std::vector<EdgePlace> all, few;
  for (const EdgePlace& p : match.places)
    if (p.stroke == stroke) all.push_back(p);
  const int count = std::min(straight ? 2 : kPlaces, int(all.size()));
  for (int i = 0; i < count; ++i)
    few.push_back(all[count > 1 ? i * (all.size() - 1) / size_t(count - 1) : 0]);
  return few;
}

void summarise(const EdgeMatch& match, EdgeCheck* check) {
  std::vector<std::pair<double, double>> gaps;
  double total = 0, below = 0;
  for (const EdgePlace& p : match.places) {
    if (p.stroke < 0) continue;
    gaps.push_back({p.deviation.norm(), p.length});
    check->mean += p.length * p.deviation.norm();
    total += p.length;
  }
  if (gaps.empty()) return;
  check->mean /= total;
  std::sort(gaps.begin(), gaps.end());
  check->largest = check->p95 = gaps.back().first;
  for (const auto& [gap, length] : gaps)
    if ((below += length) >= 0.95 * total) {
      check->p95 = gap;
      break;
    }
}

void judge(EdgeCheck* check) {
  if (check->presence == Presence::kNotVisible) {
    check->verdict = Judgement::kNotJudged;
    return;
  }
  if (check->largest_drawn.empty()) return;
  check->verdict = verdict_of(check->within.likely);
  const bool whole = check->presence == Presence::kFound && !check->open;
  if (check->verdict == Judgement::kIn && !whole) check->verdict = Judgement::kUndecided;
}

}  // namespace

const char* verdict_name(Judgement verdict) {
  constexpr const char* kNames[] = {"in", "out", "undecided", "not judged"};
  return kNames[int(verdict)];
}

Judgement verdict_of(double probability) {
  return probability >= kSure       ? Judgement::kIn
         : probability <= 1 - kSure ? Judgement::kOut
                                    : Judgement::kUndecided;
}

EdgeCheck check_edge(const EdgeMatch& match, const NominalEdge& edge, const Sketch& measured,
                     bool held, double tolerance, const SigmaModel& sigma) {
  EdgeCheck out;
  out.presence = match.presence;
  out.found = match.found;
  out.visible = match.visible;
  out.tolerance = tolerance;
  summarise(match, &out);
  std::vector<DeviationModel> pieces;
  for (const int s : match.strokes) {
    const bool straight =
        edge.kind == StrokeKind::kLine && measured.strokes[s].kind == StrokeKind::kLine;
    PieceErrors errors = piece_errors(measured, few_places(match, s, straight), held, sigma);
    errors.model.between = straight ? 1 : kBetween;
    out.sigma = std::max(out.sigma, errors.sigma);
    out.systematic = std::max(out.systematic, errors.systematic);
    out.open = out.open || is_open(measured, s);
    pieces.push_back(std::move(errors.model));
  }
  if (!pieces.empty()) {
    bound_tube(pieces, sigma.tail(), tolerance, &out.within);
    out.largest_drawn = draw_largest(pieces, sigma.tail());
    out.within.likely =
        std::clamp(share_within(out.largest_drawn, tolerance), out.within.low, out.within.high);
    if (out.open) out.within.low = 0;
  }
  judge(&out);
  return out;
}

}  // namespace sketchsplat
