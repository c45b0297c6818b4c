// Joints visited in turn, against the loop that makes W of them and solves it.
#include <delassus/io/recorder.hpp>
#include <delassus/listeners/real_time_pace.hpp>
#include <delassus/schemes/joint_by_joint.hpp>
#include <delassus/stabilisation/with_compliance.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace joint_by_joint_tests {

using namespace scenes;

namespace {

/// Lets both schemes step what `build(loop, world)` puts there and gives the largest distance of two bodies'
/// places, and of their velocities, after `steps` steps.
struct Apart {
  double places = 0, velocities = 0;
  StepReport visited, plain;
};
template <class World, class Laws, class Build>
Apart apart(World world, Laws laws, const Build& build, int steps, double h, auto scheme, auto solver) {
  AnimationLoop visits{world.clone(), laws, scheme};
  AnimationLoop plain{std::move(world), laws, solver};
  build(visits);
  build(plain);
  Apart out;
  for (int n = 0; n < steps; ++n) out.visited = visits.step(h), out.plain = plain.step(h);
  visits.world().each([&](const auto& set, auto s) {
    const auto& other = plain.world().template set<s>();
    for (Index b = 0; b < set.blocks(); ++b) {
      const Anchor place{.set = s, .block = b, .local = {0.3, 0.4, 0.5}, .owner = set.owner()},
          there{.set = s, .block = b, .local = {0.3, 0.4, 0.5}, .owner = other.owner()};
      out.places = std::max(out.places, (set.point(place) - other.point(there)).norm());
      out.velocities = std::max(out.velocities, double((set.velocity()[b] - other.velocity()[b]).norm()));
    }
  });
  return out;
}

const GaussSeidel exact{.tolerance = 0, .max_iterations = 60};

/// Nine joints of a law in a line of their own, each between a body of its own and, in turn, the world, another body of its
/// own and a fixed one.
void add_line(auto& loop, int line, const auto& item) {
  auto& set = rigid_bodies(loop);
  const Vec3 post(0, 3.0 * line, 9);
  const auto fixed = set.add_fixed(Box{1, 1, 1}, post);
  for (int k = 0; k < 9; ++k) {
    const Vec3 at(4.0 * k, 3.0 * line, 0);
    const auto body = set.add({.position = at + Vec3(0.5, 0.1, 0),
                               .orientation = Quat(Eigen::AngleAxisd(0.2 * k, Vec3(1, 2, 3).normalized())),
                               .velocity = {0.1, -0.2, 0.3},
                               .angular_velocity = {0.3 * k, 1, -0.5},
                               .mass = 1.0 + k,
                               .shape = Box{1, 0.6, 0.4}});
    const auto partner = set.add({.position = at, .velocity = {0, 0.4, 0}, .mass = 2.0, .shape = Box{0.7, 0.8, 0.5}});
    const Anchor a = anchor(set, body, {-0.5, 0, 0});
    const Anchor b = k % 3 == 0   ? world_anchor(at)
                     : k % 3 == 1 ? anchor(set, partner, {0.1, 0, 0})
                                  : anchor(set, fixed, at - post);
    loop.add(k % 2 ? item(a, b) : item(b, a));
  }
}
template <class... Laws>
void add_lines(auto& loop, int line) {
  (add_line(loop, line++, [](const Anchor& a, const Anchor& b) { return typename Laws::Item{a, b}; }), ...);
}

}  // namespace

TEST_CASE("joints that share no body move as by W and the solver, whatever they are and whatever holds them") {
  const auto build = [](auto& loop) {
    add_lines<BallJoint, Hinge, Slider, Cylindrical, Universal, Planar, Weld, PointOnLine>(loop, 0);
    add_line(loop, 8, [](const Anchor& a, const Anchor& b) { return Screw::Item{a, b, 0.1}; });
    add_line(loop, 9, [](const Anchor& a, const Anchor& b) { return DistanceJoint::Item{a, b, 0.6}; });
    add_line(loop, 10, [](const Anchor& a, const Anchor& b) {
      return DistanceJoint::Item{.a = a, .b = b, .length = 0.6, .stiffness = 400, .damping = 3};
    });
    add_line(loop, 11, [](const Anchor& a, const Anchor& b) { return VirtualCoupling::Item{.a = a, .b = b, .damping = 2}; });
    add_line(loop, 12, [](const Anchor& a, const Anchor& b) { return Breakable<Hinge>::Item{{a, b}, 1e9, 1e9}; });
  };
  // Both are exact: what is left is rounding, 1e-16 of places of 50 m a step, which a joint that is pulled together by a
  // fifth of its gap does not let grow, and a free body only with the steps.
  const Apart end =
      apart(World{RigidBodies{}},
            Constraints{BallJoint{}, Hinge{}, Slider{}, Cylindrical{}, Universal{}, Planar{}, Weld{}, PointOnLine{}, Screw{},
                        DistanceJoint{}, VirtualCoupling{}, Breakable<Hinge>{}},
            build, 200, 1e-3, JointByJoint{}, exact);
  CHECK(end.places <= 200 * 50 * 0x1p-50);
  CHECK(end.velocities <= 200 * 50 * 0x1p-50 / 1e-3);
  CHECK(end.visited.rows == 9 * (3 + 5 + 5 + 4 + 4 + 3 + 6 + 2 + 5 + 1 + 1 + 6 + 5));
  CHECK(end.visited.rows == end.plain.rows);
  CHECK(end.visited.residual <= 1e-12);
  CHECK(end.visited.status == Status::converged);
  CHECK(end.visited.max_joint_violation == Approx(end.plain.max_joint_violation).margin(1e-12));
}

TEST_CASE("joints of particles, of kinematic bodies, and of redundant rows move so too") {
  const auto build = [](auto& loop) {
    auto& set = bodies<RigidBodies>(loop.world());
    auto& points = bodies<Particles>(loop.world());
    const auto kinematic = set.add(
        {.position = {0, 0, 2}, .velocity = {1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
    for (int k = 0; k < 6; ++k) {
      const Vec3 at(3.0 * k, 1, 0);
      const auto body =
          set.add({.position = at, .angular_velocity = {0, 1, 2}, .mass = 1.5, .shape = Box{1, 0.5, 0.4}});
      const auto point = points.add({.position = at + Vec3(0.5, 0, 0), .velocity = {0, 0, 1}, .mass = 0.7});
      const auto other = points.add({.position = at + Vec3(0.5, 2, 0), .mass = 0.3});
      const auto bob = points.add({.position = at + Vec3(0.5, 2, 1), .mass = 0.3});
      if (k % 2)
        loop.add(BallJoint::Item{anchor(set, body, {0.5, 0, 0}), anchor(points, point)});
      else
        loop.add(BallJoint::Item{anchor(points, point), anchor(set, body, {0.5, 0, 0})});
      if (k % 3)
        loop.add(DistanceJoint::Item{anchor(points, other), anchor(points, bob), 1});
      else
        loop.add(BallJoint::Item{anchor(points, other), world_anchor(at + Vec3(0.5, 2, 0))});
    }
    const auto cart = set.add({.position = {0, 0, 1}, .mass = 1.0, .shape = Sphere{0.2}});
    loop.add(BallJoint::Item{anchor(set, kinematic, {0, 0, -0.5}), anchor(set, cart, {0, 0, 0.5})});
  };
  const Apart end = apart(World{RigidBodies{}, Particles{}}, Constraints{BallJoint{}, DistanceJoint{}}, build,
                          200, 1e-3, JointByJoint{}, exact);
  CHECK(end.places <= 200 * 20 * 0x1p-50);
  CHECK(end.velocities <= 200 * 20 * 0x1p-50 / 1e-3);
  CHECK(end.visited.status == Status::converged);
}

namespace {

/// A chain of boxes on ball joints that hangs from the world, level; `length` of them.
template <class Loop>
void add_chain(Loop& loop, int length) {
  auto& set = rigid_bodies(loop);
  Anchor end = world_anchor({0, 0, 0});
  for (int k = 0; k < length; ++k) {
    const auto link =
        set.add({.position = {0.2 * k + 0.1, 0, 0}, .mass = 0.5 + 0.1 * k, .shape = Box{0.2, 0.05, 0.05}});
    loop.add(BallJoint::Item{end, anchor(set, link, {-0.1, 0, 0})});
    end = anchor(set, link, {0.1, 0, 0});
  }
}

}  // namespace

// The same sweeps with v in the place of W λ + d: only rounding tells them apart. The chain is chaotic beyond
// that, which is why it is not followed for longer.
TEST_CASE(
    "joints that share bodies are swept as Gauss-Seidel sweeps W, and what is left is measured the same") {
  for (const int sweeps : {1, 3, 10}) {
    const Apart end = apart(
        World{RigidBodies{}}, Constraints{BallJoint{}}, [](auto& loop) { add_chain(loop, 10); }, 300, 1e-3,
        JointByJoint{.sweeps = sweeps},
        GaussSeidel{.tolerance = 0, .max_iterations = sweeps, .min_iterations = sweeps});
    CAPTURE(sweeps);
    CHECK(end.places <= 1e-11);
    CHECK(end.velocities <= 1e-10);
    CHECK(end.visited.sweeps == sweeps);
    CHECK(end.visited.residual > 1e-6);
    CHECK(end.visited.residual == Approx(end.plain.residual).epsilon(1e-6));
    CHECK(end.visited.natural_map_error == Approx(end.plain.natural_map_error).epsilon(1e-6));
    CHECK(end.visited.status == Status::max_iterations);
  }
}

TEST_CASE("visits keep momentum and angular momentum of bodies that float") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}}, JointByJoint{.sweeps = 2}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  std::vector<RigidBodies::Handle> links;
  for (int k = 0; k < 6; ++k)
    links.push_back(set.add({.position = {double(k), 0, 0},
                             .velocity = {0, 0.3 * k, -0.1 * k * k},
                             .angular_velocity = {1, 0, 0.2 * k},
                             .mass = 1.0 + k,
                             .shape = Box{1, 0.4, 0.2}}));
  for (int k = 0; k + 1 < 6; ++k) {
    const Anchor a = anchor(set, links[k], {0.5, 0, 0}), b = anchor(set, links[k + 1], {-0.5, 0, 0});
    if (k % 2)
      loop.add(BallJoint::Item{a, b});
    else
      loop.add(Hinge::Item{a, b});
  }
  const Vec3 P = momentum(set), L = angular_momentum(set);
  for (int n = 0; n < 1000; ++n) loop.step(1e-3);
  // Rounding of a thousand steps of eleven impulses each.
  CHECK((momentum(set) - P).norm() <= 1e-12 * P.norm());
  CHECK((angular_momentum(set) - L).norm() <= 1e-12 * std::max(1.0, L.norm()));
}

TEST_CASE(
    "joints come and go between steps, alone or with others, and a world may be put in the place of "
    "another") {
  AnimationLoop visits{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{.sweeps = 400}};
  AnimationLoop plain{World{RigidBodies{}}, Constraints{BallJoint{}}, exact};
  const auto both = [&](const auto& f) { f(visits), f(plain); };
  const auto fresh = visits.world().clone();
  both([](auto& loop) { add_chain(loop, 3); });
  const auto same = [&](int steps) {
    for (int n = 0; n < steps; ++n) visits.step(1e-3), plain.step(1e-3);
    double most = 0;
    for (Index b = 0; b < rigid_bodies(visits).blocks(); ++b)
      most = std::max(most, (rigid_bodies(visits).velocity()[b] - rigid_bodies(plain).velocity()[b]).norm());
    return most;
  };
  CHECK(same(50) <= 1e-5);
  CHECK(visits.report().sweeps == 400);
  both([](auto& loop) { loop.remove(rigid_bodies(loop).handle(1)); });  // the middle one: the first is alone
  CHECK(same(1) <= 1e-5);
  CHECK(same(50) <= 1e-5);
  CHECK(visits.report().rows == 3);
  CHECK(visits.report().sweeps == 1);
  both(
      [](auto& loop) { rigid_bodies(loop).remove(rigid_bodies(loop).handle(0)); });  // behind the loop's back
  CHECK(same(10) <= 1e-5);
  CHECK(visits.report().rows == 0);
  both([](auto& loop) { add_chain(loop, 2); });
  CHECK(same(10) <= 1e-5);
  visits.world() = fresh.clone();  // nobody is there any more: no joint is left
  visits.step(1e-3);
  CHECK(visits.report().rows == 0);
}

TEST_CASE("joints of bodies that are gone are dropped after a removal was undone and another made, by any scheme") {
  const auto check = [](auto loop) {
    auto& set = rigid_bodies(loop);
    for (int k = 0; k < 3; ++k) {
      const auto bob = set.add({.position = {1, 3.0 * k, 0}, .mass = 1.0, .shape = Sphere{0.2}});
      loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 3.0 * k, 0})});
    }
    loop.step(1e-3);
    auto saved = loop.world().clone();
    set.remove(set.handle(0));
    CHECK(loop.step(1e-3).rows == 6);
    loop.world() = std::move(saved);
    set.remove(set.handle(1));
    CHECK(loop.step(1e-3).rows == 3);
  };
  check(AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{}});
  check(AnimationLoop{World{RigidBodies{}}, Constraints{BallJoint{}}});
}

TEST_CASE("a joint whose body was given a force that is no number stays where it was, and the others go on") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{}};
  auto& set = rigid_bodies(loop);
  for (int k = 0; k < 3; ++k) {
    const auto bob = set.add({.position = {1, 3.0 * k, 0}, .mass = 1.0, .shape = Sphere{0.2}});
    loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 3.0 * k, 0})});
  }
  loop.step(1e-3);
  const Vec3 before = set.position(set.handle(1));
  set.apply_force(set.handle(1), {0, std::numeric_limits<double>::infinity(), 0});
  const StepReport report = loop.step(1e-3);
  CHECK(report.status == Status::quarantined);
  CHECK(report.quarantined == 1);
  CHECK(std::isfinite(report.residual));
  CHECK(set.position(set.handle(1)) == before);
  CHECK(set.position(set.handle(0)).z() < 0);
  CHECK(loop.step(1e-3).status == Status::converged);
  CHECK(set.position(set.handle(1)).z() < before.z());
}

// Two joints hold one rod of a metre to points two metres apart: nothing meets both.
TEST_CASE("what is no number in one joint does not pass through a kinematic body to the others") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Hinge{}}, JointByJoint{}};
  auto& set = rigid_bodies(loop);
  const auto kinematic = set.add({.velocity = {1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  for (int k = 0; k < 4; ++k) {
    const Anchor hook = anchor(set, kinematic, {0, 0.1 * k, -0.5});
    const auto bob = set.add({.position = {0, 0.1 * k, -1}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.01}});
    if (k < 2) loop.add(BallJoint::Item{hook, anchor(set, bob, {0, 0, 0.5})});
    else loop.add(Hinge::Item{hook, anchor(set, bob, {0, 0, 0.5})});
  }
  loop.step(1e-3);
  for (const Index sick : {1, 3}) set.apply_force(set.handle(sick), {0, std::numeric_limits<double>::infinity(), 0});
  CHECK(loop.step(1e-3).quarantined == 2);
  CHECK(set.position(kinematic).x() == Approx(2e-3));
  CHECK(set.position(set.handle(2)).x() == Approx(2e-3));
  CHECK(set.position(set.handle(4)).x() == Approx(2e-3));
}

TEST_CASE("joints that contradict each other are told apart from others, and their impulses do not grow") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{.sweeps = 4}};
  auto& set = rigid_bodies(loop);
  const auto rod = set.add({.mass = 1.0, .shape = Box{1, 0.1, 0.1}});
  const auto left = loop.add(BallJoint::Item{anchor(set, rod, {-0.5, 0, 0}), world_anchor({-1, 0, 0})});
  loop.add(BallJoint::Item{anchor(set, rod, {0.5, 0, 0}), world_anchor({1, 0, 0})});
  double most = 0;
  StepReport report;
  for (int n = 0; n < 2000; ++n) {
    report = loop.step(1e-3);
    most = std::max(most, loop.impulse(left).norm());
  }
  CHECK(report.status == Status::max_iterations);
  CHECK(report.residual > 0.05);
  // Four sweeps add at most 4 m |bias| = 4 · 1 kg · 0.2 · 0.5 m / 1 ms to the impulse each started with, and
  // a start beyond every load is dropped: that is beyond twice as much.
  CHECK(most <= 4 * 100 * 2 * 4);
  CHECK(is_finite(set.position(rod)));
}

// Along the rod the joint has 1/m, across it r²/I: 2.5 10⁶ and 4 10⁷ times as much, which single precision could not tell from
// nothing. What is left of the gap is single precision's of the velocity, 6e-8 of 10 m/s for a thousand steps of a fifth of it.
TEST_CASE("small bobs on long rods are held in single precision") {
  const auto gap = []<class Law>(Law, double arm) {
    AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Law{}}, JointByJoint{}};
    auto& set = rigid_bodies(loop);
    for (int k = 0; k < 4; ++k) {
      const Vec3 along = Vec3(1 + 0.3 * k, 1, 1).normalized();
      const auto bob = set.add({.position = arm * along, .mass = 1.0, .shape = Sphere{0.01}});
      loop.add(typename Law::Item{anchor(set, bob, -arm * along), world_anchor({0, 0, 0})});
    }
    double most = 0;
    StepReport report;
    for (int n = 0; n < 1000; ++n) {
      report = loop.step(1e-3);
      most = std::max(most, report.max_joint_violation);
    }
    CHECK(report.status == Status::converged);
    return most;
  };
  for (const double arm : {2.0, 10.0}) {
    CAPTURE(arm);
    CHECK(gap(BallJoint{}, arm) <= 1e-3);
    CHECK(gap(Hinge{}, arm) <= 1e-3);
  }
}

TEST_CASE("single precision visits too") {
  const auto build = [](auto& loop) {
    auto& set = rigid_bodies(loop);
    for (int k = 0; k < 4; ++k) {
      const auto bob = set.add({.position = {1, 3.0 * k, 0}, .mass = 1.0 + k, .shape = Box{1, 0.5, 0.3}});
      loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 3.0 * k, 0})});
    }
  };
  const Apart end = apart(World{RigidBodiesF{}}, Constraints{BallJoint{}}, build, 200, 1e-3, JointByJoint{},
                          AcceleratedGaussSeidel{});
  CHECK(end.places <= 200 * 10 * 0x1p-22);
  CHECK(end.visited.status == Status::converged);
}

TEST_CASE("a joint between kinematic bodies moved apart is no work of the solver's") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{}};
  auto& set = rigid_bodies(loop);
  const auto left = set.add({.velocity = {-1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto right =
      set.add({.position = {1, 0, 0}, .velocity = {1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto joint = loop.add(BallJoint::Item{anchor(set, left, {0.5, 0, 0}), anchor(set, right, {-0.5, 0, 0})});
  StepReport report;
  for (int n = 0; n < 3; ++n) report = loop.step(1e-3);
  CHECK(report.status == Status::converged);
  CHECK(report.residual == 0);
  CHECK(loop.impulse(joint).norm() == 0);
  CHECK(set.position(right).x() - set.position(left).x() == Approx(1.006));
}

TEST_CASE("springs and yielding joints between what does not answer have no impulse") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}, BallJoint{}}, WithCompliance{Baumgarte{}, 1e-3},
                     JointByJoint{}};
  auto& set = rigid_bodies(loop);
  const auto kinematic = set.add({.velocity = {1, 0, 0}, .shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  const auto fixed = set.add_fixed(Box{1, 1, 1}, {3, 0, 0});
  const auto spring = loop.add(DistanceJoint::Item{
      .a = anchor(set, kinematic), .b = anchor(set, fixed), .length = 1, .stiffness = 100});
  const auto joint = loop.add(BallJoint::Item{anchor(set, fixed), anchor(set, kinematic)});
  for (int n = 0; n < 5; ++n) loop.step(1e-3);
  CHECK(loop.impulse(spring).norm() == 0);
  CHECK(loop.impulse(joint).norm() == 0);
}

namespace {

struct SoftBall : BallJoint {
  using Item = BallJoint::Item;
  void linearize(const Item& item, const auto& world, auto row) const {
    BallJoint::linearize(item, world, row);
    for (int k = 0; k < 3; ++k) row.soft(k, 100, 5);
  }
};
struct DrivenBall : BallJoint {
  using Item = BallJoint::Item;
  static constexpr auto refines = BallJoint::refines | refine::speed;
  double speed(const Item&) const { return 0.5; }
};

template <class Law>
Apart apart_derived() {
  return apart(
      World{RigidBodies{}}, Constraints{Law{}},
      [](auto& loop) {
        auto& set = rigid_bodies(loop);
        const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.2}});
        loop.add(typename Law::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 0, 0})});
      },
      200, 1e-3, JointByJoint{}, exact);
}

}  // namespace

TEST_CASE("a law that derives from a ball joint keeps its own rows and speeds") {
  CHECK(apart_derived<SoftBall>().places <= 1e-12);
  CHECK(apart_derived<DrivenBall>().places <= 1e-12);
}

TEST_CASE("listeners hear visits, and what needs W stays empty") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, JointByJoint{.tolerance = 1e-5}, Stopwatch{},
                     ConvergenceRecord{},  Recorder{}};
  auto& set = rigid_bodies(loop);
  const auto bob = set.add({.position = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.2}});
  loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor({0, 0, 0})});
  for (int n = 0; n < 10; ++n) loop.step(1e-3);
  CHECK(loop.get<Recorder>().recording().steps.tolerance == 1e-5);
  CHECK(loop.get<Stopwatch>().laps().size() == 10);
  CHECK(loop.get<ConvergenceRecord>().sweeps().empty());
  REQUIRE(loop.island_reports().size() == 1);
  CHECK(loop.island_reports()[0].measure.residual == loop.report().residual);
}

TEST_CASE("numbers of the scheme that cannot be are refused, and without constraints it is the plain order") {
  const auto start = [](JointByJoint scheme) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, scheme};
    loop.step(1e-3);
  };
  REQUIRE_THROWS_WITH(start({.sweeps = 0}), "delassus: JointByJoint: sweeps 0 must be >= 1");
  REQUIRE_THROWS_WITH(start({.tolerance = -1}), "delassus: JointByJoint: tolerance -1 must be >= 0");
  AnimationLoop free{World{RigidBodies{}}, JointByJoint{}};
  const auto body = rigid_bodies(free).add({.mass = 1.0, .shape = Sphere{1}});
  free.step(0.1);
  REQUIRE(rigid_bodies(free).velocity(body).z() == Approx(-0.981));
}

}  // namespace joint_by_joint_tests
