/// Position projection: after the velocities are final, violations are closed by displacements alone.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/middle_contacts.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/position_laws.hpp>
#include <delassus/step/row_types.hpp>
#include <delassus/step/solve.hpp>

#include <type_traits>

namespace delassus {

/// d of the position problem: u⁺ + push(φ), close(φ) of a joint: the velocity the row has plus the rate its violation asks
/// for; an open contact only must not close. With `at_end`, the rows where the bodies are at the end of the step, equalities
/// have close(φ) of there alone. Contacts in the middle of the step have the φ that they end with already. λ starts at zero.
template <bool middle_contacts, class World, class Laws, class Rows, class S>
void make_position_bias(const World& world, const Laws& laws, Rows& rows, const S& stabilisation, double h,
                        const Rows* at_end) {
  using T = typename Rows::Scalar;
  for_each_index<Laws::pool_count>([&](auto p) {
    using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    auto& pool = rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i) {
      auto u = inner::next_rate(pool, i, world);
      if constexpr (middle_contacts && ContactLaw<Law>) set_zero(u);
      pool.lambda[i].setZero();
      pool.d[i].setZero();
      for (int k = 0; k < Law::rows; ++k) {
        const double phi = double(pool.phi[i][k]), sign = kinds[k] == RowKind::upper ? -1 : 1;
        const bool is_soft = inner::is_spring(pool.stiffness[i][k], pool.damping[i][k]);
        if (kinds[k] == RowKind::equality) {
          double asked = stabilisation.close(phi, h) + double(u[k]);
          if (at_end) asked = stabilisation.close(double(at_end->template pool<p>().phi[i][k]), h);
          pool.d[i][k] = is_soft ? T(0) : T(asked);
        } else if (kinds[k] != RowKind::friction && !is_soft)  // a spring is meant to give way
          pool.d[i][k] = T(sign * (sign * phi < 0 ? stabilisation.push(sign * phi, h) : sign * phi / h) + double(u[k]));
      }
    }
  });
}

/// What of w an island takes. Joints of the midpoint rule are closed by H, the rows of the middle, which need
/// not see what a gap at the end asks for: H w = −φ₊/h of a chain drawn straight is as long as H is blind. E,
/// the rows of the end, say what w does there. An island whose gaps would grow by them takes of w what closes
/// most,
///
///   s = argmin Σ (φ₊ + s h E w)²/W_kk = −Σ φ₊ (h E w)/W_kk / Σ (h E w)²/W_kk ≥ 0,   s < ½ where they grow.
///
/// An island with a contact or a limit takes all of w, which pushes those back as well.
template <class Step>
double share_that_closes(Step& step, const typename Step::Rows& at_end, Index island) {
  const auto& w = step.template state<role::Stabilisation>().displacement;
  double closed = 0, square = 0;
  bool are_joints = true;
  inner::each_item<Step::Laws::pool_count>(step.islands, island, [&](auto p, Index i) {
    using Law = std::remove_cvref_t<decltype(step.laws().template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    are_joints &= inner::are_equalities(kinds);
    const auto& pool = at_end.template pool<p>();
    const auto u = inner::rate(pool, i, w);
    for (int k = 0; k < Law::rows; ++k) {
      const double W = double(step.W.template diagonal<p>(i)(k, k));
      const bool is_soft = inner::is_spring(pool.stiffness[i][k], pool.damping[i][k]);
      if (kinds[k] != RowKind::equality || is_soft || !(W > 0)) continue;
      closed -= step.stabilisation().close(double(pool.phi[i][k]), step.h) * double(u[k]) / W;
      square += double(u[k]) * double(u[k]) / W;
    }
  });
  return are_joints && closed < 0.5 * square ? std::max(0.0, closed / square) : 1;
}

/// w of every island becomes the share of it that closes its joints.
template <class Step>
void bound_displacements(Step& step, const typename Step::Rows& at_end) {
  auto& displacement = step.template state<role::Stabilisation>().displacement;
  for (Index k = 0; k < step.islands.count(); ++k) {
    const double share = share_that_closes(step, at_end, k);
    if (share == 1) continue;
    Index first = 0;
    step.world().each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (step.islands.island_of(first + b) == k) std::get<s>(displacement)[b] *= typename Step::Scalar(share);
      first += set.blocks();
    });
  }
}

/// w = A⁻¹ Hᵀ μ of the position problem, into `displacement`; the status becomes that of its solve where that was far
/// from closing the gaps (they are what is left of the last step's, and small). λ and d of the step are put back.
template <class Step>
void find_displacements(Step& step, const typename Step::Rows* at_end) {
  auto& own = step.template state<role::Stabilisation>();
  auto& rows = step.rows;
  const auto exchange = [&] {
    each_pool(rows, [&](auto p, auto& pool) {
      pool.lambda.swap(inner::part<p>(own.lambda.pools));
      pool.d.swap(inner::part<p>(own.d.pools));
    });
  };
  own.lambda.resize_like(rows);
  own.d.resize_like(rows);
  exchange();
  make_position_bias<inner::has_middle_contacts<typename Step::Policies>>(std::as_const(step).world(), step.laws(), rows, step.stabilisation(), step.h, at_end);
  step.W.reset(rows);
  auto& book = own.book;
  book.show(step.W, rows);
  NoObserver nobody;
  Status worst = Status::converged;
  constexpr double far = 0.05;  // of the largest velocity that closes a gap
  for (Index k = 0; k < step.islands.count(); ++k)
    if (!step.is_nonfinite[k]) {
      IslandProblem island(book, rows, step.W, step.islands, k, step.h, nobody);
      const SolveReport r =
          step.solver().solve(island, step.solver_workspace.itself());
      if (r.measure.residual > far) worst = worse(worst, r.status);
    }
  step.world().each([&](auto& set, auto s) {
    auto& to = std::get<s>(own.displacement);
    to.resize(set.blocks());
    for (auto& x : to) x.setZero();
    add_impulses(inner::inverse_of<s>(step.W, set, 1), s, ArraysOf(rows).all(), to, inner::part<s>(step.scratch));
  });
  if (at_end) bound_displacements(step, *at_end);
  exchange();
  step.summary.status = worse(step.summary.status, worst);
}

/// q ← q ⊕ h w.
template <class World, class Displacement>
void displace(World& world, const Displacement& displacement, double h) {
  world.each([&](auto& set, auto s) {
    for (const Index b : set.active())
      if (set.moves(b)) set.displace(b, typename World::Scalar(h) * std::get<s>(displacement)[b]);
  });
}

namespace inner {

template <class P>
struct ProjectionState {
  Impulses<typename P::Rows> lambda, d;  ///< those of the velocities, meanwhile
  PositionLaws<typename P::Laws, typename P::World::Scalar, needs_of<typename P::Solver>> book;
  typename P::World::template PerSet<VelocitiesOf> displacement;  ///< w, m/s
};

/// What position projection changes: bodies are displaced as well as moved. Rows of the midpoint rule cannot say what
/// is open where the step ends; there the gaps are those of the end. An integrator that moves at once closes its joints itself.
template <class Base>
struct ProjectionStages : Base {
  static void advance(auto& step) {
    if constexpr (MovesAtOnce<std::remove_cvref_t<decltype(step.integrator())>>)
      Base::advance(step);
    else
      advance_and_displace(step);
  }

 private:
  static void advance_and_displace(auto& step) {
    constexpr bool sees_end = requires { step.template state<role::Integrator>().at_start; };
    if constexpr (sees_end) {
      Base::advance(step);
      auto& at_end = step.template state<role::Integrator>().at_start;  // the rows of the start have served
      linearize(std::as_const(step).world(), step.laws(), at_end);
      find_displacements(step, &at_end);
    } else {
      find_displacements(step, nullptr);
      Base::advance(step);
    }
    displace(step.world(), step.template state<role::Stabilisation>().displacement, step.h);
  }
};

}  // namespace inner
}  // namespace delassus
