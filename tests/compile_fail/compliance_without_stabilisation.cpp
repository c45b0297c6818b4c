// expect: delassus: WithCompliance goes around a stabilisation, once, and its number comes second: WithCompliance{Baumgarte{}, 1e-7}
#include <delassus/delassus.hpp>
#include <delassus/stabilisation/with_compliance.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, WithCompliance{1e-7}};
  loop.step(1e-3);
}
