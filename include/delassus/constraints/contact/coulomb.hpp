/// Contact with Coulomb friction: a round cone, met exactly at every visit.
#pragma once

#include <delassus/constraints/contact/cone.hpp>
#include <delassus/constraints/refinements.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace delassus {
namespace inner {

/// The least pivot of elimination that takes the largest diagonal entry first: rounding of A, or less, where A is singular, however
/// far apart its regular directions are.
template <class T>
T least_pivot(Mat<3, 3, T> A) {
  T least = std::numeric_limits<T>::infinity();
  for (int k = 0; k < 3; ++k) {
    int largest = k;
    for (int i = k + 1; i < 3; ++i)
      if (A(i, i) > A(largest, largest)) largest = i;
    for (int i = 0; i < 3; ++i) std::swap(A(k, i), A(largest, i));
    for (int i = 0; i < 3; ++i) std::swap(A(i, k), A(i, largest));
    if (!(A(k, k) > T(0))) return T(0);
    least = std::min(least, A(k, k));
    for (int i = k + 1; i < 3; ++i)
      for (int j = k + 1; j < 3; ++j) A(i, j) -= A(i, k) * A(k, j) / A(k, k);
  }
  return least;
}

}  // namespace inner

/// u = W λ + b:  0 ≤ u_n ⟂ λ_n ≥ 0,  |λ_t| ≤ μ λ_n,  and λ_t = −μ λ_n u_t/|u_t| where the contact slips.
///
/// Exactly one of three cases holds for a contact whose neighbours are fixed.
///
///   Open:  b_n ≥ 0, and λ = 0.
///   Stick: λ = −W⁻¹ b lies in the cone.
///   Slip:  u_n = 0 and u_t = −α λ_t with α > 0. After eliminating λ_n,
///          (S + α 1) λ_t = −c,  S = W_tt − W_tn W_nt/W_nn,  c = b_t − W_tn b_n/W_nn.
///
/// In slip, α is the root of μ λ_n(α) = |λ_t(α)|. A bracketed iteration finds it, from the last α.
struct Coulomb {
  static constexpr int rows = 3;
  static constexpr std::array<RowKind, 3> kinds{RowKind::lower, RowKind::friction, RowKind::friction};
  static constexpr auto refines = refine::check | refine::set_friction | refine::prepare | refine::clamp | refine::natural_map |
                                  refine::natural_squares | refine::projection_step | refine::tangent | refine::convex_tangent | refine::is_sliding;

  double friction = 0.5;  ///< μ ≥ 0, where neither the pair nor the materials say otherwise

  /// Of one contact.
  struct Parameters {
    double friction;  ///< μ ≥ 0
  };

  /// What one contact's own block gives once a step, and the last α.
  template <class T>
  struct Memory {
    Mat<3, 3, T> inverse;  ///< of W, kg
    T schur[4];        ///< S, by columns
    T to_normal[2];    ///< W_nt / W_nn
    T from_normal[2];  ///< W_tn / W_nn
    T over_normal;     ///< 1 / W_nn
    T alpha = 0;  ///< root of the last slip, 1/kg; 0: none in this step
  };

  void check() const { inner::expect_not_negative("Coulomb: friction", friction); }

  Parameters parameters() const { return {friction}; }
  static void set_friction(Parameters& p, double friction) { p.friction = friction; }

  template <class T>
  void prepare(const Mat<3, 3, T>& W, Memory<T>& memory) const {
    // Only a block that is singular to rounding (an end that cannot turn, on a line) is lifted by rounding's share, so that
    // its inverse exists: any lift shifts the solution by as much.
    const T mean = trace(W) / T(3), rounding = T(64) * std::numeric_limits<T>::epsilon();
    const bool is_regular = W.determinant() > rounding * mean * mean * mean || inner::least_pivot(W) > rounding * mean;
    const T lift = is_regular ? T(0) : rounding * mean;
    Mat<3, 3, T> lifted = W;
    for (int k = 0; k < 3; ++k) lifted(k, k) += lift;
    memory.inverse = inverse(lifted);
    memory.over_normal = T(1) / lifted(0, 0);
    for (int i = 0; i < 2; ++i) {
      memory.to_normal[i] = lifted(0, i + 1) * memory.over_normal;
      memory.from_normal[i] = lifted(i + 1, 0) * memory.over_normal;
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        memory.schur[i + 2 * j] = lifted(i + 1, j + 1) - lifted(i + 1, 0) * memory.to_normal[j];
    memory.alpha = 0;
  }

  template <class T>
  [[gnu::always_inline]] Vec<3, T> solve_local(const Parameters& p, const Mat<3, 3, T>&, const Vec<3, T>& b, Memory<T>& memory) const {
    return impulse(p, b, memory);
  }
  /// λ from b, the velocity without this contact, and what `prepare` made of W.
  template <class T>
  static Vec<3, T> impulse(const Parameters& p, const Vec<3, T>& b, Memory<T>& memory) {
    if (b[0] >= -inner::negligible_approach<T>) return zero<Vec<3, T>>();
    const T mu = T(p.friction);
    const Vec<3, T> stick = -(memory.inverse * b);
    const T limit = mu * stick[0];
    if (stick[0] >= T(0) && stick[1] * stick[1] + stick[2] * stick[2] <= limit * limit)
      return {stick[0], stick[1], stick[2]};  // in registers: a copy would pass through memory
    return slip(b, mu, memory);
  }

  /// Where W = diag(w_n, w_t, w_t) the cases are explicit: with b = d − W λ and t = −b_t/|b_t|,
  ///
  ///   λ_n = max(0, −b_n/w_n),   λ_t = min(|b_t|/w_t, μ λ_n) t.
  ///
  /// Source: [AlartCurnier1991], whose augmented Lagrangian has these terms.
  template <class T>
  Mat<3, 3, T> tangent(const Parameters& p, Local<3, T>& c) const {
    Vec<3, T>& x = c.lambda;
    auto slope = zero<Mat<3, 3, T>>();
    for (int k = 0; k < 3; ++k) {
      slope(k, k) = T(1) / c.W(k, k);
      x[k] -= slope(k, k) * c.d[k];
    }
    const T mu = T(p.friction), limit = mu * x[0], size = inner::length(x[1], x[2]);
    if (!(x[0] > T(0))) {
      set_zero(x);
      set_zero(slope);
      return slope;
    }
    if (size <= limit) return slope;
    const T t[2] = {x[1] / size, x[2] / size}, across = limit / size * slope(1, 1);
    for (int k = 0; k < 2; ++k) {
      x[k + 1] = limit * t[k];
      slope(k + 1, 0) = mu * slope(0, 0) * t[k];
      for (int l = 0; l < 2; ++l) slope(k + 1, l + 1) = across * (T(k == l) - t[k] * t[l]);
    }
    return slope;
  }

  /// `tangent` of the convex problem that is left when the slip s = |u_t| of De Saxcé's form is a given number.
  /// (λ = P_K(λ − W⁻¹ (d + μ s e_n)) in the metric W, which one scaling of λ_t makes Euclid's.)
  template <class T>
  Mat<3, 3, T> convex_tangent(const Parameters& p, Local<3, T>& c, T slip) const {
    const T mu = T(p.friction), scale = std::sqrt(c.W(1, 1) / c.W(0, 0));
    const Vec<3, T> metric(T(1), scale, scale), back = metric.cwiseInverse();
    Vec<3, T> u = c.d;
    u[0] += mu * slip;
    const Vec<3, T> x = metric.cwiseProduct(c.lambda - c.W.diagonal().cwiseInverse().cwiseProduct(u));
    c.lambda = back.cwiseProduct(project_on_cone(x, scale * mu));
    return back.asDiagonal() * project_on_cone_slope(x, scale * mu) * back.asDiagonal() / c.W(0, 0);
  }

  template <class T>
  Vec<3, T> natural_map(const Parameters& p, const Vec<3, T>& lambda, const Vec<3, T>& u, T scale) const {
    return coulomb_natural_map(lambda, u, T(p.friction), scale);
  }
  template <class T>
  Vec<2, T> natural_squares(const Parameters& p, const Vec<3, T>& lambda, const Vec<3, T>& u, T scale) const {
    return coulomb_natural_squares(lambda, u, T(p.friction), scale);
  }
  /// P(λ − M⁻¹ ũ) on the cone in the metric M = diag(m_n, m_t, m_t) ≥ W, ũ = u + μ |u_t| e_n. With y_t = λ_t − u_t/m_t and
  /// z = m_n λ_n − ũ_n:
  ///
  ///   y in the cone: y;   μ m_t |y_t| ≤ −z: 0;   else n = (z + μ m_t |y_t|)/(m_n + μ² m_t), (n, μ n y_t/|y_t|).
  ///
  /// W couples λ_n to λ_t by |W_nt|/√(W_nn |W_tt|) at most, by which both are larger.
  template <class T>
  [[gnu::always_inline]] Vec<3, T> projection_step(const Parameters& p, const Mat<3, 3, T>& W, const Vec<3, T>& lambda,
                                                   const Vec<3, T>& u) const {
    T normal = W(0, 0), tangential = std::max(W(1, 1), W(2, 2)) + std::abs(W(1, 2));
    const T across = W(0, 1) * W(0, 1) + W(0, 2) * W(0, 2);
    if (across > T(0)) {
      const T more = T(1) + std::sqrt(across / (normal * tangential));
      normal *= more, tangential *= more;
    }
    const T mu = T(p.friction), z = normal * lambda[0] - u[0] - mu * inner::length(u[1], u[2]);
    const T y1 = lambda[1] - u[1] / tangential, y2 = lambda[2] - u[2] / tangential;
    const T square = y1 * y1 + y2 * y2, limit = mu * z;
    if (z >= T(0) && normal * normal * square <= limit * limit) return {z / normal, y1, y2};
    const T size = std::sqrt(square), pushed = mu * tangential * size;
    if (!(pushed > -z)) return zero<Vec<3, T>>();
    const T n = (z + pushed) / (normal + mu * mu * tangential), share = size > T(0) ? mu * n / size : T(0);
    return {n, share * y1, share * y2};
  }
  template <class T>
  void clamp(const Parameters& p, Vec<3, T>& lambda) const {
    if (!inner::is_in_cone(lambda, T(p.friction))) lambda = project_on_cone(lambda, T(p.friction));
  }

  /// |λ_t| = μ λ_n > 0 to rounding.
  template <class T>
  bool is_sliding(const Parameters& p, const Vec<3, T>& lambda) const {
    constexpr T rounding = T(64) * std::numeric_limits<T>::epsilon();
    return lambda[0] > 0 && inner::length(lambda[1], lambda[2]) >= T(p.friction) * lambda[0] * (T(1) - rounding);
  }

 private:
  /// With X = adj(S + α) c = a + α c and D = det(S + α) = α² + τ α + δ: λ_t = −X/D, λ_n = (W_nt X/D − b_n)/W_nn.
  /// The root is that of P(α) = √Q(α) with quadratic polynomials,
  ///
  ///   P = μ (W_nt X − b_n D)/W_nn,   Q = |X|².
  ///
  /// Halley's iteration finds it on P/√Q − 1, which is nearly straight in α. S = s 1 has the root in closed
  /// form; that starts the first visit, with s = cᵀSc/|c|².
  template <class T>
  static Vec<3, T> slip(const Vec<3, T>& b, T mu, Memory<T>& memory) {
    const T bn = b[0] * memory.over_normal;
    if (mu == T(0)) return {-bn, T(0), T(0)};
    const T *S = memory.schur, *k = memory.to_normal;
    const T c1 = b[1] - memory.from_normal[0] * b[0], c2 = b[2] - memory.from_normal[1] * b[0];
    const T a1 = S[3] * c1 - S[2] * c2, a2 = S[0] * c2 - S[1] * c1;
    const T trace = S[0] + S[3], determinant = S[0] * S[3] - S[2] * S[1];
    const T across = mu * (k[0] * c1 + k[1] * c2);
    const T p2 = -mu * bn, p1 = p2 * trace + across, p0 = p2 * determinant + mu * (k[0] * a1 + k[1] * a2);
    const T q2 = c1 * c1 + c2 * c2, q1 = T(2) * (a1 * c1 + a2 * c2), q0 = a1 * a1 + a2 * a2;
    constexpr T tolerance = T(16) * std::numeric_limits<T>::epsilon(),
                near = sizeof(T) == 8 ? T(3e-6) : T(2e-3);
    T low = 0, high = std::numeric_limits<T>::infinity(), alpha = memory.alpha;
    if (alpha == T(0)) {
      const T start = (std::sqrt(q2) - across) / p2 - trace + T(0.5) * q1 / q2;
      if (start > T(0) && start < high) alpha = start;
    }
    for (int iteration = 0; iteration < 60; ++iteration) {
      const T P = (p2 * alpha + p1) * alpha + p0, dP = T(2) * p2 * alpha + p1;
      const T Q = (q2 * alpha + q1) * alpha + q0, dQ = T(2) * q2 * alpha + q1;
      const T root = std::sqrt(Q), over = T(1) / Q;
      const T gap = P - root;  // negative: α must grow
      if (std::abs(gap) <= tolerance * root || high - low <= tolerance * alpha) break;
      (gap < 0 ? low : high) = alpha;
      const T slope = dP - T(0.5) * P * dQ * over;
      const T bend = T(2) * p2 - over * (dP * dQ + P * (q2 - T(0.75) * dQ * dQ * over));
      T next = alpha - gap * slope / (slope * slope - T(0.5) * gap * bend);
      const bool is_inside = slope > 0 && next > low && next < high;
      if (!is_inside)
        next = high < std::numeric_limits<T>::infinity() ? T(0.5) * (low + high)
                                                         : std::max(T(4) * alpha, T(0.05) * trace);
      const bool is_last = next == alpha || (is_inside && std::abs(gap) <= near * root);
      alpha = next;
      if (is_last) break;  // so near the root that what is left, of the order of gap³, is rounding
    }
    memory.alpha = alpha;
    const T over = T(1) / ((alpha + trace) * alpha + determinant);
    const T x1 = -(a1 + alpha * c1) * over, x2 = -(a2 + alpha * c2) * over;
    const T normal = -(bn + k[0] * x1 + k[1] * x2), length = inner::length(x1, x2);
    if (!(normal > 0) || !(length > 0)) return {std::max(normal, T(0)), T(0), T(0)};
    const T scale = mu * normal / length;  // on the cone to the last bit
    return {normal, scale * x1, scale * x2};
  }
};

}  // namespace delassus
