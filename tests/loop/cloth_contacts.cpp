// Sheets that touch: both their sides, friction, folds.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "cloth_scenes.hpp"

namespace cloth_contacts_tests {

using namespace delassus;
using namespace soft_scenes;

using Sheets = Cloth<Corotational>;

namespace {

auto make_loop(double friction) {
  return AnimationLoop{World{RigidBodies{}, Sheets{}}, Constraints{Contact{Coulomb{friction}}},
                       ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.01},
                       WithSurfaces{NativeCollision{}}};
}
using Loop = decltype(make_loop(0));

void drape(Loop& loop) {
  bodies<RigidBodies>(loop.world()).add_fixed(Sphere{0.3});
  bodies<Sheets>(loop.world())
      .add({.mesh = square(10, 2e-3),
            .elasticity = {.young = 5e4},
            .density = 100,
            .position = {-0.52, -0.47, 0.33},
            .contact_radius = 0.01});
}

double top_speed(const Sheets& set) {
  double most = 0;
  for (const Vec3& v : set.velocity()) most = std::max(most, v.norm());
  return most;
}

}  // namespace

TEST_CASE("a sheet thrown over a ball comes to rest on it, folded, and is carried by it") {
  Loop loop = make_loop(0.3);
  auto& set = bodies<Sheets>(loop.world());
  drape(loop);
  double deepest = 0;
  for (int n = 0; n < 500; ++n) {
    loop.step(0.01);
    for (const ContactResult& c : loop.contacts())
      if (c.record.a.set != c.record.b.set) deepest = std::min(deepest, c.record.gap);
  }
  CHECK(loop.report().status == Status::converged);
  CHECK(deepest > -0.005);  // of 0.01 m between its middle and the ball, at 2.5 m/s · 0.01 s a step
  CHECK(top_speed(set) < 0.05);
  double carried = 0, lowest = 1;
  int folds = 0;
  for (const ContactResult& c : loop.contacts()) {
    CHECK(c.record.gap >
          -1e-5);  // what a step of rest at 0.05 m/s · 0.01 s leaves, times the rate 0.2, and less
    if (c.record.a.set == c.record.b.set)
      ++folds;
    else
      carried += (c.record.b.set == 1 ? 1 : -1) * c.impulse[2] / 0.01;
  }
  for (Index b = 0; b < set.blocks(); ++b) {
    CHECK(set.position(set.handle(b)).norm() > 0.3);
    lowest = std::min(lowest, set.position(set.handle(b))[2]);
  }
  CHECK(lowest < -0.2);  // its corners hang
  CHECK(folds > 0);
  CHECK(std::abs(std::abs(carried) / (0.2 * 9.81) - 1) < 0.02);
}

TEST_CASE("a ball rests on a sheet that is held at its border, whichever of its sides is up") {
  double height[2];
  for (const bool is_turned : {false, true}) {
    Loop loop = make_loop(0.3);
    auto& set = bodies<Sheets>(loop.world());
    auto& rigid = bodies<RigidBodies>(loop.world());
    SheetMesh mesh = square(3, 1e-3);
    if (is_turned)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    const auto body = set.add({.mesh = mesh, .elasticity = {.young = 1e6}, .contact_radius = 0.01});
    set.fix(body,
            [](const Vec3& x) { return std::min(x[0], x[1]) < 1e-9 || std::max(x[0], x[1]) > 1 - 1e-9; });
    // In the middle of the middle cell, 0.24 m from each node.
    const auto ball = rigid.add({.position = {0.5, 0.5, 0.12}, .mass = 2., .shape = Sphere{0.1}});
    for (int n = 0; n < 300; ++n) loop.step(0.01);
    CHECK(loop.report().status == Status::converged);
    const double lowest = std::min(set.position(set.node(body, 5))[2], set.position(set.node(body, 10))[2]);
    height[is_turned] = rigid.position(ball)[2] - lowest;
    CHECK(height[is_turned] > 0.1);
    CHECK(height[is_turned] < 0.12);
    double carried = 0;
    for (const ContactResult& c : loop.contacts()) carried += std::abs(c.impulse[2]) / 0.01;
    CHECK(std::abs(carried / (2 * 9.81) - 1) < 1e-2);  // damped for 3 s
  }
  CHECK(std::abs(height[0] - height[1]) < 1e-3);
}

TEST_CASE("of two sheets nearer than their thickness each knows on which side of the other it is") {
  Loop loop = make_loop(0);
  auto& set = bodies<Sheets>(loop.world());
  set.gravity.setZero();
  const auto lower = set.add({.mesh = square(2, 1e-3), .contact_radius = 0.01});
  set.add({.mesh = square(2, 1e-3),
           .position = {0.1, 0.13, 0.001},  // of the 0.02 m that they are thick together
           .contact_radius = 0.01,
           .group = 8,
           .collides_with = ~8u});
  const Index nodes = set.node_count(lower);
  loop.step(0.01);
  int between = 0;
  for (const ContactResult& c : loop.contacts()) {
    const double up = (c.record.a.block < nodes ? 1 : -1) * c.record.normal[2];
    if (std::abs(up) < 0.5) continue;  // borders beside each other
    ++between;
    CHECK(up > 0);
    CHECK(std::abs(c.record.gap + 0.019) < 1e-12);
  }
  CHECK(between > 4);
  double below = 0, above = 0;
  for (Index b = 0; b < set.blocks(); ++b) (b < nodes ? below : above) += set.velocity()[b][2] * set.mass(b);
  CHECK(above > 0);
  CHECK(std::abs(above + below) < 1e-12);
}

TEST_CASE("a sheet on a slope stays up to tan(theta) = mu, and slides as a block does beyond") {
  const double mu = 0.4, g = 9.81, h = 0.01;
  for (const double share : {0.98, 1.5}) {
    const double theta = std::atan(share * mu);
    AnimationLoop loop{World{RigidBodies{}, Sheets{}}, Constraints{Contact{Coulomb{mu}}}, ImplicitEuler{},
                       WithSurfaces{NativeCollision{}}};
    auto& set = bodies<Sheets>(loop.world());
    set.gravity = g * Vec3(std::sin(theta), 0, -std::cos(theta));
    bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
    const auto body = set.add({.mesh = square(4, 1e-3),
                               .elasticity = {.young = 1e6},
                               .position = {0, 0, 0.01},
                               .contact_radius = 0.01});
    for (int n = 0; n < 50; ++n) loop.step(h);
    const double a = share > 1 ? g * (std::sin(theta) - mu * std::cos(theta)) : 0;
    for (Index k = 0; k < set.node_count(body); ++k)  // nodes slide alike: nothing strains
      CHECK((set.velocity(set.node(body, k)) - Vec3(50 * h * a, 0, 0)).norm() < 1e-5);
  }
}

TEST_CASE("a sheet that is draped goes on bit for bit from a checkpoint") {
  Loop loop = make_loop(0.3), again = make_loop(0.3);
  drape(loop);
  for (int n = 0; n < 60; ++n) loop.step(0.01);
  const auto kept = checkpoint(loop);
  restore(again, kept);
  for (int n = 0; n < 20; ++n) loop.step(0.01), again.step(0.01);
  const auto &set = bodies<Sheets>(loop.world()), &other = bodies<Sheets>(again.world());
  REQUIRE(set.blocks() == other.blocks());
  CHECK(loop.contacts().size() > 20);
  for (Index b = 0; b < set.blocks(); ++b) {
    CHECK(set.position(set.handle(b)) == other.position(other.handle(b)));
    CHECK(set.velocity()[b] == other.velocity()[b]);
  }
  CHECK(set.elastic_energy() == other.elastic_energy());  // the thickness is kept too
}

}  // namespace cloth_contacts_tests
