/// What sets of points keep of each: its place, its mass, and the radius of its sphere.
#pragma once

#include <delassus/bodies/inner/body_storage.hpp>
#include <delassus/core/array.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>

#include <cstddef>
#include <span>

namespace delassus::inner {

/// What `BodyStorage` is, for a set of particles or nodes.
template <class Set, class T>
class PointStorage : public BodyStorage<Set, T, 3> {
  using BodyStorage = inner::BodyStorage<Set, T, 3>;

 public:
  using typename BodyStorage::Handle, typename BodyStorage::Velocity;

  /// Adds a force (N) that acts during the next step only.
  void apply_force(Handle point, const Vec3& force) { load_[checked(point)] += converted<T>(force); }

  Vec3 position(Handle point) const { return converted<double>(x_[checked(point)]); }
  using BodyStorage::velocity;
  Vec3 velocity(Handle point) const { return converted<double>(v_[checked(point)]); }
  /// kg; of a node the share of the elements around it, a fixed one has its own too.
  T mass(Index b) const { return mass_[b]; }

  bool moves(Index b) const { return inverse_mass_[b] > T(0); }
  /// p += s M v.
  void add_mass_times_velocity(std::span<Velocity> p, double s) const {
    for (const Index b : slots_.active()) p[b] += T(s) * mass_[b] * v_[b];
  }
  void begin_step(double) {}
  /// Moves a point by a small displacement (m) without touching its velocity.
  void displace(Index b, const Velocity& by) {
    const Velocity moved = x_[b] + by;
    if (is_finite(moved)) x_[b] = moved;
  }
  void shift(double h) {
    shifted_x_ = x_;
    for (const Index b : slots_.active())
      if (moves(b)) x_[b] += T(h) * v_[b];
  }
  void restore() { x_ = shifted_x_; }

  bool has_collider(Index b) const { return slots_.is_alive(b) && radius_[b] > 0; }
  Shape shape(Index b) const { return Sphere{radius_[b]}; }
  Pose pose(Index b) const { return {converted<double>(x_[b]), identity<Mat3>()}; }

 protected:
  /// A place for a point, with room for its state.
  Index take(const auto& body, const Velocity& velocity) {
    const Index b = BodyStorage::take(body, velocity);
    const std::size_t n = std::size_t(slots_.size());
    for (auto* array : {&x_, &shifted_x_}) array->resize(n);
    for (auto* array : {&mass_, &inverse_mass_}) array->resize(n);
    radius_.resize(n);
    return b;
  }

  using BodyStorage::checked, BodyStorage::slots_, BodyStorage::v_, BodyStorage::load_;
  Array<Velocity> x_, shifted_x_;
  Array<T> mass_, inverse_mass_;
  Array<double> radius_;
};

}  // namespace delassus::inner
