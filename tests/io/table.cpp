#include <delassus/io/table.hpp>

#include "catch.hpp"

using namespace delassus;

TEST_CASE("words stand to the left, numbers to the right, and no line ends in spaces") {
  Table table{.title = "Runs", .caption = "One core.", .columns = {"scene", "time (µs)", "note"}};
  table.add({"stack", 12.3456, "ok"});
  table.add({"a long name", 5, ""});
  REQUIRE(aligned_text(table) ==
          "Runs\n"
          "scene        time (µs)  note\n"
          "-----------  ---------  ----\n"
          "stack             12.3  ok\n"
          "a long name          5\n"
          "One core.\n");
}

TEST_CASE("a number keeps the digits it was given") {
  REQUIRE(Cell(1.23456e-7).text == "1.23e-07");
  REQUIRE(Cell(1.23456, 5).text == "1.2346");
  REQUIRE(Cell(1000000).text == "1000000");
  REQUIRE_FALSE(Cell("7").is_number);
}

TEST_CASE("a row of another length is refused by name and number") {
  Table table{.title = "Runs", .columns = {"a", "b"}};
  table.add({1, 2});
  REQUIRE_THROWS_WITH(table.add({1}), "delassus: table 'Runs': row #1 has 1 cells for 2 columns");
}

TEST_CASE("a table without rows prints its columns") {
  REQUIRE(aligned_text({.columns = {"a", "bb"}}) == "a  bb\n-  --\n");
}
