#include "scenes.hpp"

#include <delassus/solvers/proximal_newton.hpp>

#include "catch.hpp"

namespace single_precision_tests {

using namespace scenes;

namespace {

struct Forces {
  std::vector<Vec3> of_body;    ///< sum of the contact forces on each body, N
  std::vector<Vec3> of_contact;
  Status status;
};

/// A stack after `steps` steps, in the precision of `Set`.
template <class Set>
Forces stack_forces(int count, int steps) {
  const double h = 1.0 / 60;
  AnimationLoop loop{World{Set{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     GaussSeidel{.tolerance = 1e-5, .max_iterations = 100000}};
  add_stack(rigid_bodies(loop), count, Box{1, 1, 1});
  Forces out{std::vector<Vec3>(std::size_t(count + 1), Vec3::Zero()), {}, Status::converged};
  for (int n = 0; n < steps; ++n) out.status = worse(out.status, loop.step(h).status);
  for (const ContactResult& c : loop.contacts()) {
    out.of_body[c.record.a.block] -= c.impulse / h;
    out.of_body[c.record.b.block] += c.impulse / h;
    out.of_contact.push_back(c.impulse / h);
  }
  return out;
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0, apart = 0;
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, a[i].norm());
    apart = std::max(apart, (a[i] - b[i]).norm());
  }
  return apart / largest;
}

}  // namespace

// The impulses of ten boxes are not unique, their sum on each body is. Both solves are right to 1e-5 of the velocities, which
// a stack of ten turns into up to ten times that of the force on a body.
TEST_CASE("the contact force on each of ten bodies is the same in single and in double precision") {
  const Forces one = stack_forces<RigidBodies>(10, 1), other = stack_forces<RigidBodiesF>(10, 1);
  REQUIRE(other.status <= Status::stalled);  // within 1e-5, or at the floor of single precision
  REQUIRE(difference(one.of_body, other.of_body) <= 1e-4);
}

TEST_CASE("up to three boxes each impulse is the same in single and in double precision") {
  for (int count = 1; count <= 3; ++count) {
    const Forces one = stack_forces<RigidBodies>(count, 1), other = stack_forces<RigidBodiesF>(count, 1);
    CAPTURE(count);
    REQUIRE(difference(one.of_contact, other.of_contact) <= 1e-4);
  }
}

TEST_CASE("ten boxes stand for ten seconds in single precision") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     GaussSeidel{.tolerance = 1e-5, .max_iterations = 100000}};
  const auto boxes = add_stack(rigid_bodies(loop), 10, Box{1, 1, 1});
  const Standing seen = stand(loop, boxes.back(), 10);
  CHECK(seen.residual <= 2e-5);  // the floor of ten boxes, 8 epsilon w |λ|/|u|, is 1.3e-5
  CHECK(seen.drift < 2e-3);
  CHECK(seen.penetration < 5e-4);
}

namespace {

/// Where three boxes and a pendulum are after `steps` steps, from `at`, as they were started there.
std::vector<Vec3> far_from(const Vec3& at, int steps) {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     GaussSeidel{.tolerance = 1e-5, .max_iterations = 10000}};
  auto& set = bodies<RigidBodiesF>(loop.world());
  set.add_fixed(HalfSpace{}, at);
  for (int k = 0; k < 3; ++k)
    set.add({.position = at + Vec3(0, 0, 0.5 + k), .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto bob =
      set.add({.position = at + Vec3(6, 0, 4), .mass = 1.0, .inertia = Mat3(0.1 * Mat3::Identity())});
  loop.add(BallJoint::Item{world_anchor(at + Vec3(5, 0, 4)), anchor(set, bob, {-1, 0, 0})});
  for (int n = 0; n < steps; ++n) loop.step(1.0 / 60);
  std::vector<Vec3> out;
  for (const Index b : alive(set)) out.push_back(set.pose(b).position - at);
  return out;
}

}  // namespace

// Places are kept in double, with an ulp of 1e-10 m there; in single precision it is 0.06 m, more than a step
// goes. Speeds of 4 to 8 m/s are rounded by 2.4e-7 m/s in each of 120 steps, all to the same side at worst: 120²/2
// of them are 120²/2 · 2.4e-7/60 = 3e-5 m.
TEST_CASE("a million metres from the origin bodies in single precision move as they do there") {
  const auto here = far_from({0, 0, 0}, 120), there = far_from({1e6, -1e6, 0}, 120);
  double apart = 0;
  for (std::size_t k = 0; k < here.size(); ++k) apart = std::max(apart, (here[k] - there[k]).norm());
  CAPTURE(apart);
  CHECK(apart <= 3e-5);
}

// Each corner carries 4e4 N·s, which single precision knows to 5e-3 N·s: a step leaves the light box, m = 1 kg, at the sum of eight
// corners' roundings, some 0.04 m/s, and the next step takes that away. It falls by g h = 0.16 m/s a step, so that the scalar
// cannot hold the residual: rounding hides more than a tenth of the motion, and the status is not that of a solve at rounding.
TEST_CASE("a box under a million times its mass in single precision is not thrown, and no step calls that rounding") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ProximalNewton{.tolerance = 1e-4}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto light = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  set.add({.position = {0, 0, 1.5}, .mass = 1e6, .shape = Box{1, 1, 1}});
  double fastest = 0;
  for (int n = 0; n < 90; ++n) {
    const StepReport r = loop.step(1.0 / 60);
    CHECK(r.status == Status::max_iterations);
    fastest = std::max(fastest, double(set.velocity(light).norm()));
  }
  CHECK(fastest < 9.81 / 60);
}

}  // namespace single_precision_tests
