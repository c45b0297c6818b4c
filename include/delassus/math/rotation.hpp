/// Rotations: the exponential, the Cayley map, and the midpoint rule of a free rigid body.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/math/packet.hpp>

#include <limits>

namespace delassus {

/// q / |q|, also where the squares of q overflow; NaN of what is no number.
template <class T>
inline Eigen::Quaternion<T> unit(const Eigen::Quaternion<T>& q) {
  T w = q.w(), x = q.x(), y = q.y(), z = q.z();
  T size = std::sqrt((x * x + z * z) + (y * y + w * w));
  if (!(size <= std::numeric_limits<T>::max())) {
    const T largest = std::max(std::max(std::abs(w), std::abs(x)), std::max(std::abs(y), std::abs(z)));
    if (largest <= std::numeric_limits<T>::max()) {
      const T s = T(1) / largest;
      w *= s, x *= s, y *= s, z *= s;
      size = std::sqrt((x * x + z * z) + (y * y + w * w));
    }
  }
  return {w / size, x / size, y / size, z / size};
}

/// The turn by b, and then by a. Sums as Eigen's operator* has them.
template <class T>
inline Eigen::Quaternion<T> product(const Eigen::Quaternion<T>& a, const Eigen::Quaternion<T>& b) {
  const T *p = a.coeffs().data(), *q = b.coeffs().data();  // x, y, z, w
  return {(p[3] * q[3] - p[1] * q[1]) - (p[2] * q[2] + p[0] * q[0]), (p[3] * q[0] + p[1] * q[2]) - (p[2] * q[1] - p[0] * q[3]),
          (p[3] * q[1] + p[1] * q[3]) + (p[2] * q[0] - p[0] * q[2]), (p[3] * q[2] - p[1] * q[0]) + (p[2] * q[3] + p[0] * q[1])};
}
/// The same to the bit, two entries at a time.
[[gnu::always_inline]] inline Eigen::Quaternion<double> product(const Eigen::Quaternion<double>& a, const Eigen::Quaternion<double>& b) {
  const double *p = a.coeffs().data(), *q = b.coeffs().data();
  const NumberPair xy = load_pair(q), zw = load_pair(q + 2), yx{q[1], q[0]}, wz{q[3], q[2]};
  const NumberPair A = p[3] * xy + p[1] * zw, B = p[2] * yx - p[0] * wz;
  const NumberPair C = p[3] * zw - p[1] * xy, D = p[2] * wz + p[0] * yx;
  Eigen::Quaternion<double> c;
  store_pair(c.coeffs().data(), A + NumberPair{-B[0], B[1]});
  store_pair(c.coeffs().data() + 2, C + NumberPair{D[0], -D[1]});
  return c;
}
/// The turn back, of a unit quaternion.
template <class T>
inline Eigen::Quaternion<T> conjugate(const Eigen::Quaternion<T>& q) {
  return {q.w(), -q.x(), -q.y(), -q.z()};
}

/// q v q*, of a unit quaternion.
template <class T>
inline Vec<3, T> rotated(const Eigen::Quaternion<T>& q, const Vec<3, T>& v) {
  const Vec<3, T> axis(q.x(), q.y(), q.z());
  Vec<3, T> twice = cross(axis, v);
  twice += twice;
  return v + q.w() * twice + cross(axis, twice);
}

// As Eigen's operators on whole quaternions and vectors, without what the compiler reads for those on expressions.
template <class T>
inline Eigen::Quaternion<T> operator*(const Eigen::Quaternion<T>& a, const Eigen::Quaternion<T>& b) {
  return product(a, b);
}
template <class T>
inline Vec<3, T> operator*(const Eigen::Quaternion<T>& q, const Eigen::Matrix<T, 3, 1>& v) {
  return rotated(q, v);
}

/// 1 − |q|², of a unit quaternion nearly without rounding.
template <class T>
inline T lack_of_unit(const Eigen::Quaternion<T>& q) {
  return (((T(1) - q.w() * q.w()) - q.x() * q.x()) - q.y() * q.y()) - q.z() * q.z();
}

/// q / |q| of what is nearly a unit quaternion, q (1 + δ/2) with δ = 1 − |q|²: of a product of two, say, which is off by
/// rounding. Here it ends as often above 1 as below; of q / |q| what is above stays there more often, since numbers are
/// farther apart above 1, and a body that turns in every step would gain by it.
template <class T>
inline Eigen::Quaternion<T> unit_again(const Eigen::Quaternion<T>& q) {
  const T e = T(0.5) * lack_of_unit(q);
  return {q.w() + e * q.w(), q.x() + e * q.x(), q.y() + e * q.y(), q.z() + e * q.z()};
}

/// The rotation matrix of what is nearly a unit quaternion: I + s (w v^ + v^²), s = 2/|q|² = 2 (1 + δ + …), δ = 1 − |q|². That of
/// a unit quaternion, s = 2, is as far from a rotation as |q| is from 1; and 2/|q|², rounded, is off to one side, since numbers
/// lie farther apart above 2 than below.
template <class T>
[[gnu::always_inline]] inline Mat<3, 3, T> rotation_matrix(const Eigen::Quaternion<T>& q) {
  const T w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const T lack = lack_of_unit(q);
  const T sx = T(2) * (x + lack * x), sy = T(2) * (y + lack * y), sz = T(2) * (z + lack * z);
  const T xx = sx * x, yy = sy * y, zz = sz * z, xy = sx * y, yz = sy * z, zx = sz * x, wx = sx * w, wy = sy * w, wz = sz * w;
  Mat<3, 3, T> R;
  T* e = R.data();
  e[0] = T(1) - (yy + zz), e[3] = xy - wz, e[6] = zx + wy;
  e[1] = xy + wz, e[4] = T(1) - (xx + zz), e[7] = yz - wx;
  e[2] = zx - wy, e[5] = yz + wx, e[8] = T(1) - (xx + yy);
  return R;
}

/// The quaternion of a turn by the vector θ (rad): exp(θ/2).
template <class T>
Eigen::Quaternion<T> exponential(const Vec<3, T>& theta) {
  const T angle = norm(theta);
  // sin(x/2)/x to rounding for small x: the next term of the series is x⁴/3840.
  const T s = angle < T(1e-3) ? T(0.5) - angle * angle / T(48) : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * theta[0], s * theta[1], s * theta[2]};
}

/// The vector θ of a unit quaternion, |θ| ≤ π: the inverse of `exponential`.
template <class T>
Vec<3, T> logarithm(const Eigen::Quaternion<T>& q) {
  const T sign = q.w() < 0 ? T(-1) : T(1);
  const Vec<3, T> v(sign * q.x(), sign * q.y(), sign * q.z());
  const T s = norm(v);
  return s < T(1e-12) ? T(2) * v : T(2) * std::atan2(s, sign * q.w()) / s * v;
}

/// The Cayley map as a quaternion: (I − θ̂/2)⁻¹ (I + θ̂/2) turns like (1, θ/2) normalised.
template <class T>
Eigen::Quaternion<T> cayley(const Vec<3, T>& theta) {
  return unit(Eigen::Quaternion<T>(T(1), T(0.5) * theta[0], T(0.5) * theta[1], T(0.5) * theta[2]));
}

/// Ω = I⁻¹ L by I = U D Uᵀ with a unit upper triangle, both in the body's axes. Of moments along the axes it is L_k / I_k, each
/// rounded once: products with a rounded I⁻¹ would all be off by its rounding, in every step the same way.
template <class T>
Vec<3, T> rate_of(const Mat<3, 3, T>& inertia, const Vec<3, T>& momentum) {
  const T* I = inertia.data();
  const T u02 = I[6] / I[8], u12 = I[7] / I[8];
  const T d1 = I[4] - u12 * I[7], e = I[3] - u02 * I[7];
  const T u01 = e / d1, d0 = I[0] - u02 * I[6] - u01 * e;
  const T y1 = momentum[1] - u12 * momentum[2], y0 = momentum[0] - u02 * momentum[2] - u01 * y1;
  const T x = y0 / d0, y = y1 / d1 - u01 * x;
  return {x, y, momentum[2] / I[8] - u02 * x - u12 * y};
}

/// Ω̄ of `midpoint_rate`, what its equation lacks and what one rounding of it is, kg·m²/s.
template <class T>
struct MidpointRate {
  Vec<3, T> rate;
  T residual, rounding;
};

/// One step of rotation by the implicit midpoint rule, in the body's frame. a = I Ω is the momentum before, c the one
/// after the step's angular impulse, both in the axes of R:
///
///   cay(h Ω̄) I Ω₊ = c,   Ω̄ = (Ω + Ω₊)/2,   R₊ = R cay(h Ω̄),
///
/// so that R₊ I Ω₊ = R c: the spatial angular momentum takes the impulse exactly. With no impulse (c = a) it is
/// I (Ω₊ − Ω) + h Ω̄ × I Ω̄ = 0, which keeps ½ Ω·IΩ too, since the rule keeps quadratic invariants. Returns Ω̄.
/// Of a step by many radians the equation has several roots, and Newton's method may end at none: the residual says so.
///
/// Newton's method with step halving from Ω, on the equation multiplied by I + h Ω̄^/2:
///   F(Ω̄) = m − c + h/2 Ω̄ × (m + c),  m = 2 I Ω̄ − a = I Ω₊,   F′ = 2 I + h/2 (2 Ω̄^ I − (m + c)^).
/// Source: [SimoWong1991], the midpoint member.
template <class T>
MidpointRate<T> midpoint_rate(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate, const Vec<3, T>& a, const Vec<3, T>& c, T h) {
  Vec<3, T> mid = rate, sum = T(2) * (inertia * mid) - a + c;
  Vec<3, T> residual = sum - T(2) * c + (h / 2) * cross(mid, sum);
  T size = norm(residual);
  const T floor = std::numeric_limits<T>::epsilon() * std::sqrt(std::max(squared_norm(a), squared_norm(c)));
  for (int iteration = 0; iteration < 20 && size > floor; ++iteration) {
    const Mat<3, 3, T> slope = T(2) * inertia + (h / 2) * (T(2) * skew(mid) * inertia - skew(sum));
    // Scaled by tr I, so that the determinant of a small body's moments does not underflow in single precision.
    const T scale = T(1) / trace(inertia);
    const Vec<3, T> move = inverse(Mat<3, 3, T>(scale * slope)) * (scale * residual);
    T step = 1;
    for (int halving = 0;; ++halving, step /= 2) {
      const Vec<3, T> trial = mid - step * move;
      const Vec<3, T> trial_sum = T(2) * (inertia * trial) - a + c;
      const Vec<3, T> trial_residual = trial_sum - T(2) * c + (h / 2) * cross(trial, trial_sum);
      const T trial_size = norm(trial_residual);
      if (trial_size < size) {
        assign(mid, trial);
        assign(sum, trial_sum);
        assign(residual, trial_residual);
        size = trial_size;
        break;
      }
      if (halving == 7) return {mid, size, floor};
    }
  }
  return {mid, size, floor};
}

namespace inner {

template <class T>
[[gnu::noinline]] Eigen::Quaternion<T> midpoint_turn_in_halves(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate,
                                                               const Vec<3, T>& a, const Vec<3, T>& c, T h, int halvings);

/// s h, the step whose cay(s h Ω̄) turns by h Ω̄. Cayley's turn is short by (h ω)³/12; s = 1 + (h ω)²/12, with the
/// ω = Ω·L/|L| that a free body keeps, gives that back. It is the midpoint rule of another step: L and the energy are
/// kept as ever, and a free step can be turned back. s is 2 at most: beyond √12 rad a step it tells nothing.
template <class T>
T lengthened(T h, const Vec<3, T>& rate, const Vec<3, T>& momentum) {
  const T square = squared_norm(momentum), twice = dot(rate, momentum);
  const T turn = square > T(0) ? (h * twice) * (h * (twice / square)) : T(0);
  return turn < T(12) ? h * (T(1) + turn / T(12)) : T(2) * h;
}

/// Q = exp(h Ω·e ê), e = c/|c|: a turn about the momentum, so that Qᵀ c = c. Ω₊ = I⁻¹ c has the energy that it had.
template <class T>
Eigen::Quaternion<T> turn_about_momentum(const Vec<3, T>& rate, const Vec<3, T>& c, T h) {
  const T largest = std::abs(c[largest_entry(c)]);
  const Vec<3, T> scaled = largest > T(0) ? Vec<3, T>(c / largest) : c;
  const Vec<3, T> axis = largest > T(0) ? Vec<3, T>(scaled / norm(scaled)) : c;
  return exponential<T>(std::remainder(h * dot(rate, axis), T(4 * EIGEN_PI)) * axis);
}

/// `midpoint_turn` of a step that may be halved `halvings` times more.
template <class T>
Eigen::Quaternion<T> midpoint_turn_halving(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate, const Vec<3, T>& a,
                                           const Vec<3, T>& c, T h, int halvings) {
  const T longer = lengthened<T>(h, rate, a);
  const MidpointRate<T> mid = midpoint_rate<T>(inertia, rate, a, c, longer);
  // The products that make the residual are of size h |Ω̄| |c|, and as many roundings off.
  const T enough = T(128) * mid.rounding;
  if (mid.residual <= enough && enough <= std::numeric_limits<T>::max()) [[likely]] return cayley<T>(longer * mid.rate);
  const T fastest = std::max(norm(rate), norm(rate_of<T>(inertia, c)));
  if (!(h * fastest <= T(1024))) return turn_about_momentum<T>(rate, c, h);
  if (mid.residual <= enough * (T(1) + longer * norm(mid.rate))) return cayley<T>(longer * mid.rate);
  if (halvings == 0) return turn_about_momentum<T>(rate, c, h);
  return midpoint_turn_in_halves<T>(inertia, rate, a, c, h, halvings - 1);
}

/// The impulse acts in the first half; in the second the body turns freely, from Ω = I⁻¹ cay(…)ᵀ c.
template <class T>
Eigen::Quaternion<T> midpoint_turn_in_halves(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate, const Vec<3, T>& a,
                                             const Vec<3, T>& c, T h, int halvings) {
  const Eigen::Quaternion<T> first = midpoint_turn_halving<T>(inertia, rate, a, c, h / 2, halvings);
  const Vec<3, T> momentum = rotated<T>(conjugate(first), c);
  const Vec<3, T> then = rate_of<T>(inertia, momentum);
  return unit_again(product(first, midpoint_turn_halving<T>(inertia, then, momentum, momentum, h / 2, halvings)));
}

}  // namespace inner

/// cay(s h Ω̄) of `midpoint_rate` for a step of s h, as a quaternion. Where that finds no root, a body that turns by many
/// radians in a step, the step is made of halves, of which each keeps what the rule keeps; at most 2⁶ of them. Where
/// these would not do either (2¹⁰ radians in a step and more, before or after its impulse) the body turns about its momentum,
/// which keeps as much.
template <class T>
Eigen::Quaternion<T> midpoint_turn(const Mat<3, 3, T>& inertia, const Vec<3, T>& rate, const Vec<3, T>& a, const Vec<3, T>& c,
                                   T h) {
  return inner::midpoint_turn_halving<T>(inertia, rate, a, c, h, 6);
}

}  // namespace delassus
