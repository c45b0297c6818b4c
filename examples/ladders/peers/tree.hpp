/// What adapters share: turning, and the tree of joints that engines of reduced coordinates are built from.
#pragma once

#include "scene.hpp"

#include <cmath>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace ladders::peers {

inline Triple operator+(const Triple& a, const Triple& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Triple operator-(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Triple operator*(double s, const Triple& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Quadruple inverse(const Quadruple& q) { return {q[0], -q[1], -q[2], -q[3]}; }
inline Triple turned(const Quadruple& q, const Triple& x) {
  const Triple u{q[1], q[2], q[3]}, t = 2.0 * cross(u, x);
  return x + q[0] * t + cross(u, t);
}
inline Quadruple times(const Quadruple& a, const Quadruple& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
          a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1]};
}

/// A name of a body, "b7".
inline std::string numbered(std::string word, int number) { return word += std::to_string(number); }

/// An end of a joint at the start, in the world.
struct End {
  Triple point;
  Quadruple frame;
};
inline End end_of(const Scene& scene, int body, const Triple& point, const Quadruple& frame) {
  if (body < 0) return {point, frame};
  const State& s = scene.bodies[std::size_t(body)].start;
  return {s.position + turned(s.turn, point), times(s.turn, frame)};
}
inline End end_a(const Scene& scene, const Joint& j) { return end_of(scene, j.a, j.on_a, j.frame_a); }
inline End end_b(const Scene& scene, const Joint& j) { return end_of(scene, j.b, j.on_b, j.frame_b); }
inline Triple z_axis(const Quadruple& q) { return turned(q, {0, 0, 1}); }

/// Engines that take a joint's places from where the bodies are cannot start with one that is apart.
inline void expect_together(const Scene& scene) {
  for (const Joint& joint : scene.joints) {
    const End a = end_a(scene, joint), b = end_b(scene, joint);
    const Triple apart = a.point - b.point, tilt = cross(z_axis(a.frame), z_axis(b.frame));
    const double off = joint.hold == Hold::ball ? 0 : std::sqrt(dot(tilt, tilt));
    if (std::sqrt(dot(apart, apart)) > 1e-9 * (1 + std::sqrt(dot(a.point, a.point))) || off > 1e-9)
      throw Unsayable("its joints cannot start apart");
  }
}

/// The half-space n · x ≤ offset of the world that a fixed body is.
struct Plane {
  Triple normal;
  double offset;
};
inline Plane plane_of(const Body& body) {
  const auto& size = body.geometry.size;
  const Triple n = turned(body.start.turn, {size[0], size[1], size[2]});
  return {n, size[3] + dot(n, body.start.position)};
}

/// A spanning tree of the joints, from the world and what is fixed; the joints left over close loops.
struct Tree {
  std::vector<int> order;     ///< the bodies that move, parents first
  std::vector<int> parent;    ///< of each body; negative: the world, or what is fixed
  std::vector<int> joint;     ///< to its parent; negative: the body is free
  std::vector<int> closures;  ///< joints
  std::vector<std::vector<int>> children;

  explicit Tree(const Scene& scene)
      : parent(scene.bodies.size(), -1), joint(scene.bodies.size(), -1), children(scene.bodies.size()) {
    const int world = int(scene.bodies.size());
    const auto node = [&](int b) { return b < 0 || scene.bodies[std::size_t(b)].is_fixed ? world : b; };
    std::vector<std::vector<int>> at(scene.bodies.size() + 1);
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      at[std::size_t(node(scene.joints[k].a))].push_back(int(k));
      at[std::size_t(node(scene.joints[k].b))].push_back(int(k));
    }
    std::vector<char> is_reached(at.size(), 0), is_used(scene.joints.size(), 0);
    const auto spread = [&](int from) {
      std::deque<int> next{from};
      is_reached[std::size_t(from)] = 1;
      while (!next.empty()) {
        const int body = next.front();
        next.pop_front();
        if (body != world) order.push_back(body);
        for (const int k : at[std::size_t(body)]) {
          const Joint& j = scene.joints[std::size_t(k)];
          const int other = node(j.a) == body ? node(j.b) : node(j.a);
          if (is_reached[std::size_t(other)]) continue;
          is_reached[std::size_t(other)] = is_used[std::size_t(k)] = 1;
          joint[std::size_t(other)] = k;
          if (body != world) {
            parent[std::size_t(other)] = body;
            children[std::size_t(body)].push_back(other);
          }
          next.push_back(other);
        }
      }
    };
    spread(world);
    for (int b = 0; b < world; ++b)
      if (!is_reached[std::size_t(b)] && !scene.bodies[std::size_t(b)].is_fixed) spread(b);
    for (std::size_t k = 0; k < is_used.size(); ++k)
      if (!is_used[k]) closures.push_back(int(k));
  }

  /// Whether any joint holds the body, and so its velocity.
  bool is_free(int body) const { return joint[std::size_t(body)] < 0 && children[std::size_t(body)].empty(); }
};

/// The impulse (N·s, N·m·s) that gives a body that rests the velocity it starts with.
inline std::pair<Triple, Triple> starting_impulse(const Body& body) {
  const State& s = body.start;
  Triple w = turned(inverse(s.turn), s.spin);
  for (std::size_t k = 0; k < 3; ++k) w[k] *= body.moments[k];
  return {body.mass * s.velocity, turned(s.turn, w)};
}

}  // namespace ladders::peers
