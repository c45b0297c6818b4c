/// Nodes of one body whose compliance is asked for, among those of others.
#pragma once

#include <delassus/core/index.hpp>

#include <cstddef>

namespace delassus::inner {

/// `count` blocks from the one numbered `first` of a list; their compliance begins with number C of an array.
struct AskedNodes {
  Index first, count;
  std::size_t C;

  /// How many numbers, `width` a block.
  std::size_t size(int width) const { return std::size_t(width * count) * std::size_t(width * count); }
};

}  // namespace delassus::inner
