/// Loads of small islands that the motion alone does not decide.
#pragma once

#include <delassus/solvers/inner/least_impulses.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>

namespace delassus::inner {

/// Room for it, and how far it is in a solve.
template <class T>
struct SettleSpace {
  LeastImpulsesSpace<T> least;
  Array<T> solved_before;
  SolveReport before;
  int rounds = 0, sweeps = 0;  ///< of solves so far

  void reserve(Index rows) {
    const Index small = std::min(rows, Index(6 * 16));  // larger islands are asked for by name
    least.reserve(small);
    solved_before.reserve(std::size_t(small));
  }
};

/// What an island is made of, as far as its loads ask.
struct Closed {
  int contacts = 0, others = 0, rows = 0;
};
template <class T>
Closed closed_items(const Island<T>& problem) {
  Closed out;
  for (const Span<T>& span : problem) {
    (span.pool->table->friction ? out.contacts : out.others) += int(span.count);
    out.rows += int(span.count) * span.pool->rows;
  }
  return out;
}

/// Three contacts with friction have as many; fewer share no load in several ways.
inline constexpr int fewest_rows_of_loads = 9;

/// Whether some contact's friction is as large as it may be, as where it slips.
template <class T>
bool some_may_slip(const Island<T>& problem) {
  for (const Span<T>& span : problem) {
    if (!span.pool->table->friction) continue;
    for (const Index i : span) {
      const T* lambda = problem.impulse(span, i);
      const double most = 0.999 * span.pool->table->friction(*span.pool, i) * double(lambda[0]);
      if (lambda[0] > 0 && most > 0 && double(lambda[1]) * double(lambda[1]) + double(lambda[2]) * double(lambda[2]) >= most * most) return true;
    }
  }
  return false;
}

/// Several closed contacts may share a load in many ways, and which one sweeps find depends on their order. Where something
/// slips that decides the motion: each belt under a parcel pulls as hard as the parcel presses on it. Then the loads are those
/// of a compliance that vanishes, and the problem is solved again with them. Where a machine stands on its contacts that decides
/// what its joints bear: the impulses are the least of all then. `most` is the largest number of contacts of an island that is
/// asked. Returns whether to solve again from λ.
template <class T>
bool settle_loads(Island<T>& problem, SettleSpace<T>& work, int most, const SolveOptions& limits, SolveReport& report) {
  constexpr int most_rounds = 3, most_products = 200;
  constexpr double least_way = 1e-4;  // of |λ|; what is nearer is not solved again
  if (problem.row_count() < fewest_rows_of_loads) return false;
  const Closed closed = closed_items(problem);
  if (closed.contacts < 3 || closed.contacts > most || closed.rows > 6 * most) return false;
  if (closed.others == 0 && !some_may_slip(problem)) return false;
  if (report.status > Status::stalled || problem.is_out_of_time() || !problem.has_time_for(closed.rows)) return false;
  LeastImpulses<T> least(problem, work.least);
  least.sort(report.measure);
  if (least.contacts() < 3) return false;
  report.are_loads_decided = least.slipping() > 0 || closed.others > 0;
  if (least.slipping() > 0 && work.rounds < most_rounds) {
    if (least.share(most_products) > least_way) {
      ++work.rounds;
      work.sweeps = report.sweeps;
      work.before = report;
      work.solved_before = work.least.solved;
      return true;
    }
    problem.load(work.least.solved);
  }
  if (closed.others == 0) return false;
  least.sort(report.measure);
  for (int round = 0; round < 4; ++round)
    if (!least.shrink(most_products)) break;
  if (!least.keep(limits, report)) report.are_loads_decided = false;
  return false;
}

}  // namespace delassus::inner
