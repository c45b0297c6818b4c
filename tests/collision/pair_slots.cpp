#include "catch.hpp"

#include <delassus/collision/inner/pair_slots.hpp>

#include <map>
#include <random>
#include <set>

namespace pair_slots_tests {

using namespace delassus;
using inner::ListedPair;

namespace {

Array<ListedPair> list_of(const std::set<std::uint64_t>& pairs) {
  Array<ListedPair> list;
  for (const std::uint64_t pair : pairs) {
    ListedPair job;
    job.pair = pair, job.a = Index(pair), job.b = Index(pair) + 1;
    list.push_back(job);
  }
  return list;
}

/// Reads and writes as checkpoints do, one array.
struct Archive {
  Array<inner::RestingPair>& kept;
  bool reads;
  void operator()(Array<inner::RestingPair>& pairs) { reads ? void(pairs = kept) : void(kept = pairs); }
};

}  // namespace

TEST_CASE("a pair keeps its slot while it is listed and no two share one") {
  std::mt19937 random(7);
  inner::PairSlots slots;
  std::set<std::uint64_t> pairs;
  std::map<std::uint64_t, Index> last;
  Index most = 0, highest = -1;
  int kept = 0;
  for (int step = 0; step < 200; ++step) {
    for (int change = 0; change < 6; ++change) {
      const std::uint64_t pair = random() % 60;
      if (!pairs.insert(pair).second) pairs.erase(pair);
    }
    Array<ListedPair> list = list_of(pairs);
    slots.assign(list);
    std::map<std::uint64_t, Index> now;
    std::set<Index> taken;
    for (const ListedPair& job : list) {
      REQUIRE(job.slot >= 0);
      REQUIRE(taken.insert(job.slot).second);
      REQUIRE(slots[job.slot].pair == job.pair);
      const auto before = last.find(job.pair);
      if (before != last.end()) {
        REQUIRE(before->second == job.slot);
        REQUIRE(slots[job.slot].count == 1 + int(job.pair % 4));  // what was written there
        ++kept;
      } else {
        REQUIRE(slots[job.slot].count == 0);  // a fresh memory, whoever had the slot
        REQUIRE(slots[job.slot].is_plain);
        REQUIRE(slots[job.slot].margin < 0);
        slots[job.slot].count = std::uint8_t(1 + job.pair % 4);
        slots[job.slot].margin = 1;
        slots[job.slot].is_plain = false;
      }
      highest = std::max(highest, job.slot);
      now[job.pair] = job.slot;
    }
    last = now;
    most = std::max(most, Index(list.size()));
    // One step lists pairs that are fresh before the slots of those that have gone are free: at most both
    // lists are held.
    REQUIRE(highest < 2 * 60);
  }
  CHECK(kept > 2000);
  CHECK(most > 15);
}

TEST_CASE("slots of pairs that have gone are taken again") {
  inner::PairSlots slots;
  for (int step = 0; step < 50; ++step) {
    std::set<std::uint64_t> pairs;
    for (int i = 0; i < 10; ++i) pairs.insert(std::uint64_t(100 * step + i));
    Array<ListedPair> list = list_of(pairs);
    slots.assign(list);
    for (const ListedPair& job : list) REQUIRE(job.slot < 20);
  }
}

TEST_CASE("each asks the memories of the last list in its order") {
  inner::PairSlots slots;
  Array<ListedPair> list = list_of({3, 8, 21});
  slots.assign(list);
  list = list_of({1, 8, 40});
  slots.assign(list);
  std::vector<std::uint64_t> seen;
  slots.each([&](const inner::RestingPair& m) { seen.push_back(m.pair); });
  CHECK(seen == std::vector<std::uint64_t>{1, 8, 40});
  list = list_of({});
  slots.assign(list);
  slots.each([&](const inner::RestingPair&) { FAIL("no pair is listed"); });
}

TEST_CASE("memories that were kept and read again are those of their pairs wherever they lie") {
  inner::PairSlots slots;
  Array<ListedPair> list = list_of({5, 6, 7, 9});
  slots.assign(list);
  list = list_of({2, 6, 9});  // 2 has a slot behind those of 6 and 9
  slots.assign(list);
  for (const ListedPair& job : list) {
    inner::RestingPair& m = slots[job.slot];
    m.normal = Vec3(double(job.pair), 0, 1);
    m.count = 2;
    m.point[0].id = std::uint32_t(job.pair), m.point[1].id = 17;
    m.margin = job.pair == 6 ? 0.5 : -1;
    m.impact.is_there = job.pair == 9;
    m.impact.id = 4;
    m.see_if_plain();
  }
  Array<inner::RestingPair> kept, again;
  Archive write{kept, false};
  slots.memory(write);
  REQUIRE(kept.size() == 3);
  inner::PairSlots other;
  Archive read{kept, true};
  other.memory(read);
  Array<ListedPair> same = list_of({2, 4, 6, 9});
  other.assign(same);
  for (const ListedPair& job : same) {
    const inner::RestingPair& m = other[job.slot];
    REQUIRE(m.pair == job.pair);
    if (job.pair == 4) {
      CHECK(m.count == 0);
      continue;
    }
    CHECK(m.normal == Vec3(double(job.pair), 0, 1));
    CHECK(m.count == 2);
    CHECK(m.point[0].id == job.pair);
    CHECK((m.margin > 0) == (job.pair == 6));
    CHECK(m.impact.is_there == (job.pair == 9));
    CHECK(!m.is_plain);
  }
  // Written once more it is the same to the byte.
  same = list_of({2, 6, 9});
  other.assign(same);
  Archive once_more{again, false};
  other.memory(once_more);
  REQUIRE(again.size() == kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    CHECK(std::memcmp(static_cast<const void*>(&kept[i]), static_cast<const void*>(&again[i]),
                      sizeof kept[i]) == 0);
}

}  // namespace pair_slots_tests
