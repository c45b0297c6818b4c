// A scheme that overrides a stage: a wind that grows weaker acts in the free motion.
// prints: wind left 0\.135, box at x = 0\.13[0-9] m
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

struct Wind {
  using plays = role::Scheme;
  double acceleration = 8;  // m/s², along x
  double rate = 1;          // share of the wind that is lost each second

  template <class P>
  struct State {
    double strength = 1;
    void memory(auto& archive) { archive(strength); }
  };
  template <class Base>
  struct stages : Base {
    static void free_motion(auto& step) {
      Base::free_motion(step);
      double& strength = step.template state<role::Scheme>().strength;
      step.world().each([&](auto& set, auto) {
        for (auto& v : set.v_free) v[0] += step.step_size() * strength * step.scheme().acceleration;
      });
      strength -= step.step_size() * step.scheme().rate * strength;
    }
  };
  void check() const { DELASSUS_EXPECT(rate >= 0, "Wind: rate must be >= 0 1/s"); }
  void run(auto& step) const {
    stage::detect(step);
    stage::move(step);
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, Wind{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 1000; ++i) loop.step(2e-3);
  std::printf("wind left %.3f, box at x = %.3f m\n", loop.data().state<role::Scheme>().strength, rigid.position(box).x());
}
