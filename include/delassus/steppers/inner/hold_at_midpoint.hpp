/// A whole step of the midpoint rule with its joints: for `NewtonMidpoint`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/steppers/inner/yielding_midpoint.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

namespace delassus {

/// One solve by `MidpointNewton`; where that does not converge, two of half the step, each of which may be
/// halved again. A chain that snaps taut is a shock in a step, and has to be met in its time; every part
/// keeps what the rule keeps. A step that cannot be made so is begun again with rows that yield.
template <class World, class Laws, class Rows>
class MidpointHold {
 public:
  using T = typename Rows::Scalar;

  /// Leaves q₊ and v_next in the sets and the sum of the parts' λ in `rows`, which is linearised at the start
  /// on entry, with λ a guess. Where a part is no number, or far from its equations, rows that yield too,
  /// every body stays where it was: what it misses would come back as energy.
  template <class I>
  SolveReport solve(World& world, const Laws& laws, Rows& rows, const I& integrator, double h) {
    world.each([&](auto& set, auto s) {
      set.state().keep_poses();
      std::get<s>(velocity_) = set.velocity();
    });
    for (auto* all : {&newton_.impulses, &force_, &total_}) all->resize_like(rows);
    total_.set_zero();
    for_each_index<Rows::pool_count>([&](auto p) { keep_force<p>(rows.template pool<p>().lambda, h); });
    report_ = {.ended_by = "Newton"};
    Leaving leaving{*this, world, rows};
    bool& is_done = leaving.is_done;
    for (const Way way : {Way::exact, Way::yielding, Way::near}) {
      if (way != Way::exact) begin_again(world, laws, rows);
      is_done = go(world, laws, rows, integrator, h, integrator.max_halvings, way);
      if (is_done) break;
    }
    if (!is_done) report_.status = Status::quarantined;
    return report_;
  }

 private:
  /// At the end of a solve, also where a law throws.
  struct Leaving {
    MidpointHold& own;
    World& world;
    Rows& rows;
    bool is_done = false;
    ~Leaving() { own.leave(world, rows, is_done); }
  };

  /// How a step is made: by the equations, by those of rows that yield, by the equations to `acceptable`.
  enum class Way { exact, yielding, near };

  /// A step of h from where the bodies are; false when it could not be made.
  template <class I>
  bool go(World& world, const Laws& laws, Rows& rows, const I& integrator, double h, int halvings, Way way) {
    SolveReport part{.status = Status::max_iterations};
    if (way != Way::yielding) {
      guess(h);
      part = newton_.solve(world, laws, rows, integrator, h);
    }
    // Where the last step yielded, this one will have to.
    const bool yields = part.status == Status::max_iterations && !newton_.is_cut_short(integrator, part) &&
                        (way == Way::yielding || newton_.began_open(integrator, h));
    if (yields) {
      report_.ended_by = "yielding rows";
      report_.factorizations += part.factorizations;
      guess(h);
      linearize(world, laws, rows);
      part = newton_.solve_yielding(world, laws, rows, integrator, h);
    }
    report_.factorizations += part.factorizations;
    const bool is_solved = part.status != Status::max_iterations || newton_.is_cut_short(integrator, part);
    if (!is_solved && halvings > 0) {
      report_.ended_by = "halved steps";
      for (int half = 0; half < 2; ++half) {
        linearize(world, laws, rows);
        if (!go(world, laws, rows, integrator, h / 2, halvings - 1, way)) return false;
      }
      return true;
    }
    report_.status = worse(report_.status, part.status);
    report_.measure.floor = std::max(report_.measure.floor, part.measure.floor);
    if (!(part.measure.residual <= report_.measure.residual))
      report_.measure.residual = part.measure.residual;
    if (!std::isfinite(part.measure.residual)) return false;
    if (!is_solved && (way == Way::exact || part.measure.residual > integrator.acceptable)) return false;
    if (part.factorizations > 0 && !yields) newton_.take_least(world, rows);
    newton_.go(world, h);
    total_.add(newton_.impulses);
    for_each_index<Rows::pool_count>([&](auto p) { keep_force<p>(inner::part<p>(newton_.impulses.pools), h); });
    return true;
  }

  template <int p>
  void keep_force(const auto& lambda, double h) {
    for (std::size_t i = 0; i < lambda.size(); ++i) inner::part<p>(force_.pools)[i] = lambda[i] / T(h);
  }
  /// λ of a step of h by the forces of the last part.
  void guess(double h) {
    newton_.impulses.set_zero();
    newton_.impulses.add(force_, T(h));
  }
  /// Bodies where the step starts, and rows of there.
  void begin_again(World& world, const Laws& laws, Rows& rows) {
    world.each([&](auto& set, auto s) {
      set.velocity() = std::get<s>(velocity_);
      for (const Index b : set.active()) set.state().restore_pose(b);
    });
    linearize(world, laws, rows);
    total_.set_zero();
    report_ = {.factorizations = report_.factorizations, .ended_by = "Newton"};
  }
  /// v of the end becomes v_next, v that of the start. Bodies without impulses are where they were, for
  /// `arrive` to move them; so are all when the step could not be made, which v_next says by being no number.
  void leave(World& world, Rows& rows, bool is_done) {
    world.each([&](auto& set, auto s) {
      for (const Index b : set.active()) {
        auto& v = set.velocity()[b];
        set.v_next[b] = v;
        v = std::get<s>(velocity_)[b];
        if (!is_done && set.moves(b)) set.v_next[b].setConstant(std::numeric_limits<T>::quiet_NaN());
        if (!is_done || !set.moves(b)) set.state().restore_pose(b);
      }
    });
    if (!is_done) total_.set_zero();
    total_.give_to(rows);
  }

  YieldingMidpoint<World, Laws, Rows> newton_;
  typename World::template PerSet<VelocitiesOf> velocity_;
  Impulses<Rows> force_, total_;  ///< λ/h of the last part, and Σ λ
  SolveReport report_;
};

/// The same without constraints: the bodies turn freely.
template <class World>
class MidpointAlone {
 public:
  template <class I>
  SolveReport solve(World& world, const auto&, const auto&, const I& integrator, double h) {
    world.each([&](auto& set, auto) {
      const auto blocks = set.by_block(integrator.scale(h));
      set.v_next = set.velocity();
      auto& force = set.v_free;
      for (auto& f : force) f.setZero();
      integrator.impulse(set, force, h);
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        auto& v = set.velocity()[b];
        const auto start = v;
        set.v_next[b] += blocks.solve(b, force[b]);
        blocks.advance(b, set.v_next[b], h, typename World::Scalar(0.5));
        if (is_finite(set.v_next[b])) set.v_next[b] = v;
        v = start;
      }
    });
    return {};
  }
};

}  // namespace delassus
