/// Contact with Coulomb friction that also brakes rolling and spinning.
#pragma once

#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/refinements.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/pivoted_lu.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace delassus {

/// u = W λ + b, rows (n, t₁, t₂) of the velocity and (t₁, t₂, n) of the rate of turn at the contact:
///
///   0 ≤ u_n ⟂ λ_n ≥ 0,   |λ_t| ≤ μ λ_n,   |λ_r| ≤ μ_r λ_n,   |λ_s| ≤ μ_s λ_n.
///
/// Each bound is reached where its own velocity is not zero, and then against it. (Slip u_t in m/s; roll ω_r about a
/// tangent and spin ω_s about the normal in rad/s.) The impulses λ_r and λ_s are moments times h, N·m·s. Lengths are
/// μ_r and μ_s, m: half the width of the patch in which a soft wheel rests, say. A ball of radius R stands on slopes
/// up to tan θ = μ_r/R.
///
/// A visit ends at the rounding of its six equations. Either the contact sticks as a whole, or blocks are met in turn,
/// (n, t) and the roll each by Coulomb's own root. Newton's method on the cases that they are in goes the rest of the
/// way. A contact starts a step without the moments of the last one. Source: docs/references.md,
/// [AcaryBourrier2021], with a bound of its own for the spin.
struct RollingCoulomb {
  static constexpr int rows = 6;
  static constexpr std::array<RowKind, 6> kinds{RowKind::lower,    RowKind::friction, RowKind::friction,
                                                RowKind::friction, RowKind::friction, RowKind::friction};
  static constexpr auto refines = refine::check | refine::set_friction | refine::prepare | refine::clamp | refine::natural_map |
                                  refine::tangent | refine::is_sliding;

  double friction = 0.5;          ///< μ ≥ 0, where neither the pair nor the materials say otherwise
  double rolling_friction = 0;    ///< μ_r ≥ 0, m
  double torsional_friction = 0;  ///< μ_s ≥ 0, m

  /// Of one contact.
  struct Parameters {
    double friction /**< μ */, rolling /**< μ_r, m */, torsional;  ///< μ_s, m
  };

  /// What one contact's own block gives once a step. Turns are measured in the length ℓ that makes them weigh as much
  /// as the motions, ℓ² = tr W_uu / tr W_ωω. (Velocities are ℓ ω then, impulses λ_ω/ℓ.)
  template <class T>
  struct Memory {
    T length;  ///< ℓ, m; 1 where nothing turns
    Mat<6, 6, T> W;  ///< the own block, so measured, 1/kg
    PivotedLu<6, T> whole;  ///< its factors
    bool may_stick;  ///< false where it is singular
    /// The rows (n, t₁, t₂) of the velocity by themselves.
    Coulomb::Memory<T> slide, roll;  ///< n and the two rows of the roll, without what couples them
    Vec<6, T> last;  ///< λ of the last visit, so measured, N·s
  };

  void check() const {
    inner::expect_not_negative("RollingCoulomb: friction", friction);
    inner::expect_not_negative("RollingCoulomb: rolling_friction", rolling_friction);
    inner::expect_not_negative("RollingCoulomb: torsional_friction", torsional_friction);
  }

  Parameters parameters() const { return {friction, rolling_friction, torsional_friction}; }
  static void set_friction(Parameters& p, double friction) { p.friction = friction; }

  template <class T>
  void prepare(const Mat<6, 6, T>& W, Memory<T>& memory) const {
    const T moves = W(0, 0) + W(1, 1) + W(2, 2), turns = W(3, 3) + W(4, 4) + W(5, 5);
    memory.length = turns > T(0) ? std::sqrt(moves / turns) : T(1);  // a particle does not turn
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        memory.W(i, j) = W(i, j) * (i < 3 ? T(1) : memory.length) * (j < 3 ? T(1) : memory.length);
    memory.may_stick = memory.whole.factor(memory.W);
    const Mat<6, 6, T>& s = memory.W;
    Mat<3, 3, T> slide, roll = Mat<3, 3, T>::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) slide(i, j) = s(i, j);
    roll(0, 0) = s(0, 0);
    for (int i = 1; i < 3; ++i)
      for (int j = 1; j < 3; ++j) roll(i, j) = s(i + 2, j + 2);
    Coulomb{}.prepare(slide, memory.slide);
    Coulomb{}.prepare(roll, memory.roll);
    memory.last.setZero();
  }

  template <class T>
  Vec<6, T> solve_local(const Parameters& p, const Mat<6, 6, T>&, const Vec<6, T>& b, Memory<T>& memory) const {
    if (b[0] >= -inner::negligible_approach<T>) return memory.last = Vec<6, T>::Zero();
    const Cones<T> cones{T(p.friction), T(p.rolling) / memory.length, T(p.torsional) / memory.length};
    const Vec<6, T> scaled = measured_in(memory.length, b);
    Vec<6, T> lambda = -scaled;
    memory.whole.solve(lambda);
    if (!memory.may_stick || !cones.contains(lambda)) lambda = slip_somewhere(cones, scaled, memory);
    memory.last = lambda;
    return measured_in(memory.length, lambda);
  }

  /// Where W is diagonal, and alike in the rows of a disc, the cases are explicit. With x = λ − W⁻¹ d,
  ///
  ///   λ_n = max(0, x_n),   λ_k = min(|x_k|, μ_k λ_n) x_k/|x_k|,   k the slip, the roll, the spin.
  template <class T>
  Mat<6, 6, T> tangent(const Parameters& p, Local<6, T>& c) const {
    Vec<6, T>& x = c.lambda;
    Mat<6, 6, T> slope = Mat<6, 6, T>::Zero();
    for (int k = 0; k < 6; ++k) {
      slope(k, k) = T(1) / c.W(k, k);
      x[k] -= slope(k, k) * c.d[k];
    }
    if (!(x[0] > T(0))) {
      x.setZero();
      slope.setZero();
      return slope;
    }
    const Cones<T> cones{T(p.friction), T(p.rolling), T(p.torsional)};
    for (int k = 0; k < 3; ++k) {
      const T mu = cones.slope(k), size = Cones<T>::length(x, k), most = mu * x[0];
      if (size <= most) continue;
      const int from = Cones<T>::first[k], end = from + Cones<T>::size[k];
      T t[6];
      for (int i = from; i < end; ++i) t[i] = x[i] / size;
      const T across = most / size * slope(from, from);
      for (int i = from; i < end; ++i) {
        x[i] = most * t[i];
        slope(i, 0) = mu * slope(0, 0) * t[i];
        for (int j = from; j < end; ++j) slope(i, j) = across * (T(i == j) - t[i] * t[j]);
      }
    }
    return slope;
  }

  /// F_n = min(s λ_n, u_n);  F_k = s λ_k − clip(s λ_k − u_k) on the disc of radius μ_k s λ_n, k the slip, the
  /// roll, the spin. Where s is `of_turns`, 1/(kg m²), in the rows of the roll and the spin, these are in rad/s.
  template <class T>
  Vec<6, T> natural_map(const Parameters& p, const Vec<6, T>& lambda, const Vec<6, T>& u, T scale, T of_turns) const {
    return Cones<T>{T(p.friction), T(p.rolling), T(p.torsional)}.miss(lambda, u, scale, of_turns);
  }
  template <class T>
  Vec<6, T> natural_map(const Parameters& p, const Vec<6, T>& lambda, const Vec<6, T>& u, T scale) const {
    return natural_map(p, lambda, u, scale, scale);
  }
  template <class T>
  void clamp(const Parameters& p, Vec<6, T>& lambda) const {
    Cones<T>{T(p.friction), T(p.rolling), T(p.torsional)}.clamp(lambda);
  }
  /// |λ_t| = μ λ_n > 0 to rounding, whatever the turns do.
  template <class T>
  bool is_sliding(const Parameters& p, const Vec<6, T>& lambda) const {
    return Coulomb{}.is_sliding(Coulomb::Parameters{p.friction}, Vec<3, T>(lambda[0], lambda[1], lambda[2]));
  }

 private:
  /// The three discs of an impulse: rows 1–2, 3–4 and 5.
  template <class T>
  struct Cones {
    T slide, roll, spin;

    static constexpr int first[3] = {1, 3, 5}, size[3] = {2, 2, 1};
    T slope(int k) const { return k == 0 ? slide : k == 1 ? roll : spin; }
    static T length(const Vec<6, T>& x, int k) {
      return size[k] == 2 ? inner::length(x[first[k]], x[first[k] + 1]) : std::abs(x[first[k]]);
    }
    /// The cones at this share of their angles.
    Cones opened(T share) const {
      const auto narrowed = [share](T slope) { return std::tan(share * std::atan(slope)); };
      return {narrowed(slide), narrowed(roll), narrowed(spin)};
    }
    bool contains(const Vec<6, T>& x) const {
      bool is_inside = x[0] >= T(0);
      for (int k = 0; k < 3; ++k) is_inside = is_inside && length(x, k) <= slope(k) * x[0];
      return is_inside;
    }
    void clamp(Vec<6, T>& x) const {
      x[0] = std::max(x[0], T(0));
      for (int k = 0; k < 3; ++k) shorten(x, k, slope(k) * x[0]);
    }
    Vec<6, T> miss(const Vec<6, T>& lambda, const Vec<6, T>& u, T scale, T of_turns) const {
      Vec<6, T> x, y;
      for (int k = 0; k < 6; ++k) x[k] = (k < 3 ? scale : of_turns) * lambda[k], y[k] = x[k] - u[k];
      const T pressed = std::max(lambda[0], T(0));
      for (int k = 0; k < 3; ++k) shorten(y, k, slope(k) * ((k == 0 ? scale : of_turns) * pressed));
      y[0] = std::max(y[0], T(0));
      return x - y;
    }
    static void shorten(Vec<6, T>& x, int k, T most) {
      const T now = length(x, k);
      if (now <= most) return;
      for (int i = first[k]; i < first[k] + size[k]; ++i) x[i] *= most / now;
    }
  };

  template <class T>
  static Vec<6, T> measured_in(T length, const Vec<6, T>& x) {
    return {x[0], x[1], x[2], length * x[3], length * x[4], length * x[5]};
  }

  /// Blocks in turn, each to its own law at the others' impulses, with a try at the end of Newton's method
  /// from there.
  template <class T>
  static Vec<6, T> slip_somewhere(const Cones<T>& cones, const Vec<6, T>& b, Memory<T>& memory) {
    const Mat<6, 6, T>& W = memory.W;
    const T weight = trace(W) / T(6);
    const T enough = T(64) * std::numeric_limits<T>::epsilon() * b.norm();
    Vec<6, T> lambda = memory.last, best = lambda;
    T least = std::numeric_limits<T>::infinity();
    const auto is_enough = [&](const Vec<6, T>& x) {
      const T off = cones.miss(x, W * x + b, weight, weight).norm();
      if (off < least) least = off, best = x;
      return off <= enough;
    };
    for (int round = 0; round < 40; ++round) {
      meet_in_turn(cones, b, lambda, memory);
      if (is_enough(lambda)) break;
      Vec<6, T> ahead = lambda;
      bool is_over = false;
      for (int k = 0; k < 8 && !is_over && newton_step(cones, W, b, weight, ahead); ++k)
        is_over = is_enough(ahead);
      if (is_over) break;
    }
    if (least > enough) {
      // Steep cones on a normal that answers to friction: from none of it to all by the angle of the cones,
      // each answer from the one before.
      constexpr T rounding = std::numeric_limits<T>::epsilon();
      const T near = std::sqrt(rounding) * b.norm();
      T share = 0, part = T(1) / T(16);
      Vec<6, T> here = Vec<6, T>::Zero();
      here[0] = -b[0] / W(0, 0);
      for (int tries = 0; tries < 1000 && share < T(1) && part > T(16) * rounding; ++tries) {
        const T next = std::min(share + part, T(1));
        const Cones<T> some = next < T(1) ? cones.opened(next) : cones;
        Vec<6, T> ahead = here;
        bool is_met = false;
        for (int k = 0; k < 6 && !is_met && newton_step(some, W, b, weight, ahead); ++k)
          is_met = next < T(1) ? some.miss(ahead, W * ahead + b, weight, weight).norm() <= near : is_enough(ahead);
        if (is_met) here = ahead, share = next;
        part *= is_met ? T(2) : T(0.5);
      }
      for (int k = 0; k < 6 && least > enough && newton_step(cones, W, b, weight, here); ++k) is_enough(here);
    }
    cones.clamp(best);
    return best;
  }

  template <class T>
  static void meet_in_turn(const Cones<T>& cones, const Vec<6, T>& b, Vec<6, T>& lambda, Memory<T>& memory) {
    const Mat<6, 6, T>& W = memory.W;
    // What row i would do without the rows from … to of this contact.
    const auto free = [&](int i, int from, int to) {
      T sum = b[i];
      for (int j = 0; j < 6; ++j)
        if (j < from || j > to) sum += W(i, j) * lambda[j];
      return sum;
    };
    const Vec<3, T> slide =
        Coulomb::impulse({double(cones.slide)}, Vec<3, T>(free(0, 0, 2), free(1, 0, 2), free(2, 0, 2)), memory.slide);
    for (int i = 0; i < 3; ++i) lambda[i] = slide[i];
    // The roll is friction under a normal impulse that does not answer to it: b_n = −W_nn λ_n.
    const Vec<3, T> roll = Coulomb::impulse(
        {double(cones.roll)}, Vec<3, T>(-lambda[0] / memory.roll.over_normal, free(3, 3, 4), free(4, 3, 4)), memory.roll);
    lambda[3] = roll[1], lambda[4] = roll[2];
    const T most = cones.spin * lambda[0];
    lambda[5] = W(5, 5) > T(0) ? std::clamp(-free(5, 5, 5) / W(5, 5), -most, most) : T(0);
  }

  /// One step of Newton's method on: u_n = 0; u_k = 0 where block k holds, else λ_k = μ_k λ_n y/|y|, y = w
  /// λ_k − u_k.
  template <class T>
  static bool newton_step(const Cones<T>& cones, const Mat<6, 6, T>& W, const Vec<6, T>& b, T w,
                          Vec<6, T>& lambda) {
    const Vec<6, T> u = W * lambda + b;
    Mat<6, 6, T> A = W;
    Vec<6, T> step = -u;
    for (int k = 0; k < 3; ++k) {
      const int from = Cones<T>::first[k], size = Cones<T>::size[k];
      const T mu = cones.slope(k);
      T y[2] = {}, square = 0;
      for (int i = 0; i < size; ++i) y[i] = w * lambda[from + i] - u[from + i], square += y[i] * y[i];
      const T length = std::sqrt(square);
      if (length <= mu * w * lambda[0] || !(length > T(0))) continue;
      // dλ_k − μ t dλ_n − μ λ_n/|y| (1 − t tᵀ) (w dλ_k − W_k dλ) = μ λ_n t − λ_k,  t = y/|y|.
      for (int i = 0; i < size; ++i) {
        const int row = from + i;
        step[row] = w * (mu * lambda[0] * y[i] / length - lambda[row]);
        for (int j = 0; j < 6; ++j) {
          T turn = 0;
          for (int l = 0; l < size; ++l) {
            const T across = T(i == l) - y[i] * y[l] / square;
            turn += across * (w * T(j == from + l) - W(from + l, j));
          }
          A(row, j) =
              w * (T(j == row) - (j == 0 ? mu * y[i] / length : T(0)) - mu * lambda[0] / length * turn);
        }
      }
    }
    PivotedLu<6, T> lu;
    if (!lu.factor(A)) return false;
    lu.solve(step);
    lambda += step;
    return is_finite(lambda);
  }
};

}  // namespace delassus
