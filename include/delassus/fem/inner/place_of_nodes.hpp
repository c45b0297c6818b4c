/// Where a body of nodes is put as it is added, and what of its density and contacts cannot be.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/rotation.hpp>

#include <string>

namespace delassus::inner {

/// Of a soft body or a rod, whose `colliders` are its nodes or its segments.
template <class T, class Body>
void check_place_of_nodes(const Body& body, const std::string& who, const char* colliders) {
  expect_positive(who + ": density", body.density, "kg/m³");
  DELASSUS_EXPECT(is_finite(body.position) && is_finite(body.velocity),
                  who + ": position or velocity is not finite");
  DELASSUS_EXPECT(fits<T>(body.velocity), who + ": velocity " + beyond<T>(body.velocity, "m/s"));
  DELASSUS_EXPECT(std::abs(body.orientation.coeffs().norm() - 1) < 1e-6,
                  who + ": orientation is not a unit quaternion");
  expect_not_negative(who + ": contact_radius", body.contact_radius, "m");
  DELASSUS_EXPECT(body.contact_radius == 0 || (body.group & body.collides_with) == 0,
                  who + ": its " + colliders + " would collide with each other; leave its group out of collides_with");
}

}  // namespace delassus::inner
