/// What steps do to the energy of one set of bodies.
#pragma once

#include <algorithm>

/// The energy now, J.
template <class Set>
double total_energy(const Set& set) {
  return kinetic_energy(set) + potential_energy(set);
}

/// The largest rise in a step, J, below zero where every step loses, and the energy after the last one.
struct EnergyWatch {
  double rise, last;
};
template <class Loop, class Set>
EnergyWatch watch_energy(Loop& loop, const Set& set, int steps, double h) {
  double last = total_energy(set), rise = -last;
  for (int n = 0; n < steps; ++n) {
    loop.step(h);
    const double now = total_energy(set);
    rise = std::max(rise, now - last);
    last = now;
  }
  return {rise, last};
}
