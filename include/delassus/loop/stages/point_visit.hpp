/// One joint that holds a point, between bodies that answer alone.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/unrolled.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace delassus {

/// A law whose rows are that a point of one body is one of the other.
template <class Law, class World>
concept HoldsPoint = Law::rows == 3 &&
                     requires(const Law& law, const typename Law::Item& item, const World& world) {
  law.place(item, world).point;
  law.place(item, world).gap;
};

/// What `JointVisit` is, for `law.place(item, world)`. With r from an end's centre of mass to the point,
///
///   u = v + ω × r,   W = 1/m − [r] K [r],   K = R I⁻¹ Rᵀ,
///
/// summed over the ends: a third of what the rows of H one by one take.
template <class World, int sa, int sb>
class PointVisit {
 public:
  static constexpr int R = 3;
  using T = typename World::Scalar;
  using Row = Vec<3, T>;

  double violation;

  template <class Law, class S>
  PointVisit(World& world, const Law& law, const typename Law::Item& item, const S& stabilisation, double h)
      : world_(world) {
    a_.block = item.a.block, b_.block = item.b.block;
    const auto [point, gap] = law.place(item, std::as_const(world));
    for (int k = 0; k < 6; ++k) w_[k] = T(0);
    answer<sa>(a_, point);
    answer<sb>(b_, point);
    if constexpr (requires { stabilisation.joint_compliance(h); })
      yield_ = T(stabilisation.joint_compliance(h));
    bias_ = {T(stabilisation.equality(gap[0], h)), T(stabilisation.equality(gap[1], h)),
             T(stabilisation.equality(gap[2], h))};
    violation = std::max({std::abs(gap[0]), std::abs(gap[1]), std::abs(gap[2])});
  }

  template <class Member>
  Row velocity(const Member& member) const {
    return bias_ + velocity_of<sa>(a_, member) - velocity_of<sb>(b_, member);
  }
  Row against(const Row& u) const {
    Mat<3, 3, T> S;
    S(0, 0) = w_[0] + yield_, S(1, 0) = w_[1], S(1, 1) = w_[2] + yield_;
    S(2, 0) = w_[3], S(2, 1) = w_[4], S(2, 2) = w_[5] + yield_;
    return -solve_positive<3, T>(S, u);
  }
  Row response(const Row& lambda) const {
    const T x = lambda[0], y = lambda[1], z = lambda[2];
    return {(w_[0] + yield_) * x + w_[1] * y + w_[3] * z, w_[1] * x + (w_[2] + yield_) * y + w_[4] * z,
            w_[3] * x + w_[4] * y + (w_[5] + yield_) * z};
  }
  Row yields(const Row& lambda) const { return yield_ * lambda; }
  void push(const Row& lambda) const {
    push_end<sa>(a_, lambda);
    push_end<sb>(b_, -lambda);
  }
  T trace() const { return w_[0] + w_[2] + w_[5] + 3 * yield_; }
  template <class F>
  void each_moving(F&& f) const {
    if constexpr (sa >= 0)
      if (a_.over_mass > T(0)) f(std::integral_constant<int, sa>{}, a_.block);
    if constexpr (sb >= 0)
      if (b_.over_mass > T(0)) f(std::integral_constant<int, sb>{}, b_.block);
  }

 private:
  struct End {
    Index block;
    T over_mass;
    Vec<3, T> r, x, y, z;  ///< K (r × e_k)
  };
  template <int s>
  static constexpr bool turns = World::template width_of<s> == 6;

  template <int s>
  void answer(End& end, const Vec3& point) {
    if constexpr (s >= 0) {
      const auto& set = std::as_const(world_).template set<s>();
      const T m = end.over_mass = set.inverse_mass(end.block);
      if constexpr (turns<s>) {
        const T* k = set.inverse_inertia(end.block).data();  // K, column by column
        const Vec<3, T> r = end.r = (point - set.centre(end.block)).template cast<T>();
        const Vec<3, T> p(k[0], k[1], k[2]), q(k[3], k[4], k[5]), o(k[6], k[7], k[8]);
        end.x = q * r[2] - o * r[1];
        end.y = o * r[0] - p * r[2];
        end.z = p * r[1] - q * r[0];
        w_[0] += m + (end.x[1] * r[2] - end.x[2] * r[1]);
        w_[1] += end.x[2] * r[0] - end.x[0] * r[2];
        w_[2] += m + (end.y[2] * r[0] - end.y[0] * r[2]);
        w_[3] += end.x[0] * r[1] - end.x[1] * r[0];
        w_[4] += end.y[0] * r[1] - end.y[1] * r[0];
        w_[5] += m + (end.z[0] * r[1] - end.z[1] * r[0]);
      } else {
        w_[0] += m, w_[2] += m, w_[5] += m;
      }
    }
  }
  template <int s, class Member>
  Row velocity_of(const End& end, const Member& member) const {
    if constexpr (s < 0) {
      return {T(0), T(0), T(0)};
    } else {
      const auto& v = member(std::as_const(world_).template set<s>())[end.block];
      if constexpr (!turns<s>)
        return linear_part(v);
      else
        return linear_part(v) + angular_part(v).cross(end.r);
    }
  }
  template <int s>
  void push_end(const End& end, const Row& lambda) const {
    if constexpr (s >= 0) {
      auto& v = world_.template set<s>().v_next[end.block];
      unrolled<3>([&]<int k>() { v[k] += end.over_mass * lambda[k]; });
      if constexpr (turns<s>)
        unrolled<3>(
            [&]<int k>() { v[3 + k] += end.x[k] * lambda[0] + end.y[k] * lambda[1] + end.z[k] * lambda[2]; });
    }
  }

  World& world_;
  End a_, b_;
  T w_[6];  ///< W's lower triangle, row by row, without R
  T yield_ = 0;
  Row bias_;
};

}  // namespace delassus
