// The scenes of step_cost.cpp by hand.
//   step_cost_by_hand <particles|bodies|pendulum|pendulums> <hand> <steps>
#include "by_hand.hpp"
#include "step_scenes.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

using namespace step_scenes;

namespace {

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
  if (what == "particles hand") run(HandParticles{}, steps);
  else if (what == "bodies hand") run(HandBodies{}, steps);
  else if (what == "pendulum hand") run(HandPendulums<1>{}, steps);
  else if (what == "pendulums hand") run(HandPendulums<100>{}, steps);
  else return 2;
}
