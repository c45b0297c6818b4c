/// Anderson's mixing of the last sweeps.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// Room for the history of a solve: numbers √w_i λ_i, so that their products are energies. Reserved once for a loop's
/// largest problem, filled only by the stages that a stalled solve comes to.
struct History {
  static constexpr int depth = 5;
  Array<double> x, z, f, last_f, last_z, good, change_f[depth], change_z[depth];

  void each(auto&& apply) {
    for (auto* v : {&x, &z, &f, &last_f, &last_z, &good}) apply(*v);
    for (int k = 0; k < depth; ++k) apply(change_f[k]), apply(change_z[k]);
  }
};

inline double sum_of_products(const Array<double>& a, const Array<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// g ← (G + 1e-10 max G_kk 1)⁻¹ g by elimination; the lift keeps the pivots of a Gram matrix positive. No change, no step.
/// Plain arrays: five by five in Eigen's types would cost each program 35 MB of compiler memory.
template <int n>
void solve_gram(const double (&gram)[n][n], double (&g)[n], int count) {
  double G[n][n], largest = 0;
  for (int k = 0; k < count; ++k) largest = std::max(largest, gram[k][k]);
  if (!(largest > 0)) {
    for (int k = 0; k < count; ++k) g[k] = 0;
    return;
  }
  for (int k = 0; k < count; ++k)
    for (int j = 0; j < count; ++j) G[k][j] = gram[k][j] + (k == j ? 1e-10 * largest : 0);
  for (int k = 0; k < count; ++k)
    for (int i = k + 1; i < count; ++i) {
      const double share = G[i][k] / G[k][k];
      for (int j = k; j < count; ++j) G[i][j] -= share * G[k][j];
      g[i] -= share * g[k];
    }
  for (int k = count - 1; k >= 0; --k) {
    for (int j = k + 1; j < count; ++j) g[k] -= G[k][j] * g[j];
    g[k] /= G[k][k];
  }
}

/// x⁺ = P_K(z − Σ_k γ_k Δz_k), z = sweep(x), f = z − x, γ = argmin |f − Σ_k γ_k Δf_k| over the last five changes. When |f|
/// grew to twice its least the history is dropped and the last good z taken. A mixture ten times larger than the first z is
/// not taken: where the laws contradict each other λ has no limit, and mixing would run there at once.
/// Source: [WalkerNi2011].
void anderson(auto& problem, auto& monitor, History& h, const SweepRule& rule) {
  constexpr int depth = History::depth;
  h.each([rows = std::size_t(problem.row_count())](Array<double>& v) { v.resize(rows); });
  double gram[depth][depth] = {};
  int count = 0, place = 0;
  bool has_last = false;
  double least = 0, limit = -1;
  for (;;) {
    problem.gather(h.x);
    if (!monitor.goes_on(problem.sweep(rule))) return;
    problem.gather(h.z);
    if (limit < 0) limit = 100 * sum_of_products(h.z, h.z);
    for (std::size_t i = 0; i < h.x.size(); ++i) h.f[i] = h.z[i] - h.x[i];
    const double size = std::sqrt(sum_of_products(h.f, h.f));
    if (has_last && size > 2 * least) {
      problem.scatter(h.good);
      count = place = 0;
      has_last = false;
      continue;
    }
    least = has_last ? std::min(least, size) : size;
    h.good = h.z;
    if (has_last) {
      for (std::size_t i = 0; i < h.x.size(); ++i) {
        h.change_f[place][i] = h.f[i] - h.last_f[i];
        h.change_z[place][i] = h.z[i] - h.last_z[i];
      }
      count = std::min(count + 1, depth);
      for (int k = 0; k < count; ++k) gram[place][k] = gram[k][place] = sum_of_products(h.change_f[place], h.change_f[k]);
      place = (place + 1) % depth;
    }
    std::swap(h.last_f, h.f);
    std::swap(h.last_z, h.z);
    has_last = true;
    if (count == 0) continue;
    double gamma[depth];
    for (int k = 0; k < count; ++k) gamma[k] = sum_of_products(h.change_f[k], h.last_f);
    solve_gram(gram, gamma, count);
    h.x = h.last_z;
    for (int k = 0; k < count; ++k)
      for (std::size_t i = 0; i < h.x.size(); ++i) h.x[i] -= gamma[k] * h.change_z[k][i];
    if (sum_of_products(h.x, h.x) <= limit) problem.scatter(h.x);
  }
}

}  // namespace delassus::inner
