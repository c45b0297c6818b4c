#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace sort_tests {

using namespace delassus;

/// Numbers in [0, most], the same in every run.
std::vector<int> numbers(std::size_t count, int most) {
  std::vector<int> list(count);
  std::uint64_t x = 1;
  for (int& n : list) x = x * 6364136223846793005ull + 1442695040888963407ull, n = int((x >> 33) % std::uint64_t(most + 1));
  return list;
}

/// Lists of every kind that makes a partition go wrong: many repeats, ascending, descending, an organ pipe.
std::vector<std::vector<int>> lists() {
  std::vector<std::vector<int>> all;
  for (const std::size_t count : {0u, 1u, 2u, 3u, 15u, 16u, 17u, 18u, 33u, 100u, 1000u})
    for (const int most : {0, 1, 7, 1000000}) {
      std::vector<int> list = numbers(count, most);
      all.push_back(list);
      std::sort(list.begin(), list.end());
      all.push_back(list);
      std::reverse(list.begin() + std::ptrdiff_t(count / 2), list.end());
      all.push_back(list);
      std::sort(list.rbegin(), list.rend());
      all.push_back(list);
    }
  return all;
}

TEST_CASE("sorting gives what std::sort gives") {
  for (const std::vector<int>& list : lists()) {
    std::vector<int> expected = list, sorted = list, without_partition = list;
    std::sort(expected.begin(), expected.end());
    inner::sort(sorted);
    REQUIRE(sorted == expected);
    inner::sort_part(without_partition.data(), without_partition.data() + list.size(), 0, inner::Smaller{});
    REQUIRE(without_partition == expected);
    REQUIRE(inner::is_sorted(sorted.data(), sorted.data() + sorted.size()));
    REQUIRE(inner::is_sorted(list.data(), list.data() + list.size()) == std::is_sorted(list.begin(), list.end()));
    const auto is_larger = [](int a, int b) { return a > b; };
    inner::sort(sorted, is_larger);
    std::reverse(expected.begin(), expected.end());
    REQUIRE(sorted == expected);
  }
}

TEST_CASE("pairs and arrays of them are sorted as numbers are") {
  Array<std::pair<int, int>> pairs;
  for (int i = 0; i < 200; ++i) pairs.push_back({(i * 37) % 11, -i});
  std::vector<std::pair<int, int>> expected(pairs.begin(), pairs.end());
  std::sort(expected.begin(), expected.end());
  inner::sort(pairs);
  REQUIRE(std::equal(pairs.begin(), pairs.end(), expected.begin(), expected.end()));
}

TEST_CASE("what is selected stands between the smaller and the larger ones") {
  for (const std::vector<int>& list : lists())
    for (const std::size_t nth : {std::size_t(0), list.size() / 3, list.size() / 2, list.size() - 1}) {
      if (list.empty()) continue;
      std::vector<int> found = list, expected = list;
      std::sort(expected.begin(), expected.end());
      inner::select(found.data(), found.data() + nth, found.data() + found.size());
      REQUIRE(found[nth] == expected[nth]);
      for (std::size_t i = 0; i < found.size(); ++i) REQUIRE((i < nth ? found[i] <= found[nth] : found[i] >= found[nth]));
      std::sort(found.begin(), found.end());
      REQUIRE(found == expected);
    }
}

TEST_CASE("a search finds the first that is not less") {
  for (std::vector<int> list : lists()) {
    std::sort(list.begin(), list.end());
    int *const begin = list.data(), *const end = begin + list.size();
    for (const int key : {-1, 0, 3, 7, 500000, 1000001}) {
      REQUIRE(inner::lower_bound(begin, end, key) - begin == std::lower_bound(list.begin(), list.end(), key) - list.begin());
      REQUIRE(inner::is_listed(list, key) == std::binary_search(list.begin(), list.end(), key));
    }
    std::vector<int> once = list;
    once.erase(std::unique(once.begin(), once.end()), once.end());
    list.resize(std::size_t(inner::drop_repeats(begin, end) - begin));
    REQUIRE(list == once);
  }
}

TEST_CASE("a heap gives the largest first") {
  std::vector<int> list = numbers(100, 50), heap, taken;
  for (const int n : list) {
    heap.push_back(n);
    inner::push_on_heap(heap.data(), heap.size());
    REQUIRE(heap[0] == *std::max_element(heap.begin(), heap.end()));
  }
  for (; !heap.empty(); heap.pop_back()) {
    inner::pop_from_heap(heap.data(), heap.size());
    taken.push_back(heap.back());
  }
  std::sort(list.rbegin(), list.rend());
  REQUIRE(taken == list);
}

TEST_CASE("few comparisons, whatever the list") {
  for (const std::vector<int>& list : lists()) {
    long compared = 0;
    std::vector<int> sorted = list;
    inner::sort(sorted, [&](int a, int b) { return ++compared, a < b; });
    // A partition compares each element at most twice, to a depth of 2 log2 n; then insertion within 16, or a heap's 2 n log2 n.
    const double n = double(list.size()), log = std::log2(n + 1);
    REQUIRE(double(compared) <= 6 * n * log + 20 * n);
  }
}

TEST_CASE("two parts of a list are sorted and merged") {
  for (const std::vector<int>& list : lists())
    for (const std::size_t share : {0u, 1u, 2u, 3u, 4u}) {
      Array<int> mine(list.begin(), list.end()), scratch;
      std::vector<int> sorted = list;
      std::sort(sorted.begin(), sorted.end());
      inner::sort_and_merge(mine, list.size() * share / 4, scratch);
      CHECK(mine == sorted);
      inner::sort_and_merge(mine, list.size() * share / 4, scratch);
      CHECK(mine == sorted);
    }
}

}  // namespace sort_tests
