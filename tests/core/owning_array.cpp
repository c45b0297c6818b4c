#include <delassus/core/archive.hpp>
#include <delassus/core/owning_array.hpp>

#include "catch.hpp"

#include <span>
#include <utility>

namespace owning_array_tests {

using namespace delassus;

TEST_CASE("elements of an owning array never move") {
  OwningArray<Array<int>> lists(1);
  const Array<int>* const first = &lists[0];
  lists[0].push_back(7);
  lists.resize(100);
  REQUIRE(&lists[0] == first);
  REQUIRE(lists[0] == Array<int>{7});
  REQUIRE(lists.back().empty());
}

TEST_CASE("what comes back is empty and has its room still") {
  OwningArray<Array<int>> lists(3);
  lists[2].resize(50);
  const int* const room = lists[2].data();
  lists.clear();
  lists.resize(3);
  REQUIRE(lists[2].empty());
  REQUIRE(lists[2].capacity() >= 50);
  lists[2].push_back(1);
  REQUIRE(lists[2].data() == room);
}

TEST_CASE("a copy owns its own elements") {
  OwningArray<Array<int>> lists;
  lists.push_back({1, 2});
  lists.push_back({3});
  OwningArray<Array<int>> copy = lists;
  copy[0][0] = 9;
  REQUIRE(lists[0] == Array<int>{1, 2});
  copy = lists;
  REQUIRE(copy[0] == Array<int>{1, 2});
  REQUIRE(copy.size() == 2);
  const OwningArray<Array<int>> moved = std::move(copy);
  REQUIRE(moved[1] == Array<int>{3});
  int sum = 0;
  for (const Array<int>& list : moved)
    for (const int n : list) sum += n;
  REQUIRE(sum == 6);
}

TEST_CASE("an archive keeps an owning array") {
  OwningArray<Array<int>> lists, read;
  lists.push_back({1, 2});
  lists.emplace_back();
  ArchiveWriter writer;
  writer(lists);
  ArchiveReader reader(writer.data);
  reader(read);
  REQUIRE(reader.is_at_end());
  REQUIRE(read.size() == 2);
  REQUIRE(read[0] == Array<int>{1, 2});
  REQUIRE(read[1].empty());
}

}  // namespace owning_array_tests
