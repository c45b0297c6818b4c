/// A list that several workers make: each fills a part, and the parts are joined in order.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>

#include <cstddef>

namespace delassus::inner {

/// Room for the parts; it keeps its capacity.
template <class T>
class ListInParts {
 public:
  /// f(range, list) for ranges of `count` items: what it appends to the lists stands behind `to` in the order
  /// of the items, as if one worker had done all.
  template <class E, class F>
  void fill(Array<T>& to, Index count, Index least, const E& execution, const F& f) {
    const Index tasks = tasks_of(count, least, execution.workers());
    if (tasks == 1) return f(Range{0, count}, to);
    parts_.resize(std::size_t(tasks));
    execution.run(tasks, [&](Index task, Index) {
      Array<T>& part = parts_[std::size_t(task)];
      part.clear();
      // As much as all may come to, so that a warm step does not grow it because the items lie otherwise.
      part.reserve(to.capacity());
      f(range_of(count, task, tasks), part);
    });
    std::size_t size = to.size();
    for (const Array<T>& part : parts_) size += part.size();
    if (size > to.capacity()) to.reserve(size + size / 2);
    for (const Array<T>& part : parts_) to.append(part.data(), part.size());
  }

 private:
  OwningArray<Array<T>> parts_;
};

}  // namespace delassus::inner
