/// A whole step of Störmer and Verlet's method with its joints: for `Rattle`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/steppers/inner/equalities.hpp>
#include <delassus/steppers/inner/leave_step.hpp>
#include <delassus/steppers/inner/speed_of.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace delassus {

/// Kick, drift, kick:
///
///   w = v + M⁻¹ (h/2 f(q) + Hᵀ λ₁),   q₊ = the free motion of h from q with w,   φ(q₊) = 0,
///   v₊ = w₊ + M₊⁻¹ (h/2 f(q₊) + H₊ᵀ λ₂),   H₊ v₊ = 0.
///
/// w₊ is the velocity that the drift ends with. λ₁ by Newton's method with H₊ ∂q₊/∂λ₁ (the drift's own
/// response), λ₂ by one solve. Forces that depend on v see v and, at the end, w₊ + (w − v). A drift in n
/// parts closes φ = 0 after each h/n, by a λ₁ of its own along H where it begins; λ is the sum of all. That
/// is n steps of the method without forces between two kicks: what they would take out of the velocity where
/// two meet, λ₁ takes along the same H. Source: docs/references.md, [Andersen1983], [LeimkuhlerReich2004]
/// chapters 7 and 8, and for the parts [LeimkuhlerMatthews2016].
template <class World, class Laws, class Rows>
class RattleStep {
 public:
  using T = typename Rows::Scalar;

  /// Leaves q₊ and v_next in the sets and λ₁ + λ₂ in `rows`, which is linearised at the start on entry.
  template <class I>
  SolveReport solve(World& world, const Laws& laws, Rows& rows, const I& integrator, double h) {
    SolveReport report{
        .status = Status::max_iterations, .factorizations = Rows::pool_count > 0, .ended_by = "Newton"};
    begin(world, rows, integrator, h);
    const int drifts = integrator.drifts;
    if (drifts > 1) before_ = paths_;
    auto& start = drifts > 1 ? before_ : paths_;
    inner::BackUnlessDone back(world, start);
    for (int part = 0; part < drifts; ++part) {
      if (part > 0) begin_part(world, rows, integrator, h, report);
      report.status = Status::max_iterations;
      find_places(world, laws, rows, integrator, h, report);
      if (part == 0) std::swap(sent_, kicked_);
      sum_.add(first_);
      if (report.status == Status::max_iterations) break;
    }
    find_velocities(world, rows, integrator, h);
    sum_.add(second_);
    sum_.give_to(rows);
    inner::keep_or_leave(world, laws, rows, integrator, equalities_, start, h * speed_, report);
    back.is_done = true;
    return report;
  }

 private:
  /// What the bodies have after the forces of the start, without λ₁ of rigid rows.
  template <class I>
  void begin(World& world, Rows& rows, const I& integrator, double h) {
    speed_ = 0;
    Equalities<Rows>::pull(world, rows, first_, h / 2);
    world.each([&](auto& set, auto s) {
      set.factor(integrator.scale(h));
      inner::apply_inverse_to_all(set, rows, s);
      auto& path = std::get<s>(paths_);
      path.resize(std::size_t(set.blocks()));
      kick(set, integrator, std::get<s>(force_), h / 2);
      auto& free = std::get<s>(free_);
      free = set.velocity();
      for (const Index b : set.active()) {
        path.begin(set.state(), b, set.velocity()[b]);
        if (set.moves(b)) free[b] += set.template solve_block<1>(b, std::get<s>(force_)[b]);
        speed_ = std::max(speed_, inner::speed_of(set, b, free[b]));
      }
    });
    if (!(speed_ > 0)) speed_ = 1;
    sum_.resize_like(rows);
    sum_.set_zero();
    guess(world, rows);
    start_ = rows;
  }
  /// The next part of the drift begins where the last has ended, with the velocity it ended with: λ₁ along
  /// the same H takes out of it what H w would be.
  template <class I>
  void begin_part(World& world, Rows& rows, const I& integrator, double h, SolveReport& report) {
    world.each([&](auto& set, auto s) {
      set.factor(integrator.scale(h));
      inner::apply_inverse_to_all(set, rows, s);
      std::get<s>(free_) = set.v_next;
      for (const Index b : set.active()) std::get<s>(paths_).begin(set.state(), b, set.velocity()[b]);
    });
    first_.set_zero();
    report.factorizations += Rows::pool_count > 0;
    guess(world, rows);
    start_ = rows;
  }
  /// λ₁ of H w = 0. Last step's, half of them, would turn slender bodies round and round.
  void guess(World& world, Rows& rows) {
    world.each([&](auto& set, auto s) { set.v_next = std::get<s>(free_); });
    Equalities<Rows>::push_all(rows, first_, inner::next_of(world));
    if (!equalities_.factor(rows)) return;
    equalities_.solve(
        rows, [&](auto p, Index i) { return inner::next_rate(rows.template pool<p>(), i, world); },
        [&](auto p, Index i, const auto& change) { inner::part<p>(first_.pools)[i] += change; });
  }
  template <class Set, class I>
  static void kick(const Set& set, const I& integrator, Array<typename Set::Velocity>& p, double h) {
    p.resize(set.blocks());
    for (auto& x : p) x.setZero();
    integrator.impulse(set, p, h);
  }

  template <class I>
  void find_places(World& world, const Laws& laws, Rows& rows, const I& integrator, double h,
                   SolveReport& report) {
    const int most = report.factorizations - 1 + integrator.max_iterations;
    const double near = std::max(1e-7, inner::rounding_of_places<T>(world, laws, rows) / (h * speed_));
    for (double last = std::numeric_limits<double>::infinity();;) {
      drift(world, h / integrator.drifts);
      linearize(world, laws, rows);
      const double size = Equalities<Rows>::worst(rows) / (h * speed_);
      report.measure.residual = size;
      if (size <= integrator.tolerance)
        report.status = Status::converged;
      else if (size > 0.5 * last && size <= near)
        report.status = Status::stalled;
      if (report.status != Status::max_iterations || report.factorizations == most) return;
      last = size;
      ++report.factorizations;
      if (!improve(world, rows, h / integrator.drifts)) return;
    }
  }
  void drift(World& world, double h) {
    world.each([&](auto& set, auto s) { set.v_next = std::get<s>(free_); });
    Equalities<Rows>::push_all(start_, first_, inner::next_of(world));
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) {
        auto& w = std::get<s>(sent_);
        w.resize(set.blocks());
        w[b] = set.v_next[b];
        set.v_next[b] = std::get<s>(paths_).drift(set.state(), b, w[b], T(h), set.moves(b));
      }
    });
  }
  /// λ₁ −= (H₊ ∂q₊/∂λ₁)⁻¹ φ(q₊).
  bool improve(const World& world, Rows& rows, double h) {
    inner::answer_ends(world, rows, start_, [&](const auto& set, auto s, Index b, const auto& X) {
      return std::get<s>(paths_).answer(set, b, X, T(h));
    });
    if (!equalities_.factor(rows)) return false;
    equalities_.solve(
        rows, [&](auto p, Index i) { return rows.template pool<p>().phi[i]; },
        [&](auto p, Index i, const auto& change) { inner::part<p>(first_.pools)[i] += change; });
    return true;
  }

  template <class I>
  void find_velocities(World& world, Rows& rows, const I& integrator, double h) {
    world.each([&](auto& set, auto s) {
      set.factor(integrator.scale(h));
      inner::apply_inverse_to_all(set, rows, s);
      auto& v = set.velocity();
      for (const Index b : set.active())
        if (set.moves(b)) v[b] = set.v_next[b] + (std::get<s>(kicked_)[b] - v[b]);
      kick(set, integrator, std::get<s>(force_), h / 2);
    });
    Equalities<Rows>::pull(world, rows, second_, h / 2);
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) {
        set.velocity()[b] = std::get<s>(paths_).start_velocity(b);
        if (set.moves(b)) set.v_next[b] += set.template solve_block<1>(b, std::get<s>(force_)[b]);
      }
    });
    Equalities<Rows>::push_all(rows, second_, inner::next_of(world));
    if (!equalities_.factor(rows)) return;
    for (int pass = 0; pass < 2; ++pass)  // the second takes out the error of ε
      equalities_.solve(
          rows, [&](auto p, Index i) { return inner::next_rate(rows.template pool<p>(), i, world); },
          [&](auto p, Index i, const auto& change) {
            inner::part<p>(second_.pools)[i] += change;
            Equalities<Rows>::template push<p>(rows, i, change, inner::next_of(world));
          });
  }

  typename World::template PerSet<inner::PathOf> paths_, before_;  ///< from the start of a part, of the step
  typename World::template PerSet<VelocitiesOf> force_, free_;
  typename World::template PerSet<VelocitiesOf> sent_, kicked_;  ///< w of a part, of the first
  Rows start_;
  Impulses<Rows> first_, second_, sum_;  ///< λ₁ and λ₂ of a part, and of all parts
  Equalities<Rows> equalities_;
  double speed_ = 1;
};

}  // namespace delassus
