/// One rigid body on its way through a step, for schemes that lead it there themselves.
#pragma once

#include <delassus/bodies/inner/rigid_state.hpp>
#include <delassus/math/free_turns.hpp>

#include <cstddef>
#include <vector>

namespace delassus::inner {

/// For Störmer-Verlet: where the body drifts from the start of the step with a velocity, and how impulses at
/// the start change that. For Runge-Kutta: slopes (ẋ, q̇, v̇, Ω̇) at stages, with Ω in the body's axes and q as
/// four numbers.
template <class T>
class RigidPath {
 public:
  using Vector = Vec<3, T>;
  using Matrix = Mat<3, 3, T>;
  using Twist = Vec<6, T>;
  using Four = Vec<4, T>;

  void resize(std::size_t n) { bodies_.resize(n); }

  void begin(const RigidState<T>& s, Index b, const Twist& v) {
    Body& body = bodies_[b];
    body.x = s.x[b];
    body.q = s.q[b].coeffs();
    body.v = v;
    body.rate = transposed_times(s.R[b], angular_part(v));
    body.slope = body.sum = Slope{};
  }
  const Twist& start_velocity(Index b) const { return bodies_[b].v; }
  void back(RigidState<T>& s, Index b) const { put(s, b, bodies_[b].x, bodies_[b].q); }

  /// q ← the free motion of h from the start with velocity w; returns the velocity it ends with.
  Twist drift(RigidState<T>& s, Index b, const Twist& w, T h, bool moves) {
    Body& body = bodies_[b];
    put(s, b, body.x, body.q);
    if (!moves) {
      s.displace(b, h * linear_part(w), h * angular_part(w));
      return w;
    }
    const Vector spatial = s.R[b] * (s.inertia[b] * transposed_times(s.R[b], angular_part(w)));
    const Eigen::Quaternion<T> turned =
        turn_freely<T>(s.inverse_inertia[b], s.q[b], spatial, h, &body.response);
    put(s, b, body.x + converted<double>(Vector(h * linear_part(w))), turned.coeffs());
    return twist<T>(linear_part(w), s.R[b] * s.own_rate(b, transposed_times(s.R[b], spatial)));
  }
  /// What impulses at the start do to where `drift` ends: each column of X.
  template <int C, class Set>
  Mat<6, C, T> answer(const Set& set, Index b, const Mat<6, C, T>& X, T h) const {
    const T over_mass = set.moves(b) ? h / set.mass(b) : T(0);
    Mat<6, C, T> Y;
    for (int c = 0; c < C; ++c) {
      const T* x = X.data() + 6 * c;
      T* y = Y.data() + 6 * c;
      const Vector turn = bodies_[b].response * Vector(x[3], x[4], x[5]);
      for (int k = 0; k < 3; ++k) y[k] = over_mass * x[k], y[k + 3] = turn[k];
    }
    return Y;
  }

  /// −ω × R I Rᵀ ω, which a set of rigid bodies leaves out of its forces.
  Twist gyroscopic(const RigidState<T>& s, Index b, const Twist& v) const {
    const Vector rate = transposed_times(s.R[b], angular_part(v));
    return twist<T>(zero<Vector>(), s.R[b] * cross(Vector(s.inertia[b] * rate), rate));
  }
  /// q ← q₀ + t q̇ of the last slope; returns v there.
  Twist to_stage(RigidState<T>& s, Index b, T t, bool moves) {
    Body& body = bodies_[b];
    if (!moves) return drift(s, b, body.v, t, false);
    return place(s, b, body.slope, t);
  }
  void keep_stage(const RigidState<T>& s, Index b) {
    bodies_[b].stage_x = s.x[b], bodies_[b].stage_q = s.q[b].coeffs();
  }
  /// q ← the stage ⊕ t v.
  void look_along(RigidState<T>& s, Index b, const Twist& v, T t) const {
    put(s, b, bodies_[b].stage_x, bodies_[b].stage_q);
    if (t != T(0)) s.displace(b, t * linear_part(v), t * angular_part(v));
  }
  /// The slope where q and v are now, under the acceleration a of the world's axes; it counts by `weight` in
  /// the sum.
  void note_slope(const RigidState<T>& s, Index b, const Twist& v, const Twist& a, T weight) {
    Body& body = bodies_[b];
    const Vector rate = transposed_times(s.R[b], angular_part(v));
    const Eigen::Quaternion<T> half(T(0), rate[0] / 2, rate[1] / 2, rate[2] / 2);
    body.slope = {linear_part(v), Eigen::Quaternion<T>(s.q[b] * half).coeffs(), linear_part(a),
                  transposed_times(s.R[b], angular_part(a))};
    body.sum.x += weight * body.slope.x;
    body.sum.q += weight * body.slope.q;
    body.sum.v += weight * body.slope.v;
    body.sum.rate += weight * body.slope.rate;
  }
  /// q ← q₀ + h Σ weight q̇; returns v there.
  Twist to_end(RigidState<T>& s, Index b, T h, bool moves) {
    return moves ? place(s, b, bodies_[b].sum, h) : drift(s, b, bodies_[b].v, h, false);
  }

 private:
  struct Slope {
    Vector x = zero<Vector>();
    Four q = zero<Four>();
    Vector v = zero<Vector>(), rate = zero<Vector>();
  };
  struct Body {
    Vec3 x, stage_x;
    Vector rate;
    Four q, stage_q;
    Twist v;
    Slope slope, sum;
    Matrix response;
  };

  static void put(RigidState<T>& s, Index b, const Vec3& x, const Four& q) {
    s.put(b, x, Eigen::Quaternion<T>(q));
  }
  Twist place(RigidState<T>& s, Index b, const Slope& slope, T t) {
    const Body& body = bodies_[b];
    const Four q = body.q + t * slope.q;
    put(s, b, body.x + converted<double>(Vector(t * slope.x)), q / norm(q));
    const Vector rate = body.rate + t * slope.rate;
    return twist<T>(linear_part(body.v) + t * slope.v, s.R[b] * rate);
  }

  std::vector<Body> bodies_;
};

}  // namespace delassus::inner
