/// Newton's method in the impulses of an island, on flat arrays.
#pragma once

#include "island.hpp"

#include <delassus/linear/dense_elimination.hpp>
#include <delassus/solvers/solve_report.hpp>

namespace light {

/// λ meets all laws where F = λ − Λ = 0: Λ is what meets them with w 1 in the place of each W_ii, for the
/// present u = d + W λ. With D = diag(w_i 1) and S = −∂Λ/∂u from the laws' second table,
///
///   (1 + S (W − D + ε D)) δ = −F,   λ ← λ + t δ,   t halved until Σ w |F|² falls,
///
/// where ε makes the matrix regular for rows that depend on each other and leaves F as it is; it grows where
/// no step falls. Source: [QiSun1993] for the method, [AcaryBremondHuber2018] for it on contacts.
struct Newton {
  double tolerance = 1e-10;
  int max_iterations = 50;
  bool is_convex = false;  ///< with the slip of the last iterate given

  /// Status `stalled`, without a factorization, where a law has no tangent.
  template <class T>
  SolveReport solve(Island<T>& island) const;

 private:
  template <class T>
  struct Space {
    Array<T> u, before, answer, slope, lambda, trial;
    Array<Index> slope_at;  ///< by item, counted through the pools
    Array<double> step;
    DenseElimination matrix;
  };
  static constexpr double least_epsilon = 1e-10, most_epsilon = 10;

  template <class T>
  double evaluate(Island<T>& island, Space<T>& s) const;
  template <class T>
  bool descend(Island<T>& island, Space<T>& s, double size) const;
  template <class T>
  static bool find_step(Island<T>& island, Space<T>& s, double epsilon);
};

template <class T>
SolveReport Newton::solve(Island<T>& island) const {
  SolveReport report{.status = Status::stalled, .measure = island.measure(), .ended_by = "newton"};
  for (const auto& part : island.parts())
    if (!part.pool->newton) return report;
  const Rows<T>& rows = island.rows();
  Space<T> s;
  s.slope_at.assign(1, 0);
  for (Index i = 0; i < rows.items(); ++i)
    s.slope_at.push_back(s.slope_at.back() + rows.rows_of(i) * rows.rows_of(i));
  s.slope.resize(std::size_t(s.slope_at.back()));
  for (auto* x : {&s.answer, &s.trial}) x->resize(rows.lambda.size());
  double epsilon = 1e-6;
  while (report.factorizations < max_iterations && report.measure.residual > tolerance &&
         epsilon <= most_epsilon) {
    island.velocities(s.before);
    const double size = evaluate(island, s);
    if (!find_step(island, s, epsilon)) break;
    ++report.factorizations;
    epsilon = descend(island, s, size) ? std::max(0.1 * epsilon, least_epsilon) : 100 * epsilon;
    report.measure = island.measure();
  }
  if (report.measure.residual <= tolerance) report.status = Status::converged;
  return report;
}

/// Λ and S at the present λ; √Σ w |λ − Λ|².
template <class T>
double Newton::evaluate(Island<T>& island, Space<T>& s) const {
  island.velocities(s.u);
  for (const auto& part : island.parts()) {
    const Index row = part.pool->first_row;
    T *const answer = s.answer.data() + row, *const slope =
                                                 s.slope.data() + s.slope_at[part.pool->first_item];
    const NewtonTable<T>& law = *part.pool->newton;
    if (is_convex)
      law.convex_tangent(*part.pool, part.span, s.u.data() + row, s.before.data() + row, answer, slope);
    else
      law.tangent(*part.pool, part.span, s.u.data() + row, answer, slope);
  }
  double sum = 0;
  for (const Index r : island.order()) {
    const double gap = double(island.rows().lambda[r] - s.answer[r]);
    sum += double(island.compliance().weight(r)) * gap * gap;
  }
  return std::sqrt(sum);
}

/// Along the step; back to where it began if F falls nowhere.
template <class T>
bool Newton::descend(Island<T>& island, Space<T>& s, double size) const {
  island.save(s.lambda);
  for (double t = 1; t > 1e-4; t *= 0.5) {
    std::size_t n = 0;
    for (const Index r : island.order()) s.trial[r] = s.lambda[r] + T(t * s.step[n++]);
    island.load(s.trial);
    if (evaluate(island, s) < size) return true;
  }
  island.load(s.lambda);
  return false;
}

/// The matrix column by column, W's from its one primitive: what an impulse of one does to the velocities.
template <class T>
bool Newton::find_step(Island<T>& island, Space<T>& s, double epsilon) {
  Rows<T>& rows = island.rows();
  Delassus<T>& W = island.compliance();
  const Array<T> lambda = rows.lambda, d = rows.d;
  for (auto* x : {&rows.lambda, &rows.d}) x->assign(x->size(), T(0));
  s.matrix.resize(Index(island.row_count()));
  Index column = 0;
  for (const Index r : island.order()) {
    rows.lambda[r] = T(1);
    W.reset();
    island.velocities(s.u);
    rows.lambda[r] = T(0);
    s.u[r] -= T(1 - epsilon) * W.weight(r);
    Index line = 0;
    for (const auto& part : island.parts())
      for (Index n = 0; n < part.span.count; ++n) {
        const int R = part.pool->sweeping->rows;
        const Index item = part.pool->first_item + part.span.items[n], first = rows.row[item];
        const T* const slope = s.slope.data() + s.slope_at[item];
        for (int k = 0; k < R; ++k, ++line) {
          double sum = first + k == r ? 1 : 0;
          for (int c = 0; c < R; ++c) sum += double(slope[k + R * c]) * double(s.u[first + c]);
          s.matrix.at(line, column) = sum;
        }
      }
    ++column;
  }
  rows.lambda = lambda;
  rows.d = d;
  W.reset();
  s.step.clear();
  for (const Index r : island.order()) s.step.push_back(double(s.answer[r] - rows.lambda[r]));
  if (!s.matrix.factor()) return false;
  s.matrix.solve(s.step);
  return true;
}

}  // namespace light
