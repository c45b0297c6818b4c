/// Contacts at random with an operator W of their own, swept one by one and in lanes.
#pragma once

#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/solvers/inner/colouring.hpp>
#include <delassus/solvers/inner/lane_loops.hpp>
#include <delassus/solvers/inner/law_loops.hpp>
#include <delassus/solvers/island.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lane_tests {

using namespace delassus;
using namespace delassus::inner;

using Law = Contact<Coulomb>;

/// In (−1, 1).
struct Numbers {
  std::uint64_t state = 12345;
  double operator()() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return double(std::int64_t(state)) * 0x1p-63;
  }
};

/// Contacts at random with W_ii = size_of_W (a aᵀ + softest 1), |a| about 1, each among some of the others or
/// alone. Some meet rows of two other pools.
struct Contacts {
  double friction = 0.5, size_of_W = 1, size_of_d = 1, softest = 0.7;
  bool is_alone = false, meets_others = false;
};

/// One pool of such contacts with all that a view points at.
struct PoolOfContacts {
  Law law;
  std::vector<Law::Item> items;
  std::vector<Coulomb::Memory<double>> memory;
  std::vector<double> lambda, d, diagonal, block;
  std::vector<Index> start, column, all;
  std::vector<double> other_lambda, other_block;
  std::vector<Index> other_start, other_column;
  BlockRowsView<double> blocks[3]{};
  PoolView<double> view;
  Span<double> span{};
  Colouring<double> colours;
  PackedContacts packed;

  PoolOfContacts(Index count, const Contacts& kind) {
    Numbers x;
    std::vector<std::vector<Index>> meets(std::size_t(count), std::vector<Index>{});
    for (Index i = 0; i < count; ++i)
      for (Index n = 0; n < 1 + i % 6 && !kind.is_alone; ++n) {
        const Index j = Index(double(count) * 0.4999 * (1 + x()));
        if (j == i || is_in(meets[std::size_t(i)], j)) continue;
        meets[std::size_t(i)].push_back(j), meets[std::size_t(j)].push_back(i);
      }
    start.push_back(0);
    for (Index i = 0; i < count; ++i) {
      for (const Index j : meets[std::size_t(i)]) {
        column.push_back(j);
        for (int k = 0; k < 9; ++k) block.push_back(0.1 * kind.size_of_W * x());
      }
      start.push_back(Index(column.size()));
      const double a[3] = {1 + 0.4 * x(), 0.6 * x(), 0.6 * x()};
      for (int k = 0; k < 9; ++k)
        diagonal.push_back(kind.size_of_W * (a[k % 3] * a[k / 3] + (k % 4 == 0 ? kind.softest : 0)));
      d.push_back(kind.size_of_d * (x() - 0.5));
      for (int k = 0; k < 2; ++k) d.push_back(0.6 * kind.size_of_d * x());
      all.push_back(i);
    }
    lambda.resize(3 * std::size_t(count));
    memory.resize(std::size_t(count));
    items.resize(std::size_t(count));
    for (auto& item : items) item.parameters.friction = kind.friction;
    view.rows = 3, view.items = count, view.lambda = lambda.data(), view.d = d.data();
    view.diagonal = view.own_diagonal = diagonal.data();
    blocks[0] = {start.data(), column.data(), block.data(), lambda.data(), 3};
    view.block_rows = 1, view.blocks = blocks;
    if (kind.meets_others) add_others(kind);
    view.table = &LawLoops<Law, double>::table;
    view.law = &law, view.law_items = items.data(), view.memory = memory.data();
    span = {&view, all.data(), count};
    view.table->prepare({&view, nullptr, count}, 0.01);
    REQUIRE(colours.make(&span, &span + 1));
  }
  PoolOfContacts(const PoolOfContacts&) = delete;

  /// Two pools of three items, of two rows each and of three; every third contact meets two items of each.
  void add_others(const Contacts& kind) {
    Numbers x;
    other_start.push_back(0);
    for (Index i = 0; i < view.items; ++i) {
      for (Index k = 0; k < 2 && i % 3 == 1; ++k) other_column.push_back((i / 3 + k) % 3);
      other_start.push_back(Index(other_column.size()));
    }
    for (std::size_t k = 0; k < 9 * other_column.size(); ++k)
      other_block.push_back(0.3 * kind.size_of_W * x());
    for (int k = 0; k < 9; ++k) other_lambda.push_back(kind.size_of_d / kind.size_of_W * x());
    blocks[1] = blocks[0];
    blocks[0] = {other_start.data(), other_column.data(), other_block.data(), other_lambda.data(), 2};
    blocks[2] = {other_start.data(), other_column.data(), other_block.data(), other_lambda.data(), 3};
    view.block_rows = 3, view.form = FormOfW::blocks;
  }

  void pack() {
    packed.take(colours.spans());
    packed.fill(nullptr);
  }
  static bool is_in(const std::vector<Index>& list, Index i) {
    for (const Index j : list)
      if (i == j) return true;
    return false;
  }
  double largest() const {
    double most = 0;
    for (const double x : lambda) most = std::max(most, std::abs(x));
    return most;
  }
};

/// The same contacts twice, the second time in lanes.
struct Both {
  PoolOfContacts scalar, lanes;
  explicit Both(const Contacts& kind, Index count = 301) : scalar(count, kind), lanes(count, kind) {
    lanes.pack();
  }

  /// f(spans) on both sides.
  template <class F>
  void each(const F& f) {
    f(scalar), f(lanes);
  }
  void sweep(const SweepRule& rule = {}) {
    each([&](PoolOfContacts& pool) {
      Sweep<double> sums{.relaxation = rule.relaxation};
      for (const Span<double>& span : pool.colours.spans()) rule.loop_of(*span.pool->table)(span, sums);
    });
  }
  double difference() const {
    double most = 0;
    for (std::size_t k = 0; k < scalar.lambda.size(); ++k)
      most = std::max(most, std::abs(scalar.lambda[k] - lanes.lambda[k]));
    return most / scalar.largest();
  }
};

struct Cases {
  int open = 0, sticking = 0, slipping = 0;
  explicit Cases(const PoolOfContacts& pool) {
    for (std::size_t i = 0; i < pool.items.size(); ++i) {
      const double* x = &pool.lambda[3 * i];
      const double limit = pool.items[i].parameters.friction * x[0];
      ++(x[0] == 0 ? open : std::hypot(x[1], x[2]) < 0.999 * limit ? sticking : slipping);
    }
  }
};

}  // namespace lane_tests
