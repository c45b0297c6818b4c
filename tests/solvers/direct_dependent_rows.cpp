// The direct path where rows depend on each other, or contradict each other.
#include "direct_tests.hpp"

namespace direct_dependent_rows_tests {

using namespace direct_tests;

namespace {

/// Motion and forces of a door of 20 kg after 0.2 s, its hinge put in `times`.
struct Door {
  Vec3 place;
  Vec<5> sum = Vec<5>::Zero();
  double spread = 0;

  explicit Door(int times) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, DirectGaussSeidel{.tolerance = 1e-10}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const auto leaf = rigid.add({.position = {0.5, 0, 1},
                                 .velocity = {0, 0.5, 0},
                                 .angular_velocity = {0, 0, 1},
                                 .mass = 20.0,
                                 .shape = Box{1, 0.05, 2}});
    std::vector<ConstraintHandle<Hinge>> hinges;
    for (int k = 0; k < times; ++k)
      hinges.push_back(loop.add(Hinge::Item{world_anchor({0, 0, 1}), anchor_at(rigid, leaf, {0, 0, 1})}));
    for (int n = 0; n < 200; ++n) REQUIRE(loop.step(1e-3).status == Status::converged);
    place = rigid.position(leaf);
    for (const auto& hinge : hinges) {
      sum += loop.impulse(hinge);
      spread = std::max(spread, (loop.impulse(hinge) - loop.impulse(hinges[0])).norm());
    }
  }
};

}  // namespace

// HC-09: 200 steps, each with an error of the solve of 1e-10 of 1 m/s at most, put 2e-11 m into the place;
// 1e-10 is gold.
TEST_CASE("a joint put in fifty times moves and carries as one does, each taking its share") {
  const Door one(1);
  for (const int times : {2, 5, 50}) {
    const Door many(times);
    CAPTURE(times);
    CHECK((many.place - one.place).norm() <= 2e-11);
    CHECK((many.sum - one.sum).norm() <= 1e-8 * one.sum.norm());
    // The smallest impulses that do: all alike, to what rounding, 1e-16/ε, leaves of that.
    CHECK(many.spread <= 1e-5 * one.sum.norm());
  }
}

namespace {

/// A ball joint whose rows are told in other units: φ = s (x_a − x_b), so that the impulse on a is s λ.
struct ScaledPin : Bilateral<3> {
  struct Item {
    Anchor a, b;
    double scale;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 xa = world.point(item.a), xb = world.point(item.b), gap = item.scale * (xa - xb);
    row.end(item.a, Vec3(0.5 * (xa + xb))).along(Mat3::Identity().eval(), item.scale);
    row.end(item.b, Vec3(0.5 * (xa + xb))).along(Mat3::Identity().eval(), -item.scale);
    for (int k = 0; k < 3; ++k) row.phi(k, gap[k]);
  }
};

/// A rod of 2 kg on such pins at one place, let go level: where it is after 0.2 s, and what its pins bear
/// together, N·s.
template <class Solver>
std::pair<Vec3, Vec3> hung(Solver solver, const std::vector<double>& scales) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{ScaledPin{}}, solver};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto rod = rigid.add({.position = {0.5, 0, 0}, .mass = 2.0, .shape = Box{1, 0.05, 0.05}});
  std::vector<ConstraintHandle<ScaledPin>> pins;
  for (const double scale : scales)
    pins.push_back(
        loop.add(ScaledPin::Item{anchor_at(rigid, rod, Vec3::Zero()), world_anchor(Vec3::Zero()), scale}));
  for (int n = 0; n < 200; ++n) REQUIRE(loop.step(1e-3).status == Status::converged);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < pins.size(); ++k) sum += scales[k] * loop.impulse(pins[k]);
  return {rigid.position(rod), sum};
}

}  // namespace

// The joints of the library have no units to choose; a law of one's own has. Errors of the solves as above.
TEMPLATE_TEST_CASE("rows told in units of 1e-3 to 1e3 move and carry as one joint does", "",
                   DirectGaussSeidel, AcceleratedGaussSeidel) {
  const TestType solver{.tolerance = 1e-12};
  const auto one = hung(solver, {1});
  std::vector<double> many;
  for (int k = 0; k < 50; ++k) many.push_back(std::pow(10., k % 3 * 3 - 3));
  for (const auto& scales : {std::vector{1e3}, {1e-3}, {1, 1e3}, {1, 1e-3}, {1e-3, 1, 1e3, 1, 1e-3}, many}) {
    const auto [place, sum] = hung(solver, scales);
    CAPTURE(scales.size(), scales[0]);
    CHECK((place - one.first).norm() <= 1e-10);
    CHECK((sum - one.second).norm() <= 1e-8 * one.second.norm());
  }
}

// Three hinges of one axis have 15 rows of rank 5 and share the weight; their sum is one door's.
TEST_CASE("a door on three hinges carries its weight") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, DirectGaussSeidel{.tolerance = 1e-9}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto leaf = rigid.add({.position = {0.5, 0, 1}, .mass = 20.0, .shape = Box{1, 0.05, 2}});
  std::vector<ConstraintHandle<Hinge>> hinges;
  for (const double z : {0.2, 1., 1.8})
    hinges.push_back(loop.add(Hinge::Item{world_anchor({0, 0, z}), anchor_at(rigid, leaf, {0, 0, z})}));
  double most = 0;
  for (int n = 0; n < 500; ++n) {
    REQUIRE(loop.step(1e-2).status == Status::converged);
    Vec3 force = Vec3::Zero();
    for (const auto& hinge : hinges) {
      force += reaction(loop, hinge).force;
      most = std::max(most, loop.impulse(hinge).norm());
    }
    // The door rests: the forces sum up to its weight, with an error of the solve of 1e-9 g h a step, over h.
    REQUIRE(std::abs(std::abs(force.z()) - 20 * 9.81) <= 1e-5);
  }
  CHECK(most <= 20 * 9.81 * 1e-2);  // no hinge is pressed by another
}

// Two points of the world that a body cannot both reach: 5 cm apart, so the rows ask for 0.2 · 0.05/h = 0.1
// m/s apart.
TEST_CASE("joints that contradict each other are told, with a compromise and small impulses") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  const auto ball = rigid.add({.mass = 1.0, .shape = Sphere{0.1}});
  const auto left = loop.add(BallJoint::Item{anchor(rigid, ball), world_anchor({-0.025, 0, 0})});
  loop.add(BallJoint::Item{anchor(rigid, ball), world_anchor({0.025, 0, 0})});
  for (int n = 0; n < 100; ++n) {
    CHECK(loop.step(0.1).status == Status::infeasible);
    CHECK(rigid.position(ball).norm() <= 1e-6);      // in the middle
    CHECK(loop.impulse(left).norm() <= 0.1 / 1e-4);  // m · 0.1 m/s over ε, not growing from step to step
  }
}

// A chain of a hundred links whose two ends are pinned a tenth of a metre further apart than it reaches: what
// proves it is one pull through all links, which sweeps would take thousands to find.
TEST_CASE("a long chain that is too short for its pins is told at once") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, DirectGaussSeidel{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < 100; ++k) {
    const auto link = rigid.add({.position = {0.5 + k, 0, 0}, .mass = 1.0, .shape = Box{1, 0.1, 0.1}});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {-0.5, 0, 0})});
    end = anchor(rigid, link, {0.5, 0, 0});
  }
  const auto last = loop.add(BallJoint::Item{end, world_anchor({100.1, 0, 0})});
  for (int n = 0; n < 20; ++n) {
    CHECK(loop.step(0.01).status == Status::infeasible);
    CHECK(loop.impulse(last).norm() <= 0.2 * 0.1 / 0.01 / 1e-4);
  }
  loop.remove(last);
  CHECK(loop.step(0.01).status == Status::converged);
}

}  // namespace direct_dependent_rows_tests
