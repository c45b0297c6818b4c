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
    Array<Index> number;    ///< by row, in the matrix
    Array<double> step;
    DenseElimination matrix;
  };
  static constexpr double least_epsilon = 1e-10, most_epsilon = 10;

  template <class T>
  static bool differentiates(const Island<T>& island) {
    for (const auto& part : island.parts())
      if (!part.pool->newton) return false;
    return true;
  }
  template <class T>
  static void make_room(Island<T>& island, Space<T>& s);
  template <class T>
  double evaluate(Island<T>& island, Space<T>& s) const;
  template <class T>
  static bool find_step(Island<T>& island, Space<T>& s, double epsilon);
};

template <class T>
SolveReport Newton::solve(Island<T>& island) const {
  SolveReport report{.measure = island.measure(), .ended_by = "newton"};
  if (!differentiates(island)) return report.status = Status::stalled, report;
  Space<T> s;
  make_room(island, s);
  double epsilon = 1e-6;
  while (report.factorizations < max_iterations && report.measure.residual > tolerance &&
         epsilon <= most_epsilon) {
    island.velocities(s.before);
    const double size = evaluate(island, s);
    if (!find_step(island, s, epsilon)) break;
    ++report.factorizations;
    island.save(s.lambda);
    bool falls = false;
    for (double t = 1; t > 1e-4 && !falls; t *= 0.5) {
      island.each([&](const auto& part, Index, Index row) {
        for (int r = 0; r < part.pool->sweeping->rows; ++r)
          s.trial[row + r] = s.lambda[row + r] + T(t * s.step[s.number[row + r]]);
      });
      island.load(s.trial);
      falls = evaluate(island, s) < size;
    }
    if (!falls) island.load(s.lambda);
    epsilon = falls ? std::max(0.1 * epsilon, least_epsilon) : 100 * epsilon;
    report.measure = island.measure();
  }
  report.status = report.measure.residual <= tolerance ? Status::converged : Status::stalled;
  return report;
}

template <class T>
void Newton::make_room(Island<T>& island, Space<T>& s) {
  const Rows<T>& rows = island.rows();
  for (auto* x : {&s.answer, &s.trial}) x->assign(rows.lambda.size(), T(0));
  s.number.assign(rows.lambda.size(), -1);
  s.slope_at.assign(std::size_t(rows.items()) + 1, 0);
  for (Index i = 0; i < rows.items(); ++i)
    s.slope_at[i + 1] = s.slope_at[i] + rows.rows_of(i) * rows.rows_of(i);
  s.slope.assign(std::size_t(s.slope_at.back()), T(0));
  Index count = 0;
  island.each([&](const auto& part, Index, Index row) {
    for (int k = 0; k < part.pool->sweeping->rows; ++k) s.number[row + k] = count++;
  });
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
  island.each([&](const auto& part, Index i, Index row) {
    double square = 0;
    for (int k = 0; k < part.pool->sweeping->rows; ++k) {
      const double gap = double(island.rows().lambda[row + k] - s.answer[row + k]);
      square += gap * gap;
    }
    sum += double(island.weight(part, i)) * square;
  });
  return std::sqrt(sum);
}

/// The matrix column by column, W's from its one primitive: what an impulse of one does to the velocities.
template <class T>
bool Newton::find_step(Island<T>& island, Space<T>& s, double epsilon) {
  const Index n = Index(island.row_count());
  Rows<T>& rows = island.rows();
  s.matrix.resize(n);
  s.step.resize(std::size_t(n));
  const Array<T> lambda = rows.lambda, d = rows.d;
  for (auto* x : {&rows.lambda, &rows.d}) x->assign(x->size(), T(0));
  island.compliance().reset();
  Array<T> column;
  for (Index r = 0; r < Index(rows.lambda.size()); ++r) {
    if (s.number[r] < 0) continue;
    rows.lambda[r] = T(1);
    island.compliance().reset();
    island.velocities(column);
    rows.lambda[r] = T(0);
    island.each([&](const auto& part, Index i, Index row) {
      const int R = part.pool->sweeping->rows;
      const T* const slope = s.slope.data() + s.slope_at[part.pool->first_item + i];
      const bool is_own = r >= row && r < row + R;
      if (is_own) column[r] -= T(1 - epsilon) * island.weight(part, i);
      for (int k = 0; k < R; ++k) {
        double sum = r == row + k ? 1 : 0;
        for (int c = 0; c < R; ++c) sum += double(slope[k + R * c]) * double(column[row + c]);
        s.matrix.at(s.number[row + k], s.number[r]) = sum;
      }
    });
  }
  rows.lambda = lambda;
  rows.d = d;
  island.compliance().reset();
  for (Index r = 0; r < Index(rows.lambda.size()); ++r)
    if (s.number[r] >= 0) s.step[s.number[r]] = double(s.answer[r] - rows.lambda[r]);
  if (!s.matrix.factor()) return false;
  s.matrix.solve(s.step);
  return true;
}

}  // namespace light
