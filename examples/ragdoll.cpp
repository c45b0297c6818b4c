// A ragdoll of six parts falls down a stair: joints by one factorization, contacts swept on what they leave.
// prints: joints apart by at most 0\.0[0-9]+ m, 0 of 600 steps unconverged
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;
int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     WithFilter{NativeCollision{}}, DirectGaussSeidel{.tolerance = 1e-6}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  for (int k = 0; k < 6; ++k) rigid.add_fixed(Box{0.4, 2, 0.2}, {0.4 * k, 0, -0.2 * k - 0.1});
  rigid.add_fixed(HalfSpace{}, {0, 0, -1.2});

  const auto trunk =
      rigid.add({.position = {0, 0, 1}, .velocity = {1, 0, 0}, .mass = 40.0, .shape = Box{0.2, 0.3, 0.6}});
  const auto limb = [&](const Vec3& joint, double width, double length,
                        double mass) {  // a length < 0 hangs down
    const auto part = rigid.add({.position = joint + Vec3(0, 0, length / 2),
                                 .velocity = {1, 0, 0},
                                 .mass = mass,
                                 .shape = Box{width, width, std::abs(length)}});
    loop.add(BallJoint::Item{anchor_at(rigid, trunk, joint), anchor_at(rigid, part, joint)});
  };
  limb({0, 0, 1.32}, 0.15, 0.25, 4);
  for (const double side : {-1., 1.}) {
    limb({0, 0.24 * side, 1.25}, 0.08, -0.6, 3);
    limb({0, 0.1 * side, 0.68}, 0.12, -0.6, 10);
  }
  double gap = 0, unconverged = 0;
  for (int n = 0; n < 600; ++n) {
    const StepReport report = loop.step(5e-3);
    gap = std::max(gap, report.max_joint_violation);
    unconverged += report.status != Status::converged;
  }
  std::printf("joints apart by at most %.4f m, %g of 600 steps unconverged\n", gap, unconverged);
}
