// Runs one scene for a number of steps: the difference of two runs under callgrind is the instructions of a step.
//   step_cost <particles|bodies|pendulum|pendulums> <library|hand> <steps>
//   step_cost <bodies> <named> <steps>                 every default named, and a listener that hears nothing
//   step_cost <pendulum|pendulums> <unused> <steps>    with a law that has no item
#include "by_hand.hpp"

#include <delassus/delassus.hpp>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

using namespace delassus;

namespace {

constexpr double h = 1e-3;
constexpr int count = 100;

struct Draw {
  std::minstd_rand random{5};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 vector() {
    const double x = (*this)(-1, 1), y = (*this)(-1, 1), z = (*this)(-1, 1);
    return {x, y, z};
  }
};

Mat3 moments(double m) { return m * Vec3(0.2, 0.3, 0.4).asDiagonal().toDenseMatrix(); }

/// Steps and prints one coordinate, so that the two ways can be compared and nothing is optimised away.
template <class Scene>
[[gnu::noinline]] void run(Scene&& scene, int steps) {
  for (int i = 0; i < steps; ++i) scene.step();
  std::printf("%.17g\n", scene.answer());
}

struct LibraryParticles {
  AnimationLoop<World<Particles>> loop{World{Particles{}}};
  LibraryParticles() {
    Draw draw;
    auto& set = bodies<Particles>(loop.world());
    for (int i = 0; i < count; ++i) {
      const Vec3 x = draw.vector(), v = draw.vector();
      set.add({.position = x, .velocity = v, .mass = draw(1, 2)});
    }
  }
  [[gnu::noinline]] void step() { loop.step(h); }
  double answer() { return bodies<Particles>(loop.world()).point({.block = 7}).z(); }
};

struct HandParticles {
  by_hand::Particles set;
  HandParticles() {
    Draw draw;
    for (int i = 0; i < count; ++i) {
      const Vec3 x = draw.vector(), v = draw.vector();
      set.add(x, v, draw(1, 2));
    }
  }
  [[gnu::noinline]] void step() { set.step(h); }
  double answer() { return set.x[7].z(); }
};

struct Silent {
  using plays = role::Listener;
  using listens = Listens<>;
};

template <class... Policies>
struct LibraryBodies {
  AnimationLoop<World<RigidBodies>, Policies...> loop{World{RigidBodies{}}, Policies{}...};
  LibraryBodies() {
    Draw draw;
    auto& set = bodies<RigidBodies>(loop.world());
    for (int i = 0; i < count; ++i) {
      const Vec3 x = draw.vector(), v = draw.vector(), w = draw.vector();
      const double m = draw(1, 2);
      set.add({.position = x, .velocity = v, .angular_velocity = w, .mass = m, .inertia = moments(m)});
    }
  }
  [[gnu::noinline]] void step() { loop.step(h); }
  double answer() { return bodies<RigidBodies>(loop.world()).point({.block = 7, .local = {1, 2, 3}}).z(); }
};

struct HandBodies {
  by_hand::Bodies set;
  HandBodies() {
    Draw draw;
    for (int i = 0; i < count; ++i) {
      const Vec3 x = draw.vector(), v = draw.vector(), w = draw.vector();
      const double m = draw(1, 2);
      set.add(x, v, w, m, moments(m));
    }
  }
  [[gnu::noinline]] void step() { set.step(h); }
  double answer() { return (set.x[7] + set.R[7] * Vec3(1, 2, 3)).z(); }
};

/// Pendulums side by side: one shows what a step costs before anything is done, a hundred what a constraint costs.
template <int pendulums, class... Laws>
struct LibraryPendulums {
  AnimationLoop<World<RigidBodies>, Constraints<Laws...>> loop{World{RigidBodies{}}, Constraints{Laws{}...}};
  LibraryPendulums() {
    auto& set = bodies<RigidBodies>(loop.world());
    for (int i = 0; i < pendulums; ++i) {
      const auto bob = set.add({.position = {1, 3.0 * i, 0}, .mass = 1.0, .inertia = moments(1)});
      loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 3.0 * i, 0})});
    }
  }
  [[gnu::noinline]] void step() { loop.step(h); }
  double answer() { return bodies<RigidBodies>(loop.world()).point({.block = 0}).z(); }
};

template <int pendulums>
struct HandPendulums {
  std::vector<by_hand::Pendulum> all;
  double residual = 0, violation = 0;
  HandPendulums() {
    for (int i = 0; i < pendulums; ++i) {
      by_hand::Pendulum& one = all.emplace_back();
      one.body.add({1, 3.0 * i, 0}, Vec3::Zero(), Vec3::Zero(), 1, moments(1));
      one.hook = {0, 3.0 * i, 0};
      one.arm = {-1, 0, 0};
    }
  }
  [[gnu::noinline]] void step() {
    residual = violation = 0;
    for (by_hand::Pendulum& one : all) {
      one.step(h);
      residual = std::max(residual, one.residual);
      violation = std::max(violation, one.violation);
    }
  }
  double answer() { return all[0].body.x[0].z(); }
};

}  // namespace

int main(int count_of_words, char** words) {
  if (count_of_words != 4) return 2;
  const std::string what = std::string(words[1]) + " " + words[2];
  const int steps = std::atoi(words[3]);
  if (what == "particles library") run(LibraryParticles{}, steps);
  else if (what == "particles hand") run(HandParticles{}, steps);
  else if (what == "bodies library") run(LibraryBodies<>{}, steps);
  else if (what == "bodies named") run(LibraryBodies<SymplecticEuler, Silent, PlainOrder>{}, steps);
  else if (what == "bodies hand") run(HandBodies{}, steps);
  else if (what == "pendulum library") run(LibraryPendulums<1, BallJoint>{}, steps);
  else if (what == "pendulum unused") run(LibraryPendulums<1, BallJoint, DistanceJoint>{}, steps);
  else if (what == "pendulum hand") run(HandPendulums<1>{}, steps);
  else if (what == "pendulums library") run(LibraryPendulums<100, BallJoint>{}, steps);
  else if (what == "pendulums unused") run(LibraryPendulums<100, BallJoint, DistanceJoint>{}, steps);
  else if (what == "pendulums hand") run(HandPendulums<100>{}, steps);
  else return 2;
}
