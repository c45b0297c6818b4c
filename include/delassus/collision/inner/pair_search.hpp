/// What a search for pairs by several workers keeps from step to step.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/collision/inner/pair_slots.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/list_in_parts.hpp>

#include <cstdint>

namespace delassus::inner {

/// Room for the lists of a search.
struct PairSearch {
  ListInParts<Index> places;         ///< of boxes, or of memories
  ListInParts<std::uint64_t> names;  ///< of pairs of a broad phase
  ListInParts<CandidatePair> candidates;
  ListInParts<ListedPair> jobs;
  Array<Index> found;       ///< places, joined
  Array<ListedPair> asked;  ///< who may meet yet, joined
};

/// It, and who searches.
template <class E>
struct SharedSearch {
  const E& execution;
  PairSearch& room;
};
template <class E>
SharedSearch(const E&, PairSearch&) -> SharedSearch<E>;

}  // namespace delassus::inner
