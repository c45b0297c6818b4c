/// What a study calls an error: the measures its user chooses.
#pragma once

#include <delassus/bodies/invariants.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// What one measure saw in one run: `width` numbers at the start and at every output, and the worst of the
/// steps.
struct Observation {
  std::size_t width = 0;
  std::vector<double> values;
  double worst = 0;
};

namespace inner {

/// The larger one, and infinity once something is not a number: an error never becomes smaller by not being
/// one.
inline double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::max(a, b);
}

inline void append_look(std::vector<double>& out, const Quat& q) {
  for (const double x : {q.x(), q.y(), q.z(), q.w()}) out.push_back(x);
}
template <class X>
void append_look(std::vector<double>& out, const X& look) {
  if constexpr (std::is_arithmetic_v<X>) {
    out.push_back(double(look));
  } else {
    for (std::size_t k = 0; k < std::size_t(look.size()); ++k) out.push_back(double(look[k]));
  }
}
template <class X>
void observe(Observation& seen, const X& look) {
  const std::size_t before = seen.values.size();
  append_look(seen.values, look);
  seen.width = seen.values.size() - before;
}

/// The largest distance(own, theirs, width) over the outputs; infinite where one of the two has fewer.
template <class Distance>
double largest_distance(const Observation& own, const Observation& other, const Distance& distance) {
  if (own.width != other.width || own.values.size() != other.values.size())
    return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t k = 0; k + own.width <= own.values.size() && own.width > 0; k += own.width)
    largest = larger(largest, distance(&own.values[k], &other.values[k], own.width));
  return largest;
}

struct NoExact {};

}  // namespace inner

/// |x − y|.
struct Distance {
  double operator()(const double* x, const double* y, std::size_t width) const {
    double square = 0;
    for (std::size_t k = 0; k < width; ++k) square += (x[k] - y[k]) * (x[k] - y[k]);
    return std::sqrt(square);
  }
};

/// The angle between two orientations, rad: 4 asin(½ min|p ∓ q|), accurate where 2 acos(p·q) loses half the
/// digits.
struct AngleBetween {
  double operator()(const double* p, const double* q, std::size_t) const {
    const auto length = [&](double sign) {
      double square = 0;
      for (int k = 0; k < 4; ++k) square += (p[k] - sign * q[k]) * (p[k] - sign * q[k]);
      return std::sqrt(square);
    };
    return 4 * std::asin(std::min(1.0, 0.5 * std::min(length(1), length(-1))));
  }
};

/// The largest distance at the outputs between look(loop) and a reference: `exact(t)` where it is given, else
/// the runs that the study's `References` name. `look` and `exact` return a number, a vector, or a Quat.
template <class Look, class Exact = inner::NoExact, class Between = Distance>
struct Compared {
  static constexpr bool has_exact = !std::is_same_v<Exact, inner::NoExact>;
  static constexpr bool needs_reference = !has_exact;
  std::string name, unit;
  Look look;
  Exact exact;
  Between between;

  Compared(std::string what, std::string in, Look look_at, Exact truth = {}, Between distance = {})
      : name(std::move(what)),
        unit(std::move(in)),
        look(std::move(look_at)),
        exact(std::move(truth)),
        between(std::move(distance)) {}

  void begin(const auto& loop, Observation& seen) const { inner::observe(seen, look(loop)); }
  void output(const auto& loop, Observation& seen) const { inner::observe(seen, look(loop)); }
  void step(const StepReport&, Observation&) const {}
  double error(const Observation& own, const Observation& reference) const {
    return inner::largest_distance(own, reference, between);
  }
};

/// An orientation, look(loop) being a Quat, against the reference of the study.
template <class Look>
auto turned(const char* name, Look look) {
  return Compared<Look, inner::NoExact, AngleBetween>(name, "rad", std::move(look));
}

/// How far look(loop) ever is from what it was at the start: energy, momentum. Needs no reference.
template <class Look>
struct Kept {
  static constexpr bool has_exact = false, needs_reference = false;
  std::string name, unit;
  Look look;

  void begin(const auto& loop, Observation& seen) const { inner::observe(seen, look(loop)); }
  void output(const auto& loop, Observation& seen) const { inner::observe(seen, look(loop)); }
  void step(const StepReport&, Observation&) const {}
  double error(const Observation& own, const Observation&) const {
    Observation start{.width = own.width, .values = {}, .worst = 0};
    for (std::size_t k = 0; own.width > 0 && k < own.values.size(); ++k)
      start.values.push_back(own.values[k % own.width]);
    return inner::largest_distance(own, start, Distance{});
  }
};
template <class Look>
Kept(const char*, const char*, Look) -> Kept<Look>;

/// The largest look(report) of all steps: drift, penetration, residual. Needs no reference.
template <class Look>
struct Worst {
  static constexpr bool has_exact = false, needs_reference = false;
  std::string name, unit;
  Look look;

  void begin(const auto&, Observation&) const {}
  void output(const auto&, Observation&) const {}
  void step(const StepReport& report, Observation& seen) const {
    seen.worst = inner::larger(seen.worst, std::abs(look(report)));
  }
  double error(const Observation& own, const Observation&) const { return own.worst; }
};
template <class Look>
Worst(const char*, const char*, Look) -> Worst<Look>;

/// The largest violation of a joint, m; rad counts as m where a joint has angles.
inline auto joint_drift() {
  return Worst{"joint drift", "m", [](const StepReport& r) { return r.max_joint_violation; }};
}
inline auto penetration() {
  return Worst{"penetration", "m", [](const StepReport& r) { return r.max_penetration; }};
}
inline auto solver_residual() {
  return Worst{"residual", "1", [](const StepReport& r) { return r.residual; }};
}
/// The change of kinetic and potential energy of all bodies.
inline auto energy_change() {
  return Kept{
      "energy change", "J", [](const auto& loop) {
        double sum = 0;
        loop.world().each([&](const auto& set, auto) { sum += kinetic_energy(set) + potential_energy(set); });
        return sum;
      }};
}

/// `Measures{Compared{...}, energy_change()}`: every run is measured by all of them.
template <class... M>
struct Measures {
  static constexpr std::size_t count = sizeof...(M);
  static_assert(count > 0, "delassus: a study needs at least one error measure");
  static constexpr bool needs_reference = (M::needs_reference || ...);
  std::tuple<M...> all;

  explicit Measures(M... measures) : all(std::move(measures)...) {}

  /// f(measure, its number).
  template <class F>
  void each(F&& f) const {
    std::size_t k = 0;
    std::apply([&](const auto&... measure) { (f(measure, k++), ...); }, all);
  }
};
template <class... M>
Measures(M...) -> Measures<M...>;

}  // namespace delassus
