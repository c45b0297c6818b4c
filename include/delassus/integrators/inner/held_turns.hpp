/// How joints of the midpoint rule see rigid bodies turn: by the mean rate of the step, with the gyroscopic term.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/pool.hpp>
#include <delassus/core/array.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/world_view.hpp>

#include <cstddef>

namespace delassus::inner {

/// A rigid body held by joints. Let Ω̄ be its mean rate, s half of what it turns by (longer than h Ω̄/2, as `midpoint_turn` has it), J
/// the moments of its joints in the axes of the middle, where the rows are taken, and P all other moments, in N·m·s. Times 1 − s^,
/// the equation of `midpoint_rate` is
///
///   2 I (Ω̄ − Ω) + 2 s × I Ω̄ = J + (1 − s^) P.
///
/// So rows have their moments turned back from the middle to the start, where A is, and v_free has the rest, g:
///
///   I g = −2 s × I Ω̄ − s × P,   v_next = v_free + A⁻¹ Hᵀ λ = 2 v̄ − v.
///
/// g is a guess, off by h² α ω. Rows that see the moments of the middle by the axes of the start would let a joint spin a slender
/// body about its thin axis, by h ω over the ratio of its moments of inertia.
template <class T>
struct HeldTurn {
  using Vector = Vec<3, T>;
  Eigen::Quaternion<T> back;  ///< from the axes of the middle, where the rows are taken, to those of the start
  Vector gyration;            ///< g in v_free, rad/s
  T longer;                   ///< of the step, s
  bool is_held, is_slender;
};

/// I⁻¹ l in the axes of the world.
template <class Set, class T>
Vec<3, T> rate_under(Set& set, Index b, const Vec<3, T>& l) {
  const Mat<3, 3, T>& R = set.state().R[b];
  return R * set.state().own_rate(b, transposed_times(R, l));
}
/// I Ω in the axes of the world.
template <class Set, class T>
Vec<3, T> momentum_of(Set& set, Index b, const Vec<3, T>& rate) {
  const Mat<3, 3, T>& R = set.state().R[b];
  return R * (set.inertia(b) * transposed_times(R, rate));
}

/// The mean rate of the step is known better, from a solve: so are the middle and g.
template <class Set, class T>
void turn_by_mean(Set& set, Index b, HeldTurn<T>& held, const Vec<3, T>& mean, T h) {
  using Vector = Vec<3, T>;
  held.back = exponential<T>((T(-0.5) * h) * mean);
  held.gyration = -held.longer * rate_under<Set, T>(set, b, cross(mean, Vector(momentum_of<Set, T>(set, b, mean))));
}

/// Where no moment acts: g = 2 (Ω̄ − Ω). Not held is a body that turns by more than half a radian in a step, for which g is too far
/// from what it will be, unless it is slender; nor one whose turn has no root.
template <class Set, class T>
void begin_turn(Set& set, Index b, HeldTurn<T>& held, T h) {
  using Vector = Vec<3, T>;
  const Mat<3, 3, T>& R = set.state().R[b];
  const Vector turn = angular_part(set.velocity()[b]), rate = transposed_times(R, turn), momentum = set.inertia(b) * rate;
  held.longer = lengthened<T>(h, rate, momentum);
  const MidpointRate<T> mid = midpoint_rate<T>(set.inertia(b), rate, momentum, momentum, held.longer);
  held.is_slender = trace(set.inertia(b)) * trace(set.inverse_inertia(b)) > T(100);
  held.is_held = mid.residual <= T(128) * mid.rounding && (held.is_slender || h * h * squared_norm(turn) < T(0.25));
  held.gyration = T(2) * (R * Vector(mid.rate - rate));
  held.back = exponential<T>((T(-0.5) * h) * turn);
}

/// What loads add to g, and g to v_free.
template <class Set, class T>
void add_gyration(Set& set, Index b, HeldTurn<T>& held) {
  using Vector = Vec<3, T>;
  const Vector rate = angular_part(set.velocity()[b]), P = momentum_of<Set, T>(set, b, angular_part(set.v_free[b]) - rate);
  const Vector s = (T(0.5) * held.longer) * (rate + T(0.5) * held.gyration);
  held.gyration -= rate_under<Set, T>(set, b, cross(s, P));
  for (int k = 0; k < 3; ++k) set.v_free[b][k + 3] += held.gyration[k];
}

/// The body turns by cay(2 s) of the mean rate that its rows saw, and v_next becomes what `advance` expects: v with all moments of
/// the step in it. J is that of the rows. In the axes of the world the joints' moments are what the rows have at the guess of the
/// middle, which keeps the angular momentum of a pair of bodies. The thin axis of a slender body would be spun by what the guess
/// is off: there J stays what it is in the axes of the body, and momentum is kept to h³ a step.
template <class Set, class T>
void end_turn(Set& set, Index b, const HeldTurn<T>& held, const Vec<3, T>& J) {
  using Vector = Vec<3, T>;
  auto& state = set.state();
  const Mat<3, 3, T>& R = state.R[b];
  const Vector rate = angular_part(set.velocity()[b]), next = angular_part(set.v_next[b]);
  const Vector mean = T(0.5) * (rate + next), s = (T(0.5) * held.longer) * mean, t = T(2) * transposed_times(R, s);
  const Vector P = momentum_of<Set, T>(set, b, next - rate - held.gyration) - J;
  state.given_turn[b] = {t, true};
  Vector kicked;
  if (held.is_slender) {
    const Vector moment = J + P - cross(s, P) - T(2) * cross(s, momentum_of<Set, T>(set, b, mean));
    const Vector end = transposed_times(R, momentum_of<Set, T>(set, b, rate) + moment);  // I Ω₊
    kicked = rate_under<Set, T>(set, b, R * rotated<T>(cayley<T>(t), end));
  } else {
    kicked = rate + rate_under<Set, T>(set, b, P + rotated<T>(conjugate(held.back), J));
  }
  for (int k = 0; k < 3; ++k) set.v_next[b][k + 3] = kicked[k];
}

/// Sets of rigid bodies.
template <class Set>
concept TurnsRigidly = requires { typename Set::Midpoint; };

template <class Set>
struct HeldTurns {
  Array<HeldTurn<typename Set::Scalar>> bodies;
  Array<typename Set::Velocity> moment;  ///< J of the joints, N·s and N·m·s
};

/// Joints whose first rows hold two points together.
template <class Law>
concept JoinsPoints = Law::rows >= 3 && requires { requires Law::acts[0] == 0 && Law::acts[1] == 1 && Law::acts[2] == 2; };

/// The point at which both ends of a joint act, m: JointRows' own, unless the law says where.
template <class Law>
Vec3 point_of_action(const auto& item, const auto& world) {
  if constexpr (requires { Law::place(item, world); }) return Law::place(item, world).point;
  else return world.point(item.b);
}

/// Where two points shall be together, a slender body is acted on at its own: at another, as near as the guess of the middle leaves
/// them, a joint would spin it. Bodies are where the rows are taken.
template <class Law, class Set, int R, int w, class T>
void act_at_own_points(const Set& set, const Pool<Law>& pool, const WorldView<T>& world, SetBlocks<R, w, T>& blocks, const Array<HeldTurn<T>>& bodies) {
  for (Index i = 0; i < pool.count(); ++i) {
    const auto& item = pool.item(i);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
      const Index b = blocks.block[e];
      if (!bodies[b].is_held || !bodies[b].is_slender) continue;
      const bool is_a = item.a.owner == set.owner() && item.a.block == b;
      const Vec<3, T> off = converted<T>(Vec3(point_of_action<Law>(item, world) - world.point(is_a ? item.a : item.b)));
      auto& H = blocks.H[e];
      for (int k = 0; k < R; ++k) {
        const Vec<3, T> moment = cross(off, Vec<3, T>(H(k, 0), H(k, 1), H(k, 2)));
        for (int c = 0; c < 3; ++c) H(k, c + 3) -= moment[c];
      }
    }
  }
}

/// Moments of the rows of one pool in set s, of rigid bodies, turn back to the start.
template <class T>
void turn_back(const RowArrays<T>& pool, int s, const Array<HeldTurn<T>>& bodies) {
  const Array<Index>& block = *pool.set[s].block;
  const std::ptrdiff_t R = pool.rows;
  for (std::size_t e = 0; e < block.size(); ++e) {
    const auto& body = bodies[block[e]];
    if (!body.is_held) continue;
    T* const H = pool.set[s].H->data() + 6 * R * std::ptrdiff_t(e);
    for (std::ptrdiff_t k = 0; k < R; ++k) {
      const Vec<3, T> moment = rotated<T>(body.back, {H[k + 3 * R], H[k + 4 * R], H[k + 5 * R]});
      for (int c = 0; c < 3; ++c) H[k + (c + 3) * R] = moment[c];
    }
  }
}

}  // namespace delassus::inner
