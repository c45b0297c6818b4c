/// The constraint problem of a step solved again by an independent method, and how far the loop's solution is
/// from it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/inner/convex_newton.hpp>
#include <delassus/solvers/inner/row_weights.hpp>
#include <delassus/solvers/measure.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/problem.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace delassus {

/// One constraint in the loop's solution λ and in the reference λ*. What counts are the velocities u = d + W λ:
/// impulses need not be unique. On four contacts under one box, or in a closed loop of joints, many λ give the same
/// motion. A wrong impulse moves the neighbours too. So constraints are ranked by `energy`, the part of the kinetic
/// energy of the difference that impulses of this constraint alone can make. Of one wrong impulse it is all, and less
/// of any other, unless that can push the bodies in the same way, as contacts of one face do along the line between
/// them.
struct ReferenceDifference {
  int pool = -1;        ///< number of its law; −1: there is no constraint
  Index item = -1;      ///< the item-th rows of the pool; −1: there is no constraint
  double velocity = 0;  ///< |u − u*|, u = d + W λ, m/s, turns at the length of `Measure`
  double impulse = 0;   ///< |λ − λ*|, N·s or N·m·s; not unique
  double energy = 0;    ///< ½ (u − u*)ᵀ W_ii⁻¹ (u − u*), J
  double residual = 0;  ///< |F| of λ, m/s; see `Measure`
  double reference_residual = 0;  ///< |F| of λ*, m/s
};

/// The reference shares no local solve with the sweeping solvers. Where `reached` is false it did not get to its
/// tolerance. Then `reference.measure` says how far it got, and the differences are to be read with that. Two small
/// residuals beside a large difference say that the reference found another solution. A step whose energy guard acted
/// has no solution of its laws for λ.
struct ReferenceCheck {
  bool reached = true;                           ///< whether the reference converged
  SolveReport reference;                         ///< of the worst island
  double residual = 0;                           ///< of the loop's λ, the worst island's
  double velocity = 0;                           ///< the largest |u − u*|
  Array<ReferenceDifference> constraints;  ///< worst first: by energy

  /// `constraint 17 of pool 0: velocities 3e-4 m/s apart, …`.
  std::string text() const {
    if (constraints.empty()) return "no constraint to compare";
    const ReferenceDifference& worst = constraints.front();
    return "constraint " + std::to_string(worst.item) + " of pool " + std::to_string(worst.pool) +
           ": velocities " + inner::text(worst.velocity) + " m/s apart, impulses " +
           inner::text(worst.impulse) + " N·s; residual " + inner::text(residual) +
           (reached ? ", of the reference " : ", of the reference, which did not reach its tolerance, ") +
           inner::text(reference.measure.residual);
  }
};

namespace inner {

/// f(p, i, |F|, L) for every constraint of every island, L the island's length.
template <class Laws, class Rows, class Operator, class F>
void each_local(Problem<Laws, Rows, Operator>& problem, F&& f) {
  LawSet<Laws, typename Rows::Scalar> book(problem.laws);
  problem.W.reset(problem.rows);
  book.prepare(problem.W, problem.rows, problem.h);
  NoObserver nobody;
  for (Index k = 0; k < problem.islands.count(); ++k) {
    const double length = IslandProblem(book, problem.rows, problem.W, problem.islands, k, problem.h, nobody).length();
    for_each_index<Rows::pool_count>([&](auto p) {
      for (const Index i : problem.islands.items(p, k)) f(p, i, book.natural_error(p, i, length), length);
    });
  }
}

/// Of the λ in the problem, the worst island's.
template <class Laws, class Rows, class Operator>
Measure measure_of(Problem<Laws, Rows, Operator>& problem) {
  return solve(problem, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure;
}

/// ½ uᵀ W⁻¹ u, W lifted by rounding's share where it is singular; a u that is no number counts most.
template <int R, class T>
double energy_of(const Mat<R, R, T>& W, const Vec<R, T>& u) {
  Mat<R, R, T> lifted = W;
  for (int k = 0; k < R; ++k) lifted(k, k) += T(64 * R) * std::numeric_limits<T>::epsilon() * W(k, k);
  const double energy = 0.5 * double(u.dot(inverse_of_positive(lifted) * u));
  return std::isfinite(energy) ? energy : std::numeric_limits<double>::infinity();
}

template <class Laws>
inline constexpr bool all_differentiable = false;
template <class... Laws>
inline constexpr bool all_differentiable<Constraints<Laws...>> = (refines<Laws>(refine::tangent) && ...);

}  // namespace inner

/// Solves a problem anew from λ = 0 by `inner::ConvexNewton`, islands that resist by `PathNewton` without its
/// sweeps. Compares constraint by constraint.
///
/// With friction even the velocities can have more than one solution. The first attempt begins with the slips |u_t|
/// of λ, so that it finds λ if λ is one. The given slips make the law a convex problem with one u; that it is a
/// solution of the law is then measured.
///
/// Where A couples blocks (springs and soft bodies under an implicit integrator), islands are solved with all of W,
/// which is dense. They are left out, and `reached` is false, with more than `inner::WholeSystem::most` constraints,
/// or with one of more rows than a block has unknowns.
template <class Laws, class Rows, class Operator>
ReferenceCheck check_against_reference(const Problem<Laws, Rows, Operator>& problem,
                                       double tolerance = 1e-10) {
  static_assert(
      inner::all_differentiable<Laws>,
      "delassus: check_against_reference needs tangent(item, local) of every constraint law; add it to "
      "the law that lacks it");
  ReferenceCheck check;
  if constexpr (inner::all_differentiable<Laws>) {
    auto mine = problem, other = problem;
    for_each_index<Rows::pool_count>([&](auto p) {
      for (auto& lambda : other.rows.template pool<p>().lambda) lambda.setZero();
    });
    check.residual = inner::measure_of(mine).residual;
    int factorizations = 0;
    const auto try_with = [&](auto& which, const auto& solver) {
      check.reference = solve(which, solver);
      check.reference.factorizations = factorizations += check.reference.factorizations;
      return check.reference.status == Status::converged;
    };
    bool has_slips = false;
    for (const int patience : {50, 0}) {  // wedged bodies may need either, and not bear the other
      if (has_slips) break;
      auto of_slips = problem;
      has_slips = try_with(of_slips, inner::ConvexNewton{.tolerance = tolerance,
                                                         .max_iterations = 200,
                                                         .from_slips = true,
                                                         .patience = patience});
      if (has_slips) other = std::move(of_slips);
    }
    // Newton's steps alone on the path, so many that a wall of a hundred boxes is given up after seconds.
    const PathNewton path{.tolerance = tolerance, .max_iterations = 500, .max_sweeps = 0};
    if (!has_slips && !try_with(other, inner::ConvexNewton{.tolerance = tolerance})) try_with(other, path);
    // Islands that are none, since W has entries between them, would undo each other's solutions.
    const Measure end = inner::measure_of(other);
    check.reached = check.reference.status == Status::converged && end.residual <= tolerance + end.floor;

    inner::each_local(mine, [&](auto p, Index i, double residual, double) {
      check.constraints.push_back({.pool = int(p), .item = i, .residual = residual});
    });
    std::size_t next = 0;
    inner::each_local(other, [&](auto p, Index i, double residual, double length) {
      ReferenceDifference& difference = check.constraints[next++];
      const auto apart = (mine.W.template residual<p>(mine.rows, i) - other.W.template residual<p>(other.rows, i)).eval();
      using Law = std::remove_cvref_t<decltype(mine.laws.template pool<p>().law)>;
      difference.velocity = std::sqrt(inner::square_of<turning_rows<Law>()>(inner::load<Rows::template rows_of<p>>(apart.data()), length));
      difference.energy = inner::energy_of(other.W.template diagonal<p>(i), apart);
      difference.impulse = double((mine.rows.template pool<p>().lambda[i] - other.rows.template pool<p>().lambda[i]).norm());
      difference.reference_residual = residual;
      // A velocity that is no number differs most of all.
      if (!(difference.velocity <= check.velocity)) check.velocity = difference.velocity;
    });
    std::stable_sort(check.constraints.begin(), check.constraints.end(),
                     [](const auto& a, const auto& b) { return a.energy > b.energy; });
  }
  return check;
}

/// The same of the loop's last step, which stays as it is; nothing to compare in a loop without constraints.
template <class Loop>
ReferenceCheck check_against_reference(const Loop& loop, double tolerance = 1e-10) {
  static_assert(Loop::has_problem || !Loop::has_constraints,
                "delassus: NewtonMidpoint makes no problem that a reference could solve again, nor does JointByJoint; take "
                "check_against_reference out, or use ImplicitMidpoint or PlainOrder");
  if constexpr (Loop::has_problem)
    return check_against_reference(loop.problem(), tolerance);
  else
    return {};
}

}  // namespace delassus
