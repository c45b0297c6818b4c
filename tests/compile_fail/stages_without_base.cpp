// expect: delassus: what a policy overrides derives from its parameter, or the stages of the policies below it are lost; write `template <class Base> struct stages : Base`
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/loop/animation_loop.hpp>

using namespace delassus;

struct Alone {
  using plays = role::Scheme;
  void run(auto& step) const { PlainOrder{}.run(step); }
  template <class Base>
  struct stages {
    static void solve(auto&) {}
  };
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Alone{}};
  loop.step(0.01);
}
