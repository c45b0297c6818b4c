/// One rigid body in a step of the midpoint rule, as Newton's method meets it.
#pragma once

#include <delassus/bodies/inner/rigid_state.hpp>

#include <vector>

namespace delassus::inner {

/// cay(t) = 1 + (t^ + ½ t^²)/(1 + |t|²/4).
template <class T>
Mat<3, 3, T> cayley_matrix(const Vec<3, T>& t) {
  const Mat<3, 3, T> S = skew(t);
  const Mat<3, 3, T> both = S + T(0.5) * (S * S);
  Mat<3, 3, T> Q = T(1) / (T(1) + squared_norm(t) / 4) * both;
  for (int k = 0; k < 3; ++k) Q(k, k) += T(1);
  return Q;
}

/// ∂(cay(t) y)/∂t, by the quotient rule: cay(t) y = y + n/d, n = t × y + ½ t × (t × y), d = 1 + |t|²/4.
template <class T>
Mat<3, 3, T> cayley_slope(const Vec<3, T>& t, const Vec<3, T>& y) {
  const T over = T(1) / (T(1) + squared_norm(t) / 4);
  const Vec<3, T> ty = cross(t, y), n = ty + T(0.5) * cross(t, ty), half = (T(0.5) * over) * t;
  const Mat<3, 3, T> slope = skew(y) + T(0.5) * (skew(ty) + skew(t) * skew(y));
  Mat<3, 3, T> out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out(r, c) = -over * (slope(r, c) + n[r] * half[c]);
  return out;
}

/// The unknowns of a body are its mean velocity v̄ and the mean rate Ω̄ in its own axes; q₊ = (x + h v̄, R cay(h
/// Ω̄)), and
///
///   2 m (v̄ − v) = p,   cay(h Ω̄) I (2 Ω̄ − Ω) − I Ω = Rᵀ l
///
/// for the impulse p and the moment l of a step, which act on the mean (R + R₊)/2 of the axes: so constraints
/// that are quadratic in R, at the mean of both ends, do no work. A force F at the body's point r turns with
/// that mean: the geometric stiffness ½ h (RᵀF)^ ∂(cay r). Source: [SimoWong1991].
template <class T>
class RigidMidpoint {
 public:
  using Vector = Vec<3, T>;
  using Matrix = Mat<3, 3, T>;
  using Twist = Vec<6, T>;

  void resize(std::size_t n) { bodies_.resize(n); }

  /// Starts from the velocity that the body has.
  void begin(const RigidState<T>& s, Index b, const Twist& v, bool moves, T h) {
    Body& body = bodies_[b];
    body.x = s.x[b];
    body.R = s.R[b];
    body.moves = moves;
    body.velocity = body.mean = linear_part(v);
    body.rate = body.mean_rate = transposed_times(body.R, angular_part(v));
    if (!moves) body.turn = exponential<T>(h * Vector(body.rate)).toRotationMatrix();
  }

  /// q ← q₊, and what Newton's method needs of it.
  void to_end(RigidState<T>& s, Index b, T h) {
    Body& body = bodies_[b];
    if (body.moves) {
      body.t = h * body.mean_rate;
      body.turn = cayley_matrix(body.t);
    }
    s.x[b] = body.x + converted<double>(Vector(h * body.mean));
    s.R[b] = body.R * body.turn;
  }
  /// q ← the mean of both ends; the mean of two rotations is none, and is not made one.
  void to_middle(RigidState<T>& s, Index b, T h) const {
    const Body& body = bodies_[b];
    s.x[b] = body.x + converted<double>(Vector((h / 2) * body.mean));
    s.R[b] = T(0.5) * (body.R + s.R[b]);
  }
  void back(RigidState<T>& s, Index b) const {
    s.x[b] = bodies_[b].x;
    s.R[b] = bodies_[b].R;
  }

  /// What is missing to the two equations under this impulse; returns it as a velocity, m/s.
  T balance(const RigidState<T>& s, Index b, const Twist& impulse) {
    Body& body = bodies_[b];
    const Matrix& I = s.inertia[b];
    body.momentum = I * Vector(T(2) * body.mean_rate - body.rate);
    body.missing = (T(2) * s.mass[b]) * (body.mean - body.velocity) - linear_part(impulse);
    body.missing_moment = body.turn * body.momentum - I * body.rate - transposed_times(body.R, angular_part(impulse));
    set_zero(body.stiffness);
    const Vector rate = s.inverse_inertia[b] * body.missing_moment;
    return std::sqrt((squared_norm(body.missing) * s.inverse_mass[b] + dot(body.missing_moment, rate)) *
                     s.inverse_mass[b]);
  }
  /// (v̄, R Ω̄): an impulse and a moment of the step do the work of their products with it.
  Twist mean(Index b) const { return twist<T>(bodies_[b].mean, Vector(bodies_[b].R * bodies_[b].mean_rate)); }
  /// A force (N·s over the step, world axes) at the body's own point r, after `balance`.
  void stiffen(Index b, const Vector& force, const Vector& r, T h) {
    Body& body = bodies_[b];
    body.stiffness += (h / 2) * (skew(Vector(transposed_times(body.R, force))) * cayley_slope(body.t, r));
  }
  /// The matrix of the second equation where `balance` was, with the forces of `stiffen`.
  void differentiate(const RigidState<T>& s, Index b, T h) {
    Body& body = bodies_[b];
    const Matrix slope = T(2) * (body.turn * s.inertia[b]) + h * cayley_slope(body.t, body.momentum) + body.stiffness;
    const T scale = T(1) / norm(slope);
    body.inverse = scale * inverse(Matrix(scale * slope));
    // δθ₊ = h R (1 + t^/2)/d δΩ̄
    Matrix turned = skew(Vector(T(0.5) * body.t));
    for (int k = 0; k < 3; ++k) turned(k, k) += T(1);
    body.response =
        (h / (T(1) + squared_norm(body.t) / 4)) * (body.R * (turned * (times_transposed<T>(body.inverse, body.R))));
    body.over_mass = h * T(0.5) * s.inverse_mass[b];
  }

  /// What an impulse on the body does to q₊, by the matrix of `differentiate`: each column of X.
  template <int C>
  Mat<6, C, T> answer(Index b, const Mat<6, C, T>& X) const {
    const Body& body = bodies_[b];
    Mat<6, C, T> Y;
    for (int c = 0; c < C; ++c) {
      const T* x = X.data() + 6 * c;
      T* y = Y.data() + 6 * c;
      const Vector turn = body.response * Vector(x[3], x[4], x[5]);
      for (int k = 0; k < 3; ++k) y[k] = body.over_mass * x[k], y[k + 3] = turn[k];
    }
    return Y;
  }
  /// The same of what is missing.
  Twist answer_to_missing(Index b) const {
    const Body& body = bodies_[b];
    return answer<1>(b, twist<T>(body.missing, body.R * body.missing_moment));
  }
  /// q ← q₊; returns the velocity there. It is made of the unknowns and not of the impulses: a moment that is
  /// off by rounding would turn a slender body far.
  Twist go(RigidState<T>& s, Index b, T h) const {
    const Body& body = bodies_[b];
    s.x[b] = body.x + converted<double>(Vector(h * body.mean));
    s.q[b] = unit_again(s.q[b] * cayley<T>(h * body.mean_rate));
    s.turn(b);
    return twist<T>(Vector(T(2) * body.mean - body.velocity),
                    s.R[b] * Vector(T(2) * body.mean_rate - body.rate));
  }
  /// The unknowns after the impulse has changed by this.
  void move(const RigidState<T>& s, Index b, const Twist& change) {
    Body& body = bodies_[b];
    body.mean += (T(0.5) * s.inverse_mass[b]) * Vector(linear_part(change) - body.missing);
    body.mean_rate += body.inverse * Vector(transposed_times(body.R, angular_part(change)) - body.missing_moment);
  }

 private:
  struct Body {
    Vec3 x;
    Vector velocity, rate, mean, mean_rate, t, missing, missing_moment, momentum;
    Matrix R, turn, stiffness, inverse, response;
    T over_mass = 0;
    bool moves = false;
  };
  std::vector<Body> bodies_;
};

}  // namespace delassus::inner
