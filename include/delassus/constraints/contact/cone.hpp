/// Coulomb's cone: projections and the map whose zero is a solution.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>

namespace delassus {
namespace inner {

/// |(a, b)|. The squares of impulses and velocities neither overflow nor vanish where it matters, and std::hypot, which
/// guards against that, is a library call in the middle of a sweep.
template <class T>
T length(T a, T b) {
  return std::sqrt(a * a + b * b);
}

/// A contact that closes more slowly, m/s, stays open: of slower ones the powers that a slip takes are no numbers with all
/// digits, and arithmetic takes a hundred times as long. A sweep meets them where a load fades along hundreds of bodies.
template <class T>
inline constexpr T negligible_approach = sizeof(T) == 8 ? T(1e-70) : T(1e-12);

/// |x_t| ≤ μ x_n, asked without a root: most contacts are sticking.
template <class T>
bool is_in_cone(const Vec<3, T>& x, T friction) {
  const T limit = friction * x[0];
  return x[0] >= T(0) && x[1] * x[1] + x[2] * x[2] <= limit * limit;
}

}  // namespace inner

/// Euclidean projection on K(μ) = { (x_n, x_t) : |x_t| ≤ μ x_n }, rows ordered (n, t₁, t₂).
///
///   x inside: x;   μ |x_t| ≤ −x_n: 0;   else n = (x_n + μ |x_t|)/(1 + μ²), (n, μ n x_t/|x_t|).
template <class T>
Vec<3, T> project_on_cone(const Vec<3, T>& x, T friction) {
  if (inner::is_in_cone(x, friction)) return x;
  const T tangential = inner::length(x[1], x[2]);
  if (friction * tangential <= -x[0]) return zero<Vec<3, T>>();
  const T normal = (x[0] + friction * tangential) / (T(1) + friction * friction);
  const T scale = friction * normal / tangential;
  return {normal, scale * x[1], scale * x[2]};
}

/// dP_K/dx of `project_on_cone`, symmetric; on the borders between its cases one of the generalised derivatives.
template <class T>
Mat<3, 3, T> project_on_cone_slope(const Vec<3, T>& x, T friction) {
  const T tangential = inner::length(x[1], x[2]);
  if (friction * tangential <= -x[0]) return zero<Mat<3, 3, T>>();
  if (tangential <= friction * x[0]) return diagonal_of<3>(T(1));
  const T over = T(1) / (T(1) + friction * friction), normal = (x[0] + friction * tangential) * over;
  const Vec<2, T> t = x.template tail<2>() / tangential;
  const T along = friction * over, across = friction * normal / tangential;
  Mat<3, 3, T> slope;
  slope(0, 0) = over;
  slope.template topRightCorner<1, 2>() = along * t.transpose();
  slope.template bottomLeftCorner<2, 1>() = along * t;
  slope.template bottomRightCorner<2, 2>() =
      across * Mat<2, 2, T>::Identity() + (friction * along - across) * t * t.transpose();
  return slope;
}

/// s λ − P_K(s λ − ũ), ũ = u + μ |u_t| e_n: zero exactly when u and λ meet Signorini's and Coulomb's laws
/// (De Saxcé's form). Source: [AcaryBremondHuber2018].
template <class T>
Vec<3, T> coulomb_natural_map(const Vec<3, T>& lambda, const Vec<3, T>& u, T friction, T scale) {
  if (lambda[0] == T(0) && u[0] >= T(0) && lambda[1] == T(0) && lambda[2] == T(0)) return lambda;  // open
  const Vec<3, T> modified(u[0] + friction * inner::length(u[1], u[2]), u[1], u[2]);               // ũ
  const Vec<3, T> x = scale * lambda;
  const Vec<3, T> y = x - modified;
  return inner::is_in_cone(y, friction) ? modified : Vec<3, T>(x - project_on_cone(y, friction));
}

/// |s λ − P_K(s λ − ũ)|² of that map at the scales s = `scale` and s = 1, which a measure asks for together:
/// a contact that sticks has ũ for both.
template <class T>
[[gnu::always_inline]] inline Vec<2, T> coulomb_natural_squares(const Vec<3, T>& lambda, const Vec<3, T>& u,
                                                                T friction, T scale) {
  const T tangential = lambda[1] * lambda[1] + lambda[2] * lambda[2];
  if (lambda[0] == T(0) && u[0] >= T(0) && tangential == T(0)) return {T(0), T(0)};  // open
  const T square = u[1] * u[1] + u[2] * u[2];
  const T modified = u[0] + friction * std::sqrt(square);
  const auto at = [&](T s) {
    const Vec<3, T> y(s * lambda[0] - modified, s * lambda[1] - u[1], s * lambda[2] - u[2]);
    if (inner::is_in_cone(y, friction)) return modified * modified + square;
    const Vec<3, T> z = project_on_cone(y, friction);
    const T n = s * lambda[0] - z[0], t1 = s * lambda[1] - z[1], t2 = s * lambda[2] - z[2];
    return n * n + t1 * t1 + t2 * t2;
  };
  return {at(scale), at(T(1))};
}

}  // namespace delassus
