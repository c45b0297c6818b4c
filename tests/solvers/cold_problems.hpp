/// Problems from cold, and how far two solutions are apart.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>

namespace cold_problems {

using namespace delassus;

/// The problem of a step of h, from cold.
template <class Loop>
auto problem_of(Loop& loop, double h = 1.0 / 60) {
  loop.step(h);
  auto p = loop.problem();
  for_each_index<decltype(p)::Rows::pool_count>([&](auto pool) {
    for (auto& x : p.rows.template pool<pool>().lambda) x.setZero();
  });
  return p;
}

/// The largest |u_i − v_i|, m/s, of the velocities d + W λ of two problems that differ in λ.
template <class Problem>
double apart(const Problem& a, const Problem& b) {
  double most = 0;
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    for (Index i = 0; i < a.rows.template pool<p>().items(); ++i)
      most = std::max(
          most, double((a.W.template residual<p>(a.rows, i) - b.W.template residual<p>(b.rows, i)).norm()));
  });
  return most;
}

}  // namespace cold_problems
