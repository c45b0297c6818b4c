/// The Euler angles of one frame against another, as coordinates of limits, motors and drives.
#pragma once

#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/core/cmath.hpp>

namespace delassus {
namespace inner {

/// The part of an axis of three that the other outer one does not turn: q̇ = (p − c q) · ω/(1 − c²), c = p · q, for ω = q̇ p + ṙ q
/// and what is across both. Nothing where the two are parallel.
inline Vec3 dual_axis(const Vec3& p, const Vec3& q) {
  const double c = dot_from_end(p, q), left = 1 - c * c;
  return left > 1e-12 ? Vec3((p - c * q) / left) : zero<Vec3>();
}

}  // namespace inner

/// B = A R_z(ψ) R_x(θ) R_z(φ) for the axes A and B of two ends: ψ, the precession, is the angle (rad) about a_z from a_x to the
/// line of nodes a_z × b_z. It is also the first angle of any two or three hinges in series, a_z being the axis of the first and
/// b_z that of the last. Singular where a_z and b_z are parallel: there it says 0 and no row acts.
struct Precession {
  static constexpr bool winds = true;  ///< known up to whole turns
  static constexpr const char* force_unit = "N·m";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 1;  ///< rad

  /// ψ = atan2(a_x · b_z, −a_y · b_z) of one pose.
  static double value(const JointFrames& f) {
    return std::atan2(inner::dot_from_end(f.a(0), f.b(2)), -inner::dot_from_end(f.a(1), f.b(2)));
  }
  /// u_k += factor · ψ̇.
  static void write(auto& joint, int k, double factor) { joint.about(k, factor * inner::dual_axis(joint.a(2), joint.b(2))); }
  static void check(const auto& item, const char* what) { inner::expect_frames(item, what); }
};

/// θ, the nutation: the angle (rad, from 0 to π) between a_z and b_z. The second of three hinges in series, and the lean of a
/// ball joint: `Limit<Nutation>` is a cone. Where the axes are parallel no row acts.
struct Nutation {
  static constexpr bool winds = false;  ///< a pose tells all of it
  static constexpr const char* force_unit = "N·m";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 1;  ///< rad

  /// θ = atan2(|a_z × b_z|, a_z · b_z) of one pose.
  static double value(const JointFrames& f) {
    return std::atan2(norm(cross(f.a(2), f.b(2))), inner::dot_from_end(f.a(2), f.b(2)));
  }
  /// u_k += factor · θ̇.
  static void write(auto& joint, int k, double factor) {
    const Vec3 nodes = cross(joint.a(2), joint.b(2));
    const double length = norm(nodes);
    joint.about(k, length > 1e-6 ? Vec3(factor / length * nodes) : zero<Vec3>());
  }
  static void check(const auto& item, const char* what) { inner::expect_frames(item, what); }
};

/// φ, the spin: the angle (rad) about b_z from the line of nodes a_z × b_z to b_x. The last angle of hinges in series. Singular
/// as `Precession` is.
struct Spin {
  static constexpr bool winds = true;  ///< known up to whole turns
  static constexpr const char* force_unit = "N·m";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 1;  ///< rad

  /// φ = atan2(a_z · b_x, a_z · b_y) of one pose.
  static double value(const JointFrames& f) {
    return std::atan2(inner::dot_from_end(f.a(2), f.b(0)), inner::dot_from_end(f.a(2), f.b(1)));
  }
  /// u_k += factor · φ̇.
  static void write(auto& joint, int k, double factor) { joint.about(k, factor * inner::dual_axis(joint.b(2), joint.a(2))); }
  static void check(const auto& item, const char* what) { inner::expect_frames(item, what); }
};

}  // namespace delassus
