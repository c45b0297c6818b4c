/// What the benchmarks run: a standing stack, a pile of spheres, plates with many contacts.
#pragma once

#include <delassus/delassus.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace scenes {

using namespace delassus;

/// `count` unit cubes of 1 kg on the ground, one on the other.
inline void add_stack(RigidBodies& set, int count) {
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < count; ++i) set.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
}

/// `side`³ spheres of 0.1 m and 1 kg above the ground, between four walls, every layer a little off the one below.
inline void add_pile(RigidBodies& set, int side) {
  const double radius = 0.1, pitch = 0.205, half = 0.5 * pitch * side + 0.05;
  set.add_fixed(HalfSpace{});
  for (int wall = 0; wall < 4; ++wall) {
    const double angle = 1.5707963267948966 * wall;
    const Vec3 inward{-std::cos(angle), -std::sin(angle), 0};
    set.add_fixed(HalfSpace{}, -half * inward, Quat::FromTwoVectors(Vec3::UnitZ(), inward));
  }
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double x = pitch * (i - 0.5 * (side - 1)), y = pitch * (j - 0.5 * (side - 1));
        const double off = 0.02 * ((k * 7 + i * 3 + j * 5) % 5 - 2);
        set.add({.position = {x + off, y - off, radius + pitch * k}, .mass = 1.0, .shape = Sphere{radius}});
      }
}

/// Steps a loop, and says per step: seconds by stage (a counter of 320u is 320 µs), sweeps, contacts. The loop listens with a Stopwatch.
template <class Loop>
void step_by_stage(benchmark::State& state, Loop& loop, double h) {
  Stopwatch::Times sum{};
  double sweeps = 0, contacts = 0, unconverged = 0, steps = 0;
  for (auto _ : state) {
    const StepReport report = loop.step(h);
    const Stopwatch::Times& lap = loop.template get<Stopwatch>().last();
    for (std::size_t s = 0; s < Stopwatch::stages; ++s) sum[s] += lap[s];
    sweeps += report.sweeps;
    contacts += report.contacts;
    unconverged += report.status == Status::converged ? 0 : 1;
    ++steps;
  }
  for (std::size_t s = 0; s < Stopwatch::stages; ++s)
    state.counters[Stopwatch::names[s]] = 1e-3 * sum[s] / steps;
  state.counters["sweeps"] = sweeps / steps;
  state.counters["contacts"] = contacts / steps;
  state.counters["unconverged"] = unconverged / steps;
}

}  // namespace scenes
