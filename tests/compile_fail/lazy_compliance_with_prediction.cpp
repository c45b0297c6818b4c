// expect: LazyCompliance and PrecomputedCompliance take no scheme that overrides stages, such as PredictiveScheme, and no law with restitution, such as Restitution, SequentialRestitution and Limit; use AssembledCompliance
#include <delassus/delassus.hpp>
#include <delassus/compliance/lazy.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{TetrahedralFem<Linear>{}}, Constraints{BallJoint{}}, LazyCompliance{}, PredictiveScheme{}};
  loop.step(0.01);
}
