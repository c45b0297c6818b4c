/// The local solve all joints share: the rows are equalities.
#pragma once

#include <delassus/constraints/refinements.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <limits>

namespace delassus {

/// λ ← λ − W⁻¹ (b + W λ) from the λ of the last visit in this step, so that what rounding left of u = 0 at one visit goes at the
/// next. A block that is singular (a redundant row, an end without mass) is lifted by rounding's share. Bit k of `turns`: row k is
/// in rad/s, as in a `Hinge`, which is Bilateral<5, 0b11000>.
template <int rows_, unsigned turns_ = 0>
struct Bilateral {
  static constexpr int rows = rows_;
  static constexpr unsigned turns = turns_;  ///< bit k: row k is in rad/s
  static constexpr bool bilateral = true;
  static constexpr auto refines = refine::prepare | refine::tangent | refine::natural_map;

  /// Of one item, made by each `prepare`.
  template <class T>
  struct Memory {
    T inverse[rows * rows];  ///< of W, by columns
    T last[rows];            ///< λ of the last visit, N·s
  };

  template <class T>
  void prepare(const Mat<rows, rows, T>& W, Memory<T>& memory) const {
    constexpr T rounding = T(64) * std::numeric_limits<T>::epsilon();
    Mat<rows, rows, T> lifted = W;
    if constexpr (inner::are_mixed(rows, turns)) {
      T sum[2] = {};
      for (int k = 0; k < rows; ++k) sum[turns >> k & 1] += W(k, k);
      for (int k = 0; k < rows; ++k) lifted(k, k) += rounding * sum[turns >> k & 1];
    } else {
      add_diagonal(lifted, rounding * trace(W));
    }
    const Mat<rows, rows, T> inverse = inverse_of_positive(lifted);
    for (int k = 0; k < rows * rows; ++k) memory.inverse[k] = inverse.data()[k];
    for (T& x : memory.last) x = 0;
  }
  template <class Item, class T>
  Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>& W, const Vec<rows, T>& b, Memory<T>& memory) const {
    Vec<rows, T> u, correction;
    inner::set_product<rows, rows, 1>(W.data(), memory.last, u.data());
    u = b + u;
    inner::set_product<rows, rows, 1>(memory.inverse, u.data(), correction.data());
    for (int k = 0; k < rows; ++k) u[k] = memory.last[k] -= correction[k];
    return u;
  }
  template <class Item, class T>
  Mat<rows, rows, T> tangent(const Item&, Local<rows, T>& c) const {
    auto slope = zero<Mat<rows, rows, T>>();
    for (int k = 0; k < rows; ++k) {
      slope(k, k) = T(1) / c.W(k, k);
      c.lambda[k] -= slope(k, k) * c.d[k];
    }
    return slope;
  }
  /// s λ − P(s λ − u) with P the identity: the velocity itself.
  template <class Item, class T>
  Vec<rows, T> natural_map(const Item&, const Vec<rows, T>&, const Vec<rows, T>& u, T) const {
    return u;
  }
};

/// A law of joints with two ends, whose solve is Bilateral's.
template <class Law>
concept JointOfTwoEnds = requires(const typename Law::Item& item) {
  requires Law::bilateral;
  requires HasEnds<typename Law::Item>;
} && !HasParts<typename Law::Item> && !requires(const typename Law::Item& item) { item.c.owner; };

}  // namespace delassus
