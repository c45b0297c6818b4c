/// One joint that holds a point, between bodies that answer alone.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/unrolled.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/schemes/inner/joint_visit.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace delassus {

/// A law whose rows are that a point of one body is one of the other, and no more: it says so by its own name, since a law
/// that derives from it may have other rows.
template <class Law>
concept HoldsPoint = requires { requires std::is_same_v<typename Law::holds_point, Law>; };

/// What `JointVisit` is, for `law.place(item, world)`; `sa` and `sb` are the sets of its ends, −1 for one that has no rows.
/// With r from an end's centre of mass to the point,
///
///   u = v + ω × r,   W = 1/m − [r] K [r],   K = R I⁻¹ Rᵀ,
///
/// summed over the ends: a third of what the rows of H one by one take.
template <class World, int sa, int sb>
class PointVisit {
 public:
  static constexpr int R = 3;
  using Row = Vec3;

  double violation;

  template <class Law, class S>
  PointVisit(World& world, const Law& law, const typename Law::Item& item, const S& stabilisation, double h) : world_(world) {
    a_.block = item.a.block, b_.block = item.b.block;
    const auto [point, gap] = law.place(item, std::as_const(world));
    for (double& w : w_) w = 0;
    answer<sa>(a_, point);
    answer<sb>(b_, point);
    if (answers()) yield_ = inner::joint_compliance_of(stabilisation, h);
    bias_ = {stabilisation.equality(gap[0], h), stabilisation.equality(gap[1], h), stabilisation.equality(gap[2], h)};
    violation = std::max({std::abs(gap[0]), std::abs(gap[1]), std::abs(gap[2])});
  }

  bool answers() const { return does_answer<sa>(a_) || does_answer<sb>(b_); }
  template <VisitVelocity which>
  Row velocity() const {
    return bias_ + velocity_of<which, sa>(a_) - velocity_of<which, sb>(b_);
  }
  /// δ = −(W + R)⁻¹ u, zero where no end answers.
  Row against(const Row& u) const {
    Mat3 S;
    S(0, 0) = w_[0] + yield_, S(1, 0) = w_[1], S(1, 1) = w_[2] + yield_;
    S(2, 0) = w_[3], S(2, 1) = w_[4], S(2, 2) = w_[5] + yield_;
    return -solve_positive<3, double>(S, u);
  }
  Row response(const Row& lambda) const {
    const double x = lambda[0], y = lambda[1], z = lambda[2];
    return {(w_[0] + yield_) * x + w_[1] * y + w_[3] * z, w_[1] * x + (w_[2] + yield_) * y + w_[4] * z,
            w_[3] * x + w_[4] * y + (w_[5] + yield_) * z};
  }
  Row yields(const Row& lambda) const { return yield_ * lambda; }
  void push(const Row& lambda) const {
    push_end<sa>(a_, lambda);
    push_end<sb>(b_, -lambda);
  }
  double own(int k) const { return w_[k == 0 ? 0 : k == 1 ? 2 : 5] + yield_; }
  template <class F>
  void each_moving(const World&, F&& f) const {
    if constexpr (sa >= 0)
      if (does_answer<sa>(a_)) f(std::integral_constant<int, sa>{}, a_.block);
    if constexpr (sb >= 0)
      if (does_answer<sb>(b_)) f(std::integral_constant<int, sb>{}, b_.block);
  }

 private:
  using T = typename World::Scalar;
  struct End {
    Index block;
    double over_mass;
    Vec3 r, x, y, z;  ///< K (r × e_k)
  };
  template <int s>
  static constexpr bool turns = World::template width_of<s> == 6;
  /// A kinematic body has no 1/m.
  template <int s>
  static bool does_answer(const End& end) {
    if constexpr (s < 0) return false;
    else return end.over_mass > 0;
  }

  template <int s>
  void answer(End& end, const Vec3& point) {
    if constexpr (s >= 0) {
      const auto& set = std::as_const(world_).template set<s>();
      const double m = end.over_mass = double(set.inverse_mass(end.block));
      if constexpr (turns<s>) {
        const T* k = set.inverse_inertia(end.block).data();  // K, column by column
        const Vec3 r = end.r = point - set.centre(end.block);
        const Vec3 p(k[0], k[1], k[2]), q(k[3], k[4], k[5]), o(k[6], k[7], k[8]);
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
  template <VisitVelocity which, int s>
  Row velocity_of(const End& end) const {
    if constexpr (s < 0) {
      return {0, 0, 0};
    } else {
      const auto& set = std::as_const(world_).template set<s>();
      const auto& v = which == VisitVelocity::free ? set.v_free[end.block] : set.v_next[end.block];
      const Vec3 linear = linear_part(v).template cast<double>();
      if constexpr (!turns<s>) return linear;
      else return linear + cross(Vec3(angular_part(v).template cast<double>()), end.r);
    }
  }
  template <int s>
  void push_end(const End& end, const Row& lambda) const {
    if constexpr (s >= 0) {
      if (!does_answer<s>(end)) return;
      auto& v = world_.template set<s>().v_next[end.block];
      unrolled<3>([&]<int k>() { v[k] += T(end.over_mass * lambda[k]); });
      if constexpr (turns<s>)
        unrolled<3>([&]<int k>() {
          v[3 + k] += T(end.x[k] * lambda[0] + end.y[k] * lambda[1] + end.z[k] * lambda[2]);
        });
    }
  }

  World& world_;
  End a_, b_;
  double w_[6];  ///< W's lower triangle, row by row, without R
  double yield_ = 0;
  Row bias_;
};

}  // namespace delassus
