/// Of all impulses that make the same motion, the smallest.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/inner/anderson.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>

namespace delassus {
namespace inner {

/// Room for conjugate gradients, reserved once.
struct NormSearch {
  Array<double> x, b, r, p, q;
  Array<char> how;                ///< of each constraint: `Held`
  Array<char> outside, limiting;  ///< of each free one
  void reserve(std::size_t rows) {
    for (auto* v : {&x, &b, &r, &p, &q}) v->reserve(rows);
    for (auto* v : {&how, &outside, &limiting}) v->reserve(rows);
  }
  void resize(std::size_t unknowns) {
    for (auto* v : {&x, &b, &r, &p, &q}) v->assign(unknowns, 0);
  }
};

template <class T, class Space>
struct NormSpace {
  Space solver;
  Array<T> solved, target;
  NormSearch search;
  void reset(Index rows) {
    reset_if_it_can(solver, rows);
    for (auto* impulses : {&solved, &target}) impulses->reserve(std::size_t(rows));
    search.reserve(std::size_t(rows));
  }
};

/// The residual that a solver, or the one it goes around, was asked for; 0 where it stops by another measure.
double wanted_residual(const auto& solver) {
  if constexpr (requires { solver.solver; }) {
    return wanted_residual(solver.solver);
  } else if constexpr (requires { solver.options(); }) {
    const SolveOptions options = solver.options();
    return options.criterion == Criterion::residual && !options.all_verified ? options.tolerance : 0;
  } else {
    return 0;
  }
}

}  // namespace inner

/// `MinimumNorm{AcceleratedGaussSeidel{}}`: Where constraints are redundant λ is not unique. (A table on four legs, a door
/// on three hinges, a contact found twice.) Which one sweeps find depends on their order and start. After a solve that
/// converged this takes
///
///   λ = argmin Σ w_i |λ_i|²  with  W λ unchanged,   w_i = tr(W_ii)/rows.
///
/// It does so by conjugate gradients from zero on W λ = W λ*, which never leave the range of W. Equal legs carry equal loads,
/// and λ is as continuous in time as the motion is. Constraints that stand still are free in it, contacts that slip keep
/// their direction, what is open keeps its zero. Where a cone is in the way λ goes as far as it lets it, and on without the
/// constraint that is at its limit.
///
/// The motion is that of the solve, to its tolerance; otherwise λ* is kept. It costs a product with W for each of the distinct
/// eigenvalues of W, about. Source: [HestenesStiefel1952].
template <class Solver = inner::Absent>
struct MinimumNorm {
  using plays = role::Solver;
  static constexpr unsigned layers = inner::layers_of<Solver> | inner::layer::minimum_norm;
  Solver solver{};  ///< finds the motion
  int max_products = 200;  ///< with W; when they run out λ stays as it was solved

  static constexpr Needs needs = inner::needs_of<Solver>;
  template <class Rows>
  using Workspace = inner::NormSpace<typename Rows::Scalar, typename Solver::template Workspace<Rows>>;

  void check() const {
    solver.check();
    inner::expect_at_least_zero("MinimumNorm: max_products", max_products);
  }

  template <class T, class Space>
  SolveReport solve(Island<T>& problem, Space& work) const {
    SolveReport report = solver.solve(problem, work.solver);
    if (report.status > Status::stalled || problem.is_out_of_time()) return report;
    Search<T, Space> now{problem, work};
    now.sort(report.measure);
    for (int round = 0; round < 4; ++round)
      if (!now.shrink(max_products)) break;
    const Measure after = problem.measure();
    // Conjugate gradients end at 1e-13, a solve may by chance have come closer.
    if (after.residual <=
        std::max({2 * report.measure.residual, after.floor, inner::wanted_residual(solver)}))
      report.measure = after;
    else
      problem.load(work.solved);
    return report;
  }

 private:
  enum Held : char { still, slips, fixed };

  template <class T, class Space>
  struct Search {
    Island<T>& problem;
    Space& work;

    /// Which constraints are free: those whose velocity is within the error of the solve.
    void sort(const Measure& measure) {
      problem.save(work.solved);
      T u[most_rows];
      double d = 0, moved = 0;
      for (const Span<T>& span : problem)
        for (const Index i : span) {
          d += problem.square_of_velocity(span, problem.free_of_impulses(span, i));
          problem.velocity(span, i, u);
          moved += problem.square_of_velocity(span, u);
        }
      const double small = 10 * std::max(measure.residual, measure.floor) * std::sqrt(std::max(d, moved));
      work.search.how.clear();
      for (const Span<T>& span : problem)
        for (const Index i : span) {
          problem.velocity(span, i, u);
          Held how = std::sqrt(problem.square_of_velocity(span, u)) <= small ? still : fixed;
          if (span.pool->table->friction && how == fixed && double(std::abs(u[0])) <= small && problem.impulse(span, i)[0] > 0) how = slips;
          if (!(span.pool->trace(i) > 0)) how = fixed;
          work.search.how.push_back(how);
        }
    }

    /// One round: false when λ is the smallest, or nothing more can be done.
    bool shrink(int products) {
      auto& s = work.search;
      problem.save(work.target);  // λ*
      std::size_t unknowns = 0;
      each_free([&](const Free& free) { unknowns += std::size_t(free.count); });
      s.resize(unknowns);
      gather(s.x);
      multiply(s.x, s.b);
      const bool is_found = find(products);
      problem.load(work.target);
      return is_found && !go(1) && go_as_far_as_the_cones();
    }

   private:
    /// A constraint that is free: `count` unknowns, which are impulses along `at`, or on each row.
    struct Free {
      const Span<T>& span;
      Index i;
      const T* at;  ///< λ*
      bool slips;
      int rows, count;
      double length;
      double over[most_rows];

      /// Row of the impulse that the n-th unknown stands for.
      double unit(int n, int row) const {
        if (slips) return over[row] * double(at[row]) / length;
        return n == row ? over[row] : 0.0;
      }
      /// B x.
      void impulse(const double* x, T* sum) const {
        for (int row = 0; row < rows; ++row) sum[row] = 0;
        for (int n = 0; n < count; ++n)
          for (int row = 0; row < rows; ++row) sum[row] += T(unit(n, row) * x[n]);
      }
    };

    static double square_of(const T* x, int rows) {
      double sum = 0;
      for (int k = 0; k < rows; ++k) sum += double(x[k]) * double(x[k]);
      return sum;
    }
    /// f(free) for each free constraint.
    template <class F>
    void each_free(const F& f) {
      std::size_t k = 0;
      const T* at = work.target.data();
      for (const Span<T>& span : problem)
        for (const Index i : span) {
          const T* const target = at;
          at += span.pool->rows;
          const char how = work.search.how[k++];
          if (how == fixed) continue;
          Free free{span, i, target, how == slips, span.pool->rows, how == slips ? 1 : span.pool->rows,
                    how == slips ? std::sqrt(square_of(target, span.pool->rows)) : 1, {}};
          span.pool->roots_of_weights(i, free.over);
          for (int row = 0; row < free.rows; ++row) free.over[row] = free.over[row] > 0 ? 1 / free.over[row] : 0;
          f(free);
        }
    }
    /// x = √w Bᵀ λ.
    void gather(Array<double>& x) {
      std::size_t k = 0;
      each_free([&](const Free& free) {
        for (int n = 0; n < free.count; ++n, ++k) {
          double sum = 0, square = 0;
          for (int row = 0; row < free.rows; ++row) {
            sum += free.unit(n, row) * double(free.at[row]);
            square += free.unit(n, row) * free.unit(n, row);
          }
          x[k] = sum / square;
        }
      });
    }
    /// y = Bᵀ W B x; the problem has λ = B x afterwards, and zero elsewhere.
    void multiply(const Array<double>& x, Array<double>& y) {
      problem.clear();
      std::size_t k = 0;
      T numbers[most_rows];
      each_free([&](const Free& free) {
        free.impulse(&x[k], numbers);
        problem.assign(free.span, free.i, numbers);
        k += std::size_t(free.count);
      });
      k = 0;
      each_free([&](const Free& free) {
        problem.velocity(free.span, free.i, numbers);
        const T* d = problem.free_of_impulses(free.span, free.i);
        for (int n = 0; n < free.count; ++n, ++k) {
          y[k] = 0;
          for (int row = 0; row < free.rows; ++row) y[k] += free.unit(n, row) * double(numbers[row] - d[row]);
        }
      });
    }

    /// λ ← λ* + s (B x − λ*), in the cones; whether they let it. `outside` has who does not.
    bool go(double s) {
      auto& search = work.search;
      std::size_t k = 0, place = 0;
      bool is_inside = true;
      search.outside.assign(search.how.size(), 0);
      T next[most_rows], inside[most_rows];
      each_free([&](const Free& free) {
        free.impulse(&search.x[k], next);
        double size = 0, apart = 0;
        for (int row = 0; row < free.rows; ++row) {
          next[row] = free.at[row] + T(s) * (next[row] - free.at[row]);
          inside[row] = next[row];
        }
        problem.clamp(free.span, free.i, inside);
        for (int row = 0; row < free.rows; ++row) {
          size += double(next[row]) * double(next[row]);
          apart += double(inside[row] - next[row]) * double(inside[row] - next[row]);
        }
        if (std::sqrt(apart) > 1e-12 * std::sqrt(size)) {
          is_inside = false;
          search.outside[place] = 1;
        }
        problem.assign(free.span, free.i, inside);
        k += std::size_t(free.count);
        ++place;
      });
      return is_inside;
    }
    /// The largest s, and who ends it is fixed from now on.
    bool go_as_far_as_the_cones() {
      double low = 0, high = 1;
      for (int k = 0; k < 30; ++k) {
        const double middle = 0.5 * (low + high);
        (go(middle) ? low : high) = middle;
      }
      go(high);
      auto& search = work.search;
      search.limiting = search.outside;
      go(low);
      std::size_t free = 0;
      for (char& how : search.how)
        if (how != fixed && search.limiting[free++]) how = fixed;
      return true;
    }

    /// Conjugate gradients from zero.
    bool find(int products) {
      auto& s = work.search;
      std::fill(s.x.begin(), s.x.end(), 0.0);
      s.r = s.b;
      s.p = s.r;
      double square = inner::sum_of_products(s.r, s.r);
      const double goal = 1e-26 * square;
      for (int k = 0; square > goal; ++k) {
        if (k == products) return false;
        multiply(s.p, s.q);
        const double curvature = inner::sum_of_products(s.p, s.q);
        if (!(curvature > 0)) return square <= 1e-20 * inner::sum_of_products(s.b, s.b);
        const double alpha = square / curvature;
        for (std::size_t n = 0; n < s.x.size(); ++n) s.x[n] += alpha * s.p[n], s.r[n] -= alpha * s.q[n];
        const double next = inner::sum_of_products(s.r, s.r), beta = next / square;
        for (std::size_t n = 0; n < s.x.size(); ++n) s.p[n] = s.r[n] + beta * s.p[n];
        square = next;
      }
      return true;
    }
  };
};

/// Around what is no solver, as in `MinimumNorm{1e-6}`, or another one; the loop's checks say so.
template <class Solver>
  requires(!inner::Fills<Solver, role::Solver, inner::layer::minimum_norm>)
struct MinimumNorm<Solver> : inner::Hollow {
  using plays = role::Solver;
  using inner::Hollow::Hollow;
};

/// `MinimumNorm{solver}`.
template <class Solver>
MinimumNorm(Solver) -> MinimumNorm<Solver>;
/// `MinimumNorm{solver, max_products}`.
template <class Solver>
MinimumNorm(Solver, int) -> MinimumNorm<Solver>;

}  // namespace delassus
