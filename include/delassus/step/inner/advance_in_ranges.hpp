/// Advance by several workers: each moves some bodies of a set.
#pragma once

#include <delassus/bodies/inner/quarantine_record.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/step/move_freely.hpp>

#include <cstddef>

namespace delassus::inner {

/// q and v of the end from v_next, as `integrator.advance` leaves them. Sets that cannot be moved block by
/// block are moved by the caller. `records` is room for what each task notes.
template <class Set, class I, class E>
void advance_in_ranges(Set& set, const I& integrator, double h, Array<QuarantineRecord>& records,
                       const E& execution) {
  constexpr Index least_blocks = 128;
  if constexpr (StepsByBlock<Set> && EachBlockAlone<I>) {
    const auto& active = set.active();
    const Index count = Index(active.size()), tasks = tasks_of(count, least_blocks, execution.workers());
    if (tasks > 1) {
      const auto all = set.by_block(integrator.scale(h));
      records.assign(std::size_t(tasks), QuarantineRecord{});
      execution.run(tasks, [&](Index task, Index) {
        QuarantineRecord mine;
        auto blocks = all;
        blocks.record = &mine;
        const Range range = range_of(count, task, tasks);
        for (Index k = range.first; k < range.last; ++k) {
          const Index b = active[std::size_t(k)];
          OneBlock<decltype(blocks), typename Set::Velocity> block{blocks, b, set.v_next[b]};
          integrator.advance(block, h);
        }
        records[std::size_t(task)] = mine;
      });
      for (const QuarantineRecord& one : records) all.record->join(one);
      return;
    }
  }
  integrator.advance(set, h);
}

}  // namespace delassus::inner
