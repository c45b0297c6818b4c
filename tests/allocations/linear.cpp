#include "allocations/count_allocations.hpp"

#include <delassus/compliance/assembled.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/linear/sparse_lu.hpp>

#include <vector>

#include "catch.hpp"
#include "compliance/coupled_grid.hpp"
#include "linear/block_graphs.hpp"

using namespace delassus;
using namespace block_graphs;

TEST_CASE("factoring, solving and compliances allocate nothing the second time") {
  const auto graph = grid<3>(9, 9, 9, 41);
  MultifrontalCholesky<3, double> f;
  f.analyse(graph.n, graph.pairs, graph.positions);
  std::vector<Vec3> x(graph.n, Vec3(1, 2, 3));
  const std::vector<Index> nodes{1, 5, 700, 300};
  std::vector<double> C(144);
  NodeCompliance<3, double> compliance;
  long before = 0;
  for (int n = 0; n < 2; ++n) {
    before = allocations;
    graph.fill(f);
    f.factor();
    f.solve(x);
    f.compliance(nodes, C);
    compliance.find(f, nodes, C);
  }
  CHECK(allocations == before);
}

TEST_CASE("an LU by fronts allocates nothing the second time") {
  const Net net(24);
  SparseLu<3, double> f;
  f.analyse(net.joints(), net.pairs);
  REQUIRE(f.has_fronts());
  std::vector<Vec3> x(net.joints(), Vec3(1, 2, 3));
  long before = 0;
  for (int n = 0; n < 2; ++n) {
    before = allocations;
    f.set_identity();
    f.factor();
    f.solve(x);
  }
  CHECK(allocations == before);
}

TEST_CASE("building W from the compliance of nodes allocates nothing the second time") {
  using Rows = RowSystem<double, Widths<3>, 3>;
  coupled_grid::Alone<coupled_grid::CompliantGrids> world;
  world.set.add(grid<3>(5, 5, 5, 42));
  world.set.add(grid<3>(4, 4, 4, 43));
  Rows rows;
  rows.pool<0>().reset(30);
  std::mt19937 random(1);
  for (Index i = 0; i < 30; ++i)
    coupled_grid::add_item(rows.pool<0>(), std::vector<Index>{i, i + 1, 150}, random);
  AssembledCompliance::Operator<Rows> W;
  long before = 0;
  for (int n = 0; n < 2; ++n) {
    before = allocations;
    W.build(world, rows);
  }
  CHECK(allocations == before);
  CHECK(before > 0);
}
