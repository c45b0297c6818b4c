/// What the workers of a loop keep from step to step.
#pragma once

#include <delassus/bodies/inner/quarantine_record.hpp>
#include <delassus/collision/inner/pairs_in_parts.hpp>
#include <delassus/compliance/inner/rows_of_w_in_parts.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/rows/shared_set.hpp>
#include <delassus/step/contact_cache.hpp>
#include <delassus/step/inner/rows_in_parts.hpp>

namespace delassus::inner {

/// What workers keep.
template <class P, bool has_rows>
struct WorkersKeep {};
template <class P>
struct WorkersKeep<P, true> {
  using T = typename P::Rows::Scalar;
  struct Task {
    Index rows, island;
    bool operator<(const Task& o) const { return rows != o.rows ? rows > o.rows : island < o.island; }
  };

  typename kept_of_sets<typename P::World>::type sets;
  RowsInParts<T> rows;
  RowsOfWInParts<T> W;
  OwningArray<typename P::Solver::template Workspace<typename P::Rows>> solvers;  ///< by worker
  Array<Task> islands;                                                            ///< the largest first
  Crew crew;
  Scratch pairs;                               ///< of detection
  Array<Index> numbers;                        ///< 0, 1, 2 …
  Array<QuarantineRecord> moved;               ///< by task of Advance
  OwningArray<ContactCache::Search> searches;  ///< by task of the warm start

  /// The numbers below `count`.
  const Index* numbers_to(Index count) {
    while (Index(numbers.size()) < count) numbers.push_back(Index(numbers.size()));
    return numbers.data();
  }
};

}  // namespace delassus::inner
