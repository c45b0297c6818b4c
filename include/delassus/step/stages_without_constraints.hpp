/// The stages of a loop without constraints: bodies move freely.
#pragma once

#include <delassus/step/free_motion.hpp>

#include <tuple>

namespace delassus {

/// The same ten as in `PlainStages`. Nothing overrides them.
struct StagesWithoutConstraints {
  static void begin(auto& step, double h) {
    step.begin_clock(h);
    step.world().each([&](auto& set, auto) { set.begin_step(h); });
  }
  static void detect(auto&) {}
  static void linearize(auto&) {}
  static void free_motion(auto& step) {
    step.world().each([&](auto& set, auto s) {
      delassus::free_motion(set, set, step.integrator(), inner::part<s>(step.scratch), step.h);
    });
  }
  static void find_islands(auto&) {}
  static void make_bias(auto&) {}
  static void build(auto&) {}
  static void solve(auto&) {}
  static void correct(auto& step) {
    step.world().each([](auto& set, auto) { set.v_next = set.v_free; });
  }
  static bool find_missed(auto&) { return false; }
  static void advance(auto& step) {
    step.world().each([&](auto& set, auto) {
      step.integrator().advance(set, step.h);
      step.summary.quarantined += set.quarantined();
    });
    step.end_clock();
  }
};

}  // namespace delassus
