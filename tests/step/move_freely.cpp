#include "catch.hpp"
#include "stages.hpp"

#include <delassus/delassus.hpp>

namespace move_freely_tests {

using namespace delassus;

namespace {

/// Bodies of every motion, a hole where one was removed, loads, a path; particles that are free and fixed.
template <class Loop>
struct Scene {
  Loop loop;
  RigidBodies::Handle tumbler, lift;
  Particles::Handle grain;

  explicit Scene(Loop made) : loop(std::move(made)) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    auto& points = bodies<Particles>(loop.world());
    rigid.add_fixed(Box{1, 1, 1});
    const auto gone = rigid.add({.mass = 1.0, .shape = Sphere{1}});
    tumbler = rigid.add({.velocity = {1, 2, 3}, .angular_velocity = {0.1, 5, 0.2}, .mass = 2.0, .shape = Box{1, 2, 3}});
    lift = rigid.add({.shape = Box{1, 1, 1}, .motion = Motion::kinematic});
    rigid.remove(gone);
    points.add({.position = {1, 0, 0}, .is_fixed = true});
    grain = points.add({.position = {2, 0, 0}, .velocity = {0, 1, 0}, .mass = 0.3});
  }

  void push(int n) {
    auto& rigid = bodies<RigidBodies>(loop.world());
    if (n % 3 == 0) rigid.apply_force(tumbler, {1, -2, 0.3}, {0.5, 0.5, 0.5});
    if (n % 2 == 0) rigid.move_to(lift, {0, 0, 0.1 * n}, exponential<double>({0, 0.01 * n, 0}));
    bodies<Particles>(loop.world()).apply_force(grain, {0, 0, 0.1 * n});
  }

  /// Everything that moves, to compare bit for bit.
  std::vector<double> state() const {
    const auto& rigid = bodies<RigidBodies>(loop.world());
    const auto& points = bodies<Particles>(loop.world());
    std::vector<double> out;
    const auto keep = [&](const auto& x) { out.insert(out.end(), x.data(), x.data() + x.size()); };
    for (const auto body : {tumbler, lift}) {
      keep(rigid.position(body));
      keep(rigid.orientation(body).coeffs());
      keep(rigid.velocity(body));
      keep(rigid.angular_velocity(body));
    }
    keep(points.position(grain));
    keep(points.velocity(grain));
    return out;
  }
};

template <class Integrator>
void compare(const Integrator& integrator, bool with_springs) {
  const auto make = [&] { return Scene(AnimationLoop{World{RigidBodies{}, Particles{}}, integrator}); };
  auto whole = make(), staged = make();
  static_assert(decltype(whole.loop)::moves_freely);
  if (with_springs)
    for (auto* scene : {&whole, &staged})
      bodies<Particles>(scene->loop.world()).add_spring(scene->grain, Vec3(1, 1, 1), 30.0, 0.1);
  for (int n = 0; n < 50; ++n) {
    for (auto* scene : {&whole, &staged}) scene->push(n);
    whole.loop.step(5e-3);
    step_by_stages(staged.loop, 5e-3);
    REQUIRE(whole.state() == staged.state());
  }
  REQUIRE(whole.loop.time() == staged.loop.time());
}

struct Ear {
  using plays = role::Listener;
  using listens = Listens<stage::FreeMotion>;
  int heard = 0;
  void after(stage::FreeMotion, const auto&) { ++heard; }
};

}  // namespace

TEST_CASE("a free loop that moves each body in one pass gives the bits of the stages called one by one") {
  for (const bool with_springs : {false, true}) {
    CAPTURE(with_springs);
    compare(SymplecticEuler{}, with_springs);
    compare(ImplicitEuler{.rayleigh_mass = 0.3, .rayleigh_stiffness = 0.01}, with_springs);
    compare(ImplicitMidpoint{}, with_springs);
  }
}

TEST_CASE("a body with a load that is not finite stays where it is and is counted, in one pass too") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto sick = rigid.add({.position = {1, 2, 3}, .mass = 1.0, .shape = Sphere{1}});
  const auto well = rigid.add({.mass = 1.0, .shape = Sphere{1}});
  rigid.apply_force(sick, Vec3(std::nan(""), 0, 0));
  const StepReport report = loop.step(0.1);
  REQUIRE(report.status == Status::quarantined);
  REQUIRE(report.quarantined == 1);
  REQUIRE(rigid.position(sick) == Vec3(1, 2, 3));
  REQUIRE(rigid.position(well).z() < 0);
}

TEST_CASE("a loop whose listener hears a stage is stepped stage by stage") {
  AnimationLoop loop{World{RigidBodies{}}, Ear{}};
  static_assert(!decltype(loop)::moves_freely);
  loop.step(0.1);
  REQUIRE(loop.get<Ear>().heard == 1);
}

}  // namespace move_freely_tests
