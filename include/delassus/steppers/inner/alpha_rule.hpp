/// The rule of the generalised-α family, by its four coefficients.
#pragma once

#include <delassus/steppers/inner/step_by_acceleration.hpp>

namespace delassus::inner {

/// With v̇ the acceleration and a the one that moves x,
///
///   (1 − α_m) a₊ + α_m a = (1 − α_f) v̇₊ + α_f v̇,
///   x₊ = x + h v + h² ((½ − β) a + β a₊),   v₊ = v + h ((1 − γ) a + γ a₊).
///
/// α_m = α_f = 0 is Newmark's, where a = v̇. What is kept is a, then v̇. Source: docs/references.md,
/// [ChungHulbert1993], [ArnoldBruls2007] eq. (6).
struct AlphaRule {
  double alpha_m, alpha_f, beta, gamma, h;

  double velocity_share() const { return h * gamma * (1 - alpha_f) / (1 - alpha_m); }
  double place_share() const { return h * h * beta * (1 - alpha_f) / (1 - alpha_m); }
  template <class V>
  PastMotion<V> begin(const V& acceleration) const {
    return {acceleration, acceleration};
  }
  template <class V>
  V guess(const PastMotion<V>& past) const {
    return past.second;
  }
  template <class V>
  PointMotion<V> move(const V& v, const PastMotion<V>& past, const V& next) const {
    using T = typename V::Scalar;
    const V now = moving(past, next);
    return {T(h) * v + T(h * h) * (T(0.5 - beta) * past.first + T(beta) * now),
            v + T(h) * (T(1 - gamma) * past.first + T(gamma) * now)};
  }
  template <class V>
  PastMotion<V> keep(const PastMotion<V>& past, const V& next) const {
    return {moving(past, next), next};
  }

 private:
  template <class V>
  V moving(const PastMotion<V>& past, const V& next) const {
    using T = typename V::Scalar;
    return T(1 / (1 - alpha_m)) *
           (T(1 - alpha_f) * next + T(alpha_f) * past.second - T(alpha_m) * past.first);
  }
};

}  // namespace delassus::inner
