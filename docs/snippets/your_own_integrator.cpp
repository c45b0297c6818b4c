// Two integrators of your own for a drag that takes a share of the momentum a second, and the order of each.
// prints: Euler:    order 1\.0[0-9][^a-z]*midpoint: order 2\.0[0-9]
#include <delassus/delassus.hpp>

#include <cmath>
#include <cstdio>

using namespace delassus;

// v⁺ = v + h (M⁻¹ f − rate v),  q⁺ = q ⊕ h v⁺.
struct DraggedEuler {
  using plays = role::Integrator;
  double rate = 0.5;  // 1/s

  void check() const {
    if (!(rate >= 0)) throw InvalidArgument("DraggedEuler: rate must be >= 0 1/s");
  }
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);                         // p = f
    set.add_mass_times_velocity(p, -rate);     // p = f − rate M v
    times(p, h);                               // p = h (f − rate M v)
  }
  void advance(auto& set, double h) const { set.advance(h); }
};
static_assert(Integrator<DraggedEuler>);

// The drag at the mean of both velocities, which adds h rate/2 M to A.
struct DraggedMidpoint : ImplicitMidpoint {
  double rate = 0.5;  // 1/s

  SystemScale scale(double h) const { return {.mass = 1 + h * rate / 2, .damping = h / 2, .stiffness = h * h / 4}; }
  void impulse(const auto& set, auto& p, double h) const {
    ImplicitMidpoint::impulse(set, p, h);
    set.add_mass_times_velocity(p, -rate * h);
  }
};
static_assert(Integrator<DraggedMidpoint>);

// How far a falling particle is from the closed form after one second, m.
double error(auto integrator, double h) {
  AnimationLoop loop{World{Particles{}}, integrator};
  auto& points = bodies<Particles>(loop.world());
  const auto stone = points.add({.position = {0, 0, 0}, .velocity = {3, 0, 5}, .mass = 0.2});
  for (long i = std::lround(1 / h); i > 0; --i) loop.step(h);

  const double c = integrator.rate, end = 9.81 / c, share = (1 - std::exp(-c)) / c;  // at t = 1 s
  return (points.position(stone) - Vec3(3 * share, 0, (5 + end) * share - end)).norm();
}

double order(auto integrator) { return std::log2(error(integrator, 0.02) / error(integrator, 0.01)); }

int main() {
  std::printf("Euler:    order %.2f\n", order(DraggedEuler{}));
  std::printf("midpoint: order %.2f\n", order(DraggedMidpoint{}));
}
