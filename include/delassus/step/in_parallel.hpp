/// The stages of a plain step by several workers: soft bodies, rows, W and islands.
#pragma once

#include <delassus/collision/inner/pairs_in_parts.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/compliance/inner/rows_of_w_in_parts.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/execution.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/shared_set.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/correct.hpp>
#include <delassus/step/free_motion.hpp>
#include <delassus/step/inner/rows_in_parts.hpp>
#include <delassus/step/plain_stages.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace delassus {

namespace inner {

/// Rows of an island whose sweeps are worth sharing.
inline constexpr Index large_island = 768;

/// What workers keep.
template <class P, bool has_rows>
struct WorkersKeep {};
template <class P>
struct WorkersKeep<P, true> {
  using T = typename P::Rows::Scalar;
  struct Task {
    Index rows, island;
    bool operator<(const Task& o) const { return rows != o.rows ? rows > o.rows : island < o.island; }
  };

  typename kept_of_sets<typename P::World>::type sets;
  RowsInParts<T> rows;
  RowsOfWInParts<T> W;
  OwningArray<typename P::Solver::template Workspace<typename P::Rows>> solvers;  ///< by worker
  Array<Task> islands;                                                            ///< the largest first
  Crew crew;
  Scratch pairs;  ///< of detection
};

/// What answers with A⁻¹, see `inverse_of`: workers for a set that they share, where the operator W has no
/// factors of its own.
template <class W, class Kept, class E>
struct InverseInParallel {
  W& of;
  Kept& kept;
  const E& execution;

  template <int s, class Set>
  decltype(auto) inverse(Set& set, int guess) {
    if constexpr (requires { of.template inverse<s>(set, guess); })
      return of.template inverse<s>(set, guess);
    else if constexpr (SharedSet<Set>)
      return SetInParallel<Set, E>{set, part<s>(kept), execution};
    else
      return (set);
  }
};
template <class W, class Kept, class E>
InverseInParallel(W&, Kept&, const E&) -> InverseInParallel<W, Kept, E>;

/// Whether islands may be solved at once: W has blocks of its own for each, the solver keeps nothing for all,
/// and nobody hears of sweeps.
template <class Step>
inline constexpr bool solves_islands_apart =
    !Step::observes_sweeps &&
    requires(typename Step::Policies::Solver::template Workspace<typename Step::Policies::Rows> & w) {
  requires Step::Policies::Operator::islands_are_apart;
  requires !requires { w.begin_step(); };
};

}  // namespace inner

/// A policy of role::Execution derives from it and adds `workers()` and `run`, see `Execution`. Then these
/// parts of a step run on its workers, whatever their number with the same bits:
///
///   soft bodies  of finite elements: the elements, the factor of A and what it solves
///   detection    contacts of the pairs whose boxes touch, by `NativeCollision` and backends of a kernel
///   rows         of laws with many items: H and φ
///   W            its rows, where it is a matrix (`AssembledCompliance`, the default)
///   islands      each is solved by one worker, the largest first; all sweep a large one together where the
///                solver is `Coloured`
///
/// Parts that another policy of the loop replaces run as that policy does them, as do islands under a
/// deadline or with a listener that hears each sweep.
struct InParallel {
  using plays = role::Execution;

  template <class P>
  using State = inner::WorkersKeep<P, P::has_rows>;

  template <class Base>
  struct stages : Base {
    static Index workers(auto& step) {
      const Index count = step.execution().workers();
      DELASSUS_EXPECT(count >= 1, "the execution of a loop has " + std::to_string(count) +
                                      " workers; let workers() return 1 or more");
      return count;
    }

    static CollisionReport find_contacts(auto& step) {
      auto& book = step.contact_cache;
      const auto detect = [&](const auto& filter) {
        const inner::InParts with{filter, step.execution(), kept(step).pairs};
        const std::span<const Collider> colliders(book.colliders);
        if constexpr (requires { step.collision().detect(colliders, step.h, book.points, with); })
          return step.collision().detect(colliders, step.h, book.points, with);
        else
          return Base::find_contacts(step);
      };
      if constexpr (inner::asks_who_meets<decltype(step)>)
        return detect(book.who_pushed());
      else
        return detect(NoFilter{});
    }
    static void write_rows(auto& step) {
      workers(step);  // refused before anything is divided by it
      const auto laws = step.pools.all();
      const auto rows = step.arrays.all();
      for (std::size_t p = 0; p < laws.size(); ++p)
        kept(step).rows.write(laws[p], step.view, rows[p], step.execution());
    }
    static void free_motion(auto& step) {
      inner::InverseInParallel inverse{step.W, kept(step).sets, step.execution()};
      step.world().each([&](auto& set, auto s) {
        delassus::free_motion(set, inner::inverse_of<s>(inverse, set, 0), step.integrator(),
                              inner::part<s>(step.scratch), step.h);
      });
    }
    static void correct(auto& step) {
      inner::InverseInParallel inverse{step.W, kept(step).sets, step.execution()};
      delassus::correct(step.world(), step.arrays.all(), inverse, step.scratch, step.islands, step.reports,
                        step.is_nonfinite);
    }
    static void build_W(auto& step) {
      constexpr bool can = requires {
        step.W.build(std::as_const(step).world(), step.rows, kept(step).W, kept(step).sets, step.execution());
      };
      if constexpr (can)
        step.W.build(std::as_const(step).world(), step.rows, kept(step).W, kept(step).sets, step.execution());
      else
        Base::build_W(step);
    }
    static void solve_islands(auto& step, auto& observer) {
      using Step = std::remove_reference_t<decltype(step)>;
      if constexpr (inner::solves_islands_apart<Step>) {
        begin_islands(step);
        const auto& islands = kept(step).islands;
        const auto solve = [&](std::size_t k, Index worker, inner::Crew* crew) {
          IslandProblem island(step.law_set, step.rows, step.W, step.islands, islands[k].island, step.h,
                               observer);
          island.worker = worker;
          island.set_crew(crew);
          Step::Stages::solve_island(step, island);
        };
        const std::size_t large = count_large(step);
        for (std::size_t k = 0; k < large; ++k)
          solve_together(step, [&](Index worker, inner::Crew& crew) { solve(k, worker, &crew); });
        step.execution().run(Index(islands.size() - large), [&](Index task, Index worker) {
          solve(large + std::size_t(task), worker, nullptr);
        });
      } else {
        Base::solve_islands(step, observer);
      }
    }
    static auto& solver_workspace(auto& step, auto& island) {
      if constexpr (inner::solves_islands_apart<std::remove_reference_t<decltype(step)>>)
        return kept(step).solvers[std::size_t(island.worker)];
      else
        return Base::solver_workspace(step, island);
    }

   private:
    static auto& kept(auto& step) { return step.template state<role::Execution>(); }

    /// Islands whose sweeps all workers share, one after the other.
    static std::size_t count_large(auto& step) {
      using Solver = typename std::remove_reference_t<decltype(step)>::Policies::Solver;
      const auto& islands = kept(step).islands;
      std::size_t large = 0;
      if constexpr ((inner::layers_of<Solver> & inner::layer::coloured) != 0)
        if (workers(step) > 1)
          while (large < islands.size() && islands[large].rows >= inner::large_island) ++large;
      return large;
    }
    /// solve(worker, crew) by the worker that comes first, while the others help.
    static void solve_together(auto& step, const auto& solve) {
      inner::Crew& crew = kept(step).crew;
      struct Dismissal {
        inner::Crew& crew;
        ~Dismissal() { crew.dismiss(); }
      };
      crew.assemble();
      step.execution().run(workers(step), [&](Index, Index worker) {
        if (!crew.leads()) return crew.help();
        const Dismissal after{crew};
        solve(worker, crew);
      });
    }

    /// Room for all, and who begins.
    static void begin_islands(auto& step) {
      auto& own = kept(step);
      step.W.reset(step.rows);
      own.solvers.resize(std::size_t(workers(step)));
      for (auto& solver : own.solvers) inner::reset_if_it_can(solver, step.rows.row_count());
      const Index count = step.islands.count();
      step.reports.resize(count);
      own.islands.resize(std::size_t(count));
      for (Index k = 0; k < count; ++k) {
        Index rows = 0;
        for (std::size_t p = 0; p < step.arrays.all().size(); ++p)
          rows += step.arrays.all()[p].rows * Index(step.islands.items(int(p), k).size());
        own.islands[std::size_t(k)] = {rows, k};
      }
      inner::sort(own.islands);
    }
  };
};

}  // namespace delassus
