/// What a user says of a new rigid body, and the checks that refuse what cannot be one.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/geometry/inertia.hpp>
#include <delassus/geometry/shape.hpp>

#include <Eigen/Cholesky>

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
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
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

/// Refuses an inertia that no distribution of mass has: not finite, not symmetric positive, or λ₃ > λ₁ + λ₂.
inline void check_inertia(const Mat3& inertia, const std::string& who) {
  DELASSUS_EXPECT(is_finite(inertia), who + ": inertia is not finite; give a 3×3 matrix in kg·m²");
  const double scale = inertia.diagonal().cwiseAbs().maxCoeff();
  DELASSUS_EXPECT((inertia - inertia.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale,
                  who + ": inertia is not symmetric; give the matrix about the centre of mass");
  const Eigen::LLT<Mat3> cholesky(inertia);
  DELASSUS_EXPECT(scale > 0 && cholesky.info() == Eigen::Success,
                  who + ": inertia is not positive definite; every principal moment must be > 0 kg·m²");
  // The triangle inequality of the principal moments says: ½ tr(I) 1 − I, the second moment of mass, is positive.
  const Mat3 second_moment = 0.5 * inertia.trace() * Mat3::Identity() - inertia;
  const Mat3 shifted = second_moment + 1e-9 * scale * Mat3::Identity();
  const Eigen::LLT<Mat3> triangle(shifted);
  DELASSUS_EXPECT(triangle.info() == Eigen::Success,
                  who + ": inertia with diagonal (" + text(inertia(0, 0)) + ", " + text(inertia(1, 1)) + ", " +
                      text(inertia(2, 2)) + ") violates the triangle inequality I1 + I2 >= I3 of the principal " +
                      "moments; was it given about another point or in other units?");
}

/// Refuses what cannot be placed or moved, and returns the unit quaternion.
inline Quat check_state(const RigidBody& body, const std::string& who) {
  DELASSUS_EXPECT(is_finite(body.position), who + ": position is not finite");
  DELASSUS_EXPECT(is_finite(body.velocity), who + ": velocity is not finite");
  DELASSUS_EXPECT(is_finite(body.angular_velocity), who + ": angular velocity is not finite");
  const double norm = body.orientation.coeffs().norm();
  DELASSUS_EXPECT(std::isfinite(norm) && norm > 1e-12,
                  who + ": orientation is the zero quaternion or not finite; the identity is (1, 0, 0, 0)");
  return Quat(body.orientation.coeffs() / norm);
}

/// Mass (kg) and inertia (kg·m²) of a dynamic body from what the user gave.
inline MassProperties check_mass(const RigidBody& body, const std::string& who) {
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
  if (body.inertia) result.inertia = *body.inertia;
  check_inertia(result.inertia, who);
  return result;
}

}  // namespace inner
}  // namespace delassus
