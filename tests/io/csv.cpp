#include <delassus/io/csv.hpp>

#include "catch.hpp"

#include <cstdlib>

using namespace delassus;

TEST_CASE("commas, quotes and line ends are quoted") {
  Table table{.columns = {"name, unit", "value"}};
  table.add({"say \"hi\"\n", 2.5});
  REQUIRE(csv_text(table) == "\"name, unit\",value\n\"say \"\"hi\"\"\n\",2.5\n");
}

TEST_CASE("series keep every bit, and one that nobody measured leaves its field empty") {
  RecordedSteps steps;
  steps.time = {0.1};
  steps.energy = {1.0 / 3};
  steps.stages = {{"solve", {0.25}}};
  const std::string text = csv_text(steps);
  REQUIRE(text == "time,energy,residual,sweeps,solve\n0.1,0.3333333333333333,,,0.25\n");
  REQUIRE(std::atof(text.c_str() + text.find("0.3333")) == 1.0 / 3);
}

TEST_CASE("a series of another length is refused by name") {
  RecordedSteps steps;
  steps.time = {0.1, 0.2};
  steps.sweeps = {3};
  REQUIRE_THROWS_WITH(csv_text(steps), "delassus: series: series 'sweeps' has 1 samples for 2 steps");
}
