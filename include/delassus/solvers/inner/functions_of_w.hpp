/// How an operator shows its W to a pool: its arrays where it has them, else functions.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/free_velocity.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/row_view.hpp>

#include <cstddef>

namespace delassus::inner {

template <class Operator, class Rows>
struct CallsOf {
  using T = typename Rows::Scalar;

  static void residual(const FunctionsOfW<T>& of, int pool, Index i, T* u) {
    for_each_index<Rows::pool_count>([&](auto p) {
      if (p == pool) store(Vec<Rows::template rows_of<p>, T>(static_cast<Operator*>(of.W)->template residual<p>(*static_cast<Rows*>(of.rows), i)), u);
    });
  }
  static void changed(const FunctionsOfW<T>& of, int pool, Index i, const T* change) {
    for_each_index<Rows::pool_count>([&](auto p) {
      if (p == pool)
        static_cast<Operator*>(of.W)->template commit<p>(*static_cast<Rows*>(of.rows), i, load<Rows::template rows_of<p>>(change));
    });
  }
};

/// `blocks` has room for a view of each pool; `diagonal` takes W_ii of an operator that has it nowhere.
template <int p, class Operator, class Rows, class T = typename Rows::Scalar>
[[gnu::always_inline]] inline void show_W(Operator& W, Rows& rows, RowView<T>& view, SetBlocksView<T>* sets, BlockRowsView<T>* blocks, Array<T>& diagonal) {
  view.blocks = blocks;
  view.block_rows = 0;
  if constexpr (requires { W.template show<p>(rows, view, sets, blocks); }) {
    W.template show<p>(rows, view, sets, blocks);
  } else {
    constexpr int R = Rows::template rows_of<p>;
    diagonal.resize(std::size_t(R * R) * std::size_t(view.items));
    for (Index i = 0; i < view.items; ++i) {
      const Mat<R, R, T> own = W.template diagonal<p>(i);
      for (int k = 0; k < R * R; ++k) diagonal[std::size_t(R * R) * std::size_t(i) + std::size_t(k)] = own.data()[k];
    }
    view.form = FormOfW::functions;
    view.diagonal = diagonal.data();
    view.functions = {&W, &rows, CallsOf<Operator, Rows>::residual, CallsOf<Operator, Rows>::changed};
  }
  view.own_diagonal = view.diagonal;
}

}  // namespace delassus::inner
