/// Solving with the factor of a body's A, some of whose nodes are held.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

namespace delassus::inner {

/// Which nodes of a body are held: they answer to nothing. Where A has no factor every answer is a number
/// that is none, and the body stays where it was.
struct HeldNodes {
  std::span<const char> is_held;
  bool is_factored;

  /// x ← A⁻¹ x on the body's blocks; held nodes become zero. A body on which nothing acts is passed over.
  /// `by`: who solves, if not one worker.
  template <class Matrix, class Velocity, class... By>
  void solve(const Matrix& A, std::span<const Index> blocks, Array<Velocity>& work, std::span<Velocity> x,
             By&... by) const {
    bool is_still = true;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (is_held[k]) x[blocks[k]].setZero();
      work[k] = x[blocks[k]];
      is_still = is_still && is_zero(work[k]);
    }
    if (is_still) return;
    if (is_factored)
      A.solve(work, by...);
    else
      for (Velocity& w : work) w.setConstant(std::numeric_limits<typename Velocity::Scalar>::quiet_NaN());
    for (std::size_t k = 0; k < blocks.size(); ++k)
      if (!is_held[k]) x[blocks[k]] = work[k];
  }

  /// The rows and columns of A⁻¹ of n nodes, (width n) × (width n) by columns; those of held nodes are zero.
  template <int width, class Matrix, class T, class... By>
  void compliance(const Matrix& A, std::span<const Index> nodes, std::span<T> C, By&... by) const {
    if (!is_factored) {
      std::fill(C.begin(), C.end(), std::numeric_limits<T>::quiet_NaN());
      return;
    }
    A.compliance(nodes, C, by...);
    const std::size_t rows = width * nodes.size();
    for (std::size_t i = 0; i < rows; ++i) {
      if (!is_held[nodes[i / width]]) continue;
      for (std::size_t j = 0; j < rows; ++j) C[i + rows * j] = C[j + rows * i] = T(0);
    }
  }
};

}  // namespace delassus::inner
