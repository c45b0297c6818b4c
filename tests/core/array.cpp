#include <delassus/core/array.hpp>
#include <delassus/math/linear.hpp>

#include "catch.hpp"

#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace array_tests {

using namespace delassus;

namespace {

struct alignas(64) Wide {
  double x[8];
};
struct Numbered {
  int number = 7;
  double rest;
};

template <class T>
bool is_aligned(const Array<T>& list) {
  return reinterpret_cast<std::uintptr_t>(list.data()) % alignof(T) == 0;
}

struct Boxed {
  using CopiedByBytes = Boxed;
  Eigen::AlignedBox3d box;
};
struct Owner : Boxed {
  std::vector<int> list;
};
static_assert(std::is_same_v<ArrayOrVector<Vec3>, Array<Vec3>> && std::is_same_v<ArrayOrVector<Boxed>, Array<Boxed>>);
static_assert(std::is_same_v<ArrayOrVector<Owner>, std::vector<Owner>>);
static_assert(std::is_same_v<ArrayOrVector<std::string>, std::vector<std::string>>);

}  // namespace

TEST_CASE("a growing array keeps what was pushed, as std::vector does") {
  Array<Vec3> list;
  std::vector<Vec3> same;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x(i, -i, 0.5 * i);
    list.push_back(x);
    same.push_back(x);
  }
  REQUIRE(list == std::span<const Vec3>(same));
  REQUIRE(list.size() == 1000);
  REQUIRE(list.front() == same.front());
  REQUIRE(list.back() == same.back());
  list.pop_back();
  REQUIRE_FALSE(list == std::span<const Vec3>(same));
}

TEST_CASE("an element of the array itself may be pushed, inserted and filled in while it grows") {
  for (std::size_t n = 1; n < 40; ++n) {
    Array<int> list{41};
    while (list.size() < n) list.push_back(list[0] + int(list.size()));
    list.push_back(list[0]);  // at every size, full ones too
    REQUIRE(list.back() == 41);
    list.insert(list.begin(), list.back());
    REQUIRE(list[0] == 41);
    list.resize(3 * n + 5, list[0]);
    REQUIRE(list.back() == 41);
    list.assign(7 * n + 9, list[1]);
    REQUIRE(list.back() == 41);
  }
}

TEST_CASE("new elements are what T() is") {
  Array<double> zeros(3);
  zeros[1] = 5;
  zeros.clear();
  zeros.resize(3);
  for (const double x : zeros) REQUIRE(x == 0);
  Array<Numbered> numbered(4);
  for (const Numbered& x : numbered) REQUIRE(x.number == 7);
  Array<std::pair<int, int>> pairs(2);
  REQUIRE(pairs[1] == std::pair(0, 0));
}

TEST_CASE("memory has the alignment that the type asks for") {
  Array<Wide> wide;
  for (int i = 0; i < 20; ++i) {
    wide.push_back({{double(i)}});
    REQUIRE(is_aligned(wide));
  }
  REQUIRE(wide[13].x[0] == 13);
  Array<Mat<4, 4>> matrices(3, Mat<4, 4>::Identity());
  REQUIRE(is_aligned(matrices));
  REQUIRE(matrices[2].trace() == 4);
}

TEST_CASE("a copy is of its own, a moved array is empty, and assigning to itself changes nothing") {
  Array<int> a{1, 2, 3};
  Array<int> b = a;
  b[0] = 9;
  REQUIRE(a[0] == 1);
  a = *&a;
  REQUIRE(a == Array<int>{1, 2, 3});
  Array<int> c = std::move(a);
  REQUIRE(a.empty());
  REQUIRE(c.size() == 3);
  b = std::move(c);
  REQUIRE(c.empty());
  REQUIRE(b == Array<int>{1, 2, 3});
  b = std::move(*&b);
  REQUIRE(b == Array<int>{1, 2, 3});
  b = Array<int>{};
  REQUIRE(b.empty());
  swap(a, b);
  REQUIRE(a.empty());
}

TEST_CASE("cleared and filled again, an array keeps its memory") {
  Array<double> list(100, 1.0);
  const double* const before = list.data();
  const std::size_t room = list.capacity();
  list.clear();
  list.resize(100);
  REQUIRE(list.data() == before);
  list = Array<double>(50, 2.0);  // a move takes the other's
  const Array<double> other(40, 3.0);
  const double* const now = list.data();
  list = other;
  REQUIRE(list.data() == now);
  REQUIRE(room == 100);
}

TEST_CASE("elements are taken out and put in where they are asked for") {
  Array<int> list(10);
  std::iota(list.begin(), list.end(), 0);
  erase_if(list, [](int x) { return x % 3 == 0; });
  REQUIRE(list == Array<int>{1, 2, 4, 5, 7, 8});
  list.erase(list.begin() + 1, list.begin() + 3);
  REQUIRE(list == Array<int>{1, 5, 7, 8});
  list.erase(list.end() - 1);
  list.insert(list.begin() + 1, 3);
  REQUIRE(list == Array<int>{1, 3, 5, 7});
  const std::vector<int> more{9, 11};
  list.append(more.begin(), more.end());
  REQUIRE(list == Array<int>{1, 3, 5, 7, 9, 11});
  list = std::span<const int>(more);
  REQUIRE(list == Array<int>{9, 11});
}

TEST_CASE("more elements than memory can hold are refused, and what is there stays") {
  Array<Vec3> list(2, Vec3(1, 2, 3));
  REQUIRE_THROWS_AS(list.reserve(std::size_t(-1) / 8), std::bad_alloc);
  REQUIRE(list[1] == Vec3(1, 2, 3));
}

}  // namespace array_tests
