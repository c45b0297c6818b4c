/// The stages of AnimationLoop, in the plain order: each fits the functions of `stages/` to the arrays of the loop.
#pragma once

#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/stages/bias.hpp>
#include <delassus/loop/stages/correct.hpp>
#include <delassus/loop/stages/free_motion.hpp>
#include <delassus/loop/stages/linearize.hpp>
#include <delassus/loop/stages/pass_on_impacts.hpp>
#include <delassus/loop/stages/predict.hpp>
#include <delassus/loop/stages/project_position.hpp>
#include <delassus/loop/stages/push_apart.hpp>
#include <delassus/loop/stages/refine.hpp>
#include <delassus/loop/stages/solve.hpp>
#include <delassus/loop/stages/warm_start.hpp>

#include <array>
#include <cmath>
#include <span>

namespace delassus {

template <class... Policies>
void AnimationLoop<Policies...>::begin(double h) {
  DELASSUS_EXPECT(std::isfinite(h) && h > 0, "step: h = " + inner::text(h) + " s must be finite and > 0");
  if constexpr (Laws::has_contacts) check_materials(std::as_const(*this).world(), work_.materials);
  if (h != h_) {
    start_ = time();
    steps_ = 0;
  }
  last_h_ = h_ > 0 ? h_ : h;
  h_ = h;
  report_ = {};
  // Before all else: Detect and Linearize ask how fast kinematic bodies go.
  world().each([&](auto& set, auto) { set.begin_step(h); });
  if constexpr (has_constraints) {
    work_.book.attach(laws());
    inner::drop_broken(laws());
    inner::drop_stale(std::as_const(*this).world(), laws(), work_.census);
    if constexpr (Work::has_dormant) work_.activity.begin(world(), laws(), h);
  }
  tell<stage::Begin>();
}

template <class... Policies>
void AnimationLoop<Policies...>::detect() {
  if constexpr (Laws::has_contacts) {
    auto& contacts = work_.contacts;
    contacts.gather(std::as_const(*this).world());
    if constexpr (requires { Parts::Collision::asks_for_joints; })
      part<role::Collision>().refresh(std::as_const(*this).world(), [&](const auto& f) { each_joint(f); });
    inner::show_world(part<role::Collision>(), std::as_const(*this).world());
    const auto detect_all = [&] {
      return part<role::Collision>().detect(std::span<const Collider>(contacts.colliders), h_, contacts.points);
    };
    CollisionReport found;
    if constexpr (Work::has_dormant) found = detect_awake(world(), laws(), work_.activity, contacts, h_, detect_all);
    else found = detect_all();
    contacts.record();
    inner::place_ends(part<role::Collision>(), contacts.results);
    const Index unclaimed = route_contacts(laws(), contacts, work_.materials);
    if (unclaimed > 0) report_.status = worse(report_.status, Status::unclaimed_contact);
    report_.contacts = Index(contacts.points.size());
    report_.pairs = found.pairs;
    report_.queries = found.queries;
    report_.rejects = found.rejects;
    for (const ContactPoint& p : contacts.points) report_.max_penetration = std::max(report_.max_penetration, -p.gap);
  }
  tell<stage::Detect>();
}

template <class... Policies>
void AnimationLoop<Policies...>::push_apart() {
  if constexpr (Laws::has_contacts) {
    const SystemScale A = part<role::Integrator>().scale(h_);
    if (A.stiffness == 0 && A.damping == 0) delassus::push_apart(world(), laws(), work_.contacts, h_);
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::linearize() {
  if constexpr (has_constraints) {
    follow(std::as_const(*this).world(), laws());
    if constexpr (Work::at_midpoint) linearize_at_midpoint(world(), laws(), work_.rows, work_.at_start, h_);
    else delassus::linearize(std::as_const(*this).world(), laws(), work_.rows);
    warm_start(laws(), work_.rows, work_.contacts, h_, last_h_);
    if constexpr (Work::passes_impacts_on)
      pass_on_impacts(world(), laws(), work_.rows, work_.impacts, work_.contacts.results.size(), h_);
    report_.rows = work_.rows.row_count();
    report_.max_joint_violation = std::max(report_.max_joint_violation, worst_equality(laws(), work_.rows));
  }
  tell<stage::Linearize>();
}

template <class... Policies>
void AnimationLoop<Policies...>::free_motion() {
  constexpr bool is_refined = requires { requires RefinedOperator<typename Work::Operator>; };
  if constexpr (is_refined) work_.W.begin(part<role::Compliance>());
  world().each([&](auto& set, auto s) {
    if constexpr (has_constraints)
      delassus::free_motion(set, inner::inverse_of<s>(work_.W, set, 0), part<role::Integrator>(),
                            std::get<s>(scratch_), h_);
    else
      delassus::free_motion(set, set, part<role::Integrator>(), std::get<s>(scratch_), h_);
  });
  tell<stage::FreeMotion>();
}

template <class... Policies>
void AnimationLoop<Policies...>::find_islands() {
  if constexpr (has_constraints) {
    std::array<Index, WorldType::set_count> first{};
    Index blocks = 0;
    world().each([&](const auto& set, auto s) {
      first[s] = blocks;
      blocks += set.blocks();
    });
    const auto moves = [&](auto s, Index b) { return world().template set<s>().moves(b); };
    const auto ties = [&](const auto& tie) {
      world().each([&](const auto& set, auto s) {
        const auto both = [&](Index a, Index b) { tie(first[s] + a, first[s] + b); };
        if constexpr (requires { set.each_tie(both); }) set.each_tie(both);
      });
    };
    work_.islands.find(work_.rows, std::span<const Index>(first), blocks, moves, ties);
    report_.islands = work_.islands.count();
  }
  tell<stage::Islands>();
}

template <class... Policies>
void AnimationLoop<Policies...>::make_bias() {
  if constexpr (has_constraints) {
    if constexpr (Work::restitutes) {
      work_.bounce.resize_like(work_.rows);
      for_each_index<Laws::pool_count>([&](auto p) {
        for (auto& b : std::get<p>(work_.bounce.pools)) b.setZero();
      });
    }
    if constexpr (Work::at_midpoint) work_.fade.resize_like(work_.rows);
    delassus::make_bias(std::as_const(*this).world(), laws(), work_.rows, part<role::Stabilisation>(), h_,
                        theta<typename Parts::Integrator>(), work_.bounce, work_.at_start, work_.fade);
  }
  tell<stage::Bias>();
}

template <class... Policies>
void AnimationLoop<Policies...>::build() {
  if constexpr (has_constraints) {
    work_.W.build(std::as_const(*this).world(), work_.rows);
    work_.book.prepare(work_.W, work_.rows, h_);
  }
  tell<stage::Build>();
}

template <class... Policies>
void AnimationLoop<Policies...>::predict() {
  if constexpr (has_constraints) delassus::predict(world(), work_.rows, work_.W, scratch_, work_.predicted);
}

template <class... Policies>
void AnimationLoop<Policies...>::solve() {
  if constexpr (has_constraints) {
    inner::with_observer(policies_, [&](auto& observer) {
      solve_islands(work_, part<role::Solver>(), h_, observer);
      if constexpr (RefinedOperator<typename Work::Operator>) {
        static_assert(!Work::predicts && !Work::restitutes,
                      "delassus: LazyCompliance and PrecomputedCompliance take no PredictiveScheme and no law with "
                      "restitution, such as Restitution, SequentialRestitution and Limit; use AssembledCompliance");
        while (refine(world(), work_, scratch_, h_)) solve_islands(work_, part<role::Solver>(), h_, observer);
        part<role::Compliance>().report = work_.W.report();
        if (!work_.W.is_settled()) report_.status = worse(report_.status, Status::max_iterations);
      }
    });
    for (const SolveReport& r : work_.reports) {
      report_.status = worse(report_.status, r.status);
      report_.sweeps = std::max(report_.sweeps, r.sweeps);
      report_.residual = std::max(report_.residual, r.measure.residual);
      report_.siconos_error = std::max(report_.siconos_error, r.measure.siconos);
    }
    keep_impulses(laws(), work_.rows, work_.contacts);
    inner::note_broken(laws(), h_);
    forget_lost_islands(laws(), work_.rows, work_.W, work_.contacts, work_.islands, work_.reports);
    work_.contacts.remember();
    if constexpr (Work::passes_impacts_on)  // they are no start for the next step
      for (std::size_t i = 0; i < work_.impacts.size(); ++i) work_.contacts.results[i].impulse += work_.impacts[i];
  }
  tell<stage::Solve>();
}

template <class... Policies>
void AnimationLoop<Policies...>::solve_whole_step() {
  if constexpr (solves_whole_step) {
    linearize();
    if constexpr (has_constraints) {
      work_.reports.assign(1, work_.whole_step.solve(world(), laws(), work_.rows, part<role::Integrator>(), h_));
      report_.status = worse(report_.status, work_.reports[0].status);
      report_.residual = std::max(report_.residual, work_.reports[0].measure.residual);
      report_.islands = 1;
      keep_impulses(laws(), work_.rows, work_.contacts);
      inner::note_broken(laws(), h_);
    } else {
      typename Work::Rows none;
      const SolveReport report = work_.whole_step.solve(world(), laws(), none, part<role::Integrator>(), h_);
      report_.status = worse(report_.status, report.status);
    }
    tell<stage::Solve>();
    tell<stage::Correct>();
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::correct() {
  if constexpr (has_constraints) {
    if constexpr (Work::predicts) take_change(work_.rows, work_.predicted);
    delassus::correct(world(), work_.rows, work_.W, scratch_, work_.islands, work_.reports, work_.is_sick);
    if constexpr (Work::predicts) give_back_total(work_.rows, work_.predicted);
    if constexpr (Work::has_dormant)
      work_.activity.watch(part<role::Activity>(), world(), work_.rows, work_.islands, work_.reports, h_);
  } else {
    world().each([](auto& set, auto) { set.v_next = set.v_free; });
  }
  tell<stage::Correct>();
}

template <class... Policies>
void AnimationLoop<Policies...>::move_freely() {
  world().each([&](auto& set, auto s) {
    if (set.is_separable()) {
      delassus::move_freely(set, part<role::Integrator>(), h_);
    } else {
      delassus::free_motion(set, set, part<role::Integrator>(), std::get<s>(scratch_), h_);
      set.v_next = set.v_free;
      part<role::Integrator>().advance(set, h_);
    }
    report_.quarantined += set.held();
  });
  end_advance();
}

template <class... Policies>
void AnimationLoop<Policies...>::visit_joints() {
  if constexpr (visits_joints) {
    world().each([&](auto& set, auto s) {
      if (set.is_separable()) {
        delassus::kick(set, part<role::Integrator>(), h_);
      } else {
        delassus::free_motion(set, set, part<role::Integrator>(), std::get<s>(scratch_), h_);
        set.v_next = set.v_free;
      }
    });
    tell<stage::FreeMotion>();
    follow(std::as_const(*this).world(), laws());
    if (work_.reports.empty()) [[unlikely]] work_.reports.emplace_back();
    SolveReport& solved = work_.reports[0];
    work_.parts.run(world(), laws(), part<role::Stabilisation>(), h_, h_ / last_h_, part<role::Scheme>(),
                       report_, solved);
    inner::note_broken(laws(), h_);
    report_.status = solved.status;
    report_.sweeps = solved.sweeps;
    report_.residual = std::max(report_.residual, solved.measure.residual);
    report_.siconos_error = std::max(report_.siconos_error, solved.measure.siconos);
    report_.islands = 1;
    tell<stage::Solve>();
    tell<stage::Correct>();
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::advance() {
  const auto find = [&] {
    if constexpr (has_constraints)
      if constexpr (Work::projects_position)
        report_.status = worse(report_.status, find_displacements(world(), laws(), work_, part<role::Stabilisation>(),
                                                                  part<role::Solver>(), scratch_, h_));
  };
  constexpr bool sees_end = [] {
    if constexpr (has_constraints) return Work::at_midpoint && Work::projects_position;
    else return false;
  }();
  if constexpr (!sees_end) find();
  world().each([&](auto& set, auto) {
    part<role::Integrator>().advance(set, h_);
    report_.quarantined += set.held();
  });
  if constexpr (sees_end) {
    delassus::linearize(std::as_const(*this).world(), laws(), work_.at_start);
    find();
  }
  if constexpr (has_constraints)
    if constexpr (Work::projects_position) displace(world(), work_.displacement, h_);
  if constexpr (has_constraints)
    if constexpr (Work::has_dormant) work_.activity.settle(part<role::Activity>(), world(), laws(), work_.islands);
  end_advance();
  tell<stage::Advance>();
}

template <class... Policies>
void AnimationLoop<Policies...>::begin_substeps(int count) {
  if constexpr (divides_step) {
    work_.parts.begin(world(), count, h_, start_, steps_);
    start_ = time();
    steps_ = 0;
    h_ /= count;
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::end_substep(int left) {
  if constexpr (divides_step) {
    auto& parts = work_.parts;
    if constexpr (has_constraints) parts.add_impulses(laws(), work_.contacts);
    if (left > 0) {
      parts.go_on(world(), left);
      if constexpr (Laws::has_contacts) parts.follow(std::as_const(*this).world(), laws(), work_, h_);
      last_h_ = h_;
    } else {
      if constexpr (has_constraints) parts.give_impulses(laws(), work_.contacts);
      h_ = parts.h;
      start_ = parts.start;
      steps_ = parts.steps + 1;
      report_.time = time();
    }
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::end_advance() {
  if (report_.quarantined > 0) report_.status = worse(report_.status, Status::quarantined);
  ++steps_;
  report_.time = time();
}

}  // namespace delassus
