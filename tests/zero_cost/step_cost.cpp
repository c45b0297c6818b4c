// Runs one scene for a number of steps: the difference of two runs under callgrind is the instructions of a step.
//   step_cost <particles|bodies|pendulum|pendulums> <library> <steps>
//   step_cost <bodies> <named> <steps>                 every default named, and a listener that hears nothing
//   step_cost <pendulum|pendulums> <unused> <steps>    with a law that has no item
#include "library_pendulums.hpp"
#include "step_scenes.hpp"

#include <delassus/delassus.hpp>

#include <cstdlib>
#include <string>

using namespace step_scenes;

namespace {

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

}  // namespace

int main(int count_of_words, char** words) {
  if (count_of_words != 4) return 2;
  const std::string what = std::string(words[1]) + " " + words[2];
  const int steps = std::atoi(words[3]);
  if (what == "particles library") run(LibraryParticles{}, steps);
  else if (what == "bodies library") run(LibraryBodies<>{}, steps);
  else if (what == "bodies named") run(LibraryBodies<SymplecticEuler, Silent, PlainOrder>{}, steps);
  else if (what == "pendulum library") run(LibraryPendulums<1, Constraints<BallJoint>>{}, steps);
  else if (what == "pendulum unused") run(LibraryPendulums<1, Constraints<BallJoint, DistanceJoint>>{}, steps);
  else if (what == "pendulums library") run(LibraryPendulums<100, Constraints<BallJoint>>{}, steps);
  else if (what == "pendulums unused") run(LibraryPendulums<100, Constraints<BallJoint, DistanceJoint>>{}, steps);
  else return 2;
}
