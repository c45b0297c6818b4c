/// C ← C − A Bᵀ, Y ← Y L⁻ᵀ and L Lᵀ = C for dense columns, in tiles that stay in registers: the inner loops
/// of a multifrontal factorization.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/packet.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace delassus::inner {

/// A dense matrix stored by columns: entry (i, j) is data[i + j stride].
template <class T>
struct Columns {
  T* data = nullptr;
  std::size_t stride = 0;

  T* at(Index i, Index j) const { return data + i + std::size_t(j) * stride; }
  Columns from(Index i, Index j) const { return {at(i, j), stride}; }
};

/// Packs what it multiplies into strips of a few rows, each column by column, and works strip by strip,
/// `panel` columns of the result at a time. The buffers keep their capacity: a warm call allocates nothing.
template <class T>
class DenseKernel {
  using Packet = delassus::Packet<T>;
  static constexpr Index lanes = packet_size<T>;
  static constexpr Index depth = 128;  ///< columns of A packed at a time

 public:
  /// Twelve sums in sixteen registers, or twenty-four in thirty-two.
  static constexpr Index strip = 3 * lanes, panel = packet_registers >= 32 ? 8 : 4;

  /// Matrices with so many rows allocate nothing from now on.
  void reserve(Index rows) {
    fit(a_, rounded_up(rows, lanes) * depth);
    fit(b_, std::max(rounded_up(rows, panel), depth + panel) * depth);
  }
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
  /// a pivot is not positive.
  bool factor(Columns<T> C, Index m, Index columns) {
    if (!factor_square(C, columns)) return false;
    solve_right(C.from(columns, 0), {C.data, C.stride}, m - columns, columns);
    return true;
  }

  /// Columns of the left half of n.
  static constexpr Index half_of(Index n) { return rounded_up(n / 2, panel); }
  /// L Lᵀ = C, n × n, by halves: left half, what is below it, its product off the right half, right half.
  bool factor_square(Columns<T> C, Index n) {
    if (n <= panel) return factor_narrow(C, n);
    const Index half = half_of(n);
    if (!factor_square(C, half)) return false;
    const Columns<const T> below{C.at(half, 0), C.stride};
    solve_right(C.from(half, 0), {C.data, C.stride}, n - half, half);
    subtract(C.from(half, half), below, below, n - half, n - half, half, true);
    return factor_square(C.from(half, half), n - half);
  }

  /// Y ← Y L⁻ᵀ, Y is m × k, L is k × k lower: by halves, whose product comes off the right half, until a
  /// triangle fits into the cache.
  void solve_right(Columns<T> Y, Columns<const T> L, Index m, Index k) {
    if (k <= depth) return solve_by_strips(Y, L, m, k);
    const Index half = half_of(k);
    solve_right(Y, L, m, half);
    subtract(Y.from(0, half), {Y.data, Y.stride}, L.from(half, 0), m, k - half, half, false);
    solve_right(Y.from(0, half), L.from(half, half), m, k - half);
  }

  /// Y ← Y L⁻ᵀ, then G = −Y Bᵀ and C −= Y Yᵀ, in C only entries i ≥ j: Y is m × k, L is k × k lower, B is n ×
  /// k. The three share one packing of Y.
  void solve_and_multiply(Columns<T> Y, Columns<const T> L, Columns<const T> B, Columns<T> G, Columns<T> C,
                          Index m, Index n, Index k) {
    const Columns<const T> solved{Y.data, Y.stride};
    if (k > depth) {
      solve_right(Y, L, m, k);
      negated_product(G, solved, B, m, n, k, false);
      subtract(C, solved, solved, m, m, k, true);
      return;
    }
    solve_by_strips(Y, L, m, k);
    multiply_packed(G, B, m, n, k, false, true);
    multiply_packed(C, solved, m, m, k, true, false);
  }

 private:
  /// f with as many packets as the rows that are left take, three at most.
  static void with_packets(Index rows, auto&& f) {
    if (rows > 2 * lanes)
      f(std::integral_constant<int, 3>{});
    else if (rows > lanes)
      f(std::integral_constant<int, 2>{});
    else
      f(std::integral_constant<int, 1>{});
  }
  static void fit(Array<T>& to, Index size) {
    if (to.size() < std::size_t(size)) to.resize(std::size_t(size));
  }
  static constexpr Index rounded_up(Index n, Index grain) { return (n + grain - 1) / grain * grain; }

  void multiply(Columns<T> C, Columns<const T> A, Columns<const T> B, Index m, Index n, Index k,
                bool is_lower, bool is_new) {
    for (Index done = 0; done < k; done += depth) {
      const Index width = std::min(depth, k - done);
      fit(a_, rounded_up(m, lanes) * width);
      pack<strip, lanes>(a_.data(), A.from(0, done), m, width);
      multiply_packed(C, B.from(0, done), m, n, width, is_lower, is_new && done == 0);
    }
  }

  /// C −= A Bᵀ or C = −A Bᵀ with the k ≤ depth columns of A that are packed.
  void multiply_packed(Columns<T> C, Columns<const T> B, Index m, Index n, Index k, bool is_lower,
                       bool is_new) {
    fit(b_, rounded_up(n, panel) * k);
    pack<panel, panel>(b_.data(), B, n, k);
    for (Index i = 0; i < m; i += strip)
      with_packets(m - i, [&]<int packets>(std::integral_constant<int, packets>) {
        const Index rows = std::min(strip, m - i), last = is_lower ? std::min(n, i + rows) : n;
        const T* a = &a_[std::size_t(i) * k];
        for (Index j = 0; j < last; j += panel) {
          // What lies above the diagonal is left out by packets of rows.
          const Index above = is_lower && j > i ? (j - i) / lanes * lanes : 0;
          with_packets(rows - above, [&]<int used>(std::integral_constant<int, used>) {
            if constexpr (used <= packets)
              tile<used, packets * lanes>(C.from(i + above, j), rows - above, std::min(panel, n - j),
                                          a + above, &b_[std::size_t(j) * k], k, is_new);
          });
        }
      });
  }

  /// Strips of `height` rows, each column by column; the last one has its rows rounded up to a multiple of
  /// `grain`, and zeros for those that are missing.
  template <Index height, Index grain>
  static void pack(T* to, Columns<const T> from, Index rows, Index columns) {
    const Index whole = rows / height * height, there = rows - whole, high = rounded_up(there, grain);
    for (Index i = 0; i < whole; i += height, to += columns * height)
      for (Index j = 0; j < columns; ++j) copy_strip<height>(from.at(i, j), to + j * height);
    if (there == 0) return;
    for (Index j = 0; j < columns; ++j) {
      T* const last = to + j * high;
      std::copy_n(from.at(whole, j), there, last);
      std::fill_n(last + there, high - there, T(0));
    }
  }

  /// std::copy_n of more than a few numbers is a call.
  template <Index height>
  static void copy_strip(const T* from, T* to) {
    if constexpr (height % lanes == 0)
      for (Index i = 0; i < height; i += lanes) store_packet(to + i, load_packet(from + i));
    else
      std::copy_n(from, height, to);
  }

  /// −L by panels of rows, each column by column up to the panel's square, in which 1/L_ii is on the
  /// diagonal; zero above it and for rows beyond k.
  void pack_triangle(Columns<const T> L, Index k) {
    // Before the panel with row i are those of panel, 2 panel, … i columns.
    const auto start = [](Index i) { return i * (i + panel) / 2; };
    const Index size = start(rounded_up(k, panel));
    fit(b_, size);
    std::fill_n(b_.begin(), size, T(0));
    for (Index j = 0; j < k; ++j) {
      const T* source = L.at(0, j);
      const Index square = j / panel * panel;
      for (Index i = square; i < k; i += panel) {
        T* p = &b_[start(i) + j * panel];
        const Index first = i == square ? j + 1 - i : 0, last = std::min(panel, k - i);
        if (last - first == panel) {
          for (Index r = 0; r < panel; ++r) p[r] = -source[i + r];
        } else {
          for (Index r = first; r < last; ++r) p[r] = -source[i + r];
        }
      }
      b_[start(square) + j * panel + (j - square)] = T(1) / source[j];
    }
  }

  /// One tile of C −= a bᵀ, or of C = −a bᵀ, over packed strips, a's of `high` rows; a tile at the edge goes
  /// through a copy.
  template <int packets, int high>
  static void tile(Columns<T> C, Index rows, Index columns, const T* a, const T* b, Index k, bool is_new) {
    Packet s[panel][packets];
    for (auto& column : s)
      for (Packet& p : column) p = Packet{};
    for (Index l = 0; l < k; ++l, a += high, b += panel) add_products<packets>(s, a, b);
    if (rows == packets * lanes && columns == panel) {
      for (int c = 0; c < panel; ++c)
        for (int r = 0; r < packets; ++r) {
          T* to = C.at(r * lanes, c);
          store_packet(to, is_new ? -s[c][r] : load_packet(to) - s[c][r]);
        }
      return;
    }
    T edge[panel][packets * lanes];
    for (int c = 0; c < panel; ++c)
      for (int r = 0; r < packets; ++r) store_packet(edge[c] + r * lanes, s[c][r]);
    for (Index c = 0; c < columns; ++c) {
      T* to = C.at(0, c);
      for (Index r = 0; r < rows; ++r) to[r] = (is_new ? T(0) : to[r]) - edge[c][r];
    }
  }

  /// s += a bᵀ of one column of a strip and one of a panel.
  template <int packets>
  static void add_products(Packet (&s)[panel][packets], const T* a, const T* b) {
    Packet x[packets];
    for (int r = 0; r < packets; ++r) x[r] = load_packet(a + r * lanes);
    for (int c = 0; c < panel; ++c) {
      const T y = b[c];
      for (int r = 0; r < packets; ++r) s[c][r] = x[r] * y + s[c][r];
    }
  }

  /// Y ← Y L⁻ᵀ, which stays packed as well. Of a strip of rows, by panels of columns from left to right:
  ///
  ///   Y_p ← (Y_p − Σ_{l<p} Y_l L_plᵀ) L_pp⁻ᵀ.
  void solve_by_strips(Columns<T> Y, Columns<const T> L, Index m, Index k) {
    pack_triangle(L, k);
    fit(a_, rounded_up(m, lanes) * k);
    for (Index i = 0; i < m; i += strip)
      with_packets(m - i, [&]<int packets>(std::integral_constant<int, packets>) {
        solve_strip<packets>(Y.from(i, 0), &a_[std::size_t(i) * k], std::min(strip, m - i), k);
      });
  }

  /// The rows of one strip of Y ← Y L⁻ᵀ. Those of a strip that is not whole are solved in the packed strip
  /// alone.
  template <int packets>
  void solve_strip(Columns<T> Y, T* strip_of_y, Index rows, Index k) {
    constexpr Index high = packets * lanes;
    const bool is_whole = rows == high;
    if (!is_whole) pack<high, high>(strip_of_y, {Y.data, Y.stride}, rows, k);
    const T* b = b_.data();
    for (Index j = 0; j < k; j += panel) {
      const Index columns = std::min(panel, k - j);
      T* const packed = strip_of_y + std::size_t(j) * high;
      Packet s[panel][packets];
#pragma GCC unroll 8
      for (int c = 0; c < panel; ++c)
        for (int r = 0; r < packets; ++r)
          s[c][r] = c < columns ? load_packet((is_whole ? Y.at(0, j + c) : packed + c * high) + r * lanes)
                                : Packet{};
      const T* a = strip_of_y;
      for (Index l = 0; l < j; ++l, a += high, b += panel) add_products<packets>(s, a, b);
#pragma GCC unroll 8  // the sums stay in registers
      for (int c = 0; c < panel; ++c, b += panel) {
        for (int r = 0; r < packets; ++r) s[c][r] = s[c][r] * b[c];
#pragma GCC unroll 8
        for (int d = c + 1; d < panel; ++d) {
          const T y = b[d];
          for (int r = 0; r < packets; ++r) s[d][r] = s[c][r] * y + s[d][r];
        }
      }
#pragma GCC unroll 8
      for (int c = 0; c < panel; ++c)
        for (int r = 0; r < packets && c < columns; ++r) {
          store_packet(packed + c * high + r * lanes, s[c][r]);
          if (is_whole) store_packet(Y.at(r * lanes, j + c), s[c][r]);
        }
    }
    if (is_whole) return;
    for (Index j = 0; j < k; ++j) std::copy_n(strip_of_y + std::size_t(j) * high, rows, Y.at(0, j));
  }

  static bool factor_narrow(Columns<T> C, Index n) {
    for (Index j = 0; j < n; ++j) {
      for (Index k = 0; k < j; ++k)
        for (Index i = j; i < n; ++i) *C.at(i, j) -= *C.at(j, k) * *C.at(i, k);
      const T pivot = *C.at(j, j);
      if (!(pivot > T(0)) || !std::isfinite(pivot)) return false;
      for (Index i = j; i < n; ++i) *C.at(i, j) *= T(1) / std::sqrt(pivot);
    }
    return true;
  }

  Array<T> a_, b_;
};

}  // namespace delassus::inner
