/// Which effects a run used, and which it only paid for.
#pragma once

#include <delassus/bodies/bounds.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/alive.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/stage.hpp>
#include <delassus/study/audit_report.hpp>
#include <delassus/study/code_of.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// List it in a loop, run, and ask `audit(loop)`. It copies the rows of every step: for a run of inquiry, not
/// for every day.
///
/// An effect acts where it changes a velocity by more than `least` times the speed of the scene, max |v| + h
/// |g|: an impulse λ counts as w |λ|, w = tr(W_ii)/rows. Keep `least` above the tolerance of the solver,
/// which leaves that much unsaid.
class Audit {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Begin, stage::Advance, stage::Step>;
  double least = 1e-4;  ///< of the speed of the scene, in (0, 1)

  Audit() = default;
  /// `Audit{1e-3}`.
  explicit Audit(double least_share) : least(least_share) {}

  void check() const {
    inner::expect_number(least > 0 && least < 1, "Audit: least", least, "must lie in (0, 1)");
  }

  void after(stage::Begin, const auto& loop) {
    if (seen_.steps == 0) see_bodies(loop.world());
  }

  /// Each part of a step that a scheme divides has rows of its own.
  void after(stage::Advance, const auto& loop) {
    using Loop = std::remove_cvref_t<decltype(loop)>;
    constexpr bool has_W = !Loop::has_constraints || Loop::has_problem;
    static_assert(has_W,
                  "delassus: Audit weighs impulses by W, which NewtonMidpoint, Rattle and RungeKutta4 do without, and "
                  "JointByJoint too; take another integrator, such as ImplicitMidpoint, or PlainOrder, or take Audit out");
    if constexpr (Loop::has_constraints && has_W) see_constraints(loop);
  }

  void after(stage::Step, const auto& loop) {
    ++seen_.steps;
    see_motion(loop.world());
    if constexpr (requires { loop.template state<role::Scheme>().report().by_effect; }) see_inner_steps(loop);
  }

  /// Of the steps so far.
  AuditReport report() const { return inner::audit_report(seen_); }

 private:
  /// Bodies may come while the loop runs: one that was not there at the start is followed from its first step
  /// on.
  void see_bodies(const auto& world) {
    const auto box = bounds(world);
    size_ = box.isEmpty() ? 0 : box.diagonal().norm();
    each_body(world, [&](std::size_t, const auto&, Index) {});
  }

  template <class F>
  void each_body(const auto& world, const F& f) {
    world.each([&](const auto& set, auto s) {
      for (const Index b : alive(set)) {
        if (!set.moves(b)) continue;
        std::size_t at = 0;
        while (at < seen_.bodies.size() && (seen_.bodies[at].set != s || seen_.bodies[at].block != b)) ++at;
        if (at == seen_.bodies.size()) {
          const Pose pose = set.pose(b);
          seen_.bodies.push_back(
              {.name = set.who(b), .set = s, .block = b, .start = pose, .end = pose, .has_moved = false});
        }
        f(at, set, b);
      }
    });
  }

  /// A body has moved when it is further from its start than `least` times the scene is wide, or has turned
  /// by as much, rad.
  void see_motion(const auto& world) {
    each_body(world, [&](std::size_t at, const auto& set, Index b) {
      inner::BodyUse& body = seen_.bodies[at];
      body.end = set.pose(b);
      body.has_moved = body.has_moved || (body.end.position - body.start.position).norm() > least * size_ ||
                       (body.end.rotation - body.start.rotation).norm() > least;
    });
  }

  /// What made the error of the inner steps, and whose was the largest.
  void see_inner_steps(const auto& loop) {
    const ErrorReport& report = loop.template state<role::Scheme>().report();
    for (std::size_t k = 0; k < report.by_effect.size(); ++k) {
      const EffectSteps& own = report.by_effect[k];
      StepCause& cause = seen_.causes[k];
      if (own.steps > 0) cause.least_step = cause.steps == 0 ? own.least_step : std::min(cause.least_step, own.least_step);
      cause.steps += own.steps;
      cause.rejections += own.rejections;
    }
    StepCause& largest = seen_.causes[std::size_t(report.effect)];
    if (!(report.error > largest.error)) return;
    largest.error = report.error;
    loop.world().each([&](const auto& set, auto s) {
      if (Index(s) == report.set) largest.body = set.who(report.block);
    });
  }

  /// max |v| + h |g| of all bodies, m/s.
  static double speed_of(const auto& loop) {
    double speed = 0, fall = 0;
    loop.world().each([&](const auto& set, auto) {
      fall = std::max(fall, loop.step_size() * norm(inner::gravity_of(set)));
      for (const Index b : alive(set))
        speed = std::max(speed, double(set.velocity()[b].template head<3>().norm()));
    });
    return speed + fall;
  }

  void see_constraints(const auto& loop) {
    using Laws = typename std::remove_cvref_t<decltype(loop)>::Laws;
    const auto problem = loop.problem();
    const auto reports = loop.island_reports();
    const double threshold = least * std::max(speed_of(loop), speed_);
    speed_ = std::max(speed_, speed_of(loop));
    seen_.pools.resize(std::size_t(Laws::pool_count));
    for_each_index<Laws::pool_count>([&](auto p) {
      inner::PoolUse& use = seen_.pools[std::size_t(int(p))];
      const auto& pool = problem.laws.template pool<p>();
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      constexpr int R = Law::rows;
      see_pool(use, R, ContactLaw<Law>, problem.islands, p, reports);
      if (use.name.empty()) use.name = inner::type_text<Law>();
      const auto& rows = problem.rows.template pool<p>();
      use.items += rows.items();
      for (Index i = 0; i < rows.items(); ++i) {
        const auto& own = problem.W.template diagonal<p>(i);
        if constexpr (!ContactLaw<Law>) {
          see_joint(use, std::size_t(pool.slots.active()[std::size_t(i)]), R, own.data(), rows.lambda[i].data(), threshold);
          continue;
        }
        constexpr int along = std::min(R, 3);
        double w = 0;
        for (int k = 0; k < along; ++k) w += double(own(k, k)) / along;
        if constexpr (ContactLaw<Law>) {
          if (R > 3) see_rolling(use, own, rows.lambda[i], w, threshold);
          see_contact(use, loop, pool, rows, i, w, threshold);
        }
        if constexpr (ContactLaw<Law> && R >= 3) {
          if (i > 0 && pool.item(i).record->pair == pool.item(i - 1).record->pair)
            continue;  // contacts are sorted by pair
          Index end = i + 1;
          while (end < rows.items() && pool.item(end).record->pair == pool.item(i).record->pair) ++end;
          see_friction(use, pool, rows, i, end, w, threshold);
        }
      }
    });
  }

  /// What the solver spent on pool p.
  template <class T>
  static void see_pool(inner::PoolUse& use, int rows, bool is_contact, const Islands<T>& islands, int p, std::span<const SolveReport> reports) {
    use.rows = rows;
    use.is_contact = is_contact;
    use.has_friction = is_contact && rows >= 3;  // rows n, t₁, t₂
    use.has_rolling = is_contact && rows > 3;    // and those of moments
    for (Index k = 0; k < islands.count(); ++k) {
      const SolveReport& solved = reports[std::size_t(k)];
      use.work += double(rows) * double(islands.items(p, k).size()) * std::max(1, solved.sweeps + solved.factorizations);
    }
  }

  template <class Loop, class P, class Rows>
  static void see_contact(inner::PoolUse& use, const Loop& loop, const P& pool, const Rows& rows, Index i,
                          double w, double threshold) {
    const double normal = double(rows.lambda[i][0]);
    if (w * normal > threshold) ++use.acted;
    if constexpr (refines<std::remove_cvref_t<decltype(pool.law)>>(refine::restitution)) {
      use.has_restitution = true;
      // Without it the bias is φ/h for an open contact and the stabilisation's for one that overlaps.
      const double phi = double(rows.phi[i][0]), h = loop.step_size();
      const double plain = phi < 0 ? loop.template policy<role::Stabilisation>().penetration(phi, h) : 0;
      use.bounced += normal > 0 && double(rows.bias[i][0]) < plain - threshold;
    }
  }

  /// The contacts i … end of one pair of bodies. Friction impulses in a patch may press against each other
  /// and move nobody: what counts is their sum Σ λ_t, and their moment about the normal over the radius of
  /// the patch.
  template <class P, class Rows>
  static void see_friction(inner::PoolUse& use, const P& pool, const Rows& rows, Index begin, Index end,
                           double w, double threshold) {
    Vec3 centre = Vec3::Zero(), sum = Vec3::Zero();
    for (Index i = begin; i < end; ++i) centre += pool.item(i).point / double(end - begin);
    double moment = 0, radius = 0;
    bool slips = false;
    for (Index i = begin; i < end; ++i) {
      const auto& item = pool.item(i);
      const Vec3 tangent = item.frame.template bottomRows<2>().transpose() *
                           rows.lambda[i].template cast<double>().template segment<2>(1);
      const Vec3 arm = item.point + item.record->friction_arm - centre;
      sum += tangent;
      moment += arm.cross(tangent).dot(item.record->normal);
      radius = std::max(radius, arm.norm());
      slips = slips || inner::who_refines<refine::is_sliding>(pool.law).is_sliding(inner::given<std::remove_cvref_t<decltype(pool.law)>>(item), rows.lambda[i]);
    }
    const bool is_felt = w * std::max(sum.norm(), radius > 0 ? std::abs(moment) / radius : 0) > threshold;
    if (is_felt) use.held += end - begin;
    if (is_felt && slips) use.slipped += end - begin;
  }

  /// Moments move what they turn by a length ℓ, ℓ² = tr W_uu / tr W_ωω: √(w w_ω) |λ_ω|.
  template <class W, class Impulse>
  static void see_rolling(inner::PoolUse& use, const W& own, const Impulse& lambda, double w,
                          double threshold) {
    double turns = 0, square = 0;
    for (int k = 3; k < Impulse::RowsAtCompileTime; ++k)
      turns += double(own(k, k)) / 3, square += double(lambda[k]) * double(lambda[k]);
    use.rolled += std::sqrt(w * turns * square) > threshold;
  }

  /// A joint of R rows, of which W has `own` and the solver found λ.
  template <class T>
  static void see_joint(inner::PoolUse& use, std::size_t place, int R, const T* own, const T* lambda, double threshold) {
    double w = 0, square = 0;
    for (int k = 0; k < R; ++k) w += double(own[k * (R + 1)]) / R, square += double(lambda[k]) * double(lambda[k]);
    if (use.loaded.size() <= place) use.loaded.resize(place + 1, 0), use.seen.resize(place + 1, 0);
    ++use.seen[place];
    const bool is_loaded = w * std::sqrt(square) > threshold;
    use.loaded[place] += is_loaded;
    use.acted += is_loaded;
  }

  inner::AuditSeen seen_;
  double size_ = 0;   ///< of the scene at the start, m
  double speed_ = 0;  ///< the largest of the run so far, m/s
};

/// What the Audit{} in the list of a loop has seen so far.
template <class Loop>
AuditReport audit(const Loop& loop) {
  static_assert(Loop::template has<Audit>,
                "delassus: audit(loop) asks the listener Audit{}; add it to the arguments of this AnimationLoop");
  if constexpr (Loop::template has<Audit>) return loop.template get<Audit>().report();
  else return {};
}

}  // namespace delassus
