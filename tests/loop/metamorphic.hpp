/// Random scenes that can be told another way: turned, mirrored, in other units, in another order.
#pragma once

#include "scenes.hpp"

#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace metamorphic {

using namespace scenes;

/// How many scenes are drawn: 200, some ten seconds of all tests together, or as the environment variable DELASSUS_SEEDS says.
inline unsigned seeds() {
  const char* said = std::getenv("DELASSUS_SEEDS");
  return said ? unsigned(std::max(1, std::atoi(said))) : 200;
}

/// Random numbers, the same from every compiler.
struct Draw {
  std::mt19937 random;
  double operator()(double low, double high) { return low + (high - low) * double(random()) / 4294967295.0; }
  Vec3 vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }
};

struct Link {
  int a, b;  ///< bodies; a = −1: the world
  Vec3 local_a, local_b;
};

/// Balls and capsules on a slope and in the air, some hanging on each other or on the world. All in SI units.
struct Scene {
  std::vector<RigidBody> bodies;
  std::vector<Link> links;
  Vec3 gravity{0, 0, -g}, normal{0, 0, 1};
  double offset = 0;  ///< of the floor along its normal, m
  bool has_floor = true;
  double h = 0.01, push_out = 1;  ///< s, m/s
  double friction = 0.5;
};

inline Scene draw(unsigned seed, bool has_floor = true) {
  Draw number{std::mt19937(seed)};
  const auto vector = [&](double size) { return number.vector(size); };
  Scene scene;
  scene.has_floor = has_floor;
  scene.normal = (Vec3(0, 0, 1) + vector(0.2)).normalized();
  for (int k = 0; k < 8; ++k) {
    const double size = number(0.2, 0.5), mass = std::exp(number(-1, 1));
    const Vec3 at = 1.1 * Vec3(k % 3, k / 3, 0) + vector(0.1), v = vector(1), w = vector(2);
    const Quat turn = exponential<double>(vector(2));
    const bool is_ball = k % 2 == 0;
    // Just above the slope; what hangs on the world well above it, so that joint and floor never contradict
    // each other.
    const double clear = size + number(0, 0.1) + (k >= 6 ? 0.5 : 0),
                 up = (clear - scene.normal.dot(at)) / scene.normal[2];
    scene.bodies.push_back({.position = at + Vec3(0, 0, up),
                            .orientation = turn,
                            .velocity = v,
                            .angular_velocity = w,
                            .mass = mass,
                            .shape = is_ball ? Shape(Sphere{size}) : Shape(Capsule{0.5 * size, size})});
  }
  for (const auto& [a, b] : {std::pair{-1, 7}, {7, 6}, {0, 1}})
    scene.links.push_back({a, b, vector(0.3), vector(0.3)});
  // Every link starts closed: its second end is where its first one is.
  for (Link& link : scene.links) {
    const RigidBody& b = scene.bodies[std::size_t(link.b)];
    const Vec3 end = b.position + b.orientation * link.local_b;
    if (link.a < 0) {
      link.local_a = end;
    } else {
      const RigidBody& a = scene.bodies[std::size_t(link.a)];
      link.local_a = a.orientation.conjugate() * (end - a.position);
    }
  }
  return scene;
}

/// How the bodies are afterwards, in the order of the scene.
struct State {
  std::vector<Vec3> x, v, w;
  std::vector<Quat> q;
  std::size_t contacts = 0;  ///< of the last step
  int solved_steps = 0;      ///< before the first one with a solve that missed the tolerance
};

inline State run(const Scene& scene, int steps) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = scene.friction}}, BallJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 20000},
                     Baumgarte{.max_speed = scene.push_out}};
  auto& set = rigid_bodies(loop);
  set.gravity = scene.gravity;
  std::vector<RigidBodies::Handle> handles;
  for (const RigidBody& body : scene.bodies) handles.push_back(set.add(body));
  if (scene.has_floor) set.add_fixed(HalfSpace{scene.normal, 0}, scene.offset * scene.normal);
  const auto end = [&](int body, const Vec3& local) {
    return body < 0 ? world_anchor(local) : anchor(set, handles[std::size_t(body)], local);
  };
  for (const Link& link : scene.links)
    loop.add(BallJoint::Item{end(link.a, link.local_a), end(link.b, link.local_b)});
  State state{};
  bool is_solved = true;
  for (int n = 0; n < steps; ++n) {
    loop.step(scene.h);
    for (const SolveReport& r : loop.island_reports()) is_solved = is_solved && r.status <= Status::stalled;
    state.solved_steps += is_solved;
  }
  state.contacts = loop.contacts().size();
  for (const auto body : handles) {
    state.x.push_back(set.position(body));
    state.q.push_back(set.orientation(body));
    state.v.push_back(set.velocity(body));
    state.w.push_back(set.angular_velocity(body));
  }
  return state;
}

/// The largest difference of two states, in units of m, rad, m/s, rad/s as they stand; infinite where a
/// number is not one.
inline double difference(const State& a, const State& b) {
  double out = 0;
  const auto see = [&](double value) {
    out = std::isfinite(value) ? std::max(out, value) : std::numeric_limits<double>::infinity();
  };
  for (std::size_t k = 0; k < a.x.size(); ++k) {
    see((a.x[k] - b.x[k]).norm());
    see((a.v[k] - b.v[k]).norm());
    see((a.w[k] - b.w[k]).norm());
    see(std::min((a.q[k].coeffs() - b.q[k].coeffs()).norm(), (a.q[k].coeffs() + b.q[k].coeffs()).norm()));
  }
  return out;
}

}  // namespace metamorphic
