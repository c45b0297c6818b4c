// A loop behind a pointer: a class whose header names the loop and reads nothing of Eigen. Three files in one.
// prints: height after 2 s: 0\.500 m
// --- machine.hpp
#include <delassus/fwd.hpp>

#include <memory>

class Machine {
 public:
  Machine();
  ~Machine();
  double advance(double seconds);  // returns the height of the box, m

 private:
  using Loop = delassus::AnimationLoop<delassus::World<delassus::RigidBodies>,
                                       delassus::Constraints<delassus::Contact<delassus::Coulomb>>>;
  struct Parts;
  std::unique_ptr<Loop> loop_;
  std::unique_ptr<Parts> parts_;
};

// --- machine.cpp
#include <delassus/delassus.hpp>

using namespace delassus;

struct Machine::Parts {
  RigidBodies::Handle box;
};

Machine::Machine()
    : loop_(new Loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}}), parts_(new Parts) {
  auto& rigid = bodies<RigidBodies>(loop_->world());
  rigid.add_fixed(HalfSpace{});
  parts_->box = rigid.add({.position = {0, 0, 2}, .mass = 1.0, .shape = Box{1, 1, 1}});
}
Machine::~Machine() = default;

double Machine::advance(double seconds) {
  loop_->step(seconds);
  return bodies<RigidBodies>(loop_->world()).position(parts_->box).z();
}

// --- main.cpp
#include <cstdio>

int main() {
  Machine machine;
  double height = 0;
  for (int i = 0; i < 200; ++i) height = machine.advance(0.01);
  std::printf("height after 2 s: %.3f m\n", height);
}
