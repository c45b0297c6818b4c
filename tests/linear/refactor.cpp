#include <delassus/linear/multifrontal_cholesky.hpp>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

namespace refactor_tests {

using namespace delassus;
using namespace block_graphs;

namespace {

using Factor = MultifrontalCholesky<3, double>;

Factor analysed(const Blocks<3>& g, const std::vector<Index>& region) {
  Factor f;
  f.analyse(g.n, g.pairs, g.positions, region);
  g.fill(f);
  return f;
}

/// Every number of L.
std::vector<double> numbers(const Factor& f) {
  std::vector<double> all;
  for (Index s = 0; s < Index(f.pattern().supernodes().size()); ++s) {
    const Supernode& x = f.pattern().supernodes()[s];
    const auto L = f.columns_of(s);
    for (Index j = 0; j < 3 * x.width; ++j)
      all.insert(all.end(), L.at(j, j), L.at(3 * Index(x.rows.size()), j));
  }
  return all;
}

/// The pairs within `nodes` become as many times stiffer.
Blocks<3> stiffened(const Blocks<3>& g, const std::vector<Index>& nodes, double factor) {
  Blocks<3> changed = g;
  const auto is_in = [&](Index i) { return std::find(nodes.begin(), nodes.end(), i) != nodes.end(); };
  for (std::size_t k = 0; k < g.pairs.size(); ++k)
    if (is_in(g.pairs[k].first) && is_in(g.pairs[k].second)) changed.K[k] *= factor;
  return changed;
}

/// The nodes of a grid of n³ within `radius` of the corner.
std::vector<Index> corner(Index n, Index radius) {
  std::vector<Index> nodes;
  for (Index i = 0; i < n * n * n; ++i)
    if (i % n < radius && i / n % n < radius && i / (n * n) < radius) nodes.push_back(i);
  return nodes;
}

}  // namespace

TEST_CASE("refactoring a changed region gives the whole factor to the bit, wherever the region is") {
  const auto g = grid<3>(7, 7, 7, 61);
  std::vector<Index> all(g.n), scattered;
  std::iota(all.begin(), all.end(), 0);
  for (Index i = 5; i < g.n; i += 17) scattered.push_back(i), scattered.push_back(i + 1);
  for (const auto& region : {corner(7, 3), corner(7, 1), scattered, all}) {
    auto f = analysed(g, region);
    REQUIRE(f.factor());
    const auto before = numbers(f);
    // Ever other parts of the region change, so that what the others left must have been kept.
    std::mt19937 random(5);
    Blocks<3> now = g;
    for (int change = 0; change < 3; ++change) {
      std::vector<Index> nodes;
      for (const Index i : region)
        if (change == 0 || random() % 4 == 0) nodes.push_back(i);
      now = stiffened(now, nodes, change == 1 ? 0. : 3.);
      now.fill(f);
      REQUIRE(f.refactor(nodes));
      auto whole = analysed(now, region);
      REQUIRE(whole.factor());
      CHECK(numbers(f) == numbers(whole));
    }
    if (region.size() > 1) CHECK(numbers(f) != before);
  }
}

TEST_CASE("a region of a graph in parts is refactored to the bit, and other parts are left alone") {
  auto g = grid<3>(4, 4, 4, 62);
  auto other = grid<3>(3, 3, 3, 63);
  for (auto [i, j] : other.pairs) g.pairs.emplace_back(i + g.n, j + g.n);
  g.K.insert(g.K.end(), other.K.begin(), other.K.end());
  for (const Vec3& x : other.positions) g.positions.push_back(x + Vec3(9, 0, 0));
  g.n += other.n;
  const std::vector<Index> region{70, 0, 1, 4, 71, 90};
  auto f = analysed(g, region);
  REQUIRE(f.factor());
  const std::vector<Index> nodes{0, 1, 4};
  const auto now = stiffened(g, nodes, 5);
  now.fill(f);
  REQUIRE(f.refactor(nodes));
  auto whole = analysed(now, region);
  REQUIRE(whole.factor());
  CHECK(numbers(f) == numbers(whole));
}

TEST_CASE("the blocks among some nodes can be put in anew") {
  const auto g = grid<3>(5, 5, 5, 64);
  const auto region = corner(5, 3);
  auto f = analysed(g, region);
  REQUIRE(f.factor());
  f.set_zero(region);
  // A of the region alone: what its nodes have of pairs that lead outside has to be put in again as well.
  const auto is_in = [&](Index i) { return std::find(region.begin(), region.end(), i) != region.end(); };
  for (const Index i : region) f.add_diagonal(i, g.shift * Mat3::Identity());
  for (std::size_t k = 0; k < g.pairs.size(); ++k) {
    const auto [i, j] = g.pairs[k];
    if (is_in(i)) f.add_diagonal(i, g.K[k]);
    if (is_in(j)) f.add_diagonal(j, g.K[k]);
    if (is_in(i) && is_in(j)) f.add_pair(i, j, -g.K[k]);
  }
  REQUIRE(f.refactor(region));
  auto whole = analysed(g, region);
  REQUIRE(whole.factor());
  CHECK(numbers(f) == numbers(whole));
}

TEST_CASE("a change that is not positive definite is refused, and the next good one gives the whole factor") {
  const auto g = grid<3>(5, 5, 5, 65);
  const auto region = corner(5, 3);
  auto f = analysed(g, region);
  REQUIRE(f.factor());
  const auto good = numbers(f);
  for (const Index node : {region.front(), region.back()}) {
    const std::vector<Index> nodes{node};
    f.add_diagonal(node, -1e6 * Mat3::Identity());
    CHECK_FALSE(f.refactor(nodes));
    g.fill(f);
    REQUIRE(f.refactor({}));
    CHECK(numbers(f) == good);
  }
}

TEST_CASE(
    "an element added by the places of its blocks is added where its pairs are, and -1 is what there is "
    "not") {
  const auto g = grid<3>(4, 4, 4, 68);
  auto f = analysed(g, {}), h = analysed(g, {});
  Mat3 K;
  K << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  for (auto [i, j] : g.pairs) {
    f.add_pair(i, j, .01 * K);
    h.add(h.find(j, i), .01 * K.transpose());
  }
  for (Index i = 0; i < g.n; ++i) {
    f.add_diagonal(i, 10 * Mat3::Identity());
    h.add(h.find(i, i), 10 * Mat3::Identity());
  }
  REQUIRE(f.factor());
  REQUIRE(h.factor());
  CHECK(numbers(f) == numbers(h));
  CHECK(f.find(0, 63).index == -1);
}

TEST_CASE("before there is a factor, refactor makes it whole") {
  const auto g = grid<3>(5, 5, 5, 66);
  auto f = analysed(g, corner(5, 2));
  REQUIRE(f.refactor({}));
  auto whole = analysed(g, corner(5, 2));
  REQUIRE(whole.factor());
  CHECK(numbers(f) == numbers(whole));
}

TEST_CASE("a node outside of the region is refused by name") {
  const auto g = grid<3>(4, 4, 4, 67);
  auto f = analysed(g, corner(4, 2));
  REQUIRE(f.factor());
  for (const Index node : {63, 64, -1}) {
    const std::vector<Index> nodes{node};
    const std::string name = "node " + std::to_string(node);
    CHECK_THROWS_WITH(f.refactor(nodes), Catch::Contains(name) && Catch::Contains("not in the region"));
    CHECK_THROWS_WITH(f.set_zero(nodes), Catch::Contains(name));
  }
  Factor plain;
  plain.analyse(g.n, g.pairs);
  g.fill(plain);
  REQUIRE(plain.factor());
  CHECK_THROWS_WITH(plain.refactor(std::vector<Index>{0}), Catch::Contains("not in the region"));
}

}  // namespace refactor_tests
