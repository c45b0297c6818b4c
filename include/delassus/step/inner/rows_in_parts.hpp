/// Linearize by several workers: each writes some items of a pool, and the parts are joined in order.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/step/law_rows.hpp>

#include <cstddef>
#include <cstring>

namespace delassus::inner {

/// The entries that some items have in each set. What an item has in one number a row (φ, stiffness …) it
/// writes in its place.
template <class T>
class RowsInParts {
 public:
  /// H and φ of all items of a pool. The arrays become those that one worker writes.
  template <class E>
  void write(const LawPool<T>& law, const WorldView<T>& world, const RowArrays<T>& rows, const E& execution) {
    const Index items = law.law->count(law.pool), tasks = tasks_of(items, least_items, execution.workers());
    rows.reset(items);
    if (tasks == 1) return law.law->linearize(law.pool, world, rows, 0, items);
    parts_.resize(std::size_t(tasks));
    execution.run(tasks, [&](Index task, Index) {
      const Range range = range_of(items, task, tasks);
      Part& part = parts_[std::size_t(task)];
      law.law->linearize(law.pool, world, part.begin(rows), range.first, range.last);
    });
    make_room(rows, items, tasks);
    execution.run(tasks, [&](Index task, Index) {
      parts_[std::size_t(task)].append_to(rows, range_of(items, task, tasks).first);
    });
  }

 private:
  static constexpr Index least_items = 64;

  struct SetPart {
    Array<Index> offset, block;
    Array<T> H, G;
    std::size_t first = 0;  ///< of its entries among those of the pool
  };
  struct Part {
    OwningArray<SetPart> of;
    Array<SetArrays<T>> arrays;

    void clear() {}  // what it holds is cleared where it is begun
    RowArrays<T> begin(const RowArrays<T>& rows) {
      of.resize(std::size_t(rows.sets));
      arrays.resize(std::size_t(rows.sets));
      for (std::size_t s = 0; s < of.size(); ++s) {
        SetPart& set = of[s];
        set.offset.assign(1, 0);
        set.block.clear();
        set.H.clear();
        arrays[s] = {&set.offset, &set.block, &set.H, &set.G, rows.set[s].width, rows.set[s].products};
      }
      RowArrays<T> out = rows;
      out.set = arrays.data();
      return out;
    }
    void append_to(const RowArrays<T>& rows, Index first_item) const {
      for (std::size_t s = 0; s < of.size(); ++s) {
        const SetPart& set = of[s];
        const SetArrays<T>& to = rows.set[s];
        const std::size_t numbers = std::size_t(rows.rows) * std::size_t(to.width);
        Index* offset = to.offset->data() + first_item;
        for (std::size_t i = 1; i < set.offset.size(); ++i) offset[i] = set.offset[i] + Index(set.first);
        if (set.block.empty()) continue;
        std::memcpy(to.block->data() + set.first, set.block.data(), set.block.size() * sizeof(Index));
        std::memcpy(to.H->data() + set.first * numbers, set.H.data(), set.H.size() * sizeof(T));
      }
    }
  };

  void make_room(const RowArrays<T>& rows, Index items, Index tasks) {
    for (std::size_t s = 0; s < std::size_t(rows.sets); ++s) {
      const SetArrays<T>& to = rows.set[s];
      std::size_t entries = 0;
      for (Index k = 0; k < tasks; ++k) {
        SetPart& part = parts_[std::size_t(k)].of[s];
        part.first = entries;
        entries += part.block.size();
      }
      to.offset->resize_for_overwrite(std::size_t(items) + 1);
      (*to.offset)[0] = 0;
      to.block->resize_for_overwrite(entries);
      to.H->resize_for_overwrite(entries * std::size_t(rows.rows) * std::size_t(to.width));
    }
  }

  OwningArray<Part> parts_;
};

}  // namespace delassus::inner
