// Soft bodies between rigid ones of any weight: one W for all of them, so that forces are what statics says.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/stabilisation/whole_violation.hpp>

#include <array>

#include "catch.hpp"
#include "hexahedral_scenes.hpp"

namespace soft_coupling_tests {

using namespace delassus;
using namespace soft_scenes;

namespace {

using Soft = HexahedralFem<Corotational>;

auto one_loop(double friction, const ImplicitEuler& integrator) {
  return AnimationLoop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       integrator, WholeViolation{},
                       AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 20000}};
}

/// The force (N) that the contacts of a collider with the soft body hold, along z.
template <class Loop>
double carried_by(const Loop& loop, RigidBodies::Handle body, double h) {
  double sum = 0;
  for (const auto& c : loop.contacts())
    if ((c.record.a.set == 0 && c.record.a.block == body.index) ||
        (c.record.b.set == 0 && c.record.b.block == body.index))
      sum += c.impulse[2] / h;
  return std::abs(sum);
}

}  // namespace

TEST_CASE(
    "a soft kilogram carries a rigid body a thousand times heavier or lighter, with forces true to a "
    "thousandth") {
  for (const double mass : {1e-3, 1.0, 1e3}) {
    const double h = 0.01, g = 9.81;
    auto loop = one_loop(0.5, {.rayleigh_mass = 4, .rayleigh_stiffness = 0.05});
    auto& rigid = bodies<RigidBodies>(loop.world());
    auto& soft = bodies<Soft>(loop.world());
    const auto floor = rigid.add_fixed(Box{4, 4, 1}, {0.5, 0.5, -0.51});
    soft.add({.mesh = bricks(2),
              .elasticity = {.young = 1e7, .poisson = 0.3},
              .density = 1,
              .contact_radius = 0.01});
    const auto load = rigid.add({.position = {0.5, 0.5, 1.135}, .mass = mass, .shape = Box{1.5, 1.5, 0.25}});
    for (int n = 0; n < 150; ++n) loop.step(h);
    CAPTURE(mass);
    CHECK(loop.report().status == Status::converged);
    CHECK(std::abs(carried_by(loop, load, h) / (mass * g) - 1) < 1e-3);
    CHECK(std::abs(carried_by(loop, floor, h) / ((mass + 1) * g) - 1) < 1e-3);
  }
}

TEST_CASE(
    "a soft cube between two jaws is pressed by what presses them, whatever they weigh, to a thousandth") {
  double last = 0;
  for (const double mass : {1e-3, 1.0, 1e3}) {
    const double h = 0.01, force = 50;
    auto loop = one_loop(0.5, {.rayleigh_mass = 4, .rayleigh_stiffness = 0.05});
    auto& rigid = bodies<RigidBodies>(loop.world());
    auto& soft = bodies<Soft>(loop.world());
    rigid.gravity.setZero(), soft.gravity.setZero();
    soft.add({.mesh = bricks(2),
              .elasticity = {.young = 1e4, .poisson = 0.3},
              .density = 1,
              .contact_radius = 0.01});
    // One jaw is held: between two free ones the cube turns away, as a pressed strut does.
    const auto lower = rigid.add_fixed(Box{1.5, 1.5, 0.25}, {0.5, 0.5, -0.135});
    const auto upper = rigid.add({.position = {0.5, 0.5, 1.135}, .mass = mass, .shape = Box{1.5, 1.5, 0.25}});
    for (int n = 0; n < 400; ++n) {
      rigid.apply_force(upper, {0, 0, -force});
      loop.step(h);
    }
    CAPTURE(mass);
    CHECK(loop.report().status == Status::converged);
    CHECK(std::abs(carried_by(loop, upper, h) / force - 1) < 1e-3);
    CHECK(std::abs(carried_by(loop, lower, h) / force - 1) < 1e-3);
    // F/(E A) is half a percent; friction, which keeps the faces from growing, takes a tenth of it.
    const double pressed = 1.135 - rigid.position(upper)[2];
    CHECK((pressed > 0.0043 && pressed < 0.005));
    if (last > 0) CHECK(std::abs(pressed / last - 1) < 2e-2);  // friction's share depends on the way there
    last = pressed;
  }
}

namespace {

/// Coordinates from −4 to 4: cells of `fine` m within 0.72 m, then wider and wider.
std::vector<double> graded(double fine) {
  std::vector<double> x{0};
  double cell = fine;
  while (x.back() < 4 - 1e-9) {
    if (x.back() > 0.72 - 1e-9) cell *= 1.6;
    const double next = x.back() + cell;
    x.push_back(next > 4 - 0.6 * cell ? 4.0 : next);
  }
  std::vector<double> both;
  for (std::size_t k = x.size(); k-- > 1;) both.push_back(-x[k]);
  both.insert(both.end(), x.begin(), x.end());
  return both;
}

}  // namespace

TEST_CASE("a rigid ball pressed into a bonded block meets Hertz's force through W within 5 %") {
  // R = 4 m, 0.08 m deep, into 8 × 8 × 4 m, E = 1000 Pa, ν = 0.3: Hertz's half-space has F = 4/3 E* √R δ^3/2
  // = 66.31 N; for a layer bonded to its bottom Dimitriadis' series in χ = √(Rδ)/h = 0.1414 makes it 1.1406
  // of that.
  const double R = 4, depth = 0.08, radius = 1e-4, h = 1e4;
  auto loop = one_loop(0, {});
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  soft.gravity.setZero();
  const std::vector<double> x = graded(0.12);
  const Index n = Index(x.size()) - 1, layers = (n + 1) / 2;
  HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {n, n, layers});
  for (Vec3& p : mesh.points) {
    const auto at = [](double share, Index cells) { return std::size_t(std::lround(share * double(cells))); };
    p = {x[at(p[0], n)], x[at(p[1], n)], x[at(p[2], layers)]};  // the lower half: from −4 to 0
  }
  const auto block = soft.add({.mesh = mesh,
                               .elasticity = {.young = 1000, .poisson = 0.3},
                               .density = 1e-6,
                               .contact_radius = radius});
  soft.fix(block, [](const Vec3& p) { return p[2] < -4 + 1e-9; });
  const auto ball = rigid.add_fixed(Sphere{R - radius}, {0, 0, R - depth});
  loop.step(h);  // so long that inertia is 1e-12 of stiffness: one step of statics
  CHECK(loop.report().status == Status::converged);
  const double hertz = 4.0 / 3 * 1000 / 0.91 * std::sqrt(R) * std::pow(depth, 1.5);
  CHECK(std::abs(hertz - 66.31) < 0.01);
  const double force = carried_by(loop, ball, h);
  CHECK(std::abs(force / (1.1406 * hertz) - 1) < 0.05);
  // The radius of contact, √(Rδ) = 0.566 m, to a cell.
  double touched = 0;
  for (const auto& c : loop.contacts())
    if (std::abs(c.impulse[2]) > 1e-6 * force * h)
      touched = std::max(touched, c.record.point().head<2>().norm());
  CHECK(std::abs(touched - std::sqrt(R * depth)) < 0.12);
}

}  // namespace soft_coupling_tests
