/// Which colliders come near each other: what a broad phase promises.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/support.hpp>

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace delassus {

/// Two positions in the array of boxes, i < j.
struct CandidatePair {
  Index i, j;
  friend auto operator<=>(const CandidatePair&, const CandidatePair&) = default;
};

/// Finds every pair of boxes that touch or overlap, each once, in any order. An empty box pairs with nothing;
/// infinite boxes do not occur. What it remembers may only change how fast it is.
template <class B>
concept BroadPhase = requires(B& b, std::span<const Aabb> boxes, std::vector<CandidatePair>& pairs) {
  b.find(boxes, pairs);  // appends to `pairs`
};

/// What a box is called from step to step, and whether it moves.
struct BoxTag {
  std::uint32_t key = 0;
  bool is_movable = true;
};

/// A broad phase that also takes names: boxes may then stand in another order, come and go, and still be recognised. Two
/// boxes that do not move may be left out.
template <class B>
concept TaggedBroadPhase = BroadPhase<B> && requires(B& b, std::span<const Aabb> boxes, std::span<const BoxTag> tags,
                                                     std::vector<CandidatePair>& pairs) {
  b.find(boxes, tags, pairs);  // one tag a box, unique keys
};

namespace inner {

/// What a broad phase appends to: the library's own array where it takes one, which is fewer functions of a user's file.
template <class B>
struct PairsOf {
  using type = std::vector<CandidatePair>;
};
template <class B>
  requires requires(B& b, std::span<const Aabb> boxes, std::span<const BoxTag> tags, Array<CandidatePair>& pairs) { b.find(boxes, tags, pairs); }
struct PairsOf<B> {
  using type = Array<CandidatePair>;
};

}  // namespace inner

}  // namespace delassus
