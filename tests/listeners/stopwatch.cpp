#include <delassus/delassus.hpp>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "catch.hpp"

using namespace delassus;

namespace {

auto resting_box() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, Stopwatch{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  return loop;
}

}  // namespace

TEST_CASE("a stopwatch has one lap per step, and its stages add up to no more than the step took") {
  auto loop = resting_box();
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 50; ++i) loop.step(1e-2);
  const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const auto& watch = loop.get<Stopwatch>();
  REQUIRE(watch.laps().size() == 50);
  double sum = 0;
  for (const auto& lap : watch.laps())
    for (const double ms : lap) {
      CHECK(ms >= 0);
      sum += ms;
    }
  CHECK(sum > 0);
  CHECK(sum <= wall);  // the stages are disjoint parts of what the clock outside saw
}

TEST_CASE("the trace is a list of one complete event per stage and step, back to back") {
  auto loop = resting_box();
  for (int i = 0; i < 3; ++i) loop.step(1e-2);
  const std::string path = "stopwatch_trace.json";
  loop.get<Stopwatch>().write_trace(path);
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  const std::string trace = text.str();
  std::size_t events = 0;
  for (std::size_t at = trace.find("\"ph\":\"X\""); at != std::string::npos; at = trace.find("\"ph\":\"X\"", at + 1)) ++events;
  CHECK(events == 3 * Stopwatch::stages);
  CHECK(trace.substr(0, 2) == "[\n");
  CHECK(trace.substr(trace.size() - 3) == "\n]\n");
  std::remove(path.c_str());
}

TEST_CASE("a trace that cannot be written says which file") {
  CHECK_THROWS_WITH(Stopwatch{}.write_trace("no/such/folder/trace.json"),
                    Catch::Contains("no/such/folder/trace.json"));
}
