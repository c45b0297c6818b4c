// The surface of a deformable body among bodies that sleep.
#include <delassus/activity/sleeping.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

#include <algorithm>

namespace soft_surfaces_asleep_tests {

using namespace delassus;

TEST_CASE("a soft block that lands on a sleeping box between its nodes wakes it, and is carried") {
  using Soft = TetrahedralFem<Corotational>;
  const double h = 0.01, radius = 0.01;
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Frictionless{}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.02},
                     WithSurfaces{NativeCollision{.margin = 0.02}},
                     GaussSeidel{.tolerance = 1e-8, .max_iterations = 2000},
                     Sleeping{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0.3, 0.2, 0.1}, .mass = 5., .shape = Box{0.2, 0.2, 0.2}});
  const auto is_asleep = [&] { return loop.dormant().bodies().size() == 1; };
  for (int n = 0; n < 100; ++n) loop.step(h);
  REQUIRE(is_asleep());
  // A block with cells of half a metre, its lower face 0.1 m over the box, which no node is over.
  const auto block = soft.add({.mesh = box_mesh({1, 1, 0.4}, {2, 2, 1}),
                               .elasticity = {.young = 1e5},
                               .density = 100,
                               .position = {0, 0, 0.31},
                               .contact_radius = radius});
  int woken = -1;
  double lowest = 1, most = 0;
  for (int n = 0; n < 100; ++n) {
    loop.step(h);
    if (woken < 0 && !is_asleep()) woken = n;
    if (woken < 0) lowest = std::min(lowest, soft.position(soft.node(block, 0)).z());
    double carried = 0;
    for (const ContactResult& c : loop.contacts())
      if (c.record.a.set == 0 && c.record.b.set == 1 && c.record.a.block == box.index)
        carried += c.impulse.z() / h;
    most = std::max(most, carried);
  }
  CHECK(woken > 0);
  CHECK(lowest > 0.2);            // not before it is there
  CHECK(most > 0.1 * 40 * 9.81);  // and of its 40 kg the box stops a part
  CHECK(rigid.position(box).z() > 0.09);
}

}  // namespace soft_surfaces_asleep_tests
