// expect: delassus: Penalty with AtMean{} takes the mean velocity of a step, by which ImplicitMidpoint alone goes, and gaps of each step, which Substeps has not; use ImplicitMidpoint and no Substeps, or leave AtMean{} out
#include <delassus/delassus.hpp>
#include <delassus/schemes/substeps.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Penalty{Coulomb{}, 1e5, 50, AtMean{}}}}, ImplicitMidpoint{}, Substeps{4}};
  loop.step(1e-3);
}
