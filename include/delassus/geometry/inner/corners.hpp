/// The corners of a cell of a mesh.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace delassus::inner {

template <class Mesh>
auto corners(const Mesh& mesh, Index e) {
  const auto& cell = mesh.cells()[e];
  std::array<Vec3, std::tuple_size_v<std::remove_cvref_t<decltype(cell)>>> x;
  for (std::size_t a = 0; a < x.size(); ++a) x[a] = mesh.points[cell[a]];
  return x;
}

/// Between any two corners, diagonals too.
template <class Mesh>
double longest_edge(const Mesh& mesh, Index e) {
  const auto x = corners(mesh, e);
  double longest = 0;
  for (std::size_t a = 0; a < x.size(); ++a)
    for (std::size_t b = a + 1; b < x.size(); ++b) longest = std::max(longest, norm(x[a] - x[b]));
  return longest;
}

/// ∂x/∂ξ = Σ x_a ⊗ slope(a), slope(a) = ∂N_a/∂ξ.
template <std::size_t N>
Mat3 jacobian_of(const std::array<Vec3, N>& x, const auto& slope) {
  Mat3 J = zero<Mat3>();
  for (std::size_t a = 0; a < N; ++a) {
    const Vec3 s = slope(int(a));
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) J(i, k) += x[a][i] * s[k];
  }
  return J;
}

}  // namespace delassus::inner
