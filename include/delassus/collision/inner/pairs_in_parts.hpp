/// Contacts of listed pairs by several threads.
#pragma once

#include <delassus/collision/inner/pair_search.hpp>
#include <delassus/collision/inner/pair_worker.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Of any type, which the one who asks for it knows; made by the first `get`. A copy is empty.
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) {}
  Scratch& operator=(const Scratch&) { return *this; }

  template <class T>
  T& get() {
    if (!kept_) kept_ = std::make_shared<T>();
    return *static_cast<T*>(kept_.get());
  }

 private:
  std::shared_ptr<void> kept_;
};

/// A filter that brings threads, and room for what they make.
template <class Filter, class E>
struct InParts {
  const Filter& filter;
  const E& execution;
  Scratch& scratch;

  bool lets(std::uint64_t pair) const { return filter.lets(pair); }
  bool pushed(std::uint64_t pair) const requires KnowsWhoPushed<Filter> { return filter.pushed(pair); }
  bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) const requires KnowsWhoMisses<Filter> {
    return filter.misses(pair, a, b, meets);
  }
};

template <class Filter, class E>
InParts(const Filter&, const E&, Scratch&) -> InParts<Filter, E>;

/// The `InParts` within a filter.
template <class Filter>
const auto& parts_of(const Filter& filter) {
  if constexpr (requires { filter.execution; })
    return filter;
  else
    return parts_of(filter.filter);
}

template <class Kernel>
struct PartOfPairs {
  PairWorker<Kernel> worker;
  std::vector<ContactPoint> out;
  std::size_t first = 0;  ///< of its contacts among all

  void clear() {}  // what it holds is cleared where it is begun
};

/// What workers keep of a detection.
template <class Kernel>
struct DetectionInParts {
  OwningArray<PartOfPairs<Kernel>> pairs;
  PairSearch search;
};

/// What was in `out` is written over.
template <class Kernel, class Filter>
void collide_in_parts(PairWorker<Kernel>& worker, Array<ListedPair>& jobs, PairSlots& slots,
                      const Filter& filter, std::vector<ContactPoint>& out) {
  constexpr Index least_pairs = 32;
  const auto& with = parts_of(filter);
  const Index pairs = Index(jobs.size()), tasks = tasks_of(pairs, least_pairs, with.execution.workers());
  auto& parts = with.scratch.template get<DetectionInParts<Kernel>>().pairs;
  parts.resize(std::size_t(tasks));
  with.execution.run(tasks, [&](Index task, Index) {
    const Range range = range_of(pairs, task, tasks);
    PartOfPairs<Kernel>& part = parts[std::size_t(task)];
    part.out.clear();
    part.worker.begin(worker);
    for (Index k = range.first; k < range.last; ++k) {
      ListedPair& job = jobs[std::size_t(k)];
      collide_listed(part.worker, job, slots[job.slot], filter, part.out);
    }
  });
  std::size_t count = 0;
  for (PartOfPairs<Kernel>& part : parts) {
    part.first = count;
    count += part.out.size();
    worker.join(part.worker);
  }
  out.resize(count);
  with.execution.run(tasks, [&](Index task, Index) {
    const PartOfPairs<Kernel>& part = parts[std::size_t(task)];
    std::copy(part.out.begin(), part.out.end(), out.begin() + std::ptrdiff_t(part.first));
  });
}

}  // namespace delassus::inner
