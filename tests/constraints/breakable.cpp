// Reactions of joints against statics, and joints that break where these are too much.
#include <delassus/delassus.hpp>

#include <limits>

#include "catch.hpp"

namespace breakable_tests {

using namespace delassus;

namespace {

constexpr double h = 0.01, g = 9.81;

/// A box of 3 kg welded or hinged to the world at the origin, its centre 0.4 m out along x.
template <class Joint>
struct Bracket {
  AnimationLoop<World<RigidBodies>, Constraints<Joint>, AcceleratedGaussSeidel> loop{
      World{RigidBodies{}}, Constraints<Joint>{Joint{}}, AcceleratedGaussSeidel{.tolerance = 1e-12}};
  RigidBodies::Handle box;

  RigidBodies& set() { return bodies<RigidBodies>(loop.world()); }
  Bracket() { box = set().add({.position = {0.4, 0, 0}, .mass = 3.0, .shape = Box{0.8, 0.1, 0.1}}); }
  Anchor wall(const Quat& frame) { return world_anchor(Vec3::Zero(), frame); }
  Anchor end(const Quat& frame) { return anchor_at(set(), box, Vec3::Zero(), frame); }
};

}  // namespace

// What holds the box up acts on it, b: the wall, a, has (0, 0, −m g) and the moment r × that, 0.4 m g about
// y.
TEST_CASE("the reaction of a weld is the weight and its moment about the joint, in the axes of its frame") {
  Bracket<Weld> bracket;
  const Quat frame = frame_along({1, 2, -3});
  const auto weld = bracket.loop.add(Weld::Item{bracket.wall(frame), bracket.end(frame)});
  for (int n = 0; n < 20; ++n) bracket.loop.step(h);
  const Reaction r = reaction(bracket.loop, weld);
  // The solver's 1e-12 of its velocities, below 1 m/s, over h.
  CHECK((frame * r.force - Vec3(0, 0, -3 * g)).norm() <= 1e-9);
  CHECK((frame * r.moment - Vec3(0, 0.4 * 3 * g, 0)).norm() <= 1e-9);
}

TEST_CASE("a slider and a planar joint report the parts of the load that they carry") {
  Bracket<Slider> slider;
  const Quat along = frame_along({1, 0, 0});
  const auto rail = slider.loop.add(Slider::Item{slider.wall(along), slider.end(along)});
  Bracket<Planar> table;
  const auto plane = table.loop.add(Planar::Item{table.wall(Quat::Identity()), table.end(Quat::Identity())});
  for (int n = 0; n < 20; ++n) slider.loop.step(h), table.loop.step(h);
  const Reaction s = reaction(slider.loop, rail), p = reaction(table.loop, plane);
  CHECK((along * s.force - Vec3(0, 0, -3 * g)).norm() <= 1e-9);
  CHECK((along * s.moment - Vec3(0, 0.4 * 3 * g, 0)).norm() <= 1e-9);
  CHECK((p.force - Vec3(0, 0, -3 * g)).norm() <= 1e-9);
  CHECK((p.moment - Vec3(0, 0.4 * 3 * g, 0)).norm() <= 1e-9);
}

TEST_CASE("a joint breaks in the step that loads it too much, says so after it, and is gone in the next") {
  using Joint = Breakable<Weld>;
  for (const bool by_moment : {false, true}) {
    Bracket<Joint> bracket;
    // Loaded by m g and 0.4 m g: each bound alone, a little above.
    const double inf = std::numeric_limits<double>::infinity();
    const auto weld =
        bracket.loop.add(Joint::Item{{bracket.wall(Quat::Identity()), bracket.end(Quat::Identity())},
                                     by_moment ? inf : 3 * g + 1,
                                     by_moment ? 1.2 * g + 0.4 : inf});
    for (int n = 0; n < 20; ++n) {
      bracket.loop.step(h);
      REQUIRE(bracket.loop.broken<Joint>().empty());
    }
    CHECK((bracket.set().position(bracket.box) - Vec3(0.4, 0, 0)).norm() <= 1e-9);
    bracket.set().apply_force(bracket.box, {0, 0, -1.1});
    bracket.loop.step(h);
    REQUIRE(bracket.loop.broken<Joint>().size() == 1);
    CHECK(bracket.loop.broken<Joint>()[0] == weld);
    CHECK(bracket.loop.contains(weld));
    CHECK(reaction(bracket.loop, weld).force.z() == Approx(-3 * g - 1.1).epsilon(1e-9));
    CHECK(bracket.set().velocity(bracket.box).norm() <= 1e-9);  // it carried that step
    bracket.loop.step(h);
    CHECK(bracket.loop.broken<Joint>().empty());
    CHECK(!bracket.loop.contains(weld));
    CHECK_THROWS(bracket.loop.impulse(weld));
    CHECK(bracket.set().velocity(bracket.box).z() == Approx(-h * g).epsilon(1e-9));
  }
}

TEST_CASE("a broken joint that the host removed, and another in its place, are told apart") {
  using Joint = Breakable<BallJoint>;
  Bracket<Joint> bracket;
  const auto item = [&](double force) {
    return Joint::Item{{bracket.wall(Quat::Identity()), bracket.end(Quat::Identity())}, force};
  };
  const auto weak = bracket.loop.add(item(1e-3));
  bracket.loop.step(h);
  REQUIRE(bracket.loop.broken<Joint>().size() == 1);
  bracket.loop.remove(weak);
  const auto strong = bracket.loop.add(item(1e6));
  REQUIRE(strong.index == weak.index);
  bracket.loop.step(h);
  CHECK(bracket.loop.impulse(strong).norm() > 0);
}

TEST_CASE("a breakable joint refuses bounds that are not positive") {
  Bracket<Breakable<Weld>> bracket;
  CHECK_THROWS_WITH(bracket.loop.add(Breakable<Weld>::Item{
                        {bracket.wall(Quat::Identity()), bracket.end(Quat::Identity())}, 0, 1}),
                    "delassus: Breakable: max_force 0 N and max_moment 1 N·m must be > 0");
}

}  // namespace breakable_tests
