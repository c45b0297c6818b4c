/// What integrators that make their whole step have in common.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/integrator.hpp>

#include <string>

namespace delassus::inner {

/// The numbers of a Newton's method, of the integrator `name`.
inline void check_newton(const std::string& name, double tolerance, int max_iterations) {
  DELASSUS_EXPECT(tolerance >= 0, name + ": tolerance " + text(tolerance) + " must be >= 0");
  DELASSUS_EXPECT(max_iterations > 0, name + ": max_iterations " + text(max_iterations) + " must be > 0");
}

/// p += f(q, v), and all of it times h: N·s.
void kick(const auto& set, auto& p, double h) {
  set.add_forces(p);
  times(p, h);
}

/// The step has put the bodies where they are; their velocity is v_next.
void arrive(auto& set, double h) {
  if constexpr (requires { set.arrive(h); }) set.arrive(h);
}

}  // namespace delassus::inner
