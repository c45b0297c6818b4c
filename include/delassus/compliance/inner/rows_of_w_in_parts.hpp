/// Building W by several workers: each makes some rows of a pool, and the parts are joined in order.
#pragma once

#include <delassus/compliance/inner/assembled_rows.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>

#include <cstddef>
#include <cstring>

namespace delassus::inner {

/// Rows of W that a worker has made, and where they go.
template <class T>
class RowsOfWInParts {
 public:
  /// The rows of pool a, `height` an item. W becomes what one worker builds.
  template <int height, bool couples, class E>
  void build(AssembledRows<T>& W, int a, const E& execution) {
    const Index items = W.views[std::size_t(a)].items,
                tasks = tasks_of(items, W.is_coupled(a) ? least_coupled : least_items, execution.workers());
    if (tasks == 1) return AssembledRows<T>::template build_pool<height, couples>(W, a, nullptr);
    W.matrix.begin_rows(W.views.data(), a);
    const int pools = int(W.views.size());
    parts_.resize(std::size_t(tasks));
    execution.run(tasks, [&](Index task, Index) {
      Part& part = parts_[std::size_t(task)];
      part.items = range_of(items, task, tasks);
      part.matrix.resize(pools);
      part.matrix.begin_rows(W.views.data(), a);
      AssembledRows<T>::template build_rows<height, couples>(W, part.matrix, a, part.items.first,
                                                             part.items.last, nullptr);
    });
    for (int b = 0; b < pools; ++b) make_room(W, a, b, height, tasks);
    execution.run(tasks, [&](Index task, Index) { append(parts_[std::size_t(task)], W, a, height); });
  }

 private:
  static constexpr Index least_items = 64, least_coupled = 8;  ///< that are worth a task

  struct Part {
    BlockMatrix<T> matrix;
    Range items{};
    Array<Index> first_block;  ///< of its blocks among those of W, by the pool of the columns

    void clear() {}  // what it holds is cleared where its rows are begun
  };

  void make_room(AssembledRows<T>& W, int a, int b, int height, Index tasks) {
    Index blocks = 0;
    for (Index k = 0; k < tasks; ++k) {
      Part& part = parts_[std::size_t(k)];
      part.first_block.resize(W.views.size());
      part.first_block[std::size_t(b)] = blocks;
      blocks += Index(part.matrix.blocks(a, b).column.size());
    }
    auto& to = W.matrix.blocks(a, b);
    to.column.resize_for_overwrite(std::size_t(blocks));
    to.numbers.resize_for_overwrite(std::size_t(blocks) * std::size_t(height * W.views[std::size_t(b)].rows));
  }
  static void append(const Part& part, AssembledRows<T>& W, int a, int height) {
    const std::size_t square = std::size_t(height * height), items = std::size_t(part.items.count());
    if (items == 0) return;
    std::memcpy(W.matrix.diagonal(a).data() + square * std::size_t(part.items.first),
                part.matrix.diagonal(a).data() + square * std::size_t(part.items.first),
                square * items * sizeof(T));
    for (std::size_t b = 0; b < part.first_block.size(); ++b) {
      const auto& from = part.matrix.blocks(a, int(b));
      auto& to = W.matrix.blocks(a, int(b));
      const Index first = part.first_block[b];
      for (Index i = part.items.first; i < part.items.last; ++i)
        to.start[std::size_t(i) + 1] = first + from.start[std::size_t(i) + 1];
      if (from.column.empty()) continue;
      std::memcpy(to.column.data() + first, from.column.data(), from.column.size() * sizeof(Index));
      std::memcpy(to.numbers.data() + std::size_t(first) * std::size_t(height * W.views[b].rows),
                  from.numbers.data(), from.numbers.size() * sizeof(T));
    }
  }

  OwningArray<Part> parts_;
};

}  // namespace delassus::inner
