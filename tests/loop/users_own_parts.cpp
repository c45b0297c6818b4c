// What a user writes outside the library: laws, integrators, a scheme, an activity and a listener, none of which the
// library knows. Each of those that change a step has a state and a check of its own.
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/schemes/substeps.hpp>

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "rope.hpp"

namespace users_own_parts_tests {

using namespace delassus;

namespace {

/// Symplectic Euler in a medium that takes the share `drag` of the velocity per second.
struct DraggedEuler {
  using plays = role::Integrator;
  double drag = 0;

  SystemScale scale(double h) const { return {.mass = 1 + h * drag}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    set.add_mass_times_velocity(p, -drag);
    for (auto& x : p) x *= h;
  }
  void advance(auto& set, double h) const { set.advance(h); }
};

/// Bodies carry charges of a field that dies away: the field acts in the free motion.
struct FadingField {
  using plays = role::Scheme;
  double acceleration = 1;  ///< m/s², along x
  double share = 0.5;       ///< of the field that a step leaves

  template <class P>
  struct State {
    double field = 1;
    void memory(auto& archive) { archive(field); }
  };
  template <class Base>
  struct stages : Base {
    static void free_motion(auto& step) {
      Base::free_motion(step);
      double& field = step.template state<role::Scheme>().field;
      step.world().each([&](auto& set, auto) {
        for (auto& v : set.v_free) v[0] += step.h * field * step.scheme().acceleration;
      });
      field *= step.scheme().share;
    }
  };
  void check() const { DELASSUS_EXPECT(share >= 0 && share < 1, "FadingField: share must be in [0, 1)"); }
  void run(auto& step) const {
    stage::detect(step);
    stage::move(step);
  }
};

/// A whole step at once: bodies go where they went, whatever holds them.
struct Straight {
  using plays = role::Integrator;
  double scale_of_speed = 1;

  template <class P>
  struct State {
    long steps = 0;
  };
  template <class Set>
  static constexpr bool can_move = true;
  void check() const { DELASSUS_EXPECT(scale_of_speed > 0, "Straight: scale_of_speed must be > 0"); }
  void move(auto& step) const {
    ++step.template state<role::Integrator>().steps;
    step.world().each([&](auto& set, auto) {
      set.v_next = set.velocity();
      for (auto& v : set.v_next) v *= scale_of_speed;
    });
  }
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto&, auto&, double) const {}
  void advance(auto& set, double h) const { set.advance(h); }
};

/// Counts how often a body was faster than it should be.
struct SpeedWatch {
  using plays = role::Activity;
  double limit = 1;  ///< m/s

  template <class P>
  struct State {
    long faster = 0;
  };
  template <class Base>
  struct stages : Base {
    static void correct(auto& step) {
      Base::correct(step);
      step.world().each([&](const auto& set, auto) {
        for (const auto& v : set.v_next)
          if (v.template head<3>().norm() > step.activity().limit) ++step.template state<role::Activity>().faster;
      });
    }
  };
  void check() const { DELASSUS_EXPECT(limit > 0, "SpeedWatch: limit must be > 0 m/s"); }
};

/// What a tearing rope changes: it is told how hard its hardest pull was.
struct NotePulls {
  template <class P>
  struct State {
    double hardest = 0;  ///< N·s
  };
  template <class Base>
  struct stages : Base {
    static void keep_impulses(auto& step) {
      Base::keep_impulses(step);
      double& hardest = step.template state<NotePulls>().hardest;
      step.each_impulse([&](const auto& lambda) { hardest = std::max(hardest, double(std::abs(lambda[0]))); });
    }
  };
};
struct NotedRope : Rope {
  using overrides = Overrides<NotePulls>;
};
struct OtherNotedRope : Rope {
  struct Item : Rope::Item {};
  using overrides = Overrides<NotePulls>;
};

struct CountSolves {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;
  int count = 0;
  void after(stage::Solve, const auto&) { ++count; }
};

}  // namespace

TEST_CASE("a rope of one's own is slack while its end falls, and holds when it is taut") {
  AnimationLoop loop{World{Particles{}}, Constraints{Rope{}}};
  auto& set = bodies<Particles>(loop.world());
  const auto stone = set.add({.position = {0, 0, -0.2}, .mass = 2.0});
  const auto rope = loop.add(Rope::Item{anchor(set, stone), world_anchor({0, 0, 0}), 1.0});
  const double h = 1e-3;
  double pull = 0;
  for (int n = 1; n <= 2000; ++n) {
    loop.step(h);
    pull = loop.impulse(rope)[0] / h;
    REQUIRE(pull <= 0);
    if (n <= 380) {  // √(2 · 0.8/g) = 0.404 s
      REQUIRE(pull == 0);
      REQUIRE(set.velocity(stone).z() == Approx(-n * h * 9.81).epsilon(1e-12));
    }
    REQUIRE(set.position(stone).norm() <= 1 + 1e-9);
  }
  REQUIRE(pull == Approx(-2 * 9.81).epsilon(1e-6));
}

// A y-shaped problem without vertical line: the rope swings a rigid box about its corner, as a pendulum under a pull of
// m (g + v²/r) at the bottom, and its length never grows beyond first order.
TEST_CASE("a rope of one's own serves rigid bodies and particles with the same code") {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{Rope{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& particles = bodies<Particles>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 0}, .mass = 3.0, .shape = Box{0.2, 0.2, 0.2}});
  const auto stone = particles.add({.position = {0, 0, -1}, .mass = 1.0});
  loop.add(Rope::Item{anchor(rigid, box, {0, 0, 0.1}), world_anchor({0, 0, 1.1}), 1.0});
  const auto lower = loop.add(Rope::Item{anchor(particles, stone), anchor(rigid, box, {0, 0, -0.1}), 0.9});
  for (int n = 0; n < 200; ++n) REQUIRE(loop.step(1e-3).status == Status::converged);
  REQUIRE(loop.impulse(lower)[0] / 1e-3 == Approx(-9.81).epsilon(1e-6));
  REQUIRE(rigid.position(box).norm() < 1e-6);
}

// (1 + h c) v⁺ = v + h g (1 − …): v (1 + h c) + h (g − c v) → v⁺ = v + h (g − c v)/(1 + h c), whose limit is g/c.
TEST_CASE("an integrator of one's own moves the bodies by its own formula") {
  AnimationLoop loop{World{RigidBodies{}}, DraggedEuler{.drag = 2}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto ball = set.add({.position = {0, 0, 0}, .mass = 0.3, .shape = Sphere{0.1}});
  double v = 0;
  for (int n = 0; n < 1000; ++n) {
    loop.step(0.01);
    v += 0.01 * (-9.81 - 2 * v) / (1 + 0.01 * 2);
    REQUIRE(set.velocity(ball).z() == Approx(v).epsilon(1e-13));
  }
  REQUIRE(v == Approx(-9.81 / 2).epsilon(1e-6));
}

TEST_CASE("a listener of one's own hears the stage it names, once a step") {
  AnimationLoop loop{World{Particles{}}, Constraints{Rope{}}, CountSolves{}};
  for (int n = 0; n < 7; ++n) loop.step(0.01);
  REQUIRE(loop.get<CountSolves>().count == 7);
}

// v_x after n steps is h a (1 + s + … + sⁿ⁻¹).
TEST_CASE("a scheme of one's own overrides a stage and keeps its state, through a checkpoint too") {
  const auto make = [] { return AnimationLoop{World{Particles{}}, Constraints{Rope{}}, FadingField{.acceleration = 4, .share = 0.5}}; };
  auto loop = make();
  const auto stone = bodies<Particles>(loop.world()).add({.mass = 1.0});
  const double h = 0.01;
  double v = 0, field = 1;
  for (int n = 0; n < 10; ++n, field *= 0.5) {
    loop.step(h);
    v += h * field * 4;
    REQUIRE(bodies<Particles>(loop.world()).velocity(stone).x() == Approx(v).epsilon(1e-14));
  }
  auto twin = make();
  bodies<Particles>(twin.world()).add({.mass = 1.0});
  restore(twin, checkpoint(loop));
  loop.step(h), twin.step(h);
  REQUIRE(bodies<Particles>(twin.world()).velocity()[0].x() == bodies<Particles>(loop.world()).velocity()[0].x());
  REQUIRE(twin.data().state<role::Scheme>().field == 0x1p-11);
  REQUIRE_THROWS_AS((AnimationLoop{World{Particles{}}, Constraints{Rope{}}, FadingField{.share = 1}}), InvalidArgument);
}

TEST_CASE("a whole-step integrator of one's own moves the bodies, in every scheme that moves at once") {
  const auto run = [](auto scheme) {
    AnimationLoop loop{World{Particles{}}, Straight{.scale_of_speed = 0.5}, scheme};
    auto& set = bodies<Particles>(loop.world());
    const auto stone = set.add({.velocity = {8, 0, 0}, .mass = 1.0});
    loop.step(1.0);
    REQUIRE(loop.data().template state<role::Integrator>().steps > 0);
    return set.position(stone).x();
  };
  REQUIRE(run(PlainOrder{}) == 4);
  REQUIRE(run(Substeps{.count = 2}) == 2 + 1);
  REQUIRE_THROWS_AS((AnimationLoop{World{Particles{}}, Straight{.scale_of_speed = 0}}), InvalidArgument);
}

TEST_CASE("an activity of one's own sees the velocities that all others have left") {
  AnimationLoop loop{World{Particles{}}, Constraints{Rope{}}, SpeedWatch{.limit = 0.05}};
  auto& set = bodies<Particles>(loop.world());
  set.add({.mass = 1.0});
  for (int n = 0; n < 10; ++n) loop.step(1e-3);  // 9.81e-3 m/s more each: above 0.05 from the sixth on
  REQUIRE(loop.data().state<role::Activity>().faster == 5);
  REQUIRE_THROWS_AS((AnimationLoop{World{Particles{}}, Constraints{Rope{}}, SpeedWatch{.limit = 0}}), InvalidArgument);
}

TEST_CASE("what two laws of one's own override is done once, and keeps its state") {
  AnimationLoop loop{World{Particles{}}, Constraints{NotedRope{}, OtherNotedRope{}}};
  auto& set = bodies<Particles>(loop.world());
  const auto stone = set.add({.position = {0, 0, -1}, .mass = 2.0});
  loop.add(NotedRope::Item{anchor(set, stone), world_anchor({0, 0, 0}), 1.0});
  for (int n = 0; n < 100; ++n) loop.step(1e-3);
  REQUIRE(loop.data().state<NotePulls>().hardest == Approx(2 * 9.81 * 1e-3).epsilon(1e-6));
}

}  // namespace users_own_parts_tests
