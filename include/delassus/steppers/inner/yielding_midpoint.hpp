/// What the midpoint rule by Newton's method does with rows that depend on each other: they yield where no
/// finite impulse closes them, and share the least impulses.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/steppers/inner/direct_rows.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/steppers/inner/equalities.hpp>
#include <delassus/steppers/inner/least_impulses.hpp>
#include <delassus/steppers/inner/midpoint_newton.hpp>

#include <tuple>
#include <type_traits>

namespace delassus {

template <class World, class Laws, class Rows>
class YieldingMidpoint : public MidpointNewton<World, Laws, Rows> {
 public:
  using T = typename Rows::Scalar;

  /// `solve` with φ + R λ = 0 in place of φ = 0, R = 1e-10 of W_kk where the step begins. A chain drawn
  /// straight bears no load across: φ = θ² and θ λ = c have no solution, and Newton's method halves θ for
  /// ever; θ² = R λ has one: θ³ = R c. Ends as `stalled`, the residual being what the joints are apart.
  template <class I>
  SolveReport solve_yielding(World& world, const Laws& laws, Rows& rows, const I& integrator, double h) {
    this->keep_start(rows);
    SolveReport report{.status = Status::max_iterations, .ended_by = "yielding rows"};
    this->begin(world, integrator, h);
    this->linearize_both(world, laws, rows, h);
    assemble_masses(world, rows);
    auto& system = this->system_;
    system.each([&](auto p, Index k) {
      auto& yield = inner::part<p>(this->yield_.pools)[system.node(k).item];
      for (int r = 0; r < yield.size(); ++r) yield[r] = T(1e-10 * h / 2 * system.node(k).scale[r]);
    });
    this->iterate(world, laws, rows, integrator, h, false, integrator.max_iterations, report);
    const double apart = Equalities<Rows>::worst(rows) / h / (this->speed_ > 0 ? this->speed_ : 1);
    if (std::isfinite(report.measure.residual) && !(report.measure.residual >= apart))
      report.measure.residual = apart;
    const bool is_near = report.status != Status::max_iterations && apart <= integrator.acceptable;
    report.status = is_near ? Status::stalled : Status::max_iterations;
    return report;
  }

  /// Of rows that depend on each other: λ without the share that no body feels, which else wanders.
  void take_least(World& world, Rows& rows) {
    const auto lambda = [&](auto p, Index i) -> auto& { return inner::part<p>(this->impulses.pools)[i]; };
    if (least_.are_least(this->system_, lambda)) return;
    assemble_masses(world, rows);
    least_.find(this->system_, lambda);
  }

 private:
  /// By the masses alone: the stiffness of a large idle share would weigh the rows.
  void assemble_masses(World& world, Rows& rows) {
    this->assemble(world, rows,
                   [](const auto& set, auto, Index b, const auto& X) { return set.solve_block(b, X); });
  }

  LeastImpulses<inner::DirectRows<Rows>> least_;
};

}  // namespace delassus
