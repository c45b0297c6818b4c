/// Nesterov's momentum and Anderson's mixing on the flat impulses: the library's own functions, on an island
/// of no type.
#pragma once

#include "island.hpp"

#include <delassus/solvers/inner/anderson.hpp>
#include <delassus/solvers/inner/momentum.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace light {

/// Counts sweeps, measures after each, and ends at a tolerance.
template <class Problem>
struct Chase {
  Problem& problem;
  double tolerance;
  int max_sweeps, sweeps = 0;
  Measure measure{};

  bool goes_on(double) {
    ++sweeps;
    measure = problem.measure();
    return measure.residual > tolerance && sweeps < max_sweeps;
  }
  SolveReport report() const {
    return {.status = measure.residual <= tolerance ? Status::converged : Status::max_iterations,
            .sweeps = sweeps,
            .measure = measure};
  }
};

struct Nesterov {
  double tolerance = 1e-6;
  int max_sweeps = 1000;

  template <class T>
  SolveReport solve(Island<T>& island) const {
    struct Patient : Chase<Island<T>> {
      bool is_stagnating() const { return false; }
    } chase{{island, tolerance, max_sweeps}};
    Array<T> x, y;
    inner::momentum(island, chase, x, [&](const Array<T>& before, double& curvature) {
      island.save(y);
      const T moved = island.sweep();
      curvature = island.curvature(before, y);
      return double(moved);
    });
    return chase.report();
  }
};

struct Anderson {
  double tolerance = 1e-6;
  int max_sweeps = 1000;

  template <class T>
  SolveReport solve(Island<T>& island) const {
    Chase<Island<T>> chase{island, tolerance, max_sweeps};
    inner::History history;
    inner::anderson(island, chase, history, [&] { return double(island.sweep()); });
    return chase.report();
  }
};

}  // namespace light
