/// The inertia of a rotor that turns with a joint: it couples the two bodies through their relative acceleration.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/world_view.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus {

namespace inner {

/// The gradient of a coordinate: q̇ = linear · (v_b − v_a) at x_b + angular · (ω_b − ω_a).
struct CoordinateGradient : JointFrames {
  Vec3 linear = zero<Vec3>(), angular = zero<Vec3>();

  explicit CoordinateGradient(const JointFrames& frames) : JointFrames(frames) {}
  void along(int, const Vec3& direction) { linear += direction; }
  void about(int, const Vec3& axis) { angular += axis; }
};

/// The rate of item i of rows of one each, with the velocities of all sets.
template <class T>
T rotor_rate(const RowArrays<T>& rows, Index i, const T* const* v) {
  T u[1];
  rate(rows, i, v, u);
  return u[0];
}

}  // namespace inner

/// The rows of `RotorInertia` in a step: λ = −I (u⁺ − u), u the rate that the last step gave the rotor. That is compliance 1/I and bias −u.
struct RotorStages {
  template <class P>
  struct State {};

  /// What the rows add to a step.
  template <class Base>
  struct stages : Base {
    /// Writes compliance, bias and free velocity of each rotor.
    static void make_bias(auto& step) {
      Base::make_bias(step);
      const inner::BodyVelocities v(std::as_const(step).world());
      each_rotor(step, [&](auto& item, const auto& rows, Index i) {
        using T = std::remove_cvref_t<decltype((*rows.d)[0])>;
        const std::size_t row = std::size_t(i);
        const T before = std::isnan(item.rate) ? inner::rotor_rate<T>(rows, i, v.start) : T(item.rate);
        (*rows.compliance)[row] = T(1 / item.inertia);
        (*rows.bias)[row] = -before;
        (*rows.d)[row] = inner::rotor_rate<T>(rows, i, v.free) - before;
      });
    }
    /// Bodies turn after the solve, and change their rates without the rotor: it keeps its own.
    static void advance(auto& step) {
      using World = std::remove_cvref_t<decltype(step.world())>;
      using T = typename World::Scalar;
      const T* next[World::set_count + 1];
      step.world().each([&](const auto& set, auto s) { next[s] = reinterpret_cast<const T*>(set.v_next.data()); });
      each_rotor(step, [&](auto& item, const auto& rows, Index i) { item.rate = double(inner::rotor_rate<T>(rows, i, next)); });
      Base::advance(step);
    }

   private:
    /// f(item, rows, i) for all rotors.
    static void each_rotor(auto& step, auto&& f) {
      each_pool(step.laws(), [&](auto p, auto& pool) {
        if constexpr (requires { requires std::remove_cvref_t<decltype(pool.law)>::resists; }) {
          const auto rows = step.arrays.all()[std::size_t(p)];
          for (Index i = 0; i < pool.count(); ++i) f(pool.items[pool.slots.active()[i]], rows, i);
        }
      });
    }
  };
};

/// A rotor of inertia I on one coordinate: what is needed to change q̇ besides the two bodies, as a geared motor does. Its motion is
/// that of the joint, and the carrier's turn does not spin it. The kinetic energy ½ I q̇² is not in that of the bodies. One row,
/// implicit, of first order with one solve a step and of second order under `NewtonMidpoint`.
template <class Coordinate = inner::Absent>
struct RotorInertia : Bilateral<1, Coordinate::winds ? 1u : 0u> {
  using Base = Bilateral<1, Coordinate::winds ? 1u : 0u>;  ///< the law of its row
  using overrides = Overrides<RotorStages>;
  static constexpr bool resists = true;  ///< read by `RotorStages` and by `NewtonMidpoint`: `inertia` of the item resists changes of the rate

  /// One axis and what turns with it.
  struct Item {
    /// Its z axis is the axis.
    Anchor a{}, b{};     ///< turns against a
    double inertia = 0;  ///< I > 0, kg·m² or kg: of a rotor behind a gear of ratio n, n² times its own
    double rate = from_pose;  ///< q̇ of the rotor, rad/s or m/s; at first that of the joint. If you set velocities of bodies, set it so again
  };

  static constexpr auto refines = Base::refines | refine::check;

  static void check(const Item& item) {
    Coordinate::check(item, "RotorInertia");
    inner::expect_number(item.inertia >= 1e-20 && item.inertia <= 1e20, "RotorInertia: inertia", item.inertia, "must lie in [1e-20, 1e20]");
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    Coordinate::write(joint, 0, 1);
    row.soft(0, 0, item.inertia);  // who does not know of `resists` takes it for no joint
  }
};

/// Of what is no coordinate of a joint; the loop's checks say so.
template <class Coordinate>
  requires(!AxisCoordinate<Coordinate>)
struct RotorInertia<Coordinate> {
  /// Read by the checks, which refuse it.
  using no_coordinate = Coordinate;
};

}  // namespace delassus
