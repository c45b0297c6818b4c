#include <delassus/core/archive.hpp>
#include <delassus/core/pack.hpp>

#include "catch.hpp"

#include <string>
#include <type_traits>

namespace pack_tests {

using namespace delassus;

struct Empty {};

TEST_CASE("parts of a pack are reached by number and by type") {
  inner::Pack<int, std::string> pack{{1}, {"two"}};
  REQUIRE(inner::part<0>(pack) == 1);
  REQUIRE(inner::part_of_type<std::string>(pack) == "two");
  inner::part<0>(pack) = 3;
  const auto& fixed = pack;
  REQUIRE(inner::part_of_type<int>(fixed) == 3);
  static_assert(std::is_same_v<decltype(inner::part<1>(fixed)), const std::string&>);
}

TEST_CASE("a pack goes through its parts in order") {
  const inner::Pack<int, double, char> pack{{1}, {0.5}, {'c'}};
  std::string said;
  pack.each([&](const auto& x) { said += std::to_string(sizeof x) + " "; });
  REQUIRE(said == "4 8 1 ");
  inner::Pack<>{}.each([](auto&) {});
}

TEST_CASE("empty parts take no room") {
  static_assert(std::is_empty_v<inner::Pack<Empty>>);
  static_assert(sizeof(inner::Pack<int, Empty>) == sizeof(int));
  static_assert(std::is_same_v<inner::pack_of<std::tuple<int, Empty>>::type, inner::Pack<int, Empty>>);
  static_assert(std::is_trivially_copyable_v<inner::Pack<int, Empty>>);
}

TEST_CASE("an archive keeps a pack") {
  inner::Pack<int, double> pack{{1}, {0.5}}, read{};
  ArchiveWriter writer;
  writer(pack);
  ArchiveReader(writer.data)(read);
  REQUIRE(inner::part<0>(read) == 1);
  REQUIRE(inner::part<1>(read) == 0.5);
}

}  // namespace pack_tests
