/// The native kernel: formulas where they exist, GJK while the cores are apart, EPA when they are not.
#pragma once

#include <delassus/collision/closed_forms.hpp>
#include <delassus/collision/epa.hpp>
#include <delassus/collision/gjk.hpp>

namespace delassus {

/// Exact to 1e-9 of the size for any convex pair, apart, touching or deep. Scale free: no absolute length
/// enters.
struct GjkEpa {
  static constexpr bool gives_least_depth = true;  ///< read by the certificate, which then asks for no second opinion

  /// Distance of two shapes, in the frame of A; `far` beyond `margin` (m).
  /// The search begins along `cache.guess`, where it is not zero.
  template <class Cache>
  SignedPair pair(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, Cache& cache) const noexcept {
    SignedPair r;
    if (closed_form(a, b, b_in_a, cache.guess, r)) {
      if (r.distance > margin) r.status = PairStatus::far;
      return r;
    }
    return convex(a, b, b_in_a, margin, cache.guess);
  }

  /// The general answer, for any two bodies with a support function.
  template <ConvexSupport A, ConvexSupport B>
  static SignedPair convex(const A& a, const B& b, const Pose& b_in_a, double margin, Vec3 guess) noexcept {
    const inner::Difference difference{a, b, b_in_a};
    const double radius = difference.radius();
    if (!(squared_norm(guess) > 0)) guess = b_in_a.position;
    if (!(squared_norm(guess) > 0)) guess = unit_axis(2);
    const inner::GjkResult apart = inner::gjk(difference, guess, margin + radius);
    const auto answer_apart = [&] {
      const inner::Simplex& s = apart.simplex;
      return answer(apart.normal, apart.separation - radius, s.mix(&inner::DifferencePoint::a), s.mix(&inner::DifferencePoint::b),
                    core_radius(a), core_radius(b));
    };
    if (apart.is_apart) {
      SignedPair r = answer_apart();
      if (r.distance > margin) r.status = PairStatus::far;
      return r;
    }
    const inner::EpaResult deep = inner::epa(difference, apart.simplex, guess);
    if (!(std::min(deep.h, -apart.separation) < std::numeric_limits<double>::infinity())) return {};
    // Both have proven a plane; when the cores touch within rounding, either may be the better one.
    if (-apart.separation < deep.h) return answer_apart();
    return answer(deep.normal, -deep.h - radius, deep.point_a, deep.point_b, core_radius(a), core_radius(b));
  }

 private:
  static SignedPair answer(const Vec3& normal, double distance, const Vec3& core_a, const Vec3& core_b,
                           double radius_a, double radius_b) {
    return {.status = PairStatus::near,
            .distance = distance,
            .normal = normal,
            .point_a = core_a + radius_a * normal,
            .point_b = core_b - radius_b * normal};
  }
};
}  // namespace delassus
