// A tick of the haptic channel with more and more contacts in the tool's island. What counts is not the mean: p50, p99 and
// the largest of 20 000 ticks, with the load of the machine beside them, and how far the force is from the converged one.
#include "scenes.hpp"

#include <delassus/haptics/haptic_channel.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>

using namespace scenes;

namespace {

/// A tool in a heap of balls between four walls: one island. `side`² × `layers` balls.
struct Heap {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<Coulomb>, VirtualCoupling>, NativeCollision, AcceleratedGaussSeidel,
                HapticChannel>
      loop;
  RigidBodies::Handle proxy{};
  Vec3 place{0.02, 0.01, 0};

  Heap(int side, int layers, double budget)
      : loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, VirtualCoupling{}},
             NativeCollision{.margin = 1e-3}, AcceleratedGaussSeidel{.max_iterations = 500},
             HapticChannel{.budget = budget}} {
    auto& set = bodies<RigidBodies>(loop.world());
    const double r = 0.02, pitch = 0.0404, half = 0.5 * pitch * side;
    set.add_fixed(HalfSpace{});
    for (int wall = 0; wall < 4; ++wall) {
      const double angle = 1.5707963267948966 * wall;
      const Vec3 inward{-std::cos(angle), -std::sin(angle), 0};
      set.add_fixed(HalfSpace{}, -half * inward, Quat::FromTwoVectors(Vec3::UnitZ(), inward));
    }
    for (int k = 0; k < layers; ++k)
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
          set.add({.position = {pitch * (i - 0.5 * (side - 1)), pitch * (j - 0.5 * (side - 1)), r + 0.04 * k},
                   .mass = 0.1, .shape = Sphere{r}});
    place.z() = 0.04 * layers;  // in touch all the time
    const auto tool = set.add({.position = place, .mass = 0.05, .shape = Sphere{0.012}});
    proxy = set.add({.position = place, .motion = Motion::kinematic});
    loop.channel<HapticChannel>().connect(loop.add(VirtualCoupling::Item{anchor(set, tool), anchor(set, proxy), 1000, 0.5}));
    for (int n = 0; n < 200; ++n) step(0);
  }
  void step(double depth) {
    bodies<RigidBodies>(loop.world()).move_to(proxy, place - Vec3(0, 0, depth));
    loop.step(1.0 / 60);
  }
};

/// The device presses the tool into the heap, 1 cm more and less at 2 Hz; the loop steps every 17 ticks, in the same thread and untimed.
void tick(benchmark::State& state) {
  Heap heap(int(state.range(0)), int(state.range(1)), 1e-6 * double(state.range(2)));
  Heap patient(int(state.range(0)), int(state.range(1)), std::numeric_limits<double>::infinity());
  auto& haptics = heap.loop.channel<HapticChannel>();
  auto& exact = patient.loop.channel<HapticChannel>();
  std::vector<double> times;
  times.reserve(1 << 16);
  double sweeps = 0, late = 0, error = 0, force = 0, contacts = 0, before = 0;
  long n = 0;
  for (auto _ : state) {
    const double phase = 2 * 3.141592653589793 * 2 * 1e-3 * double(n), depth = 0.005 * (1 - std::cos(phase));
    if (n % 17 == 0) {
      heap.step(depth);
      if (n < 2000) patient.step(depth);
    }
    const DeviceState device{.position = heap.place - Vec3(0, 0, depth), .velocity = Vec3(0, 0, -(depth - before) / 1e-3)};
    before = depth;
    const auto start = std::chrono::steady_clock::now();
    const HapticForce f = haptics.tick(device);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    state.SetIterationTime(seconds);
    times.push_back(seconds);
    sweeps += f.solve.sweeps;
    late += f.solve.status == Status::deadline;
    contacts += heap.loop.report().contacts;
    if (n < 2000) {
      const Vec3 wanted = exact.tick(device).force;
      error = std::max(error, (f.force - wanted).norm());
      force = std::max(force, wanted.norm());
    }
    ++n;
  }
  std::sort(times.begin(), times.end());
  double load[1] = {0};
  if (getloadavg(load, 1) != 1) load[0] = -1;
  state.counters["p50"] = times[times.size() / 2];
  state.counters["p99"] = times[times.size() * 99 / 100];
  state.counters["max"] = times.back();
  state.counters["contacts"] = contacts / double(n);
  state.counters["sweeps"] = sweeps / double(n);
  state.counters["late"] = late / double(n);
  state.counters["max_force_N"] = force;
  state.counters["max_error_N"] = error;
  state.counters["load"] = load[0];
}
BENCHMARK(tick)->ArgNames({"side", "layers", "budget_us"})->Args({2, 2, 80})->Args({3, 3, 80})->Args({3, 4, 80})->Args({4, 4, 80})
    ->Args({3, 3, 1000})->UseManualTime()->Iterations(20000)->Unit(benchmark::kMicrosecond);

/// What publishing adds to a step of the loop.
void publish(benchmark::State& state) {
  Heap heap(int(state.range(0)), int(state.range(1)), 1e-4);
  auto& haptics = heap.loop.channel<HapticChannel>();
  for (auto _ : state) haptics.publish(heap.loop);
  state.counters["contacts"] = double(heap.loop.report().contacts);
}
BENCHMARK(publish)->ArgNames({"side", "layers"})->Args({3, 3})->Args({4, 4})->Unit(benchmark::kMicrosecond);

}  // namespace
