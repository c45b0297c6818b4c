/// Anderson's mixing of the last sweeps, and conjugate directions over damped ones.
#pragma once

#include <delassus/math/positive.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace delassus::inner {

/// Room for the history of a solve: numbers √w_i λ_i, so that their products are energies. Reserved once for a loop's
/// largest problem, filled only by the stages that a stalled solve comes to.
struct History {
  static constexpr int depth = 5;
  std::vector<double> x, z, f, last_f, last_z, good, change_f[depth], change_z[depth];

  template <class F>
  void each(F&& apply) {
    for (auto* v : {&x, &z, &f, &last_f, &last_z, &good}) apply(*v);
    for (int k = 0; k < depth; ++k) apply(change_f[k]), apply(change_z[k]);
  }
  void reserve(std::size_t rows) {
    each([&](std::vector<double>& v) { v.reserve(rows); });
  }
  void resize(std::size_t rows) {
    each([&](std::vector<double>& v) { v.resize(rows); });
  }
};

inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// x⁺ = P_K(z − Σ_k γ_k Δz_k), z = sweep(x), f = z − x, γ = argmin |f − Σ_k γ_k Δf_k| over the last five changes. When |f|
/// grew to twice its least the history is dropped and the last good z taken. A mixture ten times larger than the first z is
/// not taken: where the laws contradict each other λ has no limit, and mixing would run there at once.
/// Source: [WalkerNi2011].
template <class Problem, class Pursuit, class Sweep>
void anderson(Problem& problem, Pursuit& pursuit, History& h, Sweep&& sweep) {
  constexpr int depth = History::depth;
  h.resize(std::size_t(problem.row_count()));
  Mat<depth, depth> gram = Mat<depth, depth>::Zero();
  int count = 0, place = 0;
  bool has_last = false;
  double least = 0, limit = -1;
  for (;;) {
    problem.gather(h.x);
    sweep();
    if (!pursuit.goes_on()) return;
    problem.gather(h.z);
    if (limit < 0) limit = 100 * dot(h.z, h.z);
    for (std::size_t i = 0; i < h.x.size(); ++i) h.f[i] = h.z[i] - h.x[i];
    const double size = std::sqrt(dot(h.f, h.f));
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
      for (int k = 0; k < count; ++k) gram(place, k) = gram(k, place) = dot(h.change_f[place], h.change_f[k]);
      place = (place + 1) % depth;
    }
    std::swap(h.last_f, h.f);
    std::swap(h.last_z, h.z);
    has_last = true;
    if (count == 0) continue;
    Mat<depth, depth> G = Mat<depth, depth>::Identity();
    Vec<depth> g = Vec<depth>::Zero();
    double largest = 0;
    for (int k = 0; k < count; ++k) largest = std::max(largest, gram(k, k));
    for (int k = 0; k < count; ++k) {
      for (int j = 0; j < count; ++j) G(k, j) = gram(k, j);
      G(k, k) += 1e-10 * largest;
      g[k] = dot(h.change_f[k], h.last_f);
    }
    const Vec<depth> gamma = inverse_of_positive(G) * g;
    h.x = h.last_z;
    for (int k = 0; k < count; ++k)
      for (std::size_t i = 0; i < h.x.size(); ++i) h.x[i] -= gamma[k] * h.change_z[k][i];
    if (dot(h.x, h.x) <= limit) problem.scatter(h.x);
  }
}

/// x⁺ = P_K(z + β p), p⁺ = β p + g, g = z − x, β = |g|²/|g₋|², dropped when β > 1. Source: [SilcowitzNiebeErleben2010].
template <class Problem, class Pursuit, class Sweep>
void conjugate_directions(Problem& problem, Pursuit& pursuit, History& h, Sweep&& sweep) {
  h.resize(std::size_t(problem.row_count()));
  auto& direction = h.good;
  std::fill(direction.begin(), direction.end(), 0.0);
  double last = 0, limit = -1;
  for (;;) {
    problem.gather(h.x);
    sweep();
    if (!pursuit.goes_on()) return;
    problem.gather(h.z);
    if (limit < 0) limit = 100 * dot(h.z, h.z);
    for (std::size_t i = 0; i < h.x.size(); ++i) h.f[i] = h.z[i] - h.x[i];
    const double square = dot(h.f, h.f), beta = last > 0 ? square / last : 0;
    last = square;
    if (beta > 1) {
      std::fill(direction.begin(), direction.end(), 0.0);
      continue;
    }
    for (std::size_t i = 0; i < h.x.size(); ++i) {
      h.z[i] += beta * direction[i];
      direction[i] = beta * direction[i] + h.f[i];
    }
    if (dot(h.z, h.z) <= limit) problem.scatter(h.z);
  }
}

}  // namespace delassus::inner
