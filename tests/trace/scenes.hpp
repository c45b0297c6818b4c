/// Small scenes of the trace programs: a few bodies to which something happens.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/math/rotation.hpp>

#include <vector>

namespace trace {

using namespace delassus;

/// The first set of a loop.
auto& rigid_of(auto& loop) { return loop.world().template set<0>(); }

/// A box that falls over its edge and a ball that slides and then rolls: contacts of one to four points come
/// and go.
void add_tumble(auto& loop) {
  auto& set = rigid_of(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.6},
           .orientation = exponential<double>({0.1, 0.9, 0}),
           .mass = 1.0,
           .shape = Box{0.5, 0.4, 1}});
  set.add({.position = {-2, 0, 0.25},
           .velocity = {3, 0.1, 0},
           .angular_velocity = {0, -4, 0},
           .mass = 2.0,
           .shape = Sphere{0.2}});
}

/// A box on a box, off its middle and turning, and round ones that come later.
void add_heap(auto& loop) {
  auto& set = rigid_of(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.25}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
  set.add({.position = {0.2, 0, 0.78},
           .angular_velocity = {0, 0.5, 0},
           .mass = 2.0,
           .shape = Box{0.5, 0.4, 0.5}});
  set.add({.position = {0.1, 0.05, 1.7}, .velocity = {0.3, 0, -1}, .mass = 0.7, .shape = Sphere{0.2}});
  set.add({.position = {-0.9, 0, 0.6}, .velocity = {1.5, 0, 0}, .mass = 1.5, .shape = Capsule{0.15, 0.4}});
}

/// Two boxes on a slope: one is slowed down, one is thrown upward and comes back.
void add_slope(auto& loop) {
  auto& set = rigid_of(loop);
  const Quat lean(Eigen::AngleAxisd(0.4, Vec3::UnitY()));
  set.add_fixed(Box{40, 20, 1}, lean * Vec3(0, 0, -0.5), lean);
  const double speeds[] = {3, -2};
  for (int k = 0; k < 2; ++k)
    set.add({.position = lean * Vec3(0, 0.8 * k, 0.15),
             .orientation = lean,
             .velocity = lean * Vec3(speeds[k], 0.2 * k, 0),
             .mass = 1.0 + k,
             .shape = Box{0.5, 0.4, 0.3}});
}

/// Balls one above the other and beside, the lowest light: they hit, part and roll away.
void add_balls(auto& loop, int count = 3) {
  auto& set = rigid_of(loop);
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < count; ++k)
    set.add({.position = {0.03 * k, 0.02 * k, 0.3 + 0.45 * k},
             .velocity = {0.5 - 0.3 * k, 0, -1},
             .angular_velocity = {0, 2, 1},
             .mass = 0.5 + k,
             .shape = Sphere{0.2}});
}

/// `count` bars from (0, 0, top) along x, the ends of which hold each other: f(a, b) for the two ends of each
/// joint.
template <class F>
void add_chain(auto& loop, int count, double top, const F& f, double last_mass = 2) {
  auto& set = rigid_of(loop);
  Anchor end = world_anchor({0, 0, top});
  for (int k = 0; k < count; ++k) {
    const auto bar = set.add({.position = {0.25 + 0.5 * k, 0, top},
                              .velocity = {0, 0.4 * k, 0},
                              .mass = k + 1 == count ? last_mass : 1.0,
                              .shape = Box{0.4, 0.1, 0.1}});
    f(end, anchor(set, bar, {-0.25, 0, 0}));
    end = anchor(set, bar, {0.25, 0, 0});
  }
}

}  // namespace trace
