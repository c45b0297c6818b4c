#include <delassus/core/array.hpp>
#include <delassus/core/slice.hpp>

#include "catch.hpp"

#include <span>
#include <vector>

namespace slice_tests {

using namespace delassus;

int sum_of(inner::Slice<const int> list) {
  int sum = 0;
  for (const int n : list) sum += n;
  return sum;
}

TEST_CASE("every list in one piece is taken for a slice") {
  const std::vector<int> vector{1, 2, 3};
  const Array<int> array{4, 5};
  CHECK(sum_of(vector) == 6);
  CHECK(sum_of(array) == 9);
  CHECK(sum_of(std::span<const int>(vector).subspan(1)) == 5);
  CHECK(sum_of(Array<int>{7}) == 7);
  CHECK(sum_of({vector.data(), 2}) == 3);
  CHECK(inner::Slice<const int>(std::vector<int>()).empty());
}

TEST_CASE("what is written through a slice is in its list") {
  Array<int> array{1, 2};
  const inner::Slice<int> slice(array);
  slice[1] = 5;
  CHECK(array[1] == 5);
  CHECK(slice.size() == 2);
  CHECK(sum_of(slice) == 6);
}

}  // namespace slice_tests
