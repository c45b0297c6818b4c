/// What a user says of a new rigid body, and the checks that refuse what cannot be one.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/geometry/inertia.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/rotation.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace delassus {

/// dynamic: moved by forces and impulses · kinematic: moved by the user, pushes and is not pushed · fixed: never moves.
enum class Motion : std::uint8_t { dynamic, kinematic, fixed };

/// A rigid body as it is added. SI units: m, kg, kg·m², m/s, rad/s.
///
/// The body's frame has its origin at the centre of mass. Of a dynamic body, give `mass` or `density`; the inertia
/// comes from the shape unless `inertia` (about the centre of mass, body frame) is given.
struct RigidBody {
  Vec3 position = zero<Vec3>();
  Quat orientation = Quat::Identity();  ///< of any length but zero: it is made a unit quaternion
  Vec3 velocity = zero<Vec3>();
  Vec3 angular_velocity = zero<Vec3>();
  std::optional<double> mass{};
  std::optional<double> density{};
  std::optional<Mat3> inertia{};
  Shape shape{};
  Motion motion = Motion::dynamic;
  Index material = 0;
  std::uint32_t group = 1;
  std::uint32_t collides_with = ~0u;
};

namespace inner {

/// Sylvester's criterion: a symmetric 3×3 matrix is positive definite when its leading minors are positive.
template <class T>
bool is_positive_definite(const Mat<3, 3, T>& m) {
  const T a = m(0, 0), b = m(1, 1), c = m(2, 2), d = m(0, 1), e = m(0, 2), f = m(1, 2);
  return a > 0 && a * b - d * d > 0 && a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e) > 0;
}

/// The power of two next to the largest moment: products of three scaled moments neither overflow nor vanish.
template <class T>
T scale_of(const Mat<3, 3, T>& inertia) {
  return std::exp2(std::ilogb(std::max(std::max(inertia(0, 0), inertia(1, 1)), inertia(2, 2))));
}

/// I⁻¹, kg⁻¹·m⁻², for every size of body.
template <class T>
Mat<3, 3, T> inverse_of_inertia(const Mat<3, 3, T>& inertia) {
  const T scale = scale_of(inertia);
  return 1 / scale * inverse(Mat<3, 3, T>(1 / scale * inertia));
}

/// Refuses an inertia that no distribution of mass has: not finite, not symmetric positive, or λ₃ > λ₁ + λ₂.
template <class T>
void check_inertia(const Mat<3, 3, T>& inertia, const std::string& who) {
  T scale = 0, skewness = 0, sum = 0;
  for (int i = 0; i < 3; ++i) {
    scale = std::max(scale, std::abs(inertia(i, i)));
    for (int j = 0; j < 3; ++j) {
      skewness = std::max(skewness, std::abs(inertia(i, j) - inertia(j, i)));
      sum += 0 * inertia(i, j);
    }
  }
  DELASSUS_EXPECT(sum == 0, who + ": inertia is not finite; give a 3×3 matrix in kg·m²");
  DELASSUS_EXPECT(skewness <= 1e-9 * scale, who + ": inertia is not symmetric; give the matrix about the centre of mass");
  const T to_unit = 1 / scale_of(inertia);
  DELASSUS_EXPECT(is_positive_definite(to_unit * inertia),
                  who + ": inertia is not positive definite; every principal moment must be > 0 kg·m²");
  // The triangle inequality of the principal moments says: ½ tr(I) 1 − I, the second moment of mass, is positive; it is
  // zero in one direction for a flat body, so rounding's share is granted.
  const T half = 0.5 * (inertia(0, 0) + inertia(1, 1) + inertia(2, 2)) + 1e-9 * scale;
  Mat<3, 3, T> second_moment;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) second_moment(i, j) = (i == j ? half : 0) - inertia(i, j);
  DELASSUS_EXPECT(is_positive_definite(to_unit * second_moment),
                  who + ": inertia with diagonal (" + text(inertia(0, 0)) + ", " + text(inertia(1, 1)) + ", " +
                      text(inertia(2, 2)) + ") violates the triangle inequality I1 + I2 >= I3 of the principal " +
                      "moments; was it given about another point or in other units?");
}

/// Refuses what cannot be placed or moved, and returns the unit quaternion.
template <class Body>
Quat check_state(const Body& body, const std::string& who) {
  DELASSUS_EXPECT(is_finite(body.position), who + ": position is not finite");
  DELASSUS_EXPECT(is_finite(body.velocity), who + ": velocity is not finite");
  DELASSUS_EXPECT(is_finite(body.angular_velocity), who + ": angular velocity is not finite");
  const double length = norm(body.orientation.coeffs());
  DELASSUS_EXPECT(std::isfinite(length) && length > 1e-12,
                  who + ": orientation is the zero quaternion or not finite; the identity is (1, 0, 0, 0)");
  return unit(body.orientation);
}

/// Mass (kg) and inertia (kg·m²) of a dynamic body from what the user gave, for a set of scalar T.
template <class T>
MassProperties check_mass(const RigidBody& body, const std::string& who) {
  DELASSUS_EXPECT(body.mass || body.density, who + ": give mass (kg) or density (kg/m³)");
  DELASSUS_EXPECT(!(body.mass && body.density), who + ": give mass or density, not both");
  const double given = body.mass ? *body.mass : *body.density;
  DELASSUS_EXPECT(std::isfinite(given) && given > 0,
                  who + (body.mass ? ": mass " : ": density ") + text(given) + " must be finite and > 0");
  const bool has_volume = body.shape.has_volume();
  DELASSUS_EXPECT(body.inertia || has_volume, who + ": give an inertia (kg·m²) or a shape that has a volume");
  MassProperties result;
  if (has_volume) {
    result = mass_properties(body.shape, 1.0);
    const double density = body.mass ? *body.mass / result.mass : *body.density;
    result.mass *= density;
    result.inertia *= density;
  } else {
    DELASSUS_EXPECT(body.mass.has_value(), who + ": density needs a shape that has a volume");
    result.mass = *body.mass;
  }
  if (body.inertia) assign(result.inertia, *body.inertia);
  DELASSUS_EXPECT(has_inverse<T>(result.mass), who + ": mass " + without_inverse<T>(text(result.mass), "kg"));
  check_inertia(result.inertia, who);
  const Mat3 inverse = inverse_of_inertia(result.inertia);
  const Vec3 moments(result.inertia(0, 0), result.inertia(1, 1), result.inertia(2, 2));
  for (int k = 0; k < 3; ++k)
    DELASSUS_EXPECT(has_inverse<T>(moments[k]) && has_inverse<T>(inverse(k, k)),
                    who + ": inertia with diagonal " + without_inverse<T>(text(moments), "kg·m²"));
  return result;
}

}  // namespace inner
}  // namespace delassus
