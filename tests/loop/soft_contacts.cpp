// Deformable bodies in contact: the nodes of their surface are spheres for the collision backend.
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

namespace soft_contacts_tests {

using namespace delassus;
using namespace soft_scenes;

namespace {

using Soft = TetrahedralFem<Corotational>;

struct Scene {
  AnimationLoop<World<RigidBodies, Soft>, Constraints<Contact<Coulomb>>, ImplicitEuler, NativeCollision,
                AcceleratedGaussSeidel>
      loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
           ImplicitEuler{.rayleigh_stiffness = 0.02}, NativeCollision{.margin = 0.05},
           AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 5000}};
  Soft& soft = bodies<Soft>(loop.world());
  RigidBodies& rigid = bodies<RigidBodies>(loop.world());
  static constexpr double radius = 0.02, h = 0.01;

  /// A cube of side 1 m and 1000 kg, its nodes `above` the spheres' touch of the ground.
  Soft::BodyHandle add_cube(double above, double young = 1e5) {
    return soft.add({.mesh = cube(2),
                     .elasticity = {.young = young},
                     .position = {0, 0, radius + above},
                     .contact_radius = radius});
  }
  /// Of all contacts of a rigid body, what the other side receives, N.
  Vec3 force_from(RigidBodies::Handle body) const {
    Vec3 sum = Vec3::Zero();
    for (const ContactResult& c : loop.contacts()) {
      if (c.record.a.set == 0 && c.record.a.block == body.index) sum += c.impulse / h;
      if (c.record.b.set == 0 && c.record.b.block == body.index) sum -= c.impulse / h;
    }
    return sum;
  }
  Vec3 mean_velocity() const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (Index b = 0; b < soft.blocks(); ++b)
      sum += double(soft.mass(b)) * soft.velocity()[b], mass += soft.mass(b);
    return sum / mass;
  }
};

}  // namespace

TEST_CASE("a soft cube dropped on the ground comes to rest on it, and the ground carries its weight") {
  Scene s;
  const auto ground = s.rigid.add_fixed(HalfSpace{});
  const auto cube = s.add_cube(0.1);
  double deepest = 0;
  for (int n = 0; n < 900; ++n) {
    const StepReport report = s.loop.step(Scene::h);
    REQUIRE(report.status == Status::converged);
    deepest = std::max(deepest, report.max_penetration);
  }
  CHECK(deepest <
        1e-3 * Scene::h * 10);  // rows hold at v_next: what is left is what turns of the normal leave
  // The slowest mode, rocking with ω ≈ 9/s, is damped by exp(−β ω²/2 · 9 s) = 7e-4; the bounce was some 100 N
  // off.
  CHECK((s.force_from(ground) - Vec3(0, 0, 1000 * 9.81)).norm() < 0.2);
  CHECK(s.loop.contacts().size() == 9);
  // It is pressed by its weight: ρ g L²/2E of an upright column, more or less for its bulging foot.
  const double top = s.soft.position(s.soft.node(cube, 26))[2] - Scene::radius;
  CHECK(1 - top > 0.5 * 1000 * 9.81 / 2e5);
  CHECK(1 - top < 1.5 * 1000 * 9.81 / 2e5);
}

TEST_CASE("a soft cube sticks on a slope below the angle of friction and slides above it") {
  for (const double slope : {0.4, 0.6}) {
    Scene s;
    s.rigid.add_fixed(HalfSpace{});
    s.add_cube(0, 1e6);
    const double angle = std::atan(slope);
    s.soft.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
    for (int n = 0; n < 150; ++n) s.loop.step(Scene::h);
    const double before = s.mean_velocity()[0];
    for (int n = 0; n < 50; ++n) s.loop.step(Scene::h);
    const double gained = (s.mean_velocity()[0] - before) / 0.5;
    if (slope < 0.5)
      CHECK(std::abs(s.mean_velocity()[0]) < 1e-6);
    else
      CHECK(std::abs(gained / (9.81 * (std::sin(angle) - 0.5 * std::cos(angle))) - 1) <
            1e-2);  // after the ringing
  }
}

TEST_CASE("a rigid ball and a box that fall on soft cubes stay on them, and all weights reach the ground") {
  Scene s;
  const auto ground = s.rigid.add_fixed(HalfSpace{});
  // The ball needs nodes that are nearer to each other than its size: it sees no faces.
  for (const double x : {0.0, 3.0})
    s.soft.add({.mesh = cube(3),
                .elasticity = {.young = 2e5},
                .position = {x, 0, Scene::radius},
                .contact_radius = Scene::radius});
  const auto ball = s.rigid.add({.position = {0.5, 0.5, 1.5}, .mass = 30, .shape = Sphere{0.4}});
  const auto box = s.rigid.add({.position = {3.5, 0.5, 1.3}, .mass = 20, .shape = Box{0.8, 0.8, 0.2}});
  for (int n = 0; n < 400; ++n) s.loop.step(Scene::h);
  CHECK(s.loop.report().islands == 2);
  CHECK(std::abs(s.rigid.position(ball)[2] - 1.35) < 0.05);
  CHECK(std::abs(s.rigid.position(box)[2] - 1.12) < 0.03);
  // What is left of the bounce shakes 2 t by some 1e-3 m/s².
  CHECK(std::abs(s.force_from(ground)[2] - 2050 * 9.81) < 10);
  CHECK(std::abs(s.force_from(box)[2] + 20 * 9.81) < 1);
  CHECK(std::abs(s.force_from(ball)[2] + 30 * 9.81) < 1);
}

namespace {

/// A soft cube that falls aslant with a box upon it, told in other units, told back.
std::vector<double> fallen(double length, double mass, double time) {
  Scene s;
  const double speed = length / time, density = mass / (length * length * length);
  s.loop.policy<role::Stabilisation>().max_speed *= speed;
  s.loop.get<ImplicitEuler>().rayleigh_stiffness *= time;
  s.loop.get<NativeCollision>().margin *= length;
  s.rigid.gravity *= speed / time;
  s.soft.gravity *= speed / time;
  s.rigid.add_fixed(HalfSpace{});
  TetrahedralMesh mesh = cube(2);
  for (Vec3& x : mesh.points) x *= length;
  s.soft.add({.mesh = mesh,
              .elasticity = {.young = 1e5 * mass / (length * time * time)},
              .density = 1000 * density,
              .position = length * Vec3(0, 0, 0.05),
              .orientation = exponential<double>(Vec3(.02, .03, 0)),
              .velocity = speed * Vec3(.5, .1, -1),
              .contact_radius = length * Scene::radius});
  const auto box = s.rigid.add({.position = length * Vec3(.4, .6, 1.4),
                                .velocity = speed * Vec3(.1, .2, -1),
                                .angular_velocity = Vec3(.3, .2, .1) / time,
                                .density = 500 * density,
                                .shape = Box{.6 * length, .6 * length, .5 * length}});
  std::vector<double> out;
  for (int n = 0; n < 40; ++n) {
    s.loop.step(Scene::h * time);
    for (int k = 0; k < 3; ++k) {
      out.push_back(s.rigid.position(box)[k] / length);
      out.push_back(s.rigid.angular_velocity(box)[k] * time);
      for (Index b = 0; b < s.soft.blocks(); ++b) out.push_back(s.soft.velocity()[b][k] / speed);
    }
  }
  REQUIRE(s.loop.contacts().size() > 5);
  return out;
}

}  // namespace

// Powers of four round nothing, nor do their roots.
TEST_CASE("lengths, masses and times 1024 times larger or smaller change no bit of a soft body that falls") {
  const std::vector<double> usual = fallen(1, 1, 1);
  constexpr double more = 1024, less = 1 / more;
  CHECK((fallen(more, 1, 1) == usual));
  CHECK((fallen(less, 1, 1) == usual));
  CHECK((fallen(1, more, 1) == usual));
  CHECK((fallen(1, 1, less) == usual));
  CHECK((fallen(more, less, more) == usual));
}

}  // namespace soft_contacts_tests
