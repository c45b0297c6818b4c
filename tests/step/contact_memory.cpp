#include <delassus/step/contact_memory.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace contact_memory_tests {

using namespace delassus;

namespace {

using Entry = ContactMemory::Entry;

/// What is asked of the memory, one entry after another: by name, else the nearest within reach, of two the
/// later one.
Vec3 looked_up(std::vector<Entry>& entries, const Entry& asked, double reach) {
  Entry* found = nullptr;
  for (Entry& e : entries)
    if (!e.is_taken && !found && e.pair == asked.pair && e.feature == asked.feature) found = &e;
  double nearest = reach * reach;
  if (!found)
    for (Entry& e : entries) {
      const double distance = (e.point - asked.point).squaredNorm();
      if (!e.is_taken && e.pair == asked.pair && distance <= nearest) nearest = distance, found = &e;
    }
  if (!found) return Vec3::Zero();
  found->is_taken = true;
  return found->impulse;
}

}  // namespace

TEST_CASE(
    "a contact finds the impulse of its name, or the nearest unclaimed one, as looking through all of them "
    "does") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const bool is_flat : {false, true})
    for (const double reach : {0.02, 0.3}) {
      // Three pairs of 1, 7 and 400 contacts on a grid, so that many are equally far; names in steps, some
      // twice.
      std::vector<Entry> entries;
      for (const auto& [pair, count] : {std::pair{5u, 1}, {9u, 7}, {12u, 400}})
        for (int i = 0; i < count; ++i) {
          const double x = uniform(random), y = uniform(random), z = uniform(random);
          Vec3 point(is_flat ? 1 : std::round(8 * x) / 8, std::round(8 * y) / 8, std::round(8 * z) / 8);
          if (i == 3) point[1] = std::numeric_limits<double>::quiet_NaN();
          entries.push_back({pair, std::uint32_t(3 * (i / 2 * 2)), false, point, Vec3(1 + i, x, y)});
        }
      ContactMemory memory;
      const auto room = memory.renew(entries.size());
      std::copy(entries.begin(), entries.end(), room.begin());
      memory.sort();
      int named = 0, near = 0, none = 0;
      for (int k = 0; k < 600; ++k) {
        const Entry& of = entries[std::size_t(random() % entries.size())];
        const double x = uniform(random), y = uniform(random);
        Entry asked = of;
        if (k % 2 == 1) asked.feature = 1 + std::uint32_t(3 * k);  // a name nobody has
        if (is_finite(asked.point))
          asked.point += 0.5 * reach * Vec3(0, std::round(2 * x) / 2, std::round(2 * y) / 2);
        const Vec3 expected = looked_up(entries, asked, reach);
        REQUIRE(memory.take(asked.pair, asked.feature, asked.point, [&] { return reach; }) == expected);
        (is_zero(expected) ? none : k % 2 == 1 ? near : named) += 1;
      }
      CHECK(named > 50);
      CHECK(near > 50);
      CHECK(none > 5);
      CHECK(is_zero(memory.take(77, 0, Vec3::Zero(), [&] { return reach; })));  // a pair that is new
    }
}

}  // namespace contact_memory_tests
