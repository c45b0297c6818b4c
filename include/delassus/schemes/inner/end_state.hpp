/// Where a step ends: places and velocities of all bodies, and how far two ends are apart.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

namespace delassus::inner {

/// The vector, rad, by which R turned is S, in the axes of the world.
inline Vec3 turn_between(const Mat3& R, const Mat3& S) {
  const Mat3 D = times_transposed<double>(S, R);
  const Vec3 twice_sine{D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1)};
  const double sine = 0.5 * norm(twice_sine), angle = std::atan2(sine, 0.5 * (D(0, 0) + D(1, 1) + D(2, 2) - 1));
  return sine > 0 ? Vec3(0.5 * angle / sine * twice_sine) : Vec3(zero<Vec3>());
}

/// Of a block: of a node of a rod too, whose collider is the piece behind it.
template <class Set>
Pose pose_of(const Set& set, Index b) {
  if constexpr (Set::width == 6) return {set.position(set.handle(b)), set.orientation(set.handle(b)).toRotationMatrix()};
  else return {set.position(set.handle(b)), identity<Mat3>()};
}

/// Whether nothing couples the bodies of a set: fast modes would grow by an extrapolation, however well the integrator holds them.
bool moves_by_block(const auto& set) {
  if constexpr (requires { set.is_separable(); }) return set.is_separable();
  else return false;
}

/// By how much one end differs from another, and which body does most.
struct EndError {
  double place = 0, velocity = 0;  ///< max |Δx|/L + |Δθ|, and of that body |Δv|/L + |Δω|, 1/s
  double sum = 0;                  ///< the largest place + τ velocity
  Index set = -1, block = -1;      ///< of which body
};

/// Places and velocities of the bodies that a step moves.
template <class World>
class EndState {
  using T = typename World::Scalar;

 public:
  void take(const World& world) {
    world.each([&](const auto& set, auto s) {
      auto& ends = std::get<s>(ends_);
      ends.resize(std::size_t(set.blocks()));
      for (const Index b : set.active()) ends[b] = {pose_of(set, b), set.velocity()[b]};
    });
  }

  /// Against where the bodies are now. τ (s) weighs velocities; `lengths` of blocks, m.
  template <class Lengths>
  EndError error(const World& world, const Lengths& lengths, double tau) const {
    EndError most;
    world.each([&](const auto& set, auto s) {
      const auto& ends = std::get<s>(ends_);
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        const double L = lengths.of(Index(s), b);
        const auto& [pose, velocity] = ends[b];
        const Pose now = pose_of(set, b);
        const auto& v = set.velocity()[b];
        double place = norm(Vec3(now.position - pose.position)) / L,
               speed = norm(converted<double>(linear_part(v) - linear_part(velocity))) / L;
        if constexpr (std::remove_cvref_t<decltype(set)>::width == 6) {
          place += norm(turn_between(pose.rotation, now.rotation));
          speed += norm(converted<double>(angular_part(v) - angular_part(velocity)));
        }
        double sum = place + tau * speed;
        if (!std::isfinite(sum)) sum = std::numeric_limits<double>::infinity();
        if (sum > most.sum || most.set < 0) most = {place, speed, sum, Index(s), b};
      }
    });
    return most;
  }

  /// Of where the bodies are now from here: of places, and of velocities; zero for bodies that do not move.
  template <class Differences>
  void difference(const World& world, Differences& places, Differences& velocities) const {
    world.each([&](const auto& set, auto s) {
      using Velocity = typename std::remove_cvref_t<decltype(set)>::Velocity;
      const auto& ends = std::get<s>(ends_);
      auto &x = std::get<s>(places), &v = std::get<s>(velocities);
      x.resize(std::size_t(set.blocks())), v.resize(std::size_t(set.blocks()));
      for (auto& y : x) set_zero(y);
      for (auto& y : v) set_zero(y);
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        const Pose now = pose_of(set, b);
        const auto way = converted<T>(Vec3(now.position - ends[b].pose.position));
        if constexpr (std::remove_cvref_t<decltype(set)>::width == 6) x[b] = twist<T>(way, converted<T>(turn_between(ends[b].pose.rotation, now.rotation)));
        else x[b] = way;
        v[b] = Velocity(set.velocity()[b] - ends[b].velocity);
      }
    });
  }

  /// Moves all bodies on from here through where they are now, by `share` of the way.
  void extrapolate(World& world, double share) const {
    world.each([&](auto& set, auto s) {
      using Velocity = typename std::remove_cvref_t<decltype(set)>::Velocity;
      const auto& ends = std::get<s>(ends_);
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        const Pose now = pose_of(set, b);
        Velocity by;
        const Vec3 way = share * (now.position - ends[b].pose.position);
        if constexpr (std::remove_cvref_t<decltype(set)>::width == 6)
          by = twist<T>(converted<T>(way), converted<T>(Vec3(share * turn_between(ends[b].pose.rotation, now.rotation))));
        else by = converted<T>(way);
        auto& v = set.velocity()[b];
        v += T(share) * Velocity(v - ends[b].velocity);
        set.displace(b, by);
      }
    });
  }

 private:
  template <class Set>
  struct End {
    Pose pose;
    typename Set::Velocity velocity;
  };
  template <class Set>
  using EndsOf = Array<End<Set>>;
  typename World::template PerSet<EndsOf> ends_;
};

/// The sizes by which errors of bodies count, m: the bounding radius of the shape, at least `least`. Without a shape that of a
/// ball of the same inertia; of a point `least`, or 1 m; of the nodes of a soft body half the diagonal of its box.
template <class World>
class BodyLengths {
 public:
  void take(const World& world, double least) {
    least_ = std::numeric_limits<double>::infinity();
    world.each([&](const auto& set, auto s) {
      auto& lengths = lengths_[std::size_t(int(s))];
      lengths.resize(std::size_t(set.blocks()));
      for (const Index b : set.active()) {
        lengths[b] = std::max(least, own(set, b));
      }
      take_soft(set, lengths, least);
      for (const Index b : set.active()) {
        if (!(lengths[b] > 0)) lengths[b] = 1;
        if (set.moves(b)) least_ = std::min(least_, lengths[b]);
      }
    });
  }
  double least() const { return least_; }  ///< of the bodies that move
  double of(Index set, Index b) const { return lengths_[std::size_t(set)][b]; }

 private:
  /// Nodes count in units of their body; those of rods in units of all rods.
  static void take_soft(const auto& set, Array<double>& lengths, double least) {
    const auto give = [&](const auto& blocks) {
      const double infinity = std::numeric_limits<double>::infinity();
      Vec3 low{infinity, infinity, infinity}, high = -low;
      for (const Index b : blocks) {
        const Vec3 x = pose_of(set, b).position;
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
      }
      for (const Index b : blocks) lengths[b] = std::max(least, 0.5 * norm(Vec3(high - low)));
    };
    if constexpr (requires { set.each_mesh([](Index, Index, const auto&) {}); }) set.each_mesh([&](Index, Index, const auto& body) { give(body.blocks()); });
    else if constexpr (requires { typename std::remove_cvref_t<decltype(set)>::BodyHandle; }) give(set.active());
  }
  static double own(const auto& set, Index b) {
    if constexpr (requires { typename std::remove_cvref_t<decltype(set)>::BodyHandle; }) return 0;
    if (set.has_collider(b)) {
      const Shape shape = set.shape(b);
      if (shape.has_volume() && !shape.is_kept()) return outer_radius(shape);
    }
    if constexpr (requires { set.inertia(b)(0, 0); }) {
      const double mass = double(set.mass(b));
      double most = 0;
      for (int k = 0; k < 3; ++k) most = std::max(most, double(set.inertia(b)(k, k)));
      return mass > 0 ? std::sqrt(2.5 * most / mass) : 0;
    }
    return 0;
  }
  double least_ = 0;
  std::array<Array<double>, std::size_t(World::set_count)> lengths_;
};

}  // namespace delassus::inner
