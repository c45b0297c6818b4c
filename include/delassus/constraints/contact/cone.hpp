/// Coulomb's cone: projections and the map whose zero is a solution.
#pragma once

#include <delassus/math/linear.hpp>

#include <cmath>

namespace delassus {
namespace inner {

/// |(a, b)|. The squares of impulses and velocities neither overflow nor vanish where it matters, and std::hypot, which
/// guards against that, is a library call in the middle of a sweep.
template <class T>
T length(T a, T b) {
  return std::sqrt(a * a + b * b);
}

}  // namespace inner

/// Euclidean projection on K(μ) = { (x_n, x_t) : |x_t| ≤ μ x_n }, rows ordered (n, t₁, t₂).
///
///   x inside: x;   μ |x_t| ≤ −x_n: 0;   else n = (x_n + μ |x_t|)/(1 + μ²), (n, μ n x_t/|x_t|).
template <class T>
Vec<3, T> project_on_cone(const Vec<3, T>& x, T friction) {
  const T tangential = inner::length(x[1], x[2]);
  if (friction * tangential <= -x[0]) return Vec<3, T>::Zero();  // first: without friction the next line is true here too
  if (tangential <= friction * x[0]) return x;
  const T normal = (x[0] + friction * tangential) / (T(1) + friction * friction);
  const T scale = friction * normal / tangential;
  return {normal, scale * x[1], scale * x[2]};
}

/// dP_K/dx of `project_on_cone`, symmetric; on the borders between its cases one of the generalised derivatives.
template <class T>
Mat<3, 3, T> project_on_cone_slope(const Vec<3, T>& x, T friction) {
  const T tangential = inner::length(x[1], x[2]);
  if (friction * tangential <= -x[0]) return Mat<3, 3, T>::Zero();
  if (tangential <= friction * x[0]) return Mat<3, 3, T>::Identity();
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
  const Vec<3, T> x = scale * lambda;
  Vec<3, T> y = x - u;
  y[0] -= friction * inner::length(u[1], u[2]);
  return x - project_on_cone(y, friction);
}

}  // namespace delassus
