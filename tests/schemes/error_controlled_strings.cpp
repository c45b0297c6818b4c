// Strings that snap taut under steps that keep an error: the search for the jerk ends.
#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

namespace error_controlled_strings_tests {

using namespace delassus;

namespace {

struct Work {
  long steps = 0, rejections = 0, at_floor = 0, impacts = 0;
  void add(const ErrorReport& r) {
    steps += r.steps, rejections += r.rejections, at_floor += r.at_floor;
    impacts += r.by_effect[std::size_t(ErrorEffect::impact)].steps;
  }
};

auto strings(double accuracy) {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Limit<Length>{}},
                       ImplicitMidpoint{},
                       PositionProjection{},
                       AcceleratedGaussSeidel{.tolerance = 1e-11},
                       ErrorControlled{.accuracy = accuracy, .length = 0.1, .max_step = 0.02}};
}

/// Each rejection halves a step at least, and a step doubles at most after an event: so a jerk costs
/// log2(max_step/min_step) = 17.6 of them, once for itself and once where the string goes slack again or
/// another one answers.
void ends(const Work& work) {
  CAPTURE(work.steps, work.rejections, work.impacts, work.at_floor);
  CHECK(work.impacts >= 1);
  CHECK(work.at_floor <= 10);
  CHECK(work.rejections <= 2 * 18 * work.impacts);
}

}  // namespace

// Dropped from beside the hook, the ball falls 1 m freely and is held: after √(2/g) = 0.45 s.
TEST_CASE("a ball that falls into its string is held without a step at the floor") {
  for (const double e : {0.0, 0.5})
    for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      auto loop = strings(accuracy);
      auto& set = bodies<RigidBodies>(loop.world());
      const auto ball = set.add({.position = {0.01, 0, 0}, .mass = 2.0, .shape = Sphere{0.05}});
      loop.add(Limit<Length>::Item{
          .a = world_anchor({0, 0, 0}), .b = anchor(set, ball), .upper = 1, .restitution = e});
      Work work;
      double longest = 0;
      for (int n = 0; n < 40; ++n)
        loop.step(0.02), work.add(error_report(loop)), longest = std::max(longest, set.position(ball).norm());
      CAPTURE(e, accuracy, longest);
      ends(work);
      CHECK(longest < 1 + accuracy + 1e-6);
    }
}

// 30 m/s to a stop, with steps of up to 0.1 s: each ends where it was seen ahead, or 3 m beyond.
TEST_CASE("no slider passes its stop unseen under error control") {
  for (const double stop : {2.603, 9.7, 30.834, 49.75})
    for (const double H : {0.01, 0.1}) {
      AnimationLoop loop{World{RigidBodies{}},
                         Constraints{Slider{}, Limit<Slide>{}},
                         ImplicitMidpoint{},
                         AcceleratedGaussSeidel{.tolerance = 1e-10},
                         PositionProjection{.rate = 1},
                         ErrorControlled{}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const auto body = set.add({.velocity = {30, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
      const Quat along = frame_along({1, 0, 0});
      const Anchor hook = world_anchor({0, 0, 0}, along), end = anchor(set, body, {0, 0, 0}, along);
      loop.add(Slider::Item{hook, end});
      loop.add(Limit<Slide>::Item{.a = hook, .b = end, .lower = -1e9, .upper = stop, .restitution = 0.5});
      double farthest = 0;
      for (int n = 0; n * H < 2 * stop / 30; ++n)
        loop.step(H), farthest = std::max(farthest, set.position(body).x());
      CAPTURE(stop, H);
      CHECK(farthest < stop + 1e-3 * 0.5 + 1e-6);
    }
}

// Ten balls on strings of 10 cm, drawn together to 4 cm, the last one heavy: they fall, and each string snaps
// once or more.
TEST_CASE("a chain of strings that snaps taut ends its search at every accuracy") {
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
    auto loop = strings(accuracy);
    auto& set = bodies<RigidBodies>(loop.world());
    Anchor last = world_anchor({0, 0, 0});
    for (int k = 1; k <= 10; ++k) {
      const auto ball = set.add(
          {.position = {0.01 * (k % 3), 0, -0.04 * k}, .mass = k == 10 ? 2.0 : 0.2, .shape = Sphere{0.01}});
      loop.add(Limit<Length>::Item{.a = last, .b = anchor(set, ball), .upper = 0.1});
      last = anchor(set, ball);
    }
    Work work;
    for (int n = 0; n < 20; ++n) loop.step(0.02), work.add(error_report(loop));
    CAPTURE(accuracy);
    ends(work);
    CHECK(work.impacts >= 10);
  }
}

}  // namespace error_controlled_strings_tests
