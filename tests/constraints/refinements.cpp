// What a law declares it is asked for, inside contacts and wrappers too.
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/contact/sequential_restitution.hpp>
#include <delassus/constraints/joints/breakable.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/delassus.hpp>

#include "catch.hpp"

#include <algorithm>
#include <array>

namespace refinements_tests {

using namespace delassus;

namespace {

static_assert(refines<Contact<Coulomb>>(refine::clamp | refine::natural_map | refine::convex_tangent));
static_assert(refines<Contact<Penalty<Coulomb>>>(refine::clamp | refine::soften) && !refines<Contact<Coulomb>>(refine::soften));
static_assert(refines<Contact<Restitution<Coulomb>>>(refine::restitution) && !refines<Contact<Coulomb>>(refine::restitution));
static_assert(refines<Breakable<Hinge>>(refine::tangent | refine::check | refine::breaks) && !refines<Hinge>(refine::breaks));

/// Signorini's law, and nothing else that a law can have.
struct Plain {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::lower};
  struct Parameters {};
  Parameters parameters() const { return {}; }
  template <class T>
  Vec<1, T> solve_local(const Parameters&, const Mat<1, 1, T>& W, const Vec<1, T>& b) const {
    return Vec<1, T>(std::max(T(0), -b[0] / W(0, 0)));
  }
};

/// A number may have the name of a refinement, and a law may be final.
struct Belt final : Bilateral<1> {
  struct Item {
    Anchor a, b;
  };
  double speed = 2;  ///< not asked
  static constexpr double restitution = 0.5;

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 x = world.point(item.a);
    row.end(item.a, x).along(0, unit_axis(0));
    row.phi(0, x[0]);
  }
};

/// Counts the solves of a step.
struct Counted {
  template <class P>
  struct State {
    int begun = 0;
  };
  template <class Base>
  struct stages : Base {
    static void make_bias(auto& step) {
      Base::make_bias(step);
      ++step.template state<Counted>().begun;
    }
  };
};
struct CountedCoulomb : Coulomb {
  using overrides = Overrides<Counted>;
};

/// How often what the law inside overrides was called in three steps of a ball on the ground.
template <class Law>
int calls(Law law) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Sphere{0.1}});
  for (int n = 0; n < 3; ++n) loop.step(1e-3);
  return loop.data().template state<Counted>().begun;
}

}  // namespace

TEST_CASE("a wrapper of a contact law overrides what the law inside overrides") {
  CHECK(calls(CountedCoulomb{}) == 3);
  CHECK(calls(Restitution{CountedCoulomb{}, 0.5}) == 3);
  CHECK(calls(SequentialRestitution{CountedCoulomb{}, 0.5}) == 3);
  CHECK(calls(Penalty{CountedCoulomb{}, 1e4}) == 3);
}

// The ball rests on the impulse m g h of a step, to the solver's tolerance.
TEST_CASE("a contact law needs rows, kinds, Parameters and a local solve, and no refinement") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Plain{}}}, GaussSeidel{.tolerance = 1e-10}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 0.1}, .mass = 2.0, .shape = Sphere{0.1}});
  REQUIRE(loop.step(1e-3).status == Status::converged);
  REQUIRE(loop.contacts().size() == 1);
  CHECK(loop.contacts()[0].impulse.z() == Approx(2.0 * 9.81 * 1e-3).epsilon(1e-9));
}

TEST_CASE("numbers of a law may have the names of refinements") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Belt{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.velocity = {3, 0, 0}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(Belt::Item{anchor(set, body), world_anchor({0, 0, 0})});
  loop.step(1e-3);
  CHECK(set.velocity(body).x() == Approx(0).margin(1e-12));
}

}  // namespace refinements_tests
