// Tutorial: a soft block falls on a floor and comes to rest; the floor carries its weight.
// prints: at rest: shorter by 9\.5[0-9] mm, a bar in closed form 9\.81 mm, weight 78\.480 N
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;
using Soft = TetrahedralFem<Corotational>;

int main() {
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.005}, Recorder{"Soft block", "A block of 20 kPa."}};
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  auto& soft = bodies<Soft>(loop.world());

  const double side = 0.2, radius = 0.005, young = 2e4, density = 1000;
  const auto block = soft.add({.mesh = box_mesh({side, side, side}, {4, 4, 4}),
                               .elasticity = {.young = young, .poisson = 0.3},
                               .density = density,
                               .position = {0, 0, 0.1},
                               .contact_radius = radius});
  const auto middle_of_top = soft.node(block, 2 + 5 * (2 + 5 * 4));  // node i + 5 (j + 5 k)
  const double mass = density * side * side * side;

  const double h = 0.005;
  StepReport report;
  for (int n = 0; n < 600; ++n) {
    report = loop.step(h);
    if (n % 100 != 99) continue;
    double floor = 0;
    for (const auto& c : loop.contacts()) floor += std::abs(c.impulse.z()) / h;
    std::printf("%.1f s: top at %.4f m, floor carries %.3f N, %d contacts, %s\n", loop.time(),
                soft.position(middle_of_top).z(), floor, report.contacts, name(report.status));
  }
  std::printf("at rest: shorter by %.2f mm, a bar in closed form %.2f mm, weight %.3f N\n",
              1e3 * (side + radius - soft.position(middle_of_top).z()),
              1e3 * density * 9.81 * side * side / (2 * young), mass * 9.81);

  write_replay_page("soft_block.html", "Soft block", std::vector{loop.get<Recorder>().recording()});
}
