// A factor, its solves and compliances by several workers have the bits that one worker makes.
#include <delassus/core/execution.hpp>
#include <delassus/linear/inner/front_workers.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>

#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"
#include "worker_threads.hpp"

namespace front_workers_tests {

using namespace delassus;
using namespace block_graphs;

namespace {

/// Says that it has several workers, and takes the last task first: whose turn it is makes no difference.
struct Backwards {
  using plays = role::Execution;
  Index count = 3;
  Index workers() const { return count; }
  template <class F>
  void run(Index tasks, F&& f) const {
    for (Index task = tasks; task-- > 0;) f(task, task % count);
  }
};
static_assert(Execution<Backwards>);

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <int w, class T>
std::vector<Vec<w, T>> some_vector(Index n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<Vec<w, T>> x(n);
  for (auto& one : x) one = Vec<w, T>::NullaryExpr([&] { return T(draw(random)); });
  return x;
}

/// Every `step`-th node, from the last.
std::vector<Index> some_nodes(Index n, Index step) {
  std::vector<Index> nodes;
  for (Index k = n - 1; k >= 0; k -= step) nodes.push_back(k);
  return nodes;
}

template <int w, class T, class E>
void check_same_bits(const Blocks<w>& g, const E& execution) {
  CAPTURE(g.n, execution.workers());
  MultifrontalCholesky<w, T> one, many;
  typename MultifrontalCholesky<w, T>::Workers by;
  typename MultifrontalCholesky<w, T>::Dense dense;
  for (auto* f : {&one, &many}) f->analyse(g.n, g.pairs, g.positions);
  many.prepare(by, dense, execution.workers());
  for (int turn = 0; turn < 2; ++turn) {  // the second time on what the first has left
    g.fill(one), g.fill(many);
    REQUIRE(one.factor());
    REQUIRE(many.factor(by, dense, execution));
    const auto& supernodes = one.pattern().supernodes();
    Index others = 0;
    for (Index s = 0; s < Index(supernodes.size()); ++s) {
      const auto L = one.columns_of(s), M = many.columns_of(s);
      for (Index j = 0; j < w * supernodes[s].width; ++j)
        others += std::memcmp(L.at(j, j), M.at(j, j), (L.stride - j) * sizeof(T)) != 0;
    }
    CHECK(others == 0);
    auto x = some_vector<w, T>(g.n), y = x;
    one.solve(x);
    many.solve(y, by, dense, execution);
    CHECK(same_bits(x, y));
    for (const Index step : {3, 7, 50}) {
      const auto nodes = some_nodes(g.n, step);
      const std::size_t m = std::size_t(w) * nodes.size();
      std::vector<T> C(m * m, T(3)), D(m * m, T(4));
      one.compliance(nodes, C);
      many.compliance(nodes, D, dense, execution);
      CHECK(same_bits(C, D));
    }
  }
}
template <int w, class T>
void check_same_bits(const Blocks<w>& g) {
  for (const Index workers : {1, 2, 3, 8}) check_same_bits<w, T>(g, Backwards{workers});
  WorkerThreads threads;
  threads.count = 4;
  check_same_bits<w, T>(g, threads);
}

}  // namespace

TEST_CASE("several workers make the bits of one: a factor and what it solves") {
  check_same_bits<3, double>(grid<3>(11, 9, 12, 3));
  check_same_bits<3, float>(grid<3>(8, 9, 8, 4));
  check_same_bits<6, double>(grid<6>(6, 5, 7, 5));
}

TEST_CASE("several workers factor what is hardly a tree: one node and a chain and loose parts") {
  check_same_bits<3, double>(grid<3>(1, 1, 1, 1));
  check_same_bits<3, double>(grid<3>(40, 1, 1, 2));
  auto loose = grid<3>(5, 5, 5, 6);
  loose.n += 60;  // nodes without neighbours
  loose.positions.clear();
  check_same_bits<3, double>(loose);
}

TEST_CASE("several workers refuse what is not positive definite and then factor what is") {
  const auto g = grid<3>(9, 9, 9, 7);
  MultifrontalCholesky<3, double> f, one;
  MultifrontalCholesky<3, double>::Workers by;
  MultifrontalCholesky<3, double>::Dense dense;
  const Backwards execution{4};
  f.analyse(g.n, g.pairs, g.positions);
  one.analyse(g.n, g.pairs, g.positions);
  f.prepare(by, dense, 4);
  for (const Index place : {0, 300, 600, 728})  // in a subtree, and above all
    for (const double bad : {-1e6, std::numeric_limits<double>::quiet_NaN()}) {
      g.fill(f);
      f.add_diagonal(f.pattern().node(place), bad * Mat3::Identity());
      CHECK_FALSE(f.factor(by, dense, execution));
    }
  g.fill(f), g.fill(one);
  REQUIRE(f.factor(by, dense, execution));
  REQUIRE(one.factor());
  auto x = some_vector<3, double>(g.n), y = x;
  f.solve(x, by, dense, execution);
  one.solve(y);
  CHECK(same_bits(x, y));
}

TEST_CASE("subtrees have every front once: in one of them or above") {
  const auto g = grid<3>(12, 12, 12, 8);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  const auto& fronts = f.pattern().supernodes();
  for (const Index workers : {2, 8}) {
    inner::Subtrees trees;
    trees.analyse_factor(f.pattern(), 3, workers);
    CHECK(trees.count() >= workers);
    for (Index t = 0; t + 1 < trees.count(); ++t) CHECK(trees[t].work >= trees[t + 1].work);
    std::vector<Index> tree_of(fronts.size(), -1);
    for (Index t = 0; t < trees.count(); ++t)
      for (Index s = trees[t].first; s <= trees[t].last; ++s) {
        CHECK(tree_of[s] < 0);
        tree_of[s] = t;
        if (s < trees[t].last) CHECK(fronts[s].parent <= trees[t].last);
      }
    for (Index s = 0; s < Index(fronts.size()); ++s) {
      CHECK(tree_of[s] == trees.tree_of(s));
      if (tree_of[s] < 0 && fronts[s].parent >= 0) CHECK(trees.tree_of(fronts[s].parent) < 0);
    }
  }
}

}  // namespace front_workers_tests
