/// Free rotation of a rigid body as a splitting into exact turns: a Lie-Poisson integrator.
#pragma once

#include <delassus/math/rotation.hpp>

namespace delassus {

/// q after h of free rotation with the spatial angular momentum L (N·m·s). With I⁻¹ = Σ d_k u_k u_kᵀ, the
/// factors of LDLᵀ, the energy is Σ ½ d_k (u_k·RᵀL)², and each term by itself turns the body about a = R u_k,
/// which stays, at the rate d_k a·L:
///
///   Φ_h = R₁(h/2) R₂(h/2) R₃(h) R₂(h/2) R₁(h/2).
///
/// Explicit, symmetric, second order; L is kept to rounding, the energy varies by O(h²) and does not drift.
/// With an I that is diagonal the u_k are its axes. `response`, where asked for, is ∂θ₊/∂L, θ₊ in the world's
/// axes:
///
///   Θ ← Θ + h d_k a (aᵀ + (a × L)ᵀ Θ)   at each turn.
///
/// Source: [McLachlan1993]; [LeimkuhlerReich2004], chapter 8.
template <class T>
Eigen::Quaternion<T> turn_freely(const Mat<3, 3, T>& inverse_inertia, Eigen::Quaternion<T> q,
                                 const Vec<3, T>& L, T h, Mat<3, 3, T>* response = nullptr) {
  Mat<3, 3, T> K = inverse_inertia;
  Vec<3, T> axis[3];
  T rate[3];
  for (int k = 0; k < 3; ++k) {
    rate[k] = K(k, k);
    set_zero(axis[k]);
    for (int i = k; i < 3; ++i) axis[k][i] = K(i, k) / rate[k];
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) K(i, j) -= rate[k] * axis[k][i] * axis[k][j];
  }
  if (response) response->setZero();
  for (const int k : {0, 1, 2, 1, 0}) {
    const T time = k == 2 ? h : h / 2;
    const Vec<3, T> a = q * axis[k];
    const T share = time * rate[k];
    if (response) {
      const Vec<3, T> across = cross(a, L);
      Vec<3, T> row;
      for (int j = 0; j < 3; ++j) row[j] = share * (a[j] + dot(across, Vec<3, T>(response->col(j))));
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) (*response)(i, j) += a[i] * row[j];
    }
    const Vec<3, T> turn = (share * dot(a, L)) * a;
    q = exponential<T>(turn) * q;
  }
  return unit_again(q);
}

}  // namespace delassus
