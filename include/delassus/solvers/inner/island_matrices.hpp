/// The sparse matrices of islands, whose analysis is kept from step to step.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

#include <utility>
#include <vector>

namespace delassus::inner {

/// One `Matrix` an island: it keeps its analysis while the graph of its blocks stands.
template <class Matrix>
class IslandMatrices {
 public:
  /// That of an island with so many blocks, of which these pairs meet.
  Matrix& of(Index island, Index blocks, const Array<std::pair<Index, Index>>& pairs) {
    if (Index(graphs_.size()) <= island) graphs_.resize(island + 1);
    Graph& graph = graphs_[island];
    if (graph.blocks != blocks || graph.pairs != pairs) {
      graph.blocks = blocks;
      graph.pairs.assign(pairs.begin(), pairs.end());
      graph.matrix.analyse(blocks, pairs);
    }
    return graph.matrix;
  }

 private:
  struct Graph {
    Index blocks = -1;
    Array<std::pair<Index, Index>> pairs;
    Matrix matrix;
  };
  std::vector<Graph> graphs_;
};

}  // namespace delassus::inner
