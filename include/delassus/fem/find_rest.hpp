/// The rest of deformable bodies under gravity and loads: statics, by Newton's method.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/status.hpp>
#include <delassus/fem/inner/slope_search.hpp>
#include <delassus/rows/body_set.hpp>

#include <span>

namespace delassus {

/// When `find_rest` has arrived, and when it gives up.
struct RestOptions {
  double tolerance = 1e-10;  ///< of the last move: m, and rad of nodes that turn
  int max_iterations = 100;  ///< factorizations
};
/// How far `find_rest` came.
struct RestReport {
  /// Or max_iterations; quarantined where K has no factor or a number is none.
  Status status = Status::converged;
  int factorizations = 0;  ///< one for each iteration
  double move = 0;  ///< the largest of the last iteration, m or rad
};

/// Moves the nodes of a set to where f(q) = 0: elastic forces, weights and the loads there are now, which
/// stay for the next step. Velocities stay too. K must be regular: every body held by fixed nodes, none free
/// to turn or swing. Joints and contacts are not asked. Where it does not get there, the status says so and
/// the nodes are where it came to.
template <class Set>
RestReport find_rest(Set& set, const RestOptions& options = {}) {
  inner::expect_at_least_zero("find_rest: tolerance", options.tolerance);
  inner::expect_above_zero("find_rest: max_iterations", options.max_iterations);
  using Velocity = typename Set::Velocity;
  using T = typename Set::Scalar;
  Array<Velocity> force(set.blocks()), step, trial(set.blocks());
  const auto pull = [&](std::span<Velocity> f) {
    for (Velocity& x : f) x.setZero();
    set.add_forces(f);
  };
  RestReport report{.status = Status::max_iterations};
  while (report.status == Status::max_iterations && report.factorizations < options.max_iterations) {
    set.factor({.mass = 0, .stiffness = 1});
    ++report.factorizations;
    pull(force);
    step = force;
    set.solve(step);
    set.shift(0);  // sets the places aside
    const auto go = [&](double s) {
      set.restore();
      for (const Index b : set.active())
        if (set.moves(b)) set.displace(b, Velocity(T(s) * step[b]));
    };
    const double s = inner::slope_search(inner::share_within_a_radian(set, step),
                                         inner::work_along(set, force, step), [&](double share) {
                                           go(share);
                                           set.factor({.mass = 1});
                                           pull(trial);
                                           return inner::work_along(set, trial, step);
                                         });
    report.move = s * inner::largest(set, step);
    if (!(report.move >= 0)) {  // no factor, or numbers that are none
      set.restore();
      report.status = Status::quarantined;
    } else if (s == 1 && report.move <= options.tolerance) {
      report.status = Status::converged;
    }
  }
  return report;
}

}  // namespace delassus
