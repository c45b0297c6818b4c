#include <delassus/linear/nested_dissection.hpp>
#include <delassus/linear/supernodes.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

namespace nested_dissection_tests {

using namespace delassus;
using namespace block_graphs;

namespace {

/// Entries of L, by nodes.
double fill(const NodeGraph& graph, std::span<const Vec3> positions) {
  SupernodalPattern pattern;
  pattern.analyse(graph, NestedDissection{}.order(graph, positions));
  double entries = 0;
  for (const Supernode& s : pattern.supernodes()) entries += double(s.width) * double(s.rows.size());
  return entries;
}

NodeGraph graph_of(const Blocks<1>& g) { return NodeGraph(g.n, g.pairs); }

}  // namespace

TEST_CASE("every node has its place once, with positions or without, in parts that do not meet too") {
  Blocks<1> g = grid<1>(9, 7, 1, 1);
  const Index half = g.n;
  for (std::size_t k = 0, count = g.pairs.size(); k < count; ++k)
    g.pairs.emplace_back(g.pairs[k].first + half, g.pairs[k].second + half);
  g.n = 2 * half + 5;  // and five nodes alone
  Array<Index> order = NestedDissection{}.order(graph_of(g));
  std::sort(order.begin(), order.end());
  REQUIRE(Index(order.size()) == g.n);
  for (Index i = 0; i < g.n; ++i) REQUIRE(order[i] == i);
}

// The level lines of the distance from a corner are a net's diagonals, half as long again in nodes and each
// part they leave a triangle: by them alone L had 1.6 times the entries. A tenth is what the ends of a cut
// may cost.
TEST_CASE("a square net is cut along its sides, told where its nodes are or not") {
  for (const Index n : {20, 40, 80}) {
    const Net net(n);
    const NodeGraph graph(net.joints(), net.pairs);
    CAPTURE(n);
    CHECK(fill(graph, {}) <= 1.1 * fill(graph, net.positions));
  }
}

}  // namespace nested_dissection_tests
