/// Sparse LU factorization of small square blocks, by the cheaper of two ways.
#pragma once

#include <delassus/linear/block_lu.hpp>
#include <delassus/linear/multifrontal_lu.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// `BlockLu` where elimination fills in little, as chains, trees and loops do, `MultifrontalLu` where it
/// fills in much: a net of n × n joints is O(n³) either way, but of 40 × 40 the fronts take a third of the
/// time, of 100 × 100 a sixth. Which it is follows from the pattern alone. Likewise `factor` and `solve` do
/// not allocate from the second time on.
template <int w, class T>
class SparseLu {
 public:
  using Block = Mat<w, w, T>;

  /// All diagonal blocks and, both ways, the pairs (i, j), i ≠ j, in any order, repeats allowed.
  void analyse(Index blocks, std::span<const std::pair<Index, Index>> pairs) {
    plain_.analyse(blocks, pairs);
    has_fronts_ = plain_.products() > dense * blocks;
    if (has_fronts_) fronts_.analyse(blocks, pairs);
  }
  bool has_fronts() const { return has_fronts_; }

  void set_identity() { has_fronts_ ? fronts_.set_identity() : plain_.set_identity(); }
  /// A_ij, to be added to.
  Block& at(Index i, Index j) { return has_fronts_ ? fronts_.at(i, j) : plain_.at(i, j); }
  /// False when a pivot block is singular or not finite.
  bool factor() { return has_fronts_ ? fronts_.factor() : plain_.factor(); }
  /// The same where block i has first[i + 1] − first[i] rows of its own, behind which A is the identity.
  bool factor(inner::Slice<const Index> first) { return has_fronts_ ? fronts_.factor() : plain_.factor_own_rows(first); }
  /// x ← A⁻¹ x.
  void solve(std::span<Vec<w, T>> x) const { has_fronts_ ? fronts_.solve(x) : plain_.solve(x); }
  /// The same of many columns, as in `BlockLu`; fronts solve one after the other, in `x`.
  void solve(T* X, Index columns, inner::Slice<const Index> first, inner::Slice<Vec<w, T>> x) const {
    if (!has_fronts_) return plain_.solve(X, columns, first);
    for (Index c = 0; c < columns; ++c) {
      const auto each = [&](const auto& f) {
        for (std::size_t i = 0; i < x.size(); ++i)
          for (int r = 0; r < int(first[i + 1] - first[i]); ++r) f(x[i][r], X[std::ptrdiff_t(first[i] + r) * columns + c]);
      };
      for (Vec<w, T>& entry : x) set_all(entry, T(0));
      each([](T& own, T theirs) { own = theirs; });
      fronts_.solve({x.data(), x.size()});
      each([](T own, T& theirs) { theirs = own; });
    }
  }

 private:
  /// Products of blocks for each block in `BlockLu` from which on fronts take less time: measured with 3 × 3
  /// blocks on nets of joints, 20 × 20 of which are as fast both ways.
  static constexpr double dense = 300;

  BlockLu<w, T> plain_;
  MultifrontalLu<w, T> fronts_;
  bool has_fronts_ = false;
};

}  // namespace delassus
