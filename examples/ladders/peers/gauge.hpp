/// Measures a run from poses and velocities alone, by the same exact geometry whoever made them.
#pragma once

#include "scene_of.hpp"

#include <delassus/collision/queries.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace ladders::peers {

/// What one look at the bodies shows.
struct Reading {
  double penetration = 0;       ///< deepest, m: minus the signed distance of the shapes
  double mean_penetration = 0;  ///< of the pairs that overlap, m
  double joint_gap = 0;         ///< m or rad, the largest of all joints
  double energy = 0;            ///< kinetic and potential, J
  double speed = 0;             ///< of the fastest body, m/s
  /// By how much overlaps and joint gaps d grew since the last look, a second:
  ///
  ///   max over pairs and joints of (d(t + h) − d(t))⁺ / h,   d = the depth, or the gap.
  ///
  /// It is zero where the step's motion is one that contacts (which may only open) and joints allow, whatever
  /// the engine calls its residual.
  double growth = 0;
};

class Gauge {
 public:
  explicit Gauge(const Scene& scene) : scene_(scene) {
    hulls_.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) shapes_.push_back(shape_of(body.geometry));
    gaps_.assign(scene.joints.size(), 0);
  }
  Gauge(const Gauge&) = delete;

  /// `h` is the time since the last look; zero at the first, which has no growth.
  Reading read(std::span<const State> states, double h) {
    Reading out;
    for (std::size_t k = 0; k < states.size(); ++k) add_energy(scene_.bodies[k], states[k], out);
    read_pairs(states, h, out);
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      const double gap = gap_of(scene_.joints[k], states);
      out.joint_gap = std::max(out.joint_gap, gap);
      if (h > 0) out.growth = std::max(out.growth, (gap - gaps_[k]) / h);
      gaps_[k] = gap;
    }
    return out;
  }

 private:
  struct Overlap {
    std::pair<int, int> pair;
    double depth;
  };

  delassus::Shape shape_of(const Geometry& g) {
    using namespace delassus;
    switch (g.form) {
      case Form::none:
        return {};
      case Form::half_space:
        return HalfSpace{{g.size[0], g.size[1], g.size[2]}, g.size[3]};
      case Form::box:
        return Box{2 * g.size[0], 2 * g.size[1], 2 * g.size[2]};
      case Form::sphere:
        return Sphere{g.size[0]};
      case Form::capsule:
        return Capsule{g.size[0], 2 * g.size[1]};
      case Form::cylinder:
        return Cylinder{g.size[0], 2 * g.size[1]};
      case Form::convex:
        break;
    }
    std::vector<Vec3> corners;
    for (const Triple& x : g.corners) corners.push_back(vec(x));
    hulls_.emplace_back(corners);
    return hulls_.back();
  }

  /// ½ m v² + ½ ω·I ω − m g·x.
  void add_energy(const Body& body, const State& s, Reading& out) const {
    if (body.is_fixed) return;
    const Vec3 v = vec(s.velocity), w = quat(s.turn).conjugate() * vec(s.spin);
    out.energy += 0.5 * body.mass * v.squaredNorm() + 0.5 * w.dot(vec(body.moments).cwiseProduct(w)) -
                  body.mass * vec(scene_.gravity).dot(vec(s.position));
    out.speed = std::max(out.speed, v.norm());
  }

  /// All pairs whose boxes meet, by sorting along x; every body against every half-space.
  void read_pairs(std::span<const State> states, double h, Reading& out) {
    if (!scene_.touches) return;
    using namespace delassus;
    const std::size_t n = states.size();
    poses_.resize(n), boxes_.resize(n), order_.clear(), now_.clear();
    for (std::size_t k = 0; k < n; ++k) {
      if (shapes_[k].kind == ShapeKind::none) continue;
      poses_[k] = {vec(states[k].position), quat(states[k].turn).toRotationMatrix()};
      if (shapes_[k].kind == ShapeKind::half_space) continue;
      boxes_[k] = tight_box(shapes_[k], poses_[k]);
      order_.push_back(int(k));
    }
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
      return boxes_[std::size_t(a)].min()[0] < boxes_[std::size_t(b)].min()[0];
    });
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::size_t a = std::size_t(order_[i]);
      for (std::size_t j = i + 1; j < order_.size(); ++j) {
        const std::size_t b = std::size_t(order_[j]);
        if (boxes_[b].min()[0] > boxes_[a].max()[0]) break;
        if (boxes_[a].intersects(boxes_[b])) read_pair(a, b);
      }
      for (std::size_t b = 0; b < n; ++b)
        if (shapes_[b].kind == ShapeKind::half_space) read_pair(a, b);
    }
    compare(h, out);
  }

  void read_pair(std::size_t a, std::size_t b) {
    if (scene_.bodies[a].is_fixed && scene_.bodies[b].is_fixed) return;
    if (a > b) std::swap(a, b);
    const double depth = -delassus::separation(shapes_[a], poses_[a], shapes_[b], poses_[b]).distance;
    if (depth > 0) now_.push_back({{int(a), int(b)}, depth});
  }

  void compare(double h, Reading& out) {
    std::sort(now_.begin(), now_.end(), [](const Overlap& x, const Overlap& y) { return x.pair < y.pair; });
    auto old = before_.begin();
    double sum = 0;
    for (const Overlap& overlap : now_) {
      while (old != before_.end() && old->pair < overlap.pair) ++old;
      const double was = old != before_.end() && old->pair == overlap.pair ? old->depth : 0;
      if (h > 0) out.growth = std::max(out.growth, (overlap.depth - was) / h);
      out.penetration = std::max(out.penetration, overlap.depth);
      sum += overlap.depth;
    }
    if (!now_.empty()) out.mean_penetration = sum / double(now_.size());
    before_.swap(now_);
  }

  /// The distance of the joint's points, off its axis for a slider, or the angle between what shall be
  /// parallel.
  double gap_of(const Joint& joint, std::span<const State> states) const {
    const auto end = [&](int body, const Triple& point, const Quadruple& frame) {
      if (body < 0) return std::pair(vec(point), quat(frame));
      const State& s = states[std::size_t(body)];
      return std::pair(Vec3(vec(s.position) + quat(s.turn) * vec(point)), Quat(quat(s.turn) * quat(frame)));
    };
    const auto [xa, qa] = end(joint.a, joint.on_a, joint.frame_a);
    const auto [xb, qb] = end(joint.b, joint.on_b, joint.frame_b);
    Vec3 apart = xa - xb;
    const Vec3 za = qa * Vec3::UnitZ(), zb = qb * Vec3::UnitZ();
    double angle = 0;
    if (joint.hold == Hold::hinge) angle = std::atan2(za.cross(zb).norm(), za.dot(zb));
    if (joint.hold == Hold::slider || joint.hold == Hold::weld) {
      const Quat between = qa.conjugate() * qb;
      angle = 2 * std::atan2(between.vec().norm(), std::abs(between.w()));
    }
    if (joint.hold == Hold::slider) apart -= apart.dot(za) * za;
    return std::max(apart.norm(), angle);
  }

  const Scene& scene_;
  std::vector<delassus::ConvexHull> hulls_;
  std::vector<delassus::Shape> shapes_;
  std::vector<delassus::Pose> poses_;
  std::vector<delassus::Aabb> boxes_;
  std::vector<int> order_;
  std::vector<Overlap> now_, before_;
  std::vector<double> gaps_;
};

}  // namespace ladders::peers
