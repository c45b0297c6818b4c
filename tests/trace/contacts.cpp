/// Rigid bodies and contacts with the default parts: a heap, a slope, a tower, materials, bounces, rolling.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto by_default(double friction = 0.5, double tolerance = 1e-6) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       AcceleratedGaussSeidel{.tolerance = tolerance}};
}
auto by_sweeps() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.35}}}, GaussSeidel{}};
}
auto rolling() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{RollingCoulomb{
                           .friction = 0.4, .rolling_friction = 0.01, .torsional_friction = 0.02}}}};
}
auto bouncing(double e) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, e}}}};
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("contacts");
  const Options faces{.is_redundant = true};
  all.add("heap", faces, [] {
    auto loop = by_default();
    add_heap(loop);
    return loop;
  });
  all.add("tumble", {.h = 0.01, .change = 0.25, .is_redundant = true}, [] {
    auto loop = by_default(0.3, 1e-9);
    add_tumble(loop);
    return loop;
  });
  all.add("balls", {}, [] {
    auto loop = by_default();
    add_balls(loop);
    return loop;
  });
  all.add("tower_heavy_above", faces, [] {
    auto loop = by_default();
    auto& set = rigid_of(loop);
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
    set.add({.position = {0.1, 0, 1.5}, .velocity = {1, 0, 0}, .mass = 10.0, .shape = Box{1, 1, 1}});
    return loop;
  });
  all.add("materials", faces, [] {
    auto loop = by_default();
    const Index ice = loop.materials().add({.friction = 0.05}),
                rubber = loop.materials().add({.friction = 1.2});
    auto& set = rigid_of(loop);
    set.add({.shape = HalfSpace{}, .motion = Motion::fixed, .material = rubber});
    for (const Index m : {ice, rubber})
      set.add({.position = {0, m == ice ? 0. : 2., 0.2},
               .velocity = {4, 0, 0},
               .mass = 1.0,
               .shape = Box{0.6, 0.6, 0.4},
               .material = m});
    return loop;
  });
  all.add("heap_by_sweeps", faces, [] {
    auto loop = by_sweeps();
    add_heap(loop);
    return loop;
  });
  all.add("slope_by_sweeps", faces, [] {
    auto loop = by_sweeps();
    add_slope(loop);
    return loop;
  });
  all.add("balls_that_stop_rolling", {}, [] {
    auto loop = rolling();
    add_balls(loop);
    return loop;
  });
  all.add("bounces", {.h = 0.005, .is_redundant = true}, [] {
    auto loop = bouncing(0.6);
    add_tumble(loop);
    return loop;
  });
  // A thin rod slaps the ground against its slip, at step 20: restitution alone would add energy there.
  all.add("rod_that_slaps", {.h = 0.005, .is_redundant = true}, [] {
    auto loop = bouncing(0.9);
    auto& set = rigid_of(loop);
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.258 + std::sin(0.9)},
             .orientation = exponential<double>(Vec3(0, 0.9, 0)),
             .velocity = {-3, 0, -2},
             .mass = 1.0,
             .shape = Box{2, 0.05, 0.05}});
    return loop;
  });
  return all.main(argc, argv);
}
