// Every law of the library takes part in Newton's method, with each compiler.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>

#include "catch.hpp"

namespace differentiable_tests {

using namespace delassus;

template <class... Laws>
consteval bool are_differentiable() {
  return (refines<Laws>(refine::tangent) && ...);
}
static_assert(are_differentiable<Contact<Coulomb>, Contact<Frictionless>>());
static_assert(are_differentiable<Contact<Restitution<Coulomb>>, Contact<Penalty<Coulomb>>>());
static_assert(are_differentiable<Contact<Restitution<Frictionless>>, Contact<Penalty<Frictionless>>>());
static_assert(are_differentiable<BallJoint, DistanceJoint>());
static_assert(refines<Coulomb>(refine::convex_tangent) && !refines<Frictionless>(refine::convex_tangent));

namespace {

struct Mute {
  static constexpr int rows = 1;
  static constexpr std::array<RowKind, 1> kinds{RowKind::lower};
  struct Parameters {};
};
static_assert(!refines<Contact<Mute>>(refine::tangent) && !refines<Contact<Restitution<Mute>>>(refine::tangent));

}  // namespace

TEST_CASE("a wrapped law answers with the tangent of what it wraps") {
  const Coulomb law;
  Local<3> a{Mat3(Vec3(1, 2, 2).asDiagonal()), Vec3(-1, 0.3, 0.1), Vec3(0.5, 0, 0)}, b = a;
  const Contact<Restitution<Coulomb>> wrapped{Restitution{law, 0.5}};
  Contact<Restitution<Coulomb>>::Item item;
  item.parameters.friction = 0.5;
  const auto& asked = inner::who_refines<refine::tangent>(wrapped);
  REQUIRE(law.tangent({0.5}, a) == asked.tangent(inner::given<Contact<Restitution<Coulomb>>>(item), b));
  REQUIRE(a.lambda == b.lambda);
}

}  // namespace differentiable_tests
