/// The ten stages of a plain step with constraints, and those parts of them that may be overridden alone.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/bias.hpp>
#include <delassus/step/correct.hpp>
#include <delassus/step/detect.hpp>
#include <delassus/step/drop_constraints.hpp>
#include <delassus/step/find_islands.hpp>
#include <delassus/step/free_motion.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/middle_contacts.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/notify.hpp>
#include <delassus/step/rounding.hpp>
#include <delassus/step/solve.hpp>
#include <delassus/step/stages_without_constraints.hpp>
#include <delassus/step/warm_start.hpp>
#include <delassus/step/worth_solving_again.hpp>

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

namespace delassus {

namespace inner {

/// Solves of a step at most: each brings in pairs that the one before made meet, as in a row of balls.
inline constexpr int most_solves = 16;

/// Whether detection leaves pairs out that do not meet.
template <class Step>
inline constexpr bool asks_who_meets =
    Step::Laws::has_contacts && Step::Stages::looks_ahead && !Step::Policies::wants_open_contacts && !MovesAtOnce<typename Step::Policies::Integrator> &&
    DetectsMissed<typename Step::Policies::Collision, ContactCache::Pushed>;
template <class Step>
inline constexpr bool asks_who_meets<Step&> = asks_who_meets<Step>;

}  // namespace inner

/// A policy that changes a stage overrides it by name: its `stages<Base>` derives from Base, whose function of that name
/// it calls or replaces. `step` is the StepData of the loop. A stage asks for its parts by `Stages`, so that those of
/// policies are called.
struct PlainStages : StagesWithoutConstraints {
  /// Detection leaves pairs out that do not meet by what is known of their motion, and `find_missed` those that meet after all.
  /// A policy that cannot solve a step again says false.
  static constexpr bool looks_ahead = true;

  /// How many islands are solved at once, at most.
  static constexpr Index workers(auto&) { return 1; }

  static void begin(auto& step, double h) {
    if constexpr (std::remove_reference_t<decltype(step)>::Laws::has_contacts)
      check_materials(std::as_const(step).world(), step.material_pairs);
    step.begin_clock(h);
    // Before all else: Detect and Linearize ask how fast kinematic bodies go.
    step.world().each([&](auto& set, auto) { set.begin_step(h); });
    step.attach();
    attach_contacts(step.laws(), step.contact_cache);
    inner::drop_broken(step.laws());
    inner::drop_stale(std::as_const(step).world(), step.view, step.pools.all(), step.versions);
  }

  static void detect(auto& step) {
    using Step = std::remove_reference_t<decltype(step)>;
    if constexpr (Step::Laws::has_contacts) {
      step.contact_cache.solves = 0;
      step.contact_cache.foreseen.clear();
      Step::Stages::gather(step);
      if constexpr (requires { Step::Policies::Collision::asks_for_joints; })
        step.collision().refresh(std::as_const(step).world(), [&](const auto& f) { step.each_joint(f); });
      inner::show_world(step.collision(), std::as_const(step).world());
      const CollisionReport found = Step::Stages::find_contacts(step);
      const Index unclaimed = Step::Stages::take_contacts(step);
      report_contacts(found, step.contact_cache.points, unclaimed, step.summary);
      if constexpr (inner::asks_who_meets<Step>) step.contact_cache.report_of_detect = step.summary;
    }
  }
  /// A collider for each body.
  static void gather(auto& step) {
    step.contact_cache.gather(std::as_const(step).world());
    if constexpr (inner::asks_who_meets<decltype(step)>) step.contact_cache.foresee(std::as_const(step).world(), step.h);
  }
  /// Contact points of the colliders that were gathered.
  static CollisionReport find_contacts(auto& step) {
    auto& book = step.contact_cache;
    const std::span<const Collider> colliders(book.colliders.data(), book.colliders.size());
    if constexpr (inner::asks_who_meets<decltype(step)>) return step.collision().detect(colliders, step.h, book.points, book.who_pushed());
    else return step.collision().detect(colliders, step.h, book.points);
  }
  /// After Correct: true where bodies that were left out meet by v_next. Then their contacts are added, and the step is to be
  /// solved again from Linearize on.
  static bool find_missed(auto& step) {
    if constexpr (inner::asks_who_meets<decltype(step)>) {
      auto& book = step.contact_cache;
      constexpr double share = theta<std::remove_cvref_t<decltype(step.integrator())>>();
      inner::weigh_foreseen(step, share);
      book.take_solved_motion(std::as_const(step).world(), share);
      std::remove_reference_t<decltype(step)>::Stages::detect_missed(step);
      inner::leave_what_bounces(step);
      if (!book.foreseen.drop(book.points) && (book.missed.empty() || !inner::is_worth_solving_again(step))) return false;
      if (++book.solves == inner::most_solves) {
        step.summary.status = worse(step.summary.status, Status::max_iterations);
        return false;
      }
      book.join_missed();
      book.report_of_detect.sweeps = step.summary.sweeps;
      step.summary = book.report_of_detect;  // what the solve before said is void
      if (std::remove_reference_t<decltype(step)>::Stages::take_contacts(step) > 0) step.summary.status = worse(step.summary.status, Status::unclaimed_contact);
      step.summary.contacts = Index(book.points.size());
      step.last_h = step.h;  // the impulses that it starts from are of this step
      return true;
    }
    return false;
  }

  /// Contacts of who was left out and meets by the motion that was solved for.
  static void detect_missed(auto& step) {
    auto& book = step.contact_cache;
    step.collision().detect_missed(std::span<const Collider>(book.colliders.data(), book.colliders.size()), step.h, book.missed, book.who_pushed());
  }

  static void linearize(auto& step) {
    follow(step.view, step.pools.all());
    std::remove_reference_t<decltype(step)>::Stages::write_rows(step);
    std::remove_reference_t<decltype(step)>::Stages::start_warm(step);
    step.summary.rows = row_count(step.arrays.all());
    step.summary.max_joint_violation = std::max(step.summary.max_joint_violation, worst_equality(step.pools.all(), step.arrays.all()));
  }

  /// The impulses that a solve starts from.
  static void start_warm(auto& step) { warm_start(step.pools.all(), step.arrays.all(), step.contact_cache, step.h, step.last_h); }
  /// H and φ of all laws.
  static void write_rows(auto& step) { delassus::linearize(step.view, step.pools.all(), step.arrays.all()); }

  static void free_motion(auto& step) {
    step.world().each([&](auto& set, auto s) {
      delassus::free_motion(set, inner::inverse_of<s>(step.W, set, 0), step.integrator(), inner::part<s>(step.scratch), step.h);
    });
  }

  static void find_islands(auto& step) {
    delassus::find_islands(step.world(), step.arrays.all(), step.islands);
    step.summary.islands = step.islands.count();
  }

  static void make_bias(auto& step) { make_bias_by(step, inner::OneRange{}); }
  /// The same where `ranges` says who does which items.
  static void make_bias_by(auto& step, const auto& ranges) {
    using Integrator = std::remove_cvref_t<decltype(step.integrator())>;
    const auto& world = std::as_const(step).world();
    auto moving = moving_surfaces(world, step.view, step.h);
    constexpr bool sees_start = !inner::has_middle_contacts<typename std::remove_reference_t<decltype(step)>::Policies>;
    moving.turn = moving.turn && sees_start;
    delassus::make_bias(world, step.pools.all(), step.arrays.all(), moving, step.stabilisation(), step.h, theta<Integrator>(),
                        sees_start && theta<Integrator>() != 1, ranges);
  }

  static void build(auto& step) {
    std::remove_reference_t<decltype(step)>::Stages::build_W(step);
    step.law_set.prepare(step.W, step.rows, step.h);
  }

  static void build_W(auto& step) { step.W.build(std::as_const(step).world(), step.rows); }

  static void solve(auto& step) {
    using Step = std::remove_reference_t<decltype(step)>;
    if constexpr (Step::observes_sweeps) {
      Step::Stages::solve_islands(step, step.template get<typename Step::Policies::SweepObserver>());
    } else {
      NoObserver nobody;
      Step::Stages::solve_islands(step, nobody);
    }
    summarise(step.reports, step.summary);
    Step::Stages::keep_impulses(step);
  }
  /// Every island, one after the other.
  static void solve_islands(auto& step, auto& observer) {
    using Stages = typename std::remove_reference_t<decltype(step)>::Stages;
    step.W.reset(step.rows);
    if (step.contact_cache.solves == 0) inner::begin_step_if_it_can(step.solver_workspace);
    inner::reset_if_it_can(step.solver_workspace, step.rows.row_count());
    step.reports.resize(step.islands.count());
    for (Index k = 0; k < step.islands.count(); ++k) {
      observer.begin_island(k);
      IslandProblem island(step.law_set, step.rows, step.W, step.islands, k, step.h, observer);
      Stages::solve_island(step, island);
    }
  }
  /// One of them, an `Island`.
  static void solve_island(auto& step, auto& island) {
    using Step = std::remove_reference_t<decltype(step)>;
    SolveReport& report = step.reports[island.island()];
    report = step.solver().solve(island, Step::Stages::solver_workspace(step, island));
    if ((report.status == Status::infeasible || report.status == Status::max_iterations) &&
        inner::is_all_rounding(std::as_const(step).world(), static_cast<const Island<typename Step::Scalar>&>(island)))
      report.status = Status::stalled;
    if constexpr (inner::some_push<typename Step::Laws>) report.undecided_loads = inner::undecided_loads<typename Step::Scalar>(island, report);
  }
  static auto& solver_workspace(auto& step, auto&) { return step.solver_workspace.itself(); }
  /// Impulses go to the items and to the contacts, and are kept for the next step.
  static void keep_impulses(auto& step) {
    delassus::keep_impulses(step.pools.all(), step.arrays.all(), step.contact_cache);
    forget_lost_islands(step.pools.all(), step.law_set.views(), step.contact_cache, step.islands, step.reports);
    if constexpr (std::remove_reference_t<decltype(step)>::Laws::has_contacts) step.contact_cache.remember();
  }

  static void correct(auto& step) {
    delassus::correct(step.world(), step.arrays.all(), step.W, step.scratch, step.islands, step.reports, step.is_nonfinite);
  }
  static void advance(auto& step) {
    inner::note_broken(step.laws(), step.h);
    StagesWithoutConstraints::advance(step);
  }
  /// The points become records and items of the laws; returns how many no law took.
  static Index take_contacts(auto& step) {
    using Step = std::remove_reference_t<decltype(step)>;
    step.contact_cache.record();
    inner::place_ends(step.collision(), step.contact_cache.results);
    if constexpr (inner::some_have_friction<typename Step::Laws>) step.contact_cache.place_friction();
    return route_contacts(step.laws(), step.contact_cache, step.material_pairs);
  }
};

}  // namespace delassus
