// SPDX-License-Identifier: MIT
#include "datasets/synthetic/photo/photo_room.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "datasets/types/errors.h"
#include "datasets/synthetic/cad/flat_faces.h"
#include "datasets/synthetic/render/noise.h"
#include "datasets/tags/april_tag.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double kGap = 1e-4;  // between the part and the table: rays need it, nobody sees it

// Rotation whose z axis is where `up` looks.
Eigen::Matrix3d part_from_room(Up up) {
  const int axis = up == Up::kZ || up == Up::kMinusZ   ? 2
                   : up == Up::kY || up == Up::kMinusY ? 1
                                                       : 0;
  const double sign = up == Up::kMinusZ || up == Up::kMinusY || up == Up::kMinusX ? -1 : 1;
  Eigen::Matrix3d R;
  R.col(2) = sign * Eigen::Vector3d::Unit(axis);
  R.col(0) = Eigen::Vector3d::Unit((axis + 1) % 3);
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

// Builds in the room's axes.
class RoomBuilder {
 public:
  RoomBuilder(const PhotoOptions& options, float distance, float part_radius, float tag_size,
              std::uint64_t seed)
      : d_(distance), seed_(mix(seed ^ 0x70686f746f)) {
    taken_.push_back({Vector2f::Zero(), part_radius});
    reach_ = std::max(0.62f * d_, part_radius + 0.9f);
    add_walls();
    add_table();
    if (options.tag >= 0) add_tag(options.tag, tag_size);
    add_cards();
    add_things();
    add_lights();
  }
  PhotoRoom take() { return std::move(room_); }

 private:
  struct Disc {
    Vector2f centre;
    float radius;
  };

  float draw() { return float(uniform(hash(seed_, count_++, 0, 80))); }
  float draw(float low, float high) { return low + (high - low) * draw(); }
  std::uint64_t draw_seed() { return hash(seed_, count_++, 0, 81); }
  Color draw_color(float least_saturation, float most_saturation, float least, float most) {
    const float hue = draw(), saturation = draw(least_saturation, most_saturation);
    return color_of(hue, saturation, draw(least, most));
  }

  Pattern draw_print(float size) {
    static const PatternKind kinds[] = {PatternKind::kCells,  PatternKind::kMarble,
                                        PatternKind::kBricks, PatternKind::kDots,
                                        PatternKind::kText,   PatternKind::kStripes};
    Pattern p;
    p.kind = kinds[draw_seed() % 6];
    p.seed = draw_seed();
    p.light = draw_color(0.15f, 0.75f, 0.5f, 0.8f);
    p.dark = draw_color(0.15f, 0.75f, 0.05f, 0.3f);
    p.size = size * (p.kind == PatternKind::kText ? 0.35f : 1.0f) * draw(0.7f, 1.3f);
    return p;
  }

  Pattern plain(PatternKind kind, const Color& light, const Color& dark, float size) {
    return {kind, draw_seed(), light, dark, size, nullptr};
  }

  // The rectangle of `corner` and the sides `a` and `b`, whose normal is a x b.
  RoomFace& add_rectangle(const Vector3f& corner, const Vector3f& a, const Vector3f& b,
                          const Pattern& pattern) {
    add_flat_face({corner, corner + a, corner + a + b, corner + b}, &room_.mesh);
    room_.faces.push_back({corner, a.normalized(), b.normalized(), 0.0f, pattern, {}, 0.0f});
    return room_.faces.back();
  }

  void add_walls() {
    const float half = 2.4f * d_, floor = -1.0f * d_, height = 3.2f * d_;
    const Vector3f x(2 * half, 0, 0), y(0, 2 * half, 0), z(0, 0, height);
    const Vector3f low(-half, -half, floor);
    add_rectangle(
        low, x, y,
        plain(PatternKind::kPlanks, {0.42f, 0.36f, 0.3f}, {0.2f, 0.16f, 0.13f}, 0.25f * d_));
    add_rectangle(low + z, y, x,
                  plain(PatternKind::kPlaster, Color::Constant(0.8f), Color::Zero(), d_));
    const Vector3f sides[4][2] = {{low, y}, {low + y, x}, {low + x + y, -y}, {low + x, -x}};
    for (const auto& [corner, along] : sides) {
      const Color paint = draw_color(0.05f, 0.25f, 0.4f, 0.65f);
      // Normals look into the room.
      RoomFace& wall = add_rectangle(corner, along, z,
                                     plain(PatternKind::kPlaster, paint, Color::Zero(), 0.5f * d_));
      for (int i = 0; i < 4; ++i) {
        const float x_of = (0.14f + 0.24f * float(i) + draw(-0.04f, 0.04f)) * 2 * half;
        const Vector2f at{x_of, draw(0.8f, 2.3f) * d_};
        const Vector2f size{draw(0.2f, 0.4f) * d_, draw(0.2f, 0.4f) * d_};
        wall.cards.push_back({at, Vector2f::UnitX(), size, draw_print(0.15f * d_), 0.0f});
      }
    }
  }

  void add_table() {
    const float x = 1.1f * d_ + 0.4f, y = 0.85f * d_ + 0.4f, depth = 0.06f * d_;
    table_half_ = {x, y};
    const Vector3f a(2 * x, 0, 0), b(0, 2 * y, 0), down(0, 0, -depth), corner(-x, -y, 0);
    const Pattern top =
        plain(PatternKind::kWood, {0.46f, 0.29f, 0.16f}, {0.2f, 0.11f, 0.055f}, 0.5f);
    table_ = int(room_.faces.size());
    add_rectangle(corner, a, b, top);
    add_rectangle(corner + down, a, -down, top);
    add_rectangle(corner + a + down, b, -down, top);
    add_rectangle(corner + a + b + down, -a, -down, top);
    add_rectangle(corner + b + down, -b, -down, top);
    add_rectangle(corner + down, b, a, top);
  }

  // Free room for a disc on the table, near the part rather than far from it.
  bool find_place(float radius, Vector2f* place, bool beside_part = false) {
    constexpr int kTries = 300;
    const float least = taken_[0].radius + radius + 0.04f;
    const float most = beside_part ? least : std::max(reach_, least + 0.3f);
    for (int i = 0; i < kTries; ++i) {
      const float r = least + (most - least) * draw() * std::min(1.0f, 0.3f + float(i) / 150);
      const float a = float(2 * M_PI) * draw();
      const Vector2f at(r * std::cos(a), r * std::sin(a));
      if (((at.cwiseAbs() + Vector2f::Constant(radius)).array() > table_half_.array()).any())
        continue;
      const bool is_free = std::all_of(taken_.begin(), taken_.end(), [&](const Disc& disc) {
        return (disc.centre - at).norm() > disc.radius + radius + 0.02f;
      });
      if (!is_free) continue;
      taken_.push_back({at, radius});
      *place = at;
      return true;
    }
    return false;
  }

  bool add_card(const Vector2f& half, const Pattern& pattern, float margin,
                bool beside_part = false) {
    Vector2f at;
    if (!find_place(half.norm(), &at, beside_part)) return false;
    const float a = float(2 * M_PI) * draw();
    // The table's places count from its corner.
    room_.faces[table_].cards.push_back(
        {at + table_half_, {std::cos(a), std::sin(a)}, half, pattern, margin});
    return true;
  }

  void add_tag(int id, float size) {
    const TagBitmap tag = tag36h11(id);
    const int cells = tag.cells.width;
    const float half = 0.5f * size * float(cells) / float(cells - 2 * tag.border);
    Pattern pattern =
        plain(PatternKind::kBitmap, Color::Constant(0.82f), Color::Constant(0.03f), 1);
    pattern.bitmap = std::make_shared<Image<float>>(tag.cells);
    if (!add_card({half, half}, pattern, 0, /*beside_part=*/true))
      throw InputError("tag-size", "a tag that finds a place on the table", "a larger one");
    const Card& card = room_.faces[table_].cards.back();
    const Vector2f u = card.along, v(-u.y(), u.x()), middle = card.centre - table_half_;
    const int signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; ++i) {
      const Vector2f p = middle + 0.5f * size * (float(signs[i][0]) * u + float(signs[i][1]) * v);
      room_.tag_corners.col(i) << p.x(), p.y(), 0;
    }
    room_.has_tag = true;
  }

  void add_cards() {
    const Color paper = Color::Constant(0.78f), ink = Color::Constant(0.03f);
    for (int i = 0; i < 5; ++i) {
      const Vector2f half{draw(0.2f, 0.3f), draw(0.14f, 0.2f)};
      add_card(half, plain(PatternKind::kText, paper, ink, draw(0.03f, 0.055f)), 0.03f);
    }
    add_card({0.24f, 0.18f}, plain(PatternKind::kChecker, paper, ink, 0.06f), 0);
    for (int i = 0; i < 4; ++i) {
      const Vector2f half{draw(0.14f, 0.22f), draw(0.1f, 0.16f)};
      add_card(half, draw_print(0.07f), 0.02f);
    }
  }

  // Low enough for cameras to look over them at the part.
  void add_things() {
    for (int i = 0; i < 12; ++i) {
      const float radius = draw(0.08f, 0.2f);
      Vector2f at;
      if (!find_place(radius, &at)) continue;
      const float height = std::min(draw(0.12f, 0.5f), 0.35f * at.norm());
      if (draw() < 0.5f) {
        add_box(at, radius, height);
      } else {
        add_cylinder(at, radius, height);
      }
    }
  }

  void add_box(const Vector2f& at, float radius, float height) {
    const float turn = float(M_PI) * draw(), shape = draw(0.5f, 1.0f);  // of half the diagonal
    const Vector3f u(std::cos(turn), std::sin(turn), 0), v(-u.y(), u.x(), 0), z(0, 0, height);
    const Vector3f a = 2 * radius * std::sin(shape) * u, b = 2 * radius * std::cos(shape) * v;
    const Vector3f corner = Vector3f(at.x(), at.y(), 0) - 0.5f * (a + b);
    const Pattern print = draw_print(0.06f);
    add_rectangle(corner + z, a, b, print);
    const Vector3f sides[4][2] = {
        {corner, a}, {corner + a, b}, {corner + a + b, -a}, {corner + b, -b}};
    for (const auto& [foot, along] : sides) add_rectangle(foot, along, z, print);
  }

  void add_cylinder(const Vector2f& at, float radius, float height) {
    constexpr int kSides = 64;
    const Vector3f foot(at.x(), at.y(), 0), z(0, 0, height);
    const Pattern print = draw_print(0.06f);
    SurfaceMesh& mesh = room_.mesh;
    std::vector<Vector3f> rim;
    for (int i = 0; i < kSides; ++i) {
      const float angle = float(2 * M_PI) * float(i) / kSides;
      rim.push_back(foot + z + radius * Vector3f(std::cos(angle), std::sin(angle), 0));
    }
    add_flat_face(rim, &mesh);
    room_.faces.push_back({foot, Vector3f::UnitX(), Vector3f::UnitY(), 0.0f, print, {}, 0.0f});
    const int face = int(room_.faces.size());
    const unsigned first = unsigned(mesh.points.size());
    for (const Vector3f& high : rim)
      for (const Vector3f& p : {Vector3f(high - z), high}) {
        mesh.points.push_back(p);
        mesh.normals.push_back((high - z - foot).normalized());
      }
    for (unsigned i = 0; i < kSides; ++i) {
      const unsigned a = first + 2 * i, b = first + 2 * ((i + 1) % kSides);
      mesh.corners.push_back({a, b, b + 1});
      mesh.corners.push_back({a, b + 1, a + 1});
      mesh.face.insert(mesh.face.end(), 2, face);
    }
    room_.faces.push_back({foot, Vector3f::UnitX(), Vector3f::UnitZ(), radius, print, {}, 0.0f});
  }

  void add_lights() {
    const Vector3f lamp(0.9f * d_, -0.8f * d_, 1.9f * d_),
        window(-2.37f * d_, 0.5f * d_, 1.0f * d_);
    const Color warm(0.56f, 0.52f, 0.465f), sky(0.36f, 0.388f, 0.432f);
    room_.lights[0] = {lamp, {0.22f * d_, 0, 0}, {0, 0.14f * d_, 0}, {0, 0, -1}, warm};
    room_.lights[1] = {window, {0, 0.6f * d_, 0}, {0, 0, 0.55f * d_}, {1, 0, 0}, sky};
    const Pattern white = plain(PatternKind::kPlain, Color::Constant(1), Color::Zero(), 1);
    for (const AreaLight& light : room_.lights) {
      const Vector3f side =
          light.u.cross(light.v).dot(light.normal) > 0 ? light.u : Vector3f(-light.u);
      add_rectangle(light.centre - side - light.v, 2 * side, 2 * light.v, white).emission = 3;
    }
  }

  float d_, reach_ = 0;
  std::uint64_t seed_, count_ = 0;
  Vector2f table_half_ = Vector2f::Zero();
  int table_ = 0;
  std::vector<Disc> taken_;
  PhotoRoom room_;
};

void transform(const Eigen::Affine3d& unit_from_room, PhotoRoom* room) {
  room->unit_from_room = unit_from_room;
  const Eigen::Affine3f T = unit_from_room.cast<float>();
  const Eigen::Matrix3f R = T.linear();
  for (Vector3f& p : room->mesh.points) p = T * p;
  for (Vector3f& n : room->mesh.normals) n = R * n;
  for (RoomFace& face : room->faces) {
    face.origin = T * face.origin;
    face.u = R * face.u;
    face.v = R * face.v;
  }
  for (AreaLight& light : room->lights) {
    light.centre = T * light.centre;
    light.u = R * light.u;
    light.v = R * light.v;
    light.normal = R * light.normal;
  }
  if (room->has_tag) room->tag_corners = unit_from_room * room->tag_corners;
}

}  // namespace

Vector2f PhotoRoom::place_of(const Vector3f& point, int face) const {
  const RoomFace& f = faces[face];
  const Vector3f x = point - f.origin;
  Vector2f place(f.u.dot(x), f.v.dot(x));
  if (f.radius > 0) place.x() = f.radius * std::atan2(f.v.cross(f.u).dot(x), f.u.dot(x));
  return place;
}

const Card* PhotoRoom::card_at(const Vector2f& place, int face, Vector2f* inside) const {
  for (const Card& card : faces[face].cards) {
    *inside = card.inside(place);
    if (inside->minCoeff() >= 0 && (inside->array() < 2 * card.half.array()).all()) return &card;
  }
  return nullptr;
}

Color PhotoRoom::albedo(const Vector3f& point, int face, float footprint) const {
  const Vector2f place = place_of(point, face);
  Vector2f at;
  const Card* card = card_at(place, face, &at);
  if (!card) return faces[face].pattern.at(place, footprint);
  const Vector2f from_middle = (at - card->half).cwiseAbs();
  if ((from_middle.array() >= card->half.array() - card->margin).any()) return card->pattern.light;
  if (card->pattern.kind == PatternKind::kBitmap) at = at.cwiseQuotient(2 * card->half);
  return card->pattern.at(at, footprint);
}

PatternKind PhotoRoom::kind_at(const Vector3f& point, int face) const {
  Vector2f inside;
  const Card* card = card_at(place_of(point, face), face, &inside);
  return card ? card->pattern.kind : faces[face].pattern.kind;
}

PhotoRoom make_room(const PhotoOptions& options, const std::vector<Vector3f>& part, double distance,
                    double tag_size, std::uint64_t seed) {
  const Eigen::Matrix3d R = part_from_room(options.up);
  double lowest = 1e9, radius = 0;
  for (const Vector3f& p : part) {
    const Eigen::Vector3d in_room = R.transpose() * p.cast<double>();
    lowest = std::min(lowest, in_room.z());
    radius = std::max(radius, in_room.head<2>().norm());
  }
  Eigen::Affine3d unit_from_room(R);
  unit_from_room.translation() = R * Eigen::Vector3d(0, 0, lowest - kGap);
  PhotoRoom room =
      RoomBuilder(options, float(distance), float(radius), float(tag_size), seed).take();
  transform(unit_from_room, &room);
  return room;
}

}  // namespace sketchsplat
