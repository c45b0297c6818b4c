/// The direct path for the rows of whole-step integrators, whose types are known.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/show_rows.hpp>
#include <delassus/solvers/inner/direct_system.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// A `DirectSystem` of rows that are all bilateral.
template <class Rows>
class DirectRows : public DirectSystem<std::max(1, Rows::highest), std::max(1, Rows::widest)> {
  using Base = DirectSystem<std::max(1, Rows::highest), std::max(1, Rows::widest)>;

 public:
  /// Takes all rows, with H and G as they are; false where a set's A couples blocks.
  bool take_all(Rows& rows) {
    this->begin();
    sets_.resize(std::size_t(Rows::set_count));
    bool can = true;
    for_each_index<Rows::pool_count>([&](auto p) {
      RowView<typename Rows::Scalar> view;
      show_rows(rows.template pool<p>(), p, view, sets_.data());
      for (Index i = 0; i < view.items; ++i) can &= this->take(view, i, true, p);
    });
    return can;
  }

  /// f(p, k) for all constraints, p their pool as a constant.
  void each(auto&& f) const {
    for_each_index<Rows::pool_count>([&](auto p) {
      for (Index k = 0; k < this->bilateral(); ++k)
        if (this->node(k).pool == p) f(p, k);
    });
  }

  /// The right side ← −velocity(p, item), where something answers. Returns √Σ u²/W_kk, the size of it.
  double load(const auto& velocity) {
    return Base::load([&](const auto& node, auto& to) {
      for_each_index<Rows::pool_count>([&](auto p) {
        if (node.pool != p) return;
        const auto u = velocity(p, node.item);
        for (int r = 0; r < node.rows; ++r) to[r] = double(u[r]);
      });
    });
  }

 private:
  Array<SetBlocksView<typename Rows::Scalar>> sets_;
};

}  // namespace delassus::inner
