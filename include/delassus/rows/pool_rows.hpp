/// The waist: the rows of one pool of constraints as flat arrays, blocks of fixed size, no law and no body in
/// sight.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/core/block_array.hpp>

#include <cstddef>

namespace delassus {

/// The blocks of H that one pool has in one body set of width `w` velocities per block.
///
/// Item i owns the entries offset[i] … offset[i+1] − 1; entry e acts on block[e] through H[e] (R × w), and
/// G[e] = A⁻¹ Hᵀ (w × R) where the set's A is block-diagonal; G is empty where it is not.
template <int R, int w, class T>
struct SetBlocks {
  Array<Index> offset{0};
  Array<Index> block;
  BlockArray<Mat<R, w, T>> H;
  BlockArray<Mat<w, R, T>> G;

  static void each_array(auto& self, auto&& f) { f(self.offset), f(self.block), f(self.H), f(self.G); }
  void reset() {
    offset.resize(1);
    block.clear();
    H.clear();
    G.clear();
  }
};

/// All rows of one pool: R per item. Units: phi m or rad, bias, d m/s or rad/s, lambda N·s or N·m·s.
///
/// A row with stiffness or damping > 0 is soft. `compliance` (1/kg) and `relative_compliance` (in units of the row's own
/// W_kk) join W's diagonal.
template <int R, class T, int... widths>
struct PoolRows {
  static constexpr int rows = R, set_count = int(sizeof...(widths));
  using Scalar = T;

  inner::Pack<SetBlocks<R, widths, T>...> sets;
  BlockArray<Vec<R, T>> phi, stiffness, damping, bias, compliance, relative_compliance, d, lambda;

  Index items() const { return Index(phi.size()); }

  /// The rows of `items` items, all zero and without entries. The items are closed one by one, in order.
  void reset(Index items) {
    if (items == 0 && phi.empty()) return;  // a law without items, step after step
    sets.each([](auto& s) __attribute__((always_inline)) { s.reset(); });
    for (auto* array : {&phi, &stiffness, &damping, &bias, &compliance, &relative_compliance, &d, &lambda})
      array->assign_zeros(std::size_t(items));
  }

  /// f(array) for all arrays, whose room somebody wants to know or to make.
  static void each_array(auto& self, auto&& f) {
    self.sets.each([&](auto& s) { s.each_array(s, f); });
    for (auto* array : {&self.phi, &self.stiffness, &self.damping, &self.bias, &self.compliance, &self.relative_compliance, &self.d,
                        &self.lambda})
      f(*array);
  }

  /// The entries of the next item end here in every set.
  void close() {
    sets.each([](auto& s) __attribute__((always_inline)) { s.offset.push_back(Index(s.block.size())); });
  }
};

}  // namespace delassus
