/// The stages of a plain step by several workers: soft bodies, rows, W and islands.
#pragma once

#include <delassus/collision/inner/ahead_in_parts.hpp>
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
#include <delassus/step/inner/advance_in_ranges.hpp>
#include <delassus/step/inner/rows_in_parts.hpp>
#include <delassus/step/inner/workers_keep.hpp>
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
///   detection    boxes, pairs and contacts, by `NativeCollision` and backends of a kernel; what laws make of
///   them rows         of laws with many items: H and φ, their bias, and what laws keep of W W            its
///   rows, where it is a matrix (`AssembledCompliance`, the default) motion       of sets whose bodies go
///   each by itself islands      each is solved by one worker, the largest first; all sweep a large one
///   together where the
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
    static void begin(auto& step, double h) {
      workers(step);  // refused before anything is divided by it
      Base::begin(step, h);
    }
    static Index workers(auto& step) {
      const Index count = step.execution().workers();
      DELASSUS_EXPECT(count >= 1, "the execution of a loop has " + std::to_string(count) +
                                      " workers; let workers() return 1 or more");
      return count;
    }

    static void gather(auto& step) {
      step.contact_cache.gather(std::as_const(step).world(), inner::SharedRanges{step.execution()});
      if constexpr (inner::asks_who_meets<decltype(step)>)
        step.contact_cache.foresee(std::as_const(step).world(), step.h);
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
    static void detect_missed(auto& step) {
      auto& book = step.contact_cache;
      const auto pushed = book.who_pushed();
      const inner::InParts with{pushed, step.execution(), kept(step).pairs};
      if constexpr (inner::DetectsMissed<std::remove_reference_t<decltype(step.collision())>,
                                         std::remove_cv_t<decltype(with)>>)
        step.collision().detect_missed(std::span<const Collider>(book.colliders), step.h, book.missed, with);
      else
        Base::detect_missed(step);
    }
    static Index take_contacts(auto& step) {
      const inner::SharedRanges ranges{step.execution()};
      auto& book = step.contact_cache;
      book.results.resize(book.points.size());
      ranges(Index(book.points.size()), 128, [&](inner::Range range) { book.record(range); });
      inner::place_ends(step.collision(), book.results);
      if constexpr (inner::some_have_friction<typename std::remove_reference_t<decltype(step)>::Laws>)
        book.place_friction();
      return route_contacts(step.laws(), book, step.material_pairs, ranges);
    }
    static void start_warm(auto& step) {
      warm_start(step.pools.all(), step.arrays.all(), step.contact_cache, step.h, step.last_h,
                 kept(step).searches, step.execution());
    }
    static void keep_impulses(auto& step) {
      const inner::SharedRanges ranges{step.execution()};
      delassus::keep_impulses(step.pools.all(), step.arrays.all(), step.contact_cache, ranges);
      forget_lost_islands(step.pools.all(), step.law_set.views(), step.contact_cache, step.islands,
                          step.reports);
      if constexpr (std::remove_reference_t<decltype(step)>::Laws::has_contacts)
        step.contact_cache.remember(ranges);
    }
    static void write_rows(auto& step) {
      const auto laws = step.pools.all();
      const auto rows = step.arrays.all();
      for (std::size_t p = 0; p < laws.size(); ++p)
        kept(step).rows.write(laws[p], step.view, rows[p], step.execution());
    }
    static void free_motion(auto& step) {
      inner::InverseInParallel inverse{step.W, kept(step).sets, step.execution()};
      step.world().each([&](auto& set, auto s) {
        delassus::free_motion(set, inner::inverse_of<s>(inverse, set, 0), step.integrator(),
                              inner::part<s>(step.scratch), step.h, inner::SharedRanges{step.execution()});
      });
    }
    static void make_bias(auto& step) { Base::make_bias_by(step, inner::SharedRanges{step.execution()}); }
    static void build(auto& step) {
      std::remove_reference_t<decltype(step)>::Stages::build_W(step);
      Index most = 0;
      for (const auto& rows : step.arrays.all()) most = rows.items() > most ? rows.items() : most;
      step.law_set.prepare(step.W, step.rows, step.h, inner::SharedRanges{step.execution()},
                           kept(step).numbers_to(most));
    }
    static void advance(auto& step) {
      inner::note_broken(step.laws(), step.h);
      step.world().each([&](auto& set, auto) {
        inner::advance_in_ranges(set, step.integrator(), step.h, kept(step).moved, step.execution());
        step.summary.quarantined += set.quarantined();
      });
      step.end_clock();
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
        if constexpr (requires { step.W.are_islands_apart(); })
          if (!step.W.are_islands_apart()) {
            for (std::size_t k = 0; k < islands.size(); ++k) solve(k, 0, nullptr);
            return;
          }
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
