/// A whole step of body sets that nothing couples, one set after the other.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <tuple>

namespace delassus {

/// `One<Set>` is the step of one set: `solve(set, integrator, h, factorizations)` leaves it in `v_next` and
/// `v_free`, q and v as they were. What of it outlives a step it says in `memory`, if there is any.
template <template <class> class One, class World>
class StepBySets;

template <template <class> class One, class... Sets>
class StepBySets<One, World<Sets...>> {
 public:
  using World = delassus::World<Sets...>;

  template <class Laws, class Rows, class I>
  SolveReport solve(World& world, const Laws&, Rows&, const I& integrator, double h) {
    SolveReport report{.ended_by = "Newton"};
    world.each([&](auto& set, auto s) {
      report.status =
          worse(report.status, std::get<s>(sets_).solve(set, integrator, h, report.factorizations));
    });
    return report;
  }
  void memory(auto& archive) {
    std::apply([&](auto&... one) { (keep(one, archive), ...); }, sets_);
  }

 private:
  static void keep(auto& one, auto& archive) {
    if constexpr (requires { one.memory(archive); }) one.memory(archive);
  }

  std::tuple<One<Sets>...> sets_;
};

}  // namespace delassus
