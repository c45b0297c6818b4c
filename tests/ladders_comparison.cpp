// The scene that examples/ladders takes off a loop for other engines, and the gauge that measures all of
// them.
#include "../examples/ladders/watch.hpp"

#include "catch.hpp"

namespace ladders_comparison_tests {

using namespace delassus;
using namespace ladders;
namespace peers = ladders::peers;

/// Moves every body by its velocity, turns none; what pushes it is written down.
struct Drift : peers::Engine {
  std::vector<peers::State> states;
  peers::Triple pushed{};

  explicit Drift(const peers::Scene& scene) {
    for (const peers::Body& body : scene.bodies) states.push_back(body.start);
  }
  void push(int, const peers::Triple& force, const peers::Triple&) override {
    for (std::size_t k = 0; k < 3; ++k) pushed[k] += force[k];
  }
  void step(double h) override {
    for (peers::State& s : states)
      for (std::size_t k = 0; k < 3; ++k) s.position[k] += h * s.velocity[k];
  }
  peers::State state(int body) const override { return states[std::size_t(body)]; }
};

/// Puts Drift, or no other engine, in the place of the loop.
struct Stage : peers::Comparison {
  bool is_loop_itself = false;
  Drift* engine_seen = nullptr;
  std::vector<peers::Reading> readings;
  peers::Triple pushed{};

  void begin(const std::string&) override {}
  void judge(std::vector<Mark>&) override {}
  bool end(const Rung&) override { return true; }
  std::unique_ptr<peers::Engine> engine(const peers::Scene& scene, double) override {
    if (is_loop_itself) return nullptr;
    auto out = std::make_unique<Drift>(scene);
    engine_seen = out.get();
    return out;
  }
  void note(double seconds, const peers::Reading& reading) override {
    CHECK(seconds >= 0);
    readings.push_back(reading);
    if (engine_seen) pushed = engine_seen->pushed;
  }
};

auto contact_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}};
}

/// What the gauge reads of a loop as it stands.
peers::Reading look(const auto& loop) {
  const peers::Told told = peers::scene_of(loop);
  peers::Gauge gauge(told.scene);
  std::vector<peers::State> states;
  peers::read_states(loop, told, states);
  return gauge.read(states, 0);
}

TEST_CASE("what is sunk by a millimetre is a millimetre deep") {
  // Lengths of 1 m: the kernels' answers are certified to far less than 1e-12 of that, and the difference of
  // the places rounds to 1e-16.
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  struct Case {
    Shape below, above;
    Vec3 at;
  };
  const Case cases[] = {
      {HalfSpace{}, Box{1, 1, 1}, {0, 0, 0.499}},      {HalfSpace{}, Sphere{0.5}, {0, 0, 0.499}},
      {HalfSpace{}, Capsule{0.2, 0.6}, {0, 0, 0.499}}, {HalfSpace{}, Cylinder{0.2, 1}, {0, 0, 0.499}},
      {Box{2, 2, 2}, Box{1, 1, 1}, {0, 0, 1.499}},     {Box{2, 2, 2}, Sphere{0.5}, {0, 0, 1.499}},
      {Sphere{0.5}, Sphere{0.5}, {0, 0, 0.999}}};
  for (const Case& c : cases) {
    auto loop = contact_loop();
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(c.below);
    set.add({.position = c.at, .orientation = turned, .mass = 1.0, .shape = c.above});
    const peers::Reading seen = look(loop);
    INFO(name(c.below.kind) << " and " << name(c.above.kind));
    CHECK(std::abs(seen.penetration - 1e-3) < 1e-12);
    CHECK(std::abs(seen.mean_penetration - 1e-3) < 1e-12);
  }
}

TEST_CASE("a hull whose inertia lies off its axes is measured where it is") {
  auto loop = contact_loop();
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  // A wedge: its inertia has products, and its lowest corner is 2/3 below the middle of its mass, which is a
  // third of the way up.
  const std::vector<Vec3> corners{{0, -1, 0}, {3, -1, 0}, {0, -1, 2}, {0, 1, 0}, {3, 1, 0}, {0, 1, 2}};
  const ConvexHull wedge(corners);
  set.add({.position = {0, 0, 2. / 3 - 1e-3}, .density = 1.0, .shape = wedge});
  const peers::Told told = peers::scene_of(loop);
  CHECK(told.axes[1].angularDistance(Quat::Identity()) > 0.1);
  CHECK(std::abs(look(loop).penetration - 1e-3) < 1e-12);
}

TEST_CASE("the scene that is told is the loop's") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.25}}, BallJoint{}, Hinge{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = {0, 1, -2};
  const auto gone = set.add({.mass = 1.0, .shape = Sphere{1}});
  set.add_fixed(HalfSpace{Vec3(0, 0, 2), 0.5}, {0, 0, -1});
  const auto box = set.add({.position = {1, 2, 3},
                            .velocity = {4, 5, 6},
                            .angular_velocity = {7, 8, 9},
                            .mass = 2.0,
                            .shape = Box{1, 2, 3}});
  loop.remove(gone);
  loop.add(BallJoint::Item{world_anchor({1, 2, 3}), anchor(set, box, {0.1, 0.2, 0.3})});
  const peers::Scene scene = peers::scene_of(loop).scene;
  REQUIRE(scene.bodies.size() == 2);
  CHECK(scene.touches);
  CHECK(scene.friction == 0.3);
  CHECK(scene.restitution == 0.25);
  CHECK(scene.gravity == peers::Triple{0, 1, -2});
  CHECK(scene.bodies[0].is_fixed);
  CHECK(scene.bodies[0].geometry.size == std::array<double, 4>{0, 0, 1, 0.5});
  const peers::Body& told = scene.bodies[1];
  CHECK(told.mass == 2);
  CHECK(told.geometry.form == peers::Form::box);
  CHECK(told.moments[0] == Approx(2. / 12 * 13));
  CHECK(told.start.position == peers::Triple{1, 2, 3});
  CHECK(told.start.velocity == peers::Triple{4, 5, 6});
  CHECK(told.start.spin == peers::Triple{7, 8, 9});
  REQUIRE(scene.joints.size() == 1);
  CHECK(scene.joints[0].a == -1);
  CHECK(scene.joints[0].b == 1);
  CHECK(scene.joints[0].on_b == peers::Triple{0.1, 0.2, 0.3});
  // ½ m v² + ½ ω·I ω − m g·x, with v² = 77, I = 2/12 (13, 10, 5), g·x = 2 − 6.
  const double energy = 77 + (13 * 49 + 10 * 64 + 5 * 81) / 12. + 8;
  CHECK(look(loop).energy == Approx(energy));
  CHECK(look(loop).joint_gap == Approx(std::sqrt(0.14)));
}

TEST_CASE("what no description has words for says so") {
  const auto needs = [](const auto& loop) -> std::string {
    try {
      peers::scene_of(loop);
    } catch (const peers::Unsayable& why) {
      return why.what();
    }
    return "";
  };
  AnimationLoop geared{World{RigidBodies{}}, Constraints{Gear{}}};
  auto& set = bodies<RigidBodies>(geared.world());
  const auto a = set.add({.mass = 1.0, .shape = Sphere{1}}), b = set.add({.mass = 1.0, .shape = Sphere{1}});
  CHECK(needs(geared).empty());
  geared.add(Gear::Item{
      .a = anchor(set, a), .b = anchor(set, b), .c = world_anchor({0, 0, 0}), .d = world_anchor({0, 0, 0})});
  CHECK(needs(geared) == "needs gears");
  CHECK(needs(AnimationLoop{World{RigidBodies{}, Particles{}}, Constraints{}}) == "needs particles");
  AnimationLoop particles{World{Particles{}}, Constraints{DistanceJoint{}}};
  Stage stage;
  Ladder ladder("", false, 60, &stage);
  CHECK_THROWS_AS(run(ladder, particles, 1, 0.1), peers::Unsayable);
}

TEST_CASE("an engine that does nothing shows a scene that stands still") {
  auto loop = contact_loop();
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto box = set.add({.position = {0, 0, 0.49}, .mass = 1.0, .shape = Box{1, 1, 1}});
  Stage stage;
  Ladder ladder("", false, 60, &stage);
  int calls = 0;
  const Seen seen = run(ladder, loop, 0.5, 0.05, [&](int n, const Seen& now) {
    CHECK(n == calls++);
    CHECK(now.last_penetration == now.penetration);
    set.apply_force(box, {1, 2, 3});
  });
  CHECK(calls == 10);
  CHECK(seen.gain == 0);
  CHECK(seen.speed == 0);
  CHECK(std::abs(seen.penetration - 0.01) < 1e-12);
  CHECK(set.position(box) == Vec3(0, 0, 0.49));
  CHECK(stage.pushed == peers::Triple{9, 18, 27});  // of the tenth step's call no step is left to take it
  for (const peers::Reading& reading : stage.readings) CHECK(reading.growth == 0);
}

TEST_CASE("the loop's bodies go where the engine has them, and overlaps that grow are seen") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, BallJoint{}, Slider{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto ball =
      set.add({.position = {0, 0, 0.5}, .velocity = {0, 0, -0.25}, .mass = 1.0, .shape = Sphere{0.5}});
  const auto hung =
      set.add({.position = {5, 0, 5}, .velocity = {0, 0.125, 0}, .mass = 1.0, .shape = Sphere{0.5}});
  loop.add(BallJoint::Item{world_anchor({5, 0, 5}), anchor(set, hung)});
  Stage stage;
  Ladder ladder("", false, 60, &stage);
  const Seen seen = run(ladder, loop, 0.5, 0.125);
  CHECK((set.position(ball) - Vec3(0, 0, 0.5 - 0.125)).norm() < 1e-15);
  CHECK((set.velocity(ball) - Vec3(0, 0, -0.25)).norm() == 0);
  CHECK(std::abs(seen.penetration - 0.125) < 1e-12);
  CHECK(std::abs(seen.joint_gap - 0.0625) < 1e-15);
  CHECK(seen.speed == 0.25);
  for (const peers::Reading& reading : stage.readings) CHECK(std::abs(reading.growth - 0.25) < 1e-10);
  // Along its axis a slider is free; then the ball joint's growth is seen alone.
  loop.add(Slider::Item{world_anchor({5, 0, 5}, frame_along({0, 1, 0})),
                        anchor(set, hung, {0, 0, 0}, frame_along({0, 1, 0}))});
  CHECK(std::abs(look(loop).joint_gap - 0.0625) < 1e-15);
}

TEST_CASE("a hinge's gap is the angle between its axes, a slider's the way off its axis") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const Quat tilt(Eigen::AngleAxisd(0.1, Vec3::UnitX())), turn(Eigen::AngleAxisd(1.0, Vec3::UnitZ()));
  const auto body = set.add({.orientation = tilt * turn, .mass = 1.0, .shape = Sphere{1}});
  const auto hinge = loop.add(Hinge::Item{world_anchor({0, 0, 0}), anchor(set, body)});
  CHECK(std::abs(look(loop).joint_gap - 0.1) < 1e-14);
  loop.remove(hinge);
  set.place(body, {0.03, 0.04, 7}, Quat::Identity());
  loop.add(Slider::Item{world_anchor({0, 0, 0}), anchor(set, body)});
  CHECK(std::abs(look(loop).joint_gap - 0.05) < 1e-15);
}

TEST_CASE("the loop itself, under the same gauge, is measured as it reports") {
  auto loop = contact_loop(), twin = contact_loop();
  for (auto* one : {&loop, &twin}) {
    auto& set = bodies<RigidBodies>(one->world());
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.52}, .mass = 1.0, .shape = Box{1, 1, 1}});
  }
  Stage stage;
  stage.is_loop_itself = true;
  Ladder compared("", false, 60, &stage), alone("", false, 60);
  const Seen seen = run(compared, loop, 1, 0.01), report = run(alone, twin, 1, 0.01);
  CHECK(seen.last_energy == Approx(report.last_energy).epsilon(1e-14));
  CHECK(seen.speed == Approx(report.speed).epsilon(1e-14));
  // The report is of the places at the steps' starts: the same but for the last one.
  CHECK(seen.penetration == Approx(report.penetration).margin(1e-9));
  CHECK(stage.readings.size() == 100);
}

}  // namespace ladders_comparison_tests
