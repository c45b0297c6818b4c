#include <delassus/solvers/inner/colouring.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

namespace colouring_tests {

using namespace delassus;
using namespace delassus::inner;

namespace {

/// Items that meet others as a list of pairs says.
struct Meetings {
  std::vector<std::vector<Index>> of;
  std::vector<Index> start, column, all;
  std::vector<double> lambda;
  BlockRowsView<double> blocks{};
  PoolView<double> view;

  explicit Meetings(Index count) : of(std::size_t(count)) {
    for (Index i = 0; i < count; ++i) all.push_back(i);
    lambda.resize(std::size_t(count));
  }
  Meetings(const Meetings&) = delete;

  void meet(Index i, Index j) { of[std::size_t(i)].push_back(j), of[std::size_t(j)].push_back(i); }
  void finish() {
    for (const auto& row : of) {
      start.push_back(Index(column.size()));
      column.insert(column.end(), row.begin(), row.end());
    }
    start.push_back(Index(column.size()));
    blocks = {start.data(), column.data(), nullptr, lambda.data(), 1};
    view.rows = 1, view.items = Index(of.size()), view.lambda = lambda.data();
    view.block_rows = 1, view.blocks = &blocks;
  }
  Span<double> span() const { return {&view, all.data(), Index(all.size())}; }
  bool do_meet(Index i, Index j) const {
    for (const Index k : of[std::size_t(i)])
      if (k == j) return true;
    return false;
  }
};

/// Each item meets up to twelve others at random.
void make_random(Meetings& m) {
  std::uint64_t state = 7;
  const Index count = Index(m.of.size());
  for (Index i = 0; i < count; ++i)
    for (int n = 0; n < 6; ++n) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      const Index j = Index((state >> 33) % std::uint64_t(count));
      if (j != i && !m.do_meet(i, j)) m.meet(i, j);
    }
  m.finish();
}

/// The items of all spans, those of one next to those of the next, each span behind its length.
std::vector<Index> list_of(Colouring<double>& colours) {
  std::vector<Index> out;
  for (const Span<double>& span : colours.spans()) {
    out.push_back(span.count);
    out.insert(out.end(), span.begin(), span.end());
  }
  return out;
}

void check_sound(const Meetings& m, Colouring<double>& colours) {
  std::set<Index> seen;
  for (const Span<double>& span : colours.spans()) {
    REQUIRE(span.count > 0);
    CHECK(span.pool == &m.view);
    for (const Index i : span) {
      CHECK(seen.insert(i).second);
      for (const Index j : span) CHECK(!m.do_meet(i, j));
    }
    // pieces follow each other, so that threads which share a colour stay near to what they wrote
    for (Index k = items_of_piece + 1; k < span.count; ++k)
      CHECK(span.items[k] > span.items[k / items_of_piece * items_of_piece - 2]);
    // what copies a span at once must not take it for one without gaps, unless it is
    bool is_ascending = true;
    for (Index k = 1; k < span.count; ++k) is_ascending &= span.items[k] == span.items[0] + k;
    CHECK(span.is_gapless() == is_ascending);
  }
  CHECK(seen.size() == m.of.size());
}

}  // namespace

TEST_CASE("no two items of a colour meet and each item has one colour") {
  Meetings m(500);
  make_random(m);
  const Span<double> span = m.span();
  Colouring<double> colours;
  REQUIRE(colours.make(&span, &span + 1));
  check_sound(m, colours);
  std::size_t most = 0;
  for (const auto& row : m.of) most = std::max(most, row.size());
  CHECK(colours.spans().size() > 2);
  CHECK(colours.spans().size() <= most + 1);  // a greedy choice finds one that none of the neighbours has
}

TEST_CASE("items in a row are coloured alike each time whatever was coloured before") {
  Meetings m(300), other(77);
  make_random(m), make_random(other);
  const Span<double> span = m.span(), another = other.span();
  Colouring<double> fresh, used;
  REQUIRE(fresh.make(&span, &span + 1));
  REQUIRE(used.make(&another, &another + 1));
  CHECK(list_of(used) != list_of(fresh));
  REQUIRE(used.make(&span, &span + 1));
  CHECK(list_of(used) == list_of(fresh));
}

TEST_CASE("colours of items that are all in a row or meet nobody are spans without gaps or with") {
  for (const Index count : {1, 2, 3, 50}) {
    Meetings alone(count);
    alone.finish();
    const Span<double> span = alone.span();
    Colouring<double> colours;
    REQUIRE(colours.make(&span, &span + 1));
    CHECK(colours.spans().size() == 1);
    check_sound(alone, colours);
  }
  Meetings chain(50);
  for (Index i = 0; i + 1 < 50; ++i) chain.meet(i, i + 1);
  chain.finish();
  const Span<double> span = chain.span();
  Colouring<double> colours;
  REQUIRE(colours.make(&span, &span + 1));
  CHECK(colours.spans().size() == 2);
  check_sound(chain, colours);
}

TEST_CASE("items that find no colour stand alone") {
  Meetings m(80);
  for (Index i = 0; i < 70; ++i)
    for (Index j = 0; j < i; ++j) m.meet(i, j);
  m.finish();
  const Span<double> span = m.span();
  Colouring<double> colours;
  REQUIRE(colours.make(&span, &span + 1));
  check_sound(m, colours);
  CHECK(colours.spans().size() == 70);
}

TEST_CASE("pools are coloured one by one and a W without blocks not at all") {
  Meetings a(40), b(30);
  make_random(a), make_random(b);
  const Span<double> both[2] = {a.span(), b.span()};
  Colouring<double> colours;
  REQUIRE(colours.make(both, both + 2));
  Index items[2] = {};
  bool is_second = false;
  for (const Span<double>& span : colours.spans()) {
    CHECK((!is_second || span.pool == &b.view));
    is_second = span.pool == &b.view;
    items[is_second] += span.count;
  }
  CHECK(items[0] == 40);
  CHECK(items[1] == 30);
  b.view.form = FormOfW::bodies;
  CHECK(!colours.make(both, both + 2));
}

// Who has no colour takes none: not an item outside of the span either, whatever room was there before.
TEST_CASE("the colours of an island do not depend on what its items meet outside of it") {
  Meetings all(60);
  for (Index i = 0; i < 30; i += 3) all.meet(i, i + 30);
  for (Index i = 0; i + 1 < 30; ++i) all.meet(i, i + 1);
  all.finish();
  const Span<double> span{&all.view, all.all.data(), 30};
  Colouring<double> fresh, used;
  REQUIRE(fresh.make(&span, &span + 1));
  CHECK(fresh.spans().size() == 2);  // those of a chain
  const Span<double> whole = all.span();
  REQUIRE(used.make(&whole, &whole + 1));
  REQUIRE(used.make(&span, &span + 1));
  CHECK(list_of(used) == list_of(fresh));
}

}  // namespace colouring_tests
