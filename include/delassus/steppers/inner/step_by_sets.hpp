/// A whole step of body sets that nothing couples, one set after the other.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <tuple>

namespace delassus {

namespace inner {

/// How far from the origin the bodies of a set reach, m: their places are no finer than rounding of it, so that
/// velocities mean nothing below rounding of the speed that crosses it in the step, nor accelerations below
/// rounding of what takes it there. Angles of rods count as radians.
template <class Set>
double reach(const Set& set) {
  double most = Set::width == 6 ? 1 : 0;
  for (const Index b : set.active())
    if (set.moves(b)) most = std::max(most, double(set.pose(b).position.norm()));
  return most;
}

}  // namespace inner

/// `One<Set>` is the step of one set: `solve(set, integrator, h, factorizations)` leaves it in `v_next` and
/// `v_free`, q and v as they were. What of it outlives a step it says in `memory`, if there is any.
template <template <class> class One, class World, class Laws>
class StepBySets {
  static_assert(Laws::pool_count == 0,
                "delassus: Bdf2, FullNewton, GeneralizedAlpha and Newmark move bodies without joints; take the laws out, or use "
                "ImplicitEuler or ImplicitMidpoint");

 public:
  SolveReport solve(World& world, const Laws&, const auto&, const auto& integrator, double h) {
    SolveReport report{.ended_by = "Newton"};
    world.each([&](auto& set, auto s) {
      report.status =
          worse(report.status, std::get<s>(sets_).solve(set, integrator, h, report.factorizations));
    });
    return report;
  }
  void memory(auto& archive) {
    std::apply([&](auto&... one) { (inner::memory_if_any(one, archive), ...); }, sets_);
  }

 private:
  typename World::template PerSet<One> sets_;
};

}  // namespace delassus
