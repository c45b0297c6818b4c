/// Poses, masses and inertias of rigid bodies as arrays, and how a velocity moves them.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/math/free_turns.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/body_set.hpp>

#include <cstddef>
#include <type_traits>

namespace delassus::inner {

/// What M = diag(m 1, R I Rᵀ) is made of. x in m, in the world, in double whatever T is: far from the origin a float
/// has no room for a step's way, and its ulp is 0.06 m at 10⁶ m. I in kg·m², in the axes of R.
template <class T>
struct RigidState {
  using Vector = Vec<3, T>;
  using Matrix = Mat<3, 3, T>;
  using Velocity = Vec<6, T>;

  Array<Vec3> x;
  Array<Eigen::Quaternion<T>> q;
  Array<Matrix> R, inertia, inverse_inertia, inverse_inertia_world;  ///< the last is R I⁻¹ Rᵀ
  Array<T> mass, inverse_mass;
  /// t of a step's turn cay(t), in the axes of the body: of one whose joints have found it already.
  struct GivenTurn {
    Vector t;
    bool is_given;
  };
  Array<GivenTurn> given_turn;  ///< empty where nobody gives any
  Array<Vec3> kept_x;
  Array<Eigen::Quaternion<T>> kept_q;

  void resize(std::size_t n) {
    x.resize(n);
    q.resize(n);
    R.resize(n), inertia.resize(n), inverse_inertia.resize(n), inverse_inertia_world.resize(n);
    mass.resize(n), inverse_mass.resize(n);
  }

  /// A body that is not dynamic answers to no impulse: A⁻¹ = 0.
  void set_mass(Index b, bool is_dynamic) {
    inverse_mass[b] = is_dynamic ? T(1) / mass[b] : T(0);
    if (!is_dynamic) set_all(inverse_inertia[b], T(0));
    turn(b);
  }

  /// R and R I⁻¹ Rᵀ of the present orientation.
  void turn(Index b) {
    R[b] = rotation_matrix<T>(q[b]);
    inverse_inertia_world[b] = times_transposed<T>(R[b] * inverse_inertia[b], R[b]);
  }

  /// M v.
  Velocity momentum(Index b, const Velocity& v, T scale) const {
    return twist<T>(scale * mass[b] * linear_part(v),
                    scale * (R[b] * (inertia[b] * transposed_times(R[b], angular_part(v)))));
  }

  /// M⁻¹ X / mass scale, for each column of X.
  template <int C>
  Mat<6, C, T> solve(Index b, const Mat<6, C, T>& X, T inverse_scale) const {
    Mat<6, C, T> Y;
    const T over_mass = inverse_scale * inverse_mass[b];
    const T* K = inverse_inertia_world[b].data();
    for (int c = 0; c < C; ++c) {
      const T* p = X.data() + 6 * c;
      T* v = Y.data() + 6 * c;
      for (int i = 0; i < 3; ++i) {
        v[i] = over_mass * p[i];
        v[i + 3] = row_times(K[i], K[i + 3], K[i + 6], p + 3);
        if (inverse_scale != T(1)) v[i + 3] *= inverse_scale;
      }
    }
    return Y;
  }

  void put(Index b, const Vec3& position, const Eigen::Quaternion<T>& orientation) {
    assign(x[b], position);
    assign(q[b], orientation);
    turn(b);
  }
  void place(Index b, const Vec3& position, const Quat& orientation) { put(b, position, converted<T>(orientation)); }

  /// Sets all poses aside, and takes those of these blocks back.
  void keep_poses() {
    kept_x = x;
    kept_q = q;
  }
  void restore_poses(const Array<Index>& blocks) {
    for (const Index b : blocks) restore_pose(b);
  }
  void restore_pose(Index b) { put(b, kept_x[b], kept_q[b]); }

  /// x + step, and the axes turned by the vector `turn_by`, rad. False when that is not finite: then nothing moves.
  bool displace(Index b, const Vector& step, const Vector& turn_by) {
    const Vec3 moved = x[b] + converted<double>(step);
    const Eigen::Quaternion<T> turned = unit_again(product(exponential<T>(turn_by), q[b]));
    if (!is_finite(moved) || !is_finite(turned.coeffs())) return false;
    put(b, moved, turned);
    return true;
  }

  /// Ω = I⁻¹ L in the body's axes. In single precision by the inverse that was made in double: what a needle's
  /// matrix in turned axes is rounded to need not be positive.
  Vector own_rate(Index b, const Vector& momentum) const {
    if constexpr (std::is_same_v<T, double>) return rate_of<T>(inertia[b], momentum);
    else return inverse_inertia[b] * momentum;
  }

  /// q and v of one dynamic body after a step from its velocity before and after the impulses; v is the one it ends
  /// with. `old_share` of the old velocity in the mean that moves it: 0 for kick and drift, ½ for the midpoint rule.
  /// False when q or v is not finite: then both stay.
  bool drift(Index b, Velocity& v, const Velocity& next, T h, T old_share);

  /// Kick and drift: the same after the impulses, the free rotation by turns.
  bool drift(Index b, Velocity& v, const Velocity& next, T h, RotationSplitting) {
    const Vec3 moved = x[b] + converted<double>(Vector(h * linear_part(next)));
    const Vector spatial = R[b] * (inertia[b] * transposed_times(R[b], angular_part(next)));
    const Eigen::Quaternion<T> turned = turn_freely<T>(inverse_inertia[b], q[b], spatial, h);
    if (!is_finite(moved) || !is_finite(turned.coeffs())) return false;
    put(b, moved, turned);
    v = twist<T>(linear_part(next), R[b] * own_rate(b, transposed_times(R[b], spatial)));
    return true;
  }

  void memory(auto& archive) { archive(x, q, R, inertia, inverse_inertia, inverse_inertia_world, mass, inverse_mass); }
};

template <class T>
bool RigidState<T>::drift(Index b, Velocity& v, const Velocity& next, T h, T old_share) {
  const Vec3 old_x = x[b];
  const Eigen::Quaternion<T> old_q = q[b];
  // L = R I Rᵀ ω after the impulses; the body turns under it and reads ω₊ = R₊ I⁻¹ R₊ᵀ L.
  const Vector kicked = transposed_times(R[b], angular_part(next)), impulse = inertia[b] * kicked;
  const Vector spatial = R[b] * impulse;
  if (old_share > T(0)) {
    const Vector start = transposed_times(R[b], angular_part(v));
    x[b] += converted<double>(Vector(h * mean<Vector>(linear_part(v), linear_part(next), old_share)));
    if (!given_turn.empty() && given_turn[b].is_given) {
      given_turn[b].is_given = false;
      q[b] = unit_again(product(q[b], cayley<T>(given_turn[b].t)));
    } else {
      q[b] = unit_again(product(q[b], midpoint_turn<T>(inertia[b], start, inertia[b] * start, impulse, h)));
    }
  } else {
    x[b] += converted<double>(Vector(h * linear_part(next)));
    q[b] = unit_again(product(q[b], midpoint_turn<T>(inertia[b], kicked, impulse, impulse, h)));
  }
  turn(b);
  // Factor by factor: R I⁻¹ Rᵀ as one matrix mixes the rounding of a needle's large entry into the small
  // ones.
  const Vector rate = R[b] * own_rate(b, transposed_times(R[b], spatial));
  // A velocity that is not finite makes x or ω₊ so, and so does a quaternion.
  if (!is_finite(x[b]) || !is_finite(rate)) [[unlikely]] {
    put(b, old_x, old_q);
    return false;
  }
  v = twist<T>(linear_part(next), rate);
  return true;
}

}  // namespace delassus::inner
