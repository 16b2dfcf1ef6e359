// SPDX-License-Identifier: MIT
#include "topology/brep/face_plan.h"

#include <Geom_ElementarySurface.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sketchsplat::brep {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

constexpr const char* kWrongWay = "its loops run the wrong way round";
constexpr const char* kNotOne = "its loops bound more than one piece, or none";

struct TracedLoop {
  Trace trace;
  int winding = 0;  // around the seam's direction
};

std::vector<Eigen::Vector3d> border_of(const std::vector<Loop>& loops, const EdgeTable& edges) {
  constexpr int kSteps = 32;
  std::vector<Eigen::Vector3d> border;
  for (const Loop& loop : loops)
    for (const LoopStroke& s : loop)
      for (int i = 0; i < kSteps; ++i)
        border.push_back(edges.whole(s.stroke, s.forward).point(double(i) / kSteps));
  return border;
}

Trace trace_loop(const Chart& chart, const Loop& loop, const EdgeTable& edges) {
  std::vector<CurvePart> parts;
  for (const LoopStroke& s : loop) parts.push_back(edges.whole(s.stroke, s.forward));
  return trace(chart, parts);
}

// A place where a loop has the seam's coordinate.
struct Crossing {
  int stroke;
  double parameter;
  double height;  // second upright coordinate
};

class SeamFinder {
 public:
  SeamFinder(const FacePlan& plan, const std::vector<TracedLoop>& loops, const EdgeTable& edges)
      : plan_(plan), loops_(loops), edges_(edges) {}

  // First coordinates to try: of vertices first, then all around.
  std::vector<double> candidates() const {
    std::vector<double> out;
    if (plan_.chart.extruded()) return {0};  // where the profile begins
    for (size_t i = 0; i < loops_.size(); ++i) {
      if (loops_[i].winding == 0) continue;
      for (const LoopStroke& s : plan_.loops[i])
        for (const double v : edges_.vertices(s.stroke))
          out.push_back(first_of(to_eigen(edges_.curve(s.stroke).curve->Value(v))));
    }
    constexpr int kAround = 36;
    for (int k = 0; k < kAround; ++k) out.push_back(2 * M_PI * k / kAround);
    return out;
  }

  // Fills ends of the seam at a coordinate. Returns what it costs, in cuts; infinite if some loop
  // is crossed that must not be, or more than once.
  double try_at(double at, SeamEnd* lower, SeamEnd* upper, double heights[2]) const {
    double cost = 0;
    for (size_t i = 0; i < loops_.size(); ++i) {
      const std::vector<Crossing> crossings = crossings_of(int(i), at);
      if (crossings.size() != (loops_[i].winding == 0 ? 0 : 1))
        return std::numeric_limits<double>::infinity();
      if (crossings.empty()) continue;
      const Crossing& c = crossings[0];
      const bool up = loops_[i].winding < 0;
      *(up ? upper : lower) = {int(i), c.stroke, c.parameter};
      heights[up] = c.height;
      double found = c.parameter;
      const bool free = edges_.vertices(c.stroke).empty();  // it needs a vertex anyway
      if (!free && !edges_.find_vertex(c.stroke, &found)) cost += 1 + crowding(c);
    }
    return cost;
  }

 private:
  double first_of(const Eigen::Vector3d& p) const {
    return upright(plan_, plan_.chart.parameters(p)).x();
  }

  // Cuts should leave no short edges: 0 far from all vertices, up to 1 beside one.
  double crowding(const Crossing& c) const {
    const EdgeCurve& e = edges_.curve(c.stroke);
    double nearest = 1;
    for (const double v : edges_.vertices(c.stroke)) {
      double share = std::abs(c.parameter - v) / (e.last - e.first);
      if (e.closed) share = std::abs(share - std::round(share));
      nearest = std::min(nearest, share);
    }
    return std::max(0.0, 1 - 10 * nearest);
  }

  std::vector<Crossing> crossings_of(int loop, double at) const {
    std::vector<Crossing> out;
    const Trace& trace = loops_[loop].trace;
    for (size_t i = 0; i < trace.uv.size(); ++i) {
      const LoopStroke& s = plan_.loops[loop][i];
      const CurvePart part = edges_.whole(s.stroke, s.forward);
      const Matrix2Xd& uv = trace.uv[i];
      const int n = int(uv.cols()) - 1;
      for (int k = 0; k < n; ++k) {
        constexpr double kSame = 1e-7;
        const double a = upright(plan_, uv.col(k)).x(), b = upright(plan_, uv.col(k + 1)).x();
        const double low = std::min(a, b) - kSame, high = std::max(a, b) + kSame;
        const double target = at + 2 * M_PI * std::ceil((low - at) / (2 * M_PI));
        if (target > high) continue;
        add(refine(part, s.stroke, double(k) / n, double(k + 1) / n, target, a < b), &out);
      }
    }
    return out;
  }

  Crossing refine(const CurvePart& part, int stroke, double from, double to, double target,
                  bool rises) const {
    const auto past = [&](double share) {
      const double x = first_of(part.point(share));
      const double off = std::remainder(x - target, 2 * M_PI);
      return rises ? off > 0 : off < 0;
    };
    for (int i = 0; i < 60; ++i) {
      const double middle = (from + to) / 2;
      (past(middle) ? to : from) = middle;
    }
    double parameter = part.at((from + to) / 2);
    edges_.find_vertex(stroke, &parameter);
    const Eigen::Vector3d p = to_eigen(part.curve->Value(parameter));
    return {stroke, parameter, upright(plan_, plan_.chart.parameters(p)).y()};
  }

  // Neighbouring steps and strokes find the same place.
  void add(const Crossing& c, std::vector<Crossing>* out) const {
    const auto place = [&](const Crossing& x) {
      return edges_.curve(x.stroke).curve->Value(x.parameter);
    };
    for (const Crossing& other : *out)
      if (place(c).Distance(place(other)) <= edges_.near()) return;
    out->push_back(c);
  }

  const FacePlan& plan_;
  const std::vector<TracedLoop>& loops_;
  const EdgeTable& edges_;
};

void place_seam(const std::vector<TracedLoop>& loops, FacePlan* plan, EdgeTable* edges) {
  const SeamFinder finder(*plan, loops, *edges);
  double least = std::numeric_limits<double>::infinity(), heights[2] = {0, 0};
  for (const double at : finder.candidates()) {
    SeamEnd lower, upper;
    double h[2] = {0, 0};
    const double cost = finder.try_at(at, &lower, &upper, h);
    if (!(cost < least)) continue;
    least = cost;
    plan->at = at, plan->lower = lower, plan->upper = upper;
    std::copy(h, h + 2, heights);
  }
  if (!(least < 1e9)) throw Refused("it goes around its surface and leaves no place for a seam");
  const bool both = plan->lower.loop >= 0 && plan->upper.loop >= 0;
  const bool endless = plan->chart.period()[plan->winds_in_v ? 0 : 1] > 0;
  if (both && !endless && !(heights[0] < heights[1])) throw Refused(kWrongWay);
  for (const SeamEnd* end : {&plan->lower, &plan->upper})
    if (end->loop >= 0) edges->cut(end->stroke, end->parameter);
}

// Which poles a seam must run to where no loop is; throws if there is none.
void check_poles(int below, int above, bool all_around, const FacePlan& plan) {
  const auto pole = [&](int which) { return !std::isnan(plan.chart.pole(which)); };
  if (below > 1 || above > 1) throw Refused(kNotOne);
  if (all_around && plan.chart.period()[1] > 0) throw Refused("it is a whole torus but for holes");
  if (all_around && !(pole(0) && pole(1))) throw Refused(kWrongWay);
  if (below == 0 && !pole(0)) throw Refused(kNotOne);
  if (above == 0 && !pole(1)) throw Refused(pole(0) ? kWrongWay : kNotOne);
}

// Turns the frame of the surface so that its own seam, where u is 0, lies on the face's or opposite
// of the face: algorithms of OpenCASCADE are best there.
void turn_frame(const std::vector<TracedLoop>& loops, FacePlan* plan, double near) {
  double turn = plan->at;
  if (plan->chart.flat() || plan->chart.extruded()) return;
  if (!plan->seam || plan->winds_in_v) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const TracedLoop& loop : loops) {
      if (plan->outer >= 0 && &loop != &loops[size_t(plan->outer)]) continue;
      for (const Matrix2Xd& uv : loop.trace.uv) {
        low = std::min(low, uv.row(0).minCoeff());
        high = std::max(high, uv.row(0).maxCoeff());
      }
    }
    turn = (low + high) / 2 - M_PI;
  } else {
    plan->at = 0;
  }
  const auto surface = Handle(Geom_ElementarySurface)::DownCast(plan->chart.surface()->Copy());
  surface->Rotate(surface->Axis(), turn);
  plan->chart = Chart(surface, near);
}

}  // namespace

Vector2d upright(const FacePlan& plan, const Vector2d& uv) {
  return plan.winds_in_v ? Vector2d(uv.y(), -uv.x()) : uv;
}

FacePlan plan_face(const Solid& solid, const SolidFace& face, EdgeTable* edges) {
  std::vector<Loop> loops = face.loops;
  for (Loop& loop : loops) {
    if (!face.reversed) break;
    std::reverse(loop.begin(), loop.end());
    for (LoopStroke& s : loop) s.forward = !s.forward;
  }
  const Handle(Geom_Surface) surface =
      surface_of(solid.surfaces[face.surface], border_of(loops, *edges));
  FacePlan plan(Chart(surface, edges->near()));
  plan.loops = loops;
  plan.reversed = face.reversed;
  std::vector<TracedLoop> traced;
  int in_u = 0, in_v = 0;
  for (const Loop& loop : loops) {
    traced.push_back({trace_loop(plan.chart, loop, *edges)});
    const Eigen::Vector2i& w = traced.back().trace.winding;
    in_u += w[0] != 0, in_v += w[1] != 0;
    if (std::abs(w[0]) > 1 || std::abs(w[1]) > 1) throw Refused("a loop goes around it twice");
  }
  if (in_u > 0 && in_v > 0) throw Refused("its loops go around it in two directions");
  plan.winds_in_v = in_v > 0;
  int below = 0, above = 0, positive = 0;
  for (size_t i = 0; i < traced.size(); ++i) {
    TracedLoop& loop = traced[i];
    loop.winding = loop.trace.winding[plan.winds_in_v ? 1 : 0];
    below += loop.winding > 0, above += loop.winding < 0;
    if (loop.winding != 0 || !(loop.trace.area > 0)) continue;
    ++positive;
    plan.outer = int(i);
  }
  if (loops.empty()) {
    if (plan.chart.flat() || (plan.chart.period()[1] == 0 && std::isnan(plan.chart.pole(1))))
      throw Refused("it has no end");
    return plan;
  }
  if (positive > 1 || (positive == 1 && below + above > 0)) throw Refused(kNotOne);
  if (positive == 0) {
    check_poles(below, above, below + above == 0, plan);
    plan.seam = true;
    place_seam(traced, &plan, edges);
  }
  turn_frame(traced, &plan, edges->near());
  return plan;
}

}  // namespace sketchsplat::brep
