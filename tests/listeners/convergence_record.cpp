#include "scenes.hpp"

#include "catch.hpp"

using namespace scenes;

TEST_CASE("a convergence record has an entry for every sweep, and its last one is the report's residual") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, BallJoint{}},
                     GaussSeidel{.tolerance = 1e-9, .max_iterations = 500}, ConvergenceRecord{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle last;
  for (int k = 0; k < 3; ++k) last = rigid.add({.position = {0, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.add(BallJoint::Item{anchor(rigid, last), world_anchor({0, 0, 2.5})});
  const StepReport report = loop.step(1e-2);
  const auto& record = loop.get<ConvergenceRecord>();

  REQUIRE(report.islands == 1);
  REQUIRE(int(record.sweeps().size()) == report.sweeps + 1);  // sweep 0 is the warm start's measure
  CHECK(record.sweeps().front().sweep == 0);
  CHECK(record.sweeps().back().sweep == report.sweeps);
  CHECK(record.sweeps().back().measure.residual == report.residual);
  CHECK(Index(record.rows().size()) == report.rows);
  CHECK(Index(record.constraints().size()) == report.contacts + 1);
}

TEST_CASE("the forces of a convergence record carry the weight") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-10}, ConvergenceRecord{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  for (int i = 0; i < 100; ++i) loop.step(1e-2);
  double force = 0;
  for (const auto& row : loop.get<ConvergenceRecord>().rows()) force += row.force;
  // m g; the solve is within 1e-10 of the free velocity g h, so the sum of the forces is within 1e-10 of m g, and the
  // body's own acceleration, which dies out like 0.8^n, within 0.8^100 = 2e-10 of it.
  CHECK(force == Approx(2.0 * 9.81).epsilon(1e-9));
}

TEST_CASE("asked for every force, a convergence record has each row after each sweep, and ends with the step's own") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, ConvergenceRecord{true}};
  add_stack(rigid_bodies(loop), 3, Box{1, 1, 1});
  const StepReport r = loop.step(0.01);
  const auto& record = loop.get<ConvergenceRecord>();
  REQUIRE(record.sweeps().size() > 2);
  REQUIRE(record.forces().size() == record.sweeps().size() * std::size_t(r.rows));
  const std::size_t last = record.forces().size() - std::size_t(r.rows);
  for (int k = 0; k < r.rows; ++k) {
    const auto& force = record.forces()[last + std::size_t(k)];
    REQUIRE(force.sweep == r.sweeps + loop.island_reports()[0].factorizations);  // Newton's steps are counted on
    REQUIRE(force.row.force == record.rows()[std::size_t(k)].force);
  }
  REQUIRE(record.forces()[0].row.force == 0);  // a cold start
}
