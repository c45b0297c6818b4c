/// C ← C − A Bᵀ for dense columns, in tiles that stay in registers: the inner loop of a multifrontal
/// factorization.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace delassus::inner {

/// A dense matrix stored by columns: entry (i, j) is data[i + j stride].
template <class T>
struct Columns {
  T* data = nullptr;
  std::size_t stride = 0;

  T* at(Index i, Index j) const { return data + i + std::size_t(j) * stride; }
  Columns from(Index i, Index j) const { return {at(i, j), stride}; }
};

/// Packs A and B into strips and multiplies tile by tile. The buffers keep their capacity: a warm call
/// allocates nothing.
template <class T>
class DenseKernel {
  using Packet = typename Eigen::internal::packet_traits<T>::type;
  static constexpr Index lanes = Eigen::internal::unpacket_traits<Packet>::size;
  /// Twelve sums in sixteen registers, or twenty-four in thirty-two.
  static constexpr Index tile_rows = 3 * lanes,
                         tile_columns = EIGEN_ARCH_DEFAULT_NUMBER_OF_REGISTERS >= 32 ? 8 : 4;
  static constexpr Index depth = 128;  ///< columns of A packed at a time

 public:
  /// C −= A Bᵀ, C is m × n, A is m × k, B is n × k. With `is_lower` only entries i ≥ j are needed (others may
  /// change).
  void subtract(Columns<T> C, Columns<const T> A, Columns<const T> B, Index m, Index n, Index k,
                bool is_lower) {
    multiply(C, A, B, m, n, k, is_lower, false);
  }
  /// C = −A Bᵀ, likewise, k > 0: what C was is not read.
  void negated_product(Columns<T> C, Columns<const T> A, Columns<const T> B, Index m, Index n, Index k,
                       bool is_lower) {
    multiply(C, A, B, m, n, k, is_lower, true);
  }

  /// The first `columns` columns of the m × columns matrix C become those of its Cholesky factor; false when
  /// a pivot is not positive. By halves: left half, its product off the right half, right half.
  bool factor(Columns<T> C, Index m, Index columns) {
    if (columns <= 4) return factor_narrow(C, m, columns);
    const Index half = (columns / 2 + 3) / 4 * 4;
    if (!factor(C, m, half)) return false;
    const Columns<const T> below{C.at(half, 0), C.stride};
    subtract(C.from(half, half), below, below, m - half, columns - half, half, true);
    return factor(C.from(half, half), m - half, columns - half);
  }

  /// Y ← Y L⁻ᵀ, Y is m × k, L is k × k lower.
  void solve_right(Columns<T> Y, Columns<const T> L, Index m, Index k) {
    if (k <= 4) return solve_right_narrow(Y, L, m, k);
    const Index half = (k / 2 + 3) / 4 * 4;
    solve_right(Y, L, m, half);
    subtract(Y.from(0, half), {Y.data, Y.stride}, L.from(half, 0), m, k - half, half, false);
    solve_right(Y.from(0, half), L.from(half, half), m, k - half);
  }

 private:
  void multiply(Columns<T> C, Columns<const T> A, Columns<const T> B, Index m, Index n, Index k,
                bool is_lower, bool is_new) {
    for (Index done = 0; done < k; done += depth) {
      const Index width = std::min(depth, k - done);
      pack<tile_rows>(a_, A.from(0, done), m, width);
      pack<tile_columns>(b_, B.from(0, done), n, width);
      for (Index i = 0; i < m; i += tile_rows) {
        const Index last = is_lower ? std::min(n, i + tile_rows) : n;
        for (Index j = 0; j < last; j += tile_columns)
          tile(C.from(i, j), std::min(tile_rows, m - i), std::min(tile_columns, n - j),
               &a_[std::size_t(i) * width], &b_[std::size_t(j) * width], width, is_new && done == 0);
      }
    }
  }

  using Line = Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>;
  using ConstLine = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>;

  /// Strips of `height` rows, each column by column; missing rows are zero.
  template <Index height>
  static void pack(std::vector<T>& to, Columns<const T> from, Index rows, Index columns) {
    const Index strips = (rows + height - 1) / height;
    if (to.size() < std::size_t(strips) * height * columns) to.resize(std::size_t(strips) * height * columns);
    T* p = to.data();
    for (Index i = 0; i < rows; i += height) {
      const Index there = std::min(height, rows - i);
      for (Index j = 0; j < columns; ++j, p += height) {
        const T* source = from.at(i, j);
        if (there == height) {
          for (Index r = 0; r < height; ++r) p[r] = source[r];
        } else {
          for (Index r = 0; r < there; ++r) p[r] = source[r];
          for (Index r = there; r < height; ++r) p[r] = T(0);
        }
      }
    }
  }

  /// One tile of C −= a bᵀ, or of C = −a bᵀ, over packed strips; a tile at the edge goes through a copy.
  static void tile(Columns<T> C, Index rows, Index columns, const T* a, const T* b, Index k, bool is_new) {
    using namespace Eigen::internal;
    Packet s[tile_columns][3];
    for (auto& column : s)
      for (Packet& p : column) p = pset1<Packet>(T(0));
    for (Index l = 0; l < k; ++l, a += tile_rows, b += tile_columns) {
      const Packet a0 = ploadu<Packet>(a), a1 = ploadu<Packet>(a + lanes), a2 = ploadu<Packet>(a + 2 * lanes);
      for (int c = 0; c < tile_columns; ++c) {
        const Packet x = pset1<Packet>(b[c]);
        s[c][0] = pmadd(a0, x, s[c][0]);
        s[c][1] = pmadd(a1, x, s[c][1]);
        s[c][2] = pmadd(a2, x, s[c][2]);
      }
    }
    if (rows == tile_rows && columns == tile_columns) {
      for (int c = 0; c < tile_columns; ++c)
        for (int r = 0; r < 3; ++r) {
          T* to = C.at(r * lanes, c);
          pstoreu(to, is_new ? pnegate(s[c][r]) : psub(ploadu<Packet>(to), s[c][r]));
        }
      return;
    }
    T edge[tile_columns * tile_rows];
    for (int c = 0; c < tile_columns; ++c)
      for (int r = 0; r < 3; ++r) pstoreu(edge + c * tile_rows + r * lanes, s[c][r]);
    for (Index c = 0; c < columns; ++c) {
      T* to = C.at(0, c);
      for (Index r = 0; r < rows; ++r) to[r] = (is_new ? T(0) : to[r]) - edge[c * tile_rows + r];
    }
  }

  static bool factor_narrow(Columns<T> C, Index m, Index columns) {
    for (Index j = 0; j < columns; ++j) {
      Line column(C.at(j, j), m - j);
      for (Index k = 0; k < j; ++k) column -= *C.at(j, k) * ConstLine(C.at(j, k), m - j);
      const T pivot = column[0];
      if (!(pivot > T(0)) || !std::isfinite(pivot)) return false;
      column *= T(1) / std::sqrt(pivot);
    }
    return true;
  }

  static void solve_right_narrow(Columns<T> Y, Columns<const T> L, Index m, Index k) {
    for (Index j = 0; j < k; ++j) {
      Line y(Y.at(0, j), m);
      for (Index i = 0; i < j; ++i) y -= *L.at(j, i) * ConstLine(Y.at(0, i), m);
      y *= T(1) / *L.at(j, j);
    }
  }

  std::vector<T> a_, b_;
};

}  // namespace delassus::inner
