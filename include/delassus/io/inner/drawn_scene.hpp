/// What of a running loop is drawn: its bodies once, and where they are as often as wanted.
#pragma once

#include <delassus/bodies/body_input.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/rows/alive.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// f(body, pose in the frame of the body) for each part of what a shape looks like; a kept one is asked of the layers of its backend.
/// Nothing of a shape that no layer keeps.
template <class Backend, class F>
void each_part(const Backend& backend, const Shape& shape, bool is_static, const F& f) {
  if (!shape.is_kept()) {
    f(recorded_body(shape, is_static), Pose{});
  } else if constexpr (requires { backend.compound(shape); }) {
    if (shape.kind != ShapeKind::compound) return each_part(backend.backend, shape, is_static, f);
    const auto& compound = backend.compound(shape);
    for (Index k = 0; k < compound.part_count(); ++k) f(recorded_body(compound.shape(k), is_static), compound.pose(k));
  } else if constexpr (requires { backend.with_surface(shape, [](const auto&) {}); }) {
    if (shape.kind != ShapeKind::mesh) return each_part(backend.backend, shape, is_static, f);
    backend.with_surface(shape, [&](const auto& surface) {
      std::vector<Vec3> points;
      std::vector<std::vector<Index>> faces;
      for (Index t = 0; t < surface.triangle_count(); ++t) {
        const auto triangle = surface.triangle(t);
        for (int k = 0; k < 3; ++k) {
          const std::size_t corner = std::size_t(triangle.corner[k]);
          if (corner >= points.size()) points.resize(corner + 1, zero<Vec3>());
          points[corner] = triangle.point[k];
        }
        faces.push_back({triangle.corner[0], triangle.corner[1], triangle.corner[2]});
      }
      f(recorded_surface(std::move(points), std::move(faces), is_static), Pose{});
    });
  } else if constexpr (requires { backend.backend; }) {
    each_part(backend.backend, shape, is_static, f);
  }
}

/// Bodies as they are when `begin` is called. A joint is drawn from the centre of one body through its anchors to the centre of the
/// other, a soft body as the edges of its surface.
class DrawnScene {
 public:
  void begin(const auto& loop, std::vector<RecordedBody>& bodies) {
    loop.world().each([&](const auto& set, auto s) {
      for (const Index b : alive(set)) {
        const std::size_t before = bodies.size();
        const auto draw = [&](RecordedBody body, const Pose& pose) {
          bodies.push_back(std::move(body));
          drawn_.push_back({Index(s), b, pose});
        };
        if (!set.has_collider(b)) draw(recorded_particle(has_mesh<decltype(set)> ? 1e-3 : 0.03), {});
        else if constexpr (requires { loop.contacts(); })  // it has a collision then
          each_part(loop.template policy<role::Collision>(), set.shape(b), is_fixed(set, b), draw);
        else
          draw(recorded_body(set.shape(b), is_fixed(set, b)), {});
        if (bodies.size() == before) draw(recorded_body(Shape{}, is_fixed(set, b)), {});
      }
      each_mesh(set, [&](Index, auto, const auto& body) { find_edges(Index(s), body); });
    });
  }

  RecordedFrame frame(const auto& loop) const {
    RecordedFrame frame;
    frame.time = loop.time();
    loop.world().each([&](const auto& set, auto s) {
      for (const Drawn& drawn : drawn_) {
        if (drawn.set != Index(s)) continue;
        const Pose pose = set.pose(drawn.block);
        frame.poses.push_back({pose.to_world(drawn.pose.position), Quat(Mat3(pose.rotation * drawn.pose.rotation))});
      }
    });
    if constexpr (requires { loop.contacts(); })
      for (const auto& c : loop.contacts())
        if (dot(c.impulse, c.record.normal) > 0)
          frame.contacts.push_back({c.record.point(), c.impulse, c.is_sliding ? RecordedState::sliding : RecordedState::sticking, c.record.normal});
    loop.each_joint([&](const Anchor& a, const Anchor& b) { add_joint(frame, loop.world(), a, b); });
    loop.world().each([&](const auto& set, auto s) {
      for (const auto& [of, a, b] : edges_)
        if (of == Index(s)) frame.lines.push_back({set.pose(a).position, set.pose(b).position});
    });
    return frame;
  }

 private:
  struct Drawn {
    Index set, block;
    Pose pose;  ///< of the part in the frame of the body
  };

  template <class Set>
  static constexpr bool has_mesh = requires(const std::remove_cvref_t<Set>& set) {
    set.each_mesh([](Index, auto, const auto&) {});
  };

  static void each_mesh(const auto& set, const auto& f) {
    if constexpr (has_mesh<decltype(set)>) set.each_mesh(f);
  }

  /// The edges of a body's surface, each once, by blocks of its set.
  void find_edges(Index set, const auto& body) {
    const std::size_t first = edges_.size();
    for (const auto& t : surface(body.mesh()))
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3];
        edges_.push_back({set, body.blocks()[std::min(a, b)], body.blocks()[std::max(a, b)]});
      }
    std::sort(edges_.begin() + std::ptrdiff_t(first), edges_.end());
    edges_.erase(std::unique(edges_.begin() + std::ptrdiff_t(first), edges_.end()), edges_.end());
  }

  /// A kinematic body has no mass that answers, and moves.
  static bool is_fixed(const auto& set, Index b) {
    if constexpr (requires { set.motion(b); }) return set.motion(b) == Motion::fixed;
    else return !set.moves(b);
  }

  static void add_joint(RecordedFrame& frame, const auto& world, const Anchor& a, const Anchor& b) {
    const Vec3 xa = world.point(a), xb = world.point(b);
    frame.lines.push_back({xa, xb});
    add_arm(frame, world, a, xa);
    add_arm(frame, world, b, xb);
  }
  /// From the centre of the anchor's body to the anchor; the world has no centre.
  static void add_arm(RecordedFrame& frame, const auto& world, const Anchor& anchor, const Vec3& end) {
    world.visit(anchor.set, [&](const auto& set, auto) {
      const Vec3 centre = set.pose(anchor.block).position;
      if (centre != end) frame.lines.push_back({centre, end});
    });
  }

  std::vector<Drawn> drawn_;                 ///< sets in their order
  std::vector<std::array<Index, 3>> edges_;  ///< set and two of its blocks
};

}  // namespace delassus::inner
