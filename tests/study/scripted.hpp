/// A loop whose error and cost are written down: studies of it are exact, and need no physics.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/schemes/error_report.hpp>
#include <delassus/step/step_report.hpp>
#include <delassus/study/sweep.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace scripted {

using namespace delassus;

/// An "integrator" whose value at time t is t + factor · h^order, and whose step costs `price` seconds.
template <int order, int which = 0>
struct Method {
  double factor = 1, price = 1;
  std::string code() const {
    return "Method<" + std::to_string(order) + ", " + std::to_string(which) + ">{}";
  }
};
/// A "solver" that adds its tolerance to the error and takes a sweep for every decade of it.
struct Sweeps {
  double tolerance = 0;
};
/// What may go wrong.
struct Sound {};
struct Caps {};
struct Blows {};
struct Vanishes {};  // a value that is not a number, without a status that says so
struct Refuses {};

/// A "scheme" that takes steps which leave an error of `accuracy`, and repeats each third.
struct Keeps {
  double accuracy = 1e-3;
};

struct Loop {
  double* clock;
  Keeps keeps{0};
  double factor = 0, order = 1, price = 1, tolerance = 0;
  int fault = 0;
  double time = 0, h = 0;
  long count = 0;

  const Loop& data() const { return *this; }
  template <class Role>
  const Keeps& policy() const {
    return keeps;
  }
  double value() const {
    if (fault == 3 && time > 0.5) return std::numeric_limits<double>::quiet_NaN();
    return time + (time > 0 ? (keeps.accuracy > 0 ? keeps.accuracy : factor * std::pow(h, order)) + tolerance : 0);
  }
  StepReport step(double by) {
    h = by;
    time = ++count * by;
    *clock += price;
    StepReport report{.sweeps = tolerance > 0 ? int(std::lround(-std::log10(tolerance))) : 1,
                      .max_penetration = 0.25 * by};
    if (fault == 1 && count % 4 == 0) report.status = Status::max_iterations;
    if (fault == 2 && count == 5) report.status = Status::quarantined;
    return report;
  }
};

/// What `sweep` asks a loop that keeps an accuracy.
inline ErrorReport error_report(const Loop&) { return {.steps = 6, .rejections = 2}; }

/// The scene: how many loops it built is counted.
struct Scene {
  double* clock;
  int* built;

  template <class... P>
  Loop operator()(const P&... policies) const {
    Loop loop{.clock = clock};
    ++*built;
    (take(loop, policies), ...);
    return loop;
  }

 private:
  template <int order, int which>
  static void take(Loop& loop, const Method<order, which>& m) {
    loop.factor = m.factor;
    loop.order = order;
    loop.price = m.price;
  }
  static void take(Loop& loop, const Keeps& k) { loop.keeps = k; }
  static void take(Loop& loop, const Sweeps& s) { loop.tolerance = s.tolerance; }
  static void take(Loop&, const Sound&) {}
  static void take(Loop& loop, const Caps&) { loop.fault = 1; }
  static void take(Loop& loop, const Blows&) { loop.fault = 2; }
  static void take(Loop& loop, const Vanishes&) { loop.fault = 3; }
  static void take(Loop&, const Refuses&) { throw InvalidArgument("this scene wants no such policy"); }
};

/// A scene with a clock and a count of its own.
struct Stage {
  double seconds = 0;
  int built = 0;
  Scene scene{&seconds, &built};
  ScriptedClock clock() { return {.time = &seconds}; }
};

inline const auto value = [](const Loop& loop) { return loop.value(); };
inline const auto exact = [](double t) { return t; };

}  // namespace scripted
