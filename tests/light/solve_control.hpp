/// What may end a solve from outside, and who hears of it.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/solvers/measure.hpp>

#include <limits>

namespace light {

using namespace delassus;

/// Plain functions with a context each. Without a deadline no clock is read, and a span is as long as its
/// pool.
struct SolveControl {
  static constexpr Index longest_piece = 64;

  double deadline = std::numeric_limits<double>::infinity();  ///< on the clock, s
  double (*now)(void* clock) = nullptr;
  void* clock = nullptr;
  void (*observe)(void* observer, int sweeps, const Measure&) = nullptr;  ///< after each measure
  void* observer = nullptr;

  bool has_deadline() const { return deadline < std::numeric_limits<double>::infinity(); }
  bool is_late() const { return has_deadline() && now(clock) >= deadline; }
  Index longest_span() const { return has_deadline() ? longest_piece : std::numeric_limits<Index>::max(); }
  void notify(int sweeps, const Measure& m) const {
    if (observe) observe(observer, sweeps, m);
  }
};

}  // namespace light
