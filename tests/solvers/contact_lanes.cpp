#include "lane_tests.hpp"

#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/solvers/inner/pieces.hpp>
#include <delassus/solvers/island.hpp>

#include <limits>
#include <thread>

namespace contact_lanes_tests {

using namespace lane_tests;

namespace {

/// A law of a host's own, which answers otherwise.
struct Sticky : Coulomb {};
static_assert(is_answered_by_coulomb<Law>() && is_answered_by_coulomb<Contact<Restitution<Coulomb>>>());
static_assert(is_answered_by_coulomb<Contact<Penalty<Coulomb>>>());
static_assert(!is_answered_by_coulomb<Contact<Pyramid>>() && !is_answered_by_coulomb<Contact<Sticky>>());

// Conditions of blocks are below 6, the sums have below 20 terms of the size of λ: some 200 roundings
// of 1.1e-16 of the largest λ, fewer after several sweeps, which contract.
constexpr double rounding = 1e-12;

}  // namespace

TEST_CASE("contacts in lanes get the impulses that each gets by itself") {
  for (const double friction : {0.0, 1e-6, 0.1, 0.5, 1.5, 10.0})
    for (const double size : {1.0, 1e-60, 1e60})
      for (const double size_of_W : {1.0, 1e-8, 1e12}) {
        INFO(friction << " " << size << " " << size_of_W);
        Both both({.friction = friction, .size_of_W = size_of_W, .size_of_d = size});
        both.sweep();
        CHECK(both.difference() < rounding);
        for (int k = 0; k < 4; ++k) both.sweep();
        CHECK(both.difference() < rounding);
        const Cases cases(both.lanes);
        CHECK(cases.open > 20);
        if (friction > 0) CHECK(cases.slipping > 20);
        if (friction > 0.2) CHECK(cases.sticking > 20);
      }
}

TEST_CASE("relaxed sweeps and projections of contacts in lanes are those of each") {
  for (const double friction : {0.0, 0.5, 1.5}) {
    Both relaxed({.friction = friction});
    for (int k = 0; k < 5; ++k) relaxed.sweep({.relaxation = 1.3});
    CHECK(relaxed.difference() < rounding);
    Both projected({.friction = friction});
    for (int k = 0; k < 5; ++k) projected.sweep({.projects = true});
    CHECK(projected.difference() < rounding);
    CHECK(Cases(projected.lanes).open > 20);
    for (const double share : {1.0, 0.5}) {
      Both descended({.friction = friction});
      REQUIRE(descended.lanes.colours.spans()[0].pool->table->descend != descended.scalar.colours.spans()[0].pool->table->descend);
      for (int k = 0; k < 5; ++k) descended.sweep({.relaxation = share, .descends = true});
      CHECK(descended.difference() < rounding);
      CHECK(Cases(descended.lanes).open > 20);
      if (friction > 0) CHECK(Cases(descended.lanes).slipping > 20);
    }
  }
}

TEST_CASE("contacts in lanes hear what rows of other pools do while it changes") {
  Both both({.meets_others = true});
  Numbers x;
  for (int k = 0; k < 6; ++k) {
    for (std::size_t n = 0; n < both.lanes.other_lambda.size(); ++n) {
      both.lanes.other_lambda[n] += 0.5 * x();
      both.scalar.other_lambda[n] = both.lanes.other_lambda[n];
    }
    const std::vector<double> before = both.lanes.lambda;
    both.sweep({.projects = k % 3 == 2, .descends = k % 3 == 1});
    CHECK(before != both.lanes.lambda);
    CHECK(both.difference() < rounding);
    MeasureSums sums[2];
    int side = 0;
    both.each([&](PoolOfContacts& pool) {
      for (const Span<double>& span : pool.colours.spans()) span.pool->table->measure(span, sums[side]);
      ++side;
    });
    CHECK(sums[1].residual == Approx(sums[0].residual).epsilon(1e-10));
    CHECK(sums[1].d == Approx(sums[0].d).epsilon(1e-10));
    CHECK(sums[1].u == Approx(sums[0].u).epsilon(1e-10));
  }
}

TEST_CASE("sums of a sweep and measures of contacts in lanes are those of each") {
  Both both({});
  for (int k = 0; k < 2; ++k) both.sweep();
  Sweep<double> sums[2];
  MeasureSums measures[2];
  int side = 0;
  both.each([&](PoolOfContacts& pool) {
    std::vector<double> before;
    for (const Span<double>& span : pool.colours.spans())
      for (const Index i : span)
        for (int k = 0; k < 3; ++k) before.push_back(0.5 * pool.lambda[3 * std::size_t(i) + std::size_t(k)]);
    const double* at = before.data();
    sums[side].tells_change = true;
    for (const Span<double>& span : pool.colours.spans()) {
      sums[side].x = at;
      span.pool->table->sweep(span, sums[side]);
      at += 3 * span.count;
    }
    for (const Span<double>& span : pool.colours.spans()) span.pool->table->measure(span, measures[side]);
    ++side;
  });
  REQUIRE(sums[0].energy > 0);
  for (double Sweep<double>::*x :
       {&Sweep<double>::energy, &Sweep<double>::along, &Sweep<double>::displacement, &Sweep<double>::most})
    CHECK(sums[1].*x == Approx(sums[0].*x).epsilon(1e-10));  // changes are differences of λ: fewer digits
  for (double MeasureSums::*x :
       {&MeasureSums::residual, &MeasureSums::siconos, &MeasureSums::d, &MeasureSums::u, &MeasureSums::lambda,
        &MeasureSums::closing, &MeasureSums::worst, &MeasureSums::reach}) {
    CHECK(measures[0].*x > 0);
    CHECK(measures[1].*x == Approx(measures[0].*x).epsilon(1e-10));
  }
}

TEST_CASE("contacts in lanes go on along their last change as each does") {
  Both both({});
  for (int k = 0; k < 2; ++k) both.sweep();
  std::vector<double> before[2];
  int side = 0;
  both.each([&](PoolOfContacts& pool) {
    for (const Span<double>& span : pool.colours.spans())
      for (const Index i : span)
        for (int k = 0; k < 3; ++k)
          before[side].push_back((i % 3 ? 0.5 : 1) * pool.lambda[3 * std::size_t(i) + std::size_t(k)]);
    ++side;
  });
  const std::vector<double> was = both.lanes.lambda;
  side = 0;
  both.each([&](PoolOfContacts& pool) {
    double* at = before[side++].data();
    for (const Span<double>& span : pool.colours.spans())
      span.pool->table->extrapolate(span, at, 0.7), at += 3 * span.count;
  });
  CHECK(was != both.lanes.lambda);
  CHECK(both.difference() < rounding);
  double most = 0;
  for (std::size_t k = 0; k < before[0].size(); ++k)
    most = std::max(most, std::abs(before[0][k] - before[1][k]));
  CHECK(most < rounding * both.scalar.largest());
}

TEST_CASE("contacts in lanes whose blocks are singular get impulses of the same effect") {
  Both both({.softest = 0});
  both.sweep();
  // The inverses are of blocks lifted by 64 roundings, so that λ along what W_ii does not see has no digit in
  // common. What it moves has: W_ii Δλ, of the size of the velocities times 1/64.
  for (std::size_t i = 0; i < both.lanes.items.size(); ++i) {
    const double *x = &both.scalar.lambda[3 * i], *y = &both.lanes.lambda[3 * i];
    CHECK(std::isfinite(y[0] + y[1] + y[2]));
    CHECK(std::hypot(y[1], y[2]) <= 0.5 * y[0] * (1 + 1e-14));
    CHECK((x[0] == 0) == (y[0] == 0));
  }
}

TEST_CASE("lanes sweep no span that is not theirs") {
  Both both({});
  const Span<double> whole = both.lanes.colours.spans()[0], other = both.scalar.colours.spans()[0];
  REQUIRE(whole.count > 20);
  Sweep<double> sums;
  // A part of a colour, and a copy of the pool, as solvers make them: to the last bit what the law does
  // alone.
  whole.pool->table->sweep({whole.pool, whole.items + 3, 7}, sums);
  other.pool->table->sweep({other.pool, other.items + 3, 7}, sums);
  CHECK(both.difference() == 0);
  const PoolView<double> copy = *whole.pool;
  whole.pool->table->sweep({&copy, whole.items, whole.count}, sums);
  other.pool->table->sweep(other, sums);
  CHECK(both.difference() == 0);
}

TEST_CASE("a number that is none stays with the contacts that it reaches") {
  Both both({});
  both.each([](PoolOfContacts& pool) { pool.d[3 * 10] = std::numeric_limits<double>::quiet_NaN(); });
  both.lanes.packed.fill(nullptr);
  both.sweep();
  for (std::size_t k = 0; k < both.lanes.lambda.size(); ++k)
    CHECK(std::isnan(both.lanes.lambda[k]) == std::isnan(both.scalar.lambda[k]));
}

TEST_CASE("threads that share the pieces of contacts in lanes leave the same bits") {
  std::vector<double> alone;
  for (const int helpers : {0, 1, 2, 7}) {
    PoolOfContacts pool(2000, {});
    Crew crew;
    Pieces<double> pieces;
    Island<double> island(&pool.span, 1, 0, 0.01);
    if (helpers > 0) island.set_crew(&crew);
    Array<Span<double>>& spans = pool.colours.spans();
    pool.packed.take(spans);
    island.pass_by(spans.data(), int(spans.size()), pieces);
    crew.assemble();
    std::vector<std::thread> threads;
    for (int k = 0; k < helpers; ++k) threads.emplace_back([&crew] { crew.help(); });
    pool.packed.fill(island.crew());
    Array<double> x;
    double sums = 0;
    for (int k = 0; k < 10; ++k) {
      double along = 0;
      island.save(x);
      sums += island.sweep({.tells_change = true}, x.data(), &along) + along + island.last_change();
      island.extrapolate(x, 0.3);
      sums += island.sweep({.projects = true}) + island.sweep({.descends = true}) + island.measure().residual;
    }
    crew.dismiss();
    for (std::thread& thread : threads) thread.join();
    std::vector<double> all = pool.lambda;
    all.push_back(sums);
    if (helpers == 0) alone = all;
    CHECK(all == alone);
    CHECK(sums > 0);
  }
}

}  // namespace contact_lanes_tests
