#include "catch.hpp"
#include "collision/mesh_scene.hpp"
#include "scenes.hpp"

#include <delassus/activity/sleeping.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/constraints/joints/breakable.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/schemes/predictive_scheme.hpp>
#include <delassus/schemes/substeps.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

// A contact acts only where bodies meet within the step. The row n·u + gap/h ≥ 0 of the nearest points is a half-space that
// holds all of the other body and more: a body beside it crosses the one and never the other.
namespace past_edges_tests {

using namespace delassus;

namespace {

const Constraints rough{Contact{Coulomb{.friction = 0.5}}};

/// The most that the velocity of a body of mass 1 is changed, m/s, which comes down at 3 m/s beside the box of 1 m whose edge
/// is at `beside`, over 20 phases of the step.
template <class Loop>
double change_beside(const Loop& empty, const Shape& table, const Shape& body, double radius, double clearance, double h) {
  double worst = 0;
  for (int phase = 0; phase < 20; ++phase) {
    auto loop = empty.clone();
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    set.add_fixed(table);
    const auto b = set.add({.position = {0.5 + radius + clearance, 0.013, 0.6 + 3 * h * phase / 20},
                            .velocity = {0, 0, -3},
                            .mass = 1,
                            .shape = body});
    for (int i = 0; i < int(0.5 / h); ++i) loop.step(h);
    worst = std::max({worst, (set.velocity(b) - Vec3(0, 0, -3)).norm(), radius * set.angular_velocity(b).norm()});
  }
  return worst;
}

template <class... P>
auto loop_of(const P&... policies) {
  return AnimationLoop{World{RigidBodies{}}, rough, policies...};
}

}  // namespace

TEST_CASE("a body that passes an edge is not touched") {
  // Nothing meets, so that nothing may change: not to the last bit.
  const Shape table = Box{1, 1, 1};
  for (const double h : {1 / 60., 1 / 240., 1 / 480.}) {
    CHECK(change_beside(loop_of(), table, Sphere{0.01}, 0.01, 1e-3, h) == 0);
    CHECK(change_beside(loop_of(), table, Sphere{0.05}, 0.05, 2e-4, h) == 0);
    CHECK(change_beside(loop_of(), table, Box{0.02, 0.02, 0.02}, 0.01, 1e-3, h) == 0);
    CHECK(change_beside(loop_of(), table, Capsule{0.01, 0.04}, 0.01, 1e-3, h) == 0);
    CHECK(change_beside(loop_of(), table, Cylinder{0.01, 0.02}, 0.01, 1e-3, h) == 0);
    CHECK(change_beside(loop_of(NativeCollision{.margin = 0.1}), table, Sphere{0.01}, 0.01, 1e-3, h) == 0);
  }
}

TEST_CASE("a body that passes an edge is not touched under any scheme") {
  const Shape table = Box{1, 1, 1}, ball = Sphere{0.01};
  const double h = 1 / 60.;
  CHECK(change_beside(loop_of(Substeps{.count = 3}), table, ball, 0.01, 1e-3, h) == 0);
  CHECK(change_beside(loop_of(PredictiveScheme{}), table, ball, 0.01, 1e-3, h) == 0);
  CHECK(change_beside(loop_of(Sleeping{}), table, ball, 0.01, 1e-3, h) == 0);
  CHECK(change_beside(loop_of(ImplicitMidpoint{}), table, ball, 0.01, 1e-3, h) == 0);
}

TEST_CASE("a particle that passes an edge is not touched, though others of its set are on a spring") {
  // Nothing meets, and no spring joins the particle to anything, so that nothing may change: after a spring is gone too, in
  // whose place it was added.
  for (const double h : {1 / 60., 1 / 240.})
    for (int phase = 0; phase < 20; ++phase) {
      AnimationLoop loop{World{RigidBodies{}, Particles{}}, rough};
      bodies<RigidBodies>(loop.world()).add_fixed(Box{1, 1, 1});
      auto& set = bodies<Particles>(loop.world());
      set.gravity.setZero();
      const auto gone = set.add({.position = {49, 0, 0}, .mass = 1}), left = set.add({.position = {50, 0, 0}, .mass = 1}),
                 right = set.add({.position = {51, 0, 0}, .mass = 1});
      set.add_spring(gone, left, 100);
      set.add_spring(left, right, 100);
      set.remove(gone);
      const auto b = set.add({.position = {0.511, 0, 0.6 + 3 * h * phase / 20}, .velocity = {0, 0, -3}, .mass = 1, .radius = 0.01});
      for (int i = 0; i < int(0.5 / h); ++i) loop.step(h);
      CHECK(set.velocity(b) == Vec3(0, 0, -3));
    }
}

TEST_CASE("a body that passes the edge of a mesh or of a part is not touched") {
  for (const double h : {1 / 60., 1 / 240.})
    for (const Shape& body : {Shape(Sphere{0.01}), Shape(Box{0.02, 0.02, 0.02})}) {
      auto meshes = loop_of(WithMeshes{NativeCollision{}});
      const Shape mesh = meshes.get<WithMeshes<NativeCollision>>().add(scenes::fine_box(1, 1, 1, 3));
      CHECK(change_beside(meshes, mesh, body, 0.01, 1e-3, h) == 0);
      auto compounds = loop_of(WithCompounds{NativeCollision{}});
      const Shape halves = compounds.get<WithCompounds<NativeCollision>>().add(
          Compound(std::vector<CompoundPart>{{.shape = Box{1, 1, 0.5}, .position = {0, 0, -0.25}},
                                             {.shape = Box{1, 1, 0.5}, .position = {0, 0, 0.25}}}));
      CHECK(change_beside(compounds, halves, body, 0.01, 1e-3, h) == 0);
    }
}

TEST_CASE("a ball without friction that lands inside an edge keeps its speed along the face") {
  // It meets the face, 5 mm inside: the normal is z, and v_x has no reason to change. Afterwards it lies on the face or has
  // left it; without gravity v_z is 0 then.
  const auto land = [](auto loop, const Shape& table, double angle, double h) {
    double worst = 0;
    for (int phase = 0; phase < 20; ++phase) {
      auto one = loop.clone();
      auto& set = bodies<RigidBodies>(one.world());
      set.gravity.setZero();
      set.add_fixed(table);
      const double r = 0.05, v = 3;
      const Vec3 direction(std::cos(angle), 0, -std::sin(angle)), lands(0.495, 0.013, 0.5 + r);
      const auto b = set.add({.position = lands - direction * (v * h * (3 + phase / 20.)),
                              .velocity = v * direction,
                              .mass = 1,
                              .shape = Sphere{r}});
      for (int i = 0; i < 10; ++i) one.step(h);
      worst = std::max({worst, std::abs(set.velocity(b).x() - v * direction.x()), std::abs(set.velocity(b).z())});
    }
    return worst;
  };
  const Constraints smooth{Contact{Frictionless{}}};
  AnimationLoop convex{World{RigidBodies{}}, smooth};
  AnimationLoop meshes{World{RigidBodies{}}, smooth, WithMeshes{NativeCollision{}}};
  const Shape mesh = meshes.get<WithMeshes<NativeCollision>>().add(scenes::fine_box(1, 1, 1, 3));
  // A normal is taken as the face's where this changes the gap by less than 1e-5 of the size L = 2 r, up to x² = 2e-5 L r
  // beside the edge. The impulse then acts at the edge, turns the ball, and takes 5/2 (x/r)² too little of v_z.
  const double tolerance = 2.5 * 2e-5 * 2 * 3;
  for (const double h : {1 / 60., 1 / 240.})
    for (const double angle : {0.4, 0.8, 1.2, 1.5}) {
      CHECK(land(convex.clone(), Box{1, 1, 1}, angle, h) < tolerance);
      CHECK(land(meshes.clone(), mesh, angle, h) < tolerance);
    }
}

TEST_CASE("what comes down aslant on a mesh lands on the triangle that it meets") {
  // Which is another one than it is over when the step begins. The face is flat, and the normal z: v_z ends, v_x stays.
  AnimationLoop empty{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, WithMeshes{NativeCollision{}}};
  const double h = 1 / 60.;
  for (const int cells : {2, 20})
    for (const Shape& body : {Shape(Sphere{0.05}), Shape(Box{0.1, 0.1, 0.1}), Shape(Capsule{0.05, 0.1})})
      for (const double v : {3., 10., 30.}) {
        double sinks = 0, slows = 0, parts = 0;
        for (int phase = 0; phase < 10; ++phase) {
          auto loop = empty.clone();
          auto& set = bodies<RigidBodies>(loop.world());
          set.gravity.setZero();
          set.add_fixed(loop.template get<WithMeshes<NativeCollision>>().add(scenes::fine_box(4, 4, 1, cells)));
          const double half = body.kind == ShapeKind::capsule ? 0.1 : 0.05;
          const Vec3 velocity(0.8 * v, 0.1 * v, -0.6 * v), lands(0.31, 0.17, 0.5 + half);
          const auto b = set.add({.position = lands - velocity * (h * (1 + phase / 10.)), .velocity = velocity, .mass = 1, .shape = body});
          for (int i = 0; i < 4; ++i) {
            loop.step(h);
            sinks = std::max(sinks, 0.5 + half - set.position(b).z());
          }
          slows = std::max(slows, std::abs(set.velocity(b).x() - velocity.x()));
          parts = std::max(parts, std::abs(set.velocity(b).z()));
        }
        CAPTURE(cells, int(body.kind), v);
        CHECK(sinks < 1e-4 * 0.1);
        CHECK(slows < 1e-5 * v);
        CHECK(parts < 1e-4 * v);
      }
}

TEST_CASE("a corner of a mesh that a fast body clips is met") {
  AnimationLoop empty{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, WithMeshes{NativeCollision{}}};
  const Vec3 out = Vec3(1, 1, 1).normalized(), along = Vec3(1, -1, 0).normalized();
  const Quat z_to_out = Quat(1 + out[2], -out[1], out[0], 0).normalized();  // FromTwoVectors takes the compiler longer than all else here
  const double h = 1 / 60.;
  for (const Shape& body : {Shape(Sphere{0.1}), Shape(Cylinder{0.1, 0.2})})
    for (const double v : {30., 100., 200.})
      for (int phase = 0; phase < 10; ++phase) {
        auto loop = empty.clone();
        auto& set = bodies<RigidBodies>(loop.world());
        set.gravity.setZero();
        set.add_fixed(loop.template get<WithMeshes<NativeCollision>>().add(scenes::fine_box(1, 1, 1, 2)));
        // 3 cm of it are in the way.
        const auto b = set.add({.position = Vec3(0.5, 0.5, 0.5) + 0.07 * out - along * (v * h * (1 + phase / 10.) + 0.4),
                                .orientation = z_to_out,
                                .velocity = v * along,
                                .mass = 1,
                                .shape = body});
        for (int i = 0; i < 4 + 1 / (v * h); ++i) loop.step(h);
        CAPTURE(int(body.kind), v, phase);
        CHECK(set.velocity(b).dot(out) > 1e-3 * v);  // it is pushed out
      }
}

TEST_CASE("a box that lands flat inside an edge does not turn, though it is over the edge before the impact ends") {
  AnimationLoop empty{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, WithMeshes{NativeCollision{}}};
  const Shape mesh = empty.get<WithMeshes<NativeCollision>>().add(scenes::fine_box(1, 1, 1, 3));
  const double h = 1 / 60., v = 15;
  for (const Shape& table : {Shape(Box{1, 1, 1}), mesh})
    for (int phase = 0; phase < 10; ++phase) {
      auto loop = empty.clone();
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      set.add_fixed(table);
      const Vec3 direction(std::cos(0.8), 0, -std::sin(0.8)), lands(0.445, 0.013, 0.55);
      const auto b = set.add({.position = lands - direction * (v * h * (1 + phase / 10.)), .velocity = v * direction, .mass = 1, .shape = Box{0.1, 0.1, 0.1}});
      for (int i = 0; i < 6; ++i) loop.step(h);
      CAPTURE(int(table.kind), phase);
      CHECK((set.velocity(b) - Vec3(v * direction.x(), 0, 0)).norm() < 1e-4 * v);
      CHECK(0.05 * set.angular_velocity(b).norm() < 1e-4 * v);
    }
}

TEST_CASE("balls without friction that meet beside each other part along the line of their centres") {
  // The centres of two balls of one mass and radius r, b beside each other, are 2 r apart where they meet: sin θ = b / 2r. The impulse
  // takes the approach v cos θ along that line, and turns neither. Bodies count as touching at 1e-4 of the size 2 r, which moves θ
  // by 1e-4 tan θ, and half of v cos θ with it. The angular momentum is kept where the rest of the impulse comes at the other side.
  const double r = 0.05;
  for (const double v : {1., 3., 10., 30.})
    for (const double b : {0.01, 0.04, 0.07, 0.09})
      for (int phase = 0; phase < 20; ++phase) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}};
        auto& set = bodies<RigidBodies>(loop.world());
        set.gravity.setZero();
        const auto hits = set.add({.velocity = {v, 0, 0}, .mass = 1, .shape = Sphere{r}});
        const auto is_hit = set.add({.position = {0.5 + phase * v / 60 / 20, b, 0}, .mass = 1, .shape = Sphere{r}});
        for (int i = 0; i < 10 + 60 / v; ++i) loop.step(1 / 60.);
        const double sine = b / (2 * r), cosine = std::sqrt(1 - sine * sine);
        const Vec3 wanted = v * cosine / 2 * Vec3(cosine, sine, 0);
        CAPTURE(v, b, phase);
        CHECK((set.velocity(is_hit) - wanted).norm() < 1e-4 * v);
        CHECK((set.velocity(hits) - Vec3(v, 0, 0) + wanted).norm() < 1e-4 * v);
        CHECK(r * std::max(set.angular_velocity(hits).norm(), set.angular_velocity(is_hit).norm()) < 1e-12 * v);
        const Vec3 turns = set.position(hits).cross(set.velocity(hits)) + set.position(is_hit).cross(set.velocity(is_hit));
        CHECK(turns.norm() < 1e-4 * 2 * r * v);
      }
}

TEST_CASE("a box does not pass a wall, whatever its speed") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const bool is_mesh : {false, true})
    for (int shot = 0; shot < 50; ++shot) {
      AnimationLoop loop{World{RigidBodies{}}, rough, WithMeshes{NativeCollision{}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      set.add_fixed(is_mesh ? loop.get<WithMeshes<NativeCollision>>().add(scenes::fine_box(0.1, 8, 8, 4)) : Shape(Box{0.1, 8, 8}));
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      const auto b = set.add({.position = {-2 - 0.5 * x, 0.2 * y, 0.2 * z},
                              .orientation = Quat(1, 0.5 * x, 0.5 * y, 0.5 * z).normalized(),
                              .velocity = {5. + shot, 0, 0},
                              .mass = 1,
                              .shape = shot % 3 == 0 ? Shape(Sphere{0.1}) : Shape(Box{0.2, 0.2, 0.2})});
      double farthest = -3;
      for (int i = 0; i < 60; ++i) loop.step(1 / 60.), farthest = std::max(farthest, set.position(b).x());
      INFO("shot " << shot << ", mesh " << is_mesh);
      // The middle stays half a core from the wall, 5 cm of a box of 20 cm, and it did arrive.
      CHECK(farthest < -0.05 - 0.05 + 1e-3);
      CHECK(farthest > -0.25);
    }
}

TEST_CASE("balls that are pushed within the step do not go through each other") {
  // Six of 2 cm, 1 mm apart, the first at 4 m/s: 6.7 cm in a step. Without restitution they go on together, at 4/6 m/s.
  for (const double h : {1 / 60., 1 / 240.}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    std::vector<RigidBodies::Handle> balls;
    for (int i = 0; i < 6; ++i) balls.push_back(set.add({.position = {0.021 * i, 0, 0}, .velocity = {i == 0 ? 4. : 0., 0, 0}, .mass = 1, .shape = Sphere{0.01}}));
    double deepest = 0;
    for (int i = 0; i < int(0.5 / h); ++i) {
      const StepReport report = loop.step(h);
      CHECK(report.status == Status::converged);
      deepest = std::max(deepest, report.max_penetration);
    }
    CHECK(deepest < 1e-6 * 4 * h);  // the tolerance of the solve, times the step
    for (const auto b : balls) CHECK(std::abs(set.velocity(b).x() - 4 / 6.) < 1e-5);
  }
}

TEST_CASE("what would overlap by little in a large island waits for the next step") {
  // A ball hits the top one of `count` boxes, which goes on with half its speed and reaches a second ball, `gap` away, within the step.
  const auto after = [](int count, double speed, double gap) {
    AnimationLoop loop{World{RigidBodies{}}, rough};
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(HalfSpace{});
    for (int i = 0; i < count; ++i) set.add({.position = {0, 0, 0.1 + 0.2 * i}, .mass = 1, .shape = Box{0.2, 0.2, 0.2}});
    for (int i = 0; i < 10; ++i) loop.step(1 / 60.);
    const double top = 0.2 * count - 0.1;
    set.add({.position = {-0.2 - 1e-3, 0, top}, .velocity = {speed, 0, 0}, .mass = 1, .shape = Sphere{0.1}});
    set.add({.position = {0.2 + gap, 0, top}, .mass = 1, .shape = Sphere{0.1}});
    loop.step(1 / 60.);
    const int solves = loop.data().contact_cache.solves;
    return std::pair(solves, loop.step(1 / 60.).max_penetration);
  };
  const double gap = 6e-3, slow = 1.2, fast = 12, length = 0.2;
  const double overlap = 0.5 * slow / 60 - gap;
  REQUIRE((overlap > 0 && overlap < 0.05 * 0.5 * length));
  // One box has 4 contacts, twelve have 48: 144 rows.
  const auto [solves_of_one, of_one] = after(1, slow, gap);
  CHECK(solves_of_one == 1);
  CHECK(of_one < 1e-4 * length);
  const auto [solves_of_twelve, of_twelve] = after(12, slow, gap);
  CHECK(solves_of_twelve == 0);
  CHECK((of_twelve > 1e-4 * length && of_twelve < overlap + 1e-4 * length));  // friction below brakes the box, and nothing drives it
  const auto [solves_of_deep, of_deep] = after(12, fast, gap);
  CHECK(solves_of_deep > 0);
  CHECK(of_deep < 0.05 * length);
}

TEST_CASE("what breaks in a step that is solved again breaks once") {
  // Balls in a row need several solves; beside them a load that tears off at once.
  using Joint = Breakable<BallJoint>;
  AnimationLoop loop{World{RigidBodies{}}, Constraints<Contact<Frictionless>, Joint>{Contact{Frictionless{}}, Joint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  for (int i = 0; i < 6; ++i) set.add({.position = {0.021 * i, 0, 0}, .velocity = {i == 0 ? 4. : 0., 0, 0}, .mass = 1, .shape = Sphere{0.01}});
  const auto load = set.add({.position = {0, 5, 0}, .mass = 1, .shape = Sphere{0.1}});
  loop.add(Joint::Item{{world_anchor({0, 5, 0}), anchor_at(set, load, Vec3(0, 5, 0))}, 1});
  loop.step(1 / 60.);
  REQUIRE(loop.data().contact_cache.solves > 0);
  CHECK(loop.broken<Joint>().size() == 1);
}

TEST_CASE("a sleeper that is met within the step wakes in that step") {
  AnimationLoop loop{World{RigidBodies{}}, rough, Sleeping{.after = 0.1}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto sleeper = set.add({.position = {3, 0, 0.1}, .mass = 1, .shape = Box{0.2, 0.2, 0.2}});
  for (int i = 0; i < 30; ++i) loop.step(1 / 60.);
  // A ball that hits another one, which will reach the sleeper in the same step: 1.5 m at 120 m/s.
  set.add({.position = {2.0, 0, 0.1}, .velocity = {240, 0, 0}, .mass = 1, .shape = Sphere{0.1}});
  set.add({.position = {2.3, 0, 0.1}, .mass = 1, .shape = Sphere{0.1}});
  const double momentum = 240;
  loop.step(1 / 60.);
  double sum = 0;
  for (const Index b : set.active()) sum += set.moves(b) ? set.velocity()[b][0] : 0;
  CHECK(set.position(sleeper).x() > 3.1);
  CHECK(std::abs(sum - momentum) < 0.05 * momentum);  // friction of the floor takes µ of what presses on it, no more
}

TEST_CASE("a step that is solved again is the same when it is repeated from a checkpoint") {
  const auto make = [] {
    AnimationLoop loop{World{RigidBodies{}}, rough};
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(Box{1, 1, 1});
    for (int i = 0; i < 6; ++i)
      set.add({.position = {0.45 + 0.01 * i, 0.021 * i, 0.53 + 0.06 * i}, .velocity = {0.3, 4. - i, -3}, .mass = 1, .shape = Sphere{0.01}});
    return loop;
  };
  auto loop = make();
  for (int i = 0; i < 3; ++i) loop.step(1 / 60.);
  auto copy = loop.clone();
  for (int i = 0; i < 40; ++i) {
    loop.step(1 / 60.);
    copy.step(1 / 60.);
  }
  auto &a = bodies<RigidBodies>(loop.world()), &b = bodies<RigidBodies>(copy.world());
  for (const Index i : a.active()) CHECK(a.velocity()[i] == b.velocity()[i]);
}

}  // namespace past_edges_tests
