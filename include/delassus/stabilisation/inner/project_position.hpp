/// Position projection: after the velocities are final, violations are closed by displacements alone.
#pragma once

#include <delassus/compliance/add_impulses.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/law_rows.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/middle_contacts.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/position_laws.hpp>
#include <delassus/step/row_types.hpp>
#include <delassus/step/solve.hpp>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

/// d of the position problem: u⁺ + push(φ), close(φ) of a joint: the velocity the row has plus the rate its violation asks
/// for; an open contact only must not close. With `at_end`, the rows where the bodies are at the end of the step, equalities
/// have close(φ) of there alone. Contacts in the middle of the step have the φ that they end with already. λ starts at zero.
template <class T, class World, class S>
void make_position_bias(const World& world, AllLaws<T> laws, AllRows<T> rows, const S& stabilisation, double h, bool has_middle_contacts,
                        const AllRows<T>* at_end) {
  const inner::BodyVelocities<World> v(world);
  T u[most_rows];
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const RowArrays<T>& pool = rows[p];
    const RowKind* const kinds = laws[p].law->kinds;
    const bool is_in_middle = has_middle_contacts && laws[p].law->is_contact;
    for (Index i = 0; i < pool.items(); ++i) {
      if (is_in_middle) std::fill(u, u + pool.rows, T(0));
      else inner::rate(pool, i, v.next, u);
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        T& d = (*pool.d)[row];
        d = (*pool.lambda)[row] = T(0);
        if (pool.is_soft(row)) continue;  // a spring is meant to give way
        const double phi = double((*pool.phi)[row]), sign = kinds[k] == RowKind::upper ? -1 : 1;
        if (kinds[k] == RowKind::equality)
          d = T(at_end ? stabilisation.close(double((*(*at_end)[p].phi)[row]), h) : stabilisation.close(phi, h) + double(u[k]));
        else if (kinds[k] != RowKind::friction)
          d = T(sign * (sign * phi < 0 ? stabilisation.push(sign * phi, h) : sign * phi / h) + double(u[k]));
      }
    }
  }
}

/// What of w an island takes. Joints of the midpoint rule are closed by H, the rows of the middle, which need
/// not see what a gap at the end asks for: H w = −φ₊/h of a chain drawn straight is as long as H is blind. E,
/// the rows of the end, say what w does there. An island whose gaps would grow by them takes of w what closes
/// most,
///
///   s = argmin Σ (φ₊ + s h E w)²/W_kk = −Σ φ₊ (h E w)/W_kk / Σ (h E w)²/W_kk ≥ 0,   s < ½ where they grow.
///
/// An island with a contact or a limit takes all of w, which pushes those back as well.
template <class Step, class T>
double share_that_closes(Step& step, AllRows<T> at_end, const T* const* w, const Island<T>& island) {
  double closed = 0, square = 0;
  bool are_joints = true;
  T u[most_rows];
  for (const Span<T>& span : island) {
    const RowArrays<T>& pool = at_end[std::size_t(span.pool->pool)];
    const RowKind* const kinds = island.kinds(span);
    for (int k = 0; k < pool.rows; ++k) are_joints &= kinds[k] == RowKind::equality;
    for (const Index i : span) {
      inner::rate(pool, i, w, u);
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        const double W = double(span.pool->own_block(i)[k * (pool.rows + 1)]);
        if (kinds[k] != RowKind::equality || pool.is_soft(row) || !(W > 0)) continue;
        closed -= step.stabilisation().close(double((*pool.phi)[row]), step.h) * double(u[k]) / W;
        square += double(u[k]) * double(u[k]) / W;
      }
    }
  }
  return are_joints && closed < 0.5 * square ? std::max(0.0, closed / square) : 1;
}

/// w of every island becomes the share of it that closes its joints.
template <class Step, class T>
void bound_displacements(Step& step, AllRows<T> at_end) {
  auto& own = step.template state<role::Stabilisation>();
  const T* w[Step::Policies::World::set_count + 1];
  step.world().each([&](const auto&, auto s) { w[s] = reinterpret_cast<const T*>(std::get<s>(own.displacement).data()); });
  NoObserver nobody;
  for (Index k = 0; k < step.islands.count(); ++k) {
    const IslandProblem island(own.book, step.rows, step.W, step.islands, k, step.h, nobody);
    const double share = share_that_closes<Step, T>(step, at_end, w, island);
    if (share == 1) continue;
    Index first = 0;
    step.world().each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (step.islands.island_of(first + b) == k) std::get<s>(own.displacement)[b] *= T(share);
      first += set.blocks();
    });
  }
}

/// w = A⁻¹ Hᵀ μ of the position problem, into `displacement`; the status becomes that of its solve where that was far
/// from closing the gaps (they are what is left of the last step's, and small). λ and d of the step are put back.
template <class Step, class T>
void find_displacements(Step& step, const AllRows<T>* at_end) {
  auto& own = step.template state<role::Stabilisation>();
  const AllRows<T> rows = step.arrays.all();
  const auto exchange = [&] {
    for (std::size_t p = 0; p < rows.size(); ++p) rows[p].lambda->swap(own.lambda[p]), rows[p].d->swap(own.d[p]);
  };
  own.lambda.resize(rows.size());
  own.d.resize(rows.size());
  for (std::size_t p = 0; p < rows.size(); ++p) own.lambda[p].resize(rows[p].lambda->size()), own.d[p].resize(rows[p].d->size());
  exchange();
  make_position_bias(std::as_const(step).world(), step.pools.all(), rows, step.stabilisation(), step.h,
                     inner::has_middle_contacts<typename Step::Policies>, at_end);
  step.W.reset(step.rows);
  auto& book = own.book;
  book.show(step.W, step.rows);
  NoObserver nobody;
  Status worst = Status::converged;
  constexpr double far = 0.05;  // of the largest velocity that closes a gap
  for (Index k = 0; k < step.islands.count(); ++k)
    if (!step.is_nonfinite[k]) {
      IslandProblem island(book, step.rows, step.W, step.islands, k, step.h, nobody);
      const SolveReport r =
          step.solver().solve(island, step.solver_workspace.itself());
      if (r.measure.residual > far) worst = worse(worst, r.status);
    }
  step.world().each([&](auto& set, auto s) {
    auto& to = std::get<s>(own.displacement);
    to.resize(set.blocks());
    for (auto& x : to) set_zero(x);
    add_impulses(inner::inverse_of<s>(step.W, set, 1), s, rows, to, inner::part<s>(step.scratch));
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
  OwningArray<Array<typename P::World::Scalar>> lambda, d;  ///< of each pool, those of the velocities meanwhile
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
    using Step = std::remove_reference_t<decltype(step)>;
    using T = typename Step::Policies::World::Scalar;
    constexpr bool sees_end = requires { step.template state<role::Integrator>().at_start; };
    if constexpr (sees_end) {
      Base::advance(step);
      const auto& rows = step.template state<role::Integrator>().arrays;  // the rows of the start have served
      linearize(step.view, step.pools.all(), rows.all());
      const AllRows<T> at_end = rows.all();
      find_displacements<Step, T>(step, &at_end);
    } else {
      find_displacements<Step, T>(step, nullptr);
      Base::advance(step);
    }
    displace(step.world(), step.template state<role::Stabilisation>().displacement, step.h);
  }
};

}  // namespace inner
}  // namespace delassus
