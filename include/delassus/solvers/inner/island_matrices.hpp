/// The sparse matrices of islands, whose analysis is kept from step to step.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>

#include <utility>

namespace delassus::inner {

template <class Matrix>
struct IslandGraph {
  Index blocks = -1;
  Array<std::pair<Index, Index>> pairs;
  Matrix matrix;
};

/// One `Matrix` an island: it keeps its analysis while the graph of its blocks stands.
template <class Matrix>
class IslandMatrices {
 public:
  /// That of an island with so many blocks, of which these pairs meet.
  Matrix& of(Index island, Index blocks, const Array<std::pair<Index, Index>>& pairs) {
    if (Index(graphs_.size()) <= island) graphs_.resize(island + 1);
    IslandGraph<Matrix>& graph = graphs_[island];
    if (graph.blocks != blocks || graph.pairs != pairs) {
      graph.blocks = blocks;
      graph.pairs.assign(pairs.begin(), pairs.end());
      graph.matrix.analyse(blocks, pairs);
    }
    return graph.matrix;
  }

 private:
  OwningArray<IslandGraph<Matrix>> graphs_;
};

}  // namespace delassus::inner
