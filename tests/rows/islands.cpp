#include <delassus/rows/islands.hpp>

#include <vector>

#include "catch.hpp"

using namespace delassus;

namespace {

/// One set of ten particles and two pools of one row; items are written as lists of the blocks they hold.
struct Graph {
  RowSystem<double, Widths<3>, 1, 1> rows;
  std::vector<bool> moves = std::vector<bool>(10, true);
  Islands<double> islands;

  template <int p>
  void item(std::vector<Index> held) {
    auto& pool = rows.pool<p>();
    pool.phi.emplace_back();
    for (const Index b : held) {
      inner::part<0>(pool.sets).block.push_back(b);
      inner::part<0>(pool.sets).H.emplace_back();
    }
    pool.close();
  }
  void find() {
    const Index first[] = {0};
    islands.clear_blocks();
    for (const bool one : moves) islands.add_block(one);
    islands.find(ArraysOf(rows).all(), first);
  }
  std::vector<Index> items(int pool, Index island) const {
    const auto found = islands.items(pool, island);
    return {found.begin(), found.end()};
  }
};

}  // namespace

TEST_CASE("islands are the connected groups of bodies, numbered by their lowest body") {
  Graph g;
  g.item<0>({7, 8});
  g.item<0>({1, 2});
  g.item<0>({2, 3});
  g.item<1>({8, 9});
  g.item<1>({3, 1});
  g.find();
  REQUIRE(g.islands.count() == 2);
  CHECK(g.items(0, 0) == std::vector<Index>{1, 2});
  CHECK(g.items(1, 0) == std::vector<Index>{1});
  CHECK(g.items(0, 1) == std::vector<Index>{0});
  CHECK(g.items(1, 1) == std::vector<Index>{0});
  CHECK(g.islands.island_of(9) == 1);
  CHECK(g.islands.island_of(0) == -1);
}

TEST_CASE("a body that does not move joins nothing") {
  Graph g;
  g.moves[5] = false;
  g.item<0>({1, 5});
  g.item<0>({5, 2});
  g.item<1>({5});  // holds nothing that moves: in no island
  g.find();
  REQUIRE(g.islands.count() == 2);
  CHECK(g.items(0, 0) == std::vector<Index>{0});
  CHECK(g.items(0, 1) == std::vector<Index>{1});
  CHECK(g.items(1, 0).empty());
  CHECK(g.items(1, 1).empty());
}

TEST_CASE("a group elsewhere changes neither the order nor the members of an island") {
  Graph alone, crowded;
  for (Graph* g : {&alone, &crowded}) {
    if (g == &crowded) g->item<0>({8, 9});
    g->item<0>({4, 3});
    g->item<0>({3, 5});
    if (g == &crowded) g->item<0>({6, 7});
    g->item<0>({5, 4});
    g->find();
  }
  REQUIRE(alone.islands.count() == 1);
  REQUIRE(crowded.islands.count() == 3);
  CHECK(alone.items(0, 0) == std::vector<Index>{0, 1, 2});
  CHECK(crowded.items(0, 0) == std::vector<Index>{1, 2, 4});
}

TEST_CASE("without constraints there is no island, twice in a row") {
  Graph g;
  g.item<0>({1, 2});
  g.find();
  g.rows.reset();
  g.find();
  CHECK(g.islands.count() == 0);
}

TEST_CASE("all items can be taken as one island, whatever they act on") {
  Graph g;
  g.item<0>({1, 2});
  g.item<1>({7, 8});
  g.item<0>({4, 3});
  g.islands.take_all(ArraysOf(g.rows).all());
  REQUIRE(g.islands.count() == 1);
  CHECK(g.items(0, 0) == std::vector<Index>{0, 1});
  CHECK(g.items(1, 0) == std::vector<Index>{0});
}
