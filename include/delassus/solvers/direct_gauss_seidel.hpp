/// Joints by one sparse factorization, contacts and limits by sweeps on what the joints leave them.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/fwd.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/inner/compromise.hpp>
#include <delassus/solvers/inner/contradiction.hpp>
#include <delassus/solvers/inner/joint_system.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/inner/schur_complement.hpp>
#include <delassus/solvers/inner/sweeps_then_newton.hpp>
#include <delassus/solvers/inner/velocities_by_body.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace delassus {
namespace inner {

/// Room for the direct path: of constraints of `highest` rows at most, on blocks of `widest` velocities.
template <class T, int highest, int widest>
struct DirectSpace {
  static_assert(widest > 0,
                "delassus: the direct path needs the bodies of a problem, and this one, as a "
                "FrictionProblem, has W alone; "
                "solve it by AcceleratedGaussSeidel");
  JointSystem<highest, std::max(1, widest)> joints;
  SchurComplement<T, DirectSystem<highest, std::max(1, widest)>> others;
  VelocitiesByBody<T> velocities;
  Array<T> before, after;
  SweepsThenNewton::Space<T> contacts;
  void reset(Index rows) {
    contacts.reset(rows);
    for (auto* impulses : {&before, &after}) impulses->reserve(std::size_t(rows));
  }
};

}  // namespace inner

/// The constraints b of an island whose rows are all equalities are met exactly, W_bb δ = −(d + W λ)_b.
/// `inner::DirectSystem` does it in O(n) for chains, trees and loops of n joints, at any ratio of masses. The
/// others c are swept on
///
///   S = W_cc − W_cb W_bb⁻¹ W_bc,   u_c = d_c + W_cb λ_b + W_cc λ_c with λ_b such that the joints hold,
///
/// by `AcceleratedGaussSeidel`. The matrix S is dense. An island with more than `max_swept_rows` rows of them
/// is swept whole, as is one whose A couples bodies by springs. Where contacts jam and sweeps do not end it,
/// Newton's method acts on S, `inner::SweepsThenNewton`. Impulses of joints start from zero: Where rows
/// depend on each other they come out the smallest that do.
///
/// Joints that contradict each other get a compromise, as springs of 1e-4 of their compliance would give.
/// What the others ask for is hardly touched where a mechanism only stands at a dead centre. The status is
/// `infeasible` where `inner::Contradiction` proves it. Contacts and limits that joints leave no way get the
/// compromise of `AcceleratedGaussSeidel`. Cannot mend what an explicit constraint force does to a heavy
/// chain: see docs/decisions/0009.
struct DirectGaussSeidel {
  using plays = role::Solver;
  double tolerance = 1e-8;                    ///< of the criterion
  int max_iterations = 4000;                  ///< sweeps over contacts and limits
  int min_iterations = 1;                     ///< of the same
  int max_swept_rows = 900;                   ///< 6.5 MB of S at three rows a constraint
  bool scale_tolerance = false;               ///< tolerance × number of rows
  bool all_verified = false;                  ///< every constraint's share below the tolerance, not the sum
  Criterion criterion = Criterion::residual;  ///< what the tolerance is compared with

  static constexpr Needs needs = Needs::sweeps;
  using compliance = UnassembledCompliance;  ///< of a loop that names none
  template <class Rows>
  using Workspace = inner::DirectSpace<typename Rows::Scalar, inner::rows_of_a_node<Rows>, Rows::widest>;

  SolveOptions options() const {
    return {tolerance, max_iterations, min_iterations, scale_tolerance, all_verified, criterion};
  }
  void check() const {
    inner::expect_at_least_zero("DirectGaussSeidel: tolerance", tolerance);
    inner::expect_at_least_zero("DirectGaussSeidel: max_iterations", max_iterations);
    inner::expect_at_least_zero("DirectGaussSeidel: max_swept_rows", max_swept_rows);
    inner::expect_measured("DirectGaussSeidel", criterion);
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const;

 private:
  template <class T, class Space>
  void solve_directly(Island<T>& problem, Space& work, SolveReport& report) const;

  static constexpr int most_rounds = inner::rounds_on_others;
  static constexpr double fine = 1e-10, coarse = 1e-4;  ///< ε, in units of each row's own W_kk
  static constexpr double before_sweeps = 1e-11, to_rounding = 1e-13;  ///< of what `settle` leaves

  template <class T, class Part>
  static const Span<T>& span_of(const Island<T>& problem, const Part& part) {
    return problem.begin()[part.pool];
  }

  /// Whether d, λ and the diagonal of W are numbers.
  template <class T>
  static bool is_finite(const Island<T>& problem) {
    T sum = 0;
    for (const Span<T>& span : problem)
      for (const Index i : span) {
        const T *d = problem.free_of_impulses(span, i), *lambda = problem.impulse(span, i);
        sum += span.pool->trace(i);
        for (int k = 0; k < span.pool->rows; ++k) sum += std::abs(d[k]) + std::abs(lambda[k]);
      }
    return std::isfinite(sum);
  }

  /// Whether the rows have a thousand times the energy that they would have without impulses, which hold or push away what comes, and
  /// leave it slower: no tolerance stopped these on their way to infinity.
  template <class T>
  static bool runs_away(Island<T>& problem) {
    double before = 0, after = 0;
    T u[most_rows];
    for (const Span<T>& span : problem)
      for (const Index i : span) {
        const double weight = span.pool->weight(i);
        if (!(weight > 0)) continue;
        problem.velocity(span, i, u);
        const T* d = problem.free_of_impulses(span, i);
        before += problem.square_of_velocity(span, d) / weight;
        after += problem.square_of_velocity(span, u) / weight;
      }
    return !(after <= 1e3 * before);
  }

  /// λ ← 0, and y with it to the last digit: what large impulses left of it is rounding of theirs.
  template <class T>
  static void clear(Island<T>& problem) {
    problem.clear();
    for (const Span<T>& span : problem)
      for (int s = 0; s < span.pool->sets; ++s) {
        const SetBlocksView<T>& set = span.pool->set[s];
        if (!set.y) continue;
        for (const Index i : span)
          for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) std::fill_n(set.y + std::ptrdiff_t(set.width) * set.block[e], set.width, 0.0);
      }
  }

  /// The bilateral constraints first; false where there are none, or the direct path cannot act.
  template <class T, class System>
  bool gather(const Island<T>& problem, System& joints) const {
    joints.begin();
    bool can = true;
    int swept = 0;
    for (const bool is_bilateral : {true, false})
      for (const Span<T>& span : problem) {
        const PoolView<T>& pool = *span.pool;
        if (inner::are_equalities(pool.table->kinds, pool.rows) != is_bilateral) continue;
        const int place = int(&span - problem.begin());
        for (const Index i : span)
          can &= is_bilateral ? joints.take_joint(pool, i, place) : joints.take(pool, i, false, place);
        if (!is_bilateral) swept += pool.rows * int(span.count);
      }
    if (!can || joints.bilateral() == 0 || swept > max_swept_rows) return false;
    joints.analyse(problem.island());
    return true;
  }

  /// The right side ← −(d + W λ)_b.
  template <class T, class System>
  static double load(Island<T>& problem, System& joints) {
    return joints.load([&](const auto& part, auto& to) {
      T u[most_rows];
      problem.velocity(span_of(problem, part), part.item, u);
      for (int r = 0; r < part.rows; ++r) to[r] = double(u[r]);
    });
  }
  /// λ_b ← λ_b − W_bb⁻¹ (d + W λ)_b, repeated while that halves the velocity of the joints' rows: what ε and
  /// rounding left goes. A repetition that makes it worse is taken back. False when rows contradict each
  /// other: a thousandth stays. It ends below `enough` of the largest velocity so far.
  template <class T, class System>
  static bool settle(Island<T>& problem, System& joints, double enough, double& largest) {
    const double first = load(problem, joints);
    largest = std::max(largest, first);
    double size = first;
    for (int repetition = 0; repetition < 8 && size > 0; ++repetition) {
      joints.solve();
      joints.keep();
      push(problem, joints, 1);
      const double next = load(problem, joints);
      if (!(next < size)) {
        push(problem, joints, -1);
        break;
      }
      const bool goes_on = next < 0.5 * size && next > enough * largest;
      size = next;
      if (!goes_on) break;
    }
    return size <= 1e-3 * first;
  }
  /// Whether that is proved, by the way in which λ_b runs away.
  template <class T, class Space>
  static bool contradicts(Island<T>& problem, Space& work) {
    load(problem, work.joints);
    work.joints.solve();
    work.joints.keep();
    problem.save(work.before);
    push(problem, work.joints, 1);
    if (inner::Contradiction<T>(problem).is_proved(work.before)) return true;
    problem.load(work.before);
    return false;
  }
  /// λ_b ← λ_b + sign δ.
  template <class T, class System>
  static void push(Island<T>& problem, const System& joints, double sign) {
    T next[most_rows];
    for (const auto& part : joints.parts()) {
      const Span<T>& span = span_of(problem, part);
      const T* lambda = problem.impulse(span, part.item);
      for (int r = 0; r < part.rows; ++r) next[r] = lambda[r] + T(sign * part.step[r]);
      problem.assign(span, part.item, next);
    }
  }

  /// The others with S in place of W, from the λ they have, to that share of the tolerance; W is told in the
  /// end.
  template <class T, class Space>
  Status sweep_others(Island<T>& problem, Space& work, SolveReport& report, int round, double share) const {
    Island<T> rest = work.others.build(work.joints, problem, round);
    if (rest.row_count() == 0) return Status::converged;
    problem.save(work.before);
    const inner::SweepsThenNewton solver{
        inner::sweeps_of(options(), max_iterations - report.sweeps, min_iterations, share)};
    const SolveReport swept = solver.solve(rest, work.contacts);
    report.sweeps += swept.sweeps;
    report.factorizations += swept.factorizations;
    if (swept.factorizations > 0) report.ended_by = swept.ended_by;
    T found[most_rows];
    const T* before = work.before.data();
    for (const Span<T>& span : problem) {
      const int R = span.pool->rows;
      const bool is_swept = !inner::are_equalities(span.pool->table->kinds, R);
      for (const Index i : span) {
        T* lambda = span.pool->lambda + std::ptrdiff_t(R) * i;
        for (int k = 0; k < R && is_swept; ++k) found[k] = lambda[k], lambda[k] = before[k];
        before += R;
        if (is_swept) problem.assign(span, i, found);
      }
      if (is_swept) span.pool->table->prepare(span, problem.h());
    }
    return swept.status;
  }
};

template <class T, class Space>
SolveReport DirectGaussSeidel::solve(Island<T>& problem, Space& work) const {
  SolveReport report;
  // A measure costs as much as loading the joints: of the start it is made for who hears of it.
  if (problem.is_heard() || problem.timer() || !is_finite(problem)) {
    report.measure = problem.measure();
    if (!std::isfinite(report.measure.residual))
      return {.status = Status::quarantined, .measure = report.measure};
  }
  auto& joints = work.joints;
  if (!gather(problem, joints))
    return inner::sweeps_of(options(), max_iterations, min_iterations)
        .solve(problem, work.contacts.newton.sweeps);
  problem.notify(0, report.measure);
  report.ended_by = "factorization";
  const bool is_matrix = work.velocities.show(problem);
  solve_directly(problem, work, report);
  if (report.status != Status::converged && runs_away(problem)) {
    clear(problem);
    const int done = report.factorizations;
    report = inner::sweeps_of(options(), max_iterations, min_iterations).solve(problem, work.contacts.newton.sweeps);
    report.factorizations += done;
  }
  if (is_matrix) work.velocities.put_back(problem);
  return report;
}

template <class T, class Space>
void DirectGaussSeidel::solve_directly(Island<T>& problem, Space& work, SolveReport& report) const {
  auto& joints = work.joints;
  bool is_contradiction = false;
  double largest = 0;
  for (const double epsilon : {fine, coarse}) {
    const T nothing[most_rows] = {};
    for (const auto& part : joints.parts()) problem.assign(span_of(problem, part), part.item, nothing);
    ++report.factorizations;
    if (!joints.factor(epsilon)) continue;
    if (settle(problem, joints, joints.bilateral() < joints.count() ? before_sweeps : to_rounding, largest))
      break;
    is_contradiction = is_contradiction || contradicts(problem, work);
  }
  if (joints.bilateral() == joints.count() || problem.timer()) report.measure = problem.measure();
  // What is met by the others' own scale can miss by the whole island's: each round asks for half as much.
  double share = 1;
  for (int round = 0; round < most_rounds && joints.bilateral() < joints.count(); ++round, share *= 0.5) {
    const Status swept = sweep_others(problem, work, report, round, share);
    settle(problem, joints, to_rounding, largest);
    if (round == 0 && (swept == Status::infeasible || swept == Status::max_iterations)) {
      problem.save(work.after);
      if (inner::Contradiction<T>(problem).is_proved(work.before)) {
        auto& space = work.contacts.newton.sweeps;
        report = inner::compromise(problem, report, space.best, space.x);
        return;
      }
      problem.load(work.after);
    }
    report.measure = problem.measure();
    report.status = swept;
    if (swept == Status::infeasible) return;
    if (options().is_done(report.measure, problem.row_count()) || problem.is_out_of_time()) break;
  }
  problem.notify(report.sweeps + report.factorizations, report.measure);
  report.status =
      is_contradiction ? Status::infeasible : options().verdict(report.measure, problem.row_count());
}

#ifdef DELASSUS_COMPILED_DIRECT  // after delassus/compiled.hpp
DELASSUS_COMPILED_DIRECT(extern template, 3)
DELASSUS_COMPILED_DIRECT(extern template, 5)
DELASSUS_COMPILED_DIRECT(extern template, 6)
#endif

}  // namespace delassus
