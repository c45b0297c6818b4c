/// The angle of the turn from one frame to another, as a coordinate of limits: how far a ball joint is turned
/// in all.
#pragma once

#include <delassus/constraints/joints/joint_rows.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>

#include <limits>
#include <numbers>
#include <string>

namespace delassus {

/// θ, rad from 0 to π: b's frame is a's, turned by θ about one axis n. With s = ½ Σ a_k × b_k = n sin θ,
///
///   θ = atan2(|s|, ½ (Σ a_k · b_k − 1)),   θ̇ = n · (ω_b − ω_a).
///
/// `Limit<RotationAngle>` with an `upper` is the limit of a ball joint that counts lean and twist together.
/// Where the frames are alike, or half a turn apart, no row acts. A stop that is nearer to 0 than the body
/// turns in a step leaves it trembling by about that turn: hold it by a `Weld` instead. Source: the axis and
/// angle of a rotation matrix.
struct RotationAngle {
  static constexpr bool winds = false;              ///< a pose tells all of it
  static constexpr const char* force_unit = "N·m";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 1;         ///< rad

  /// θ of one pose, rad.
  static double value(const JointFrames& f) { return std::atan2(norm(twice_sine(f)), cosine_and_one(f) - 1); }
  /// u_k += factor · θ̇.
  static void write(auto& joint, int k, double factor) {
    const Vec3 s = twice_sine(joint);
    const double length = norm(s);
    joint.about(k, length > 1e-6 ? Vec3(factor / length * s) : zero<Vec3>());
  }
  /// Refuses stops that no turn reaches as well; those that are infinite are open.
  static void check(const auto& item, const char* what) {
    inner::expect_frames(item, what);
    if constexpr (requires { item.lower, item.upper; }) {
      constexpr double half = std::numbers::pi;
      inner::expect_number(
          (item.upper >= 0 && item.upper <= half) || item.upper == std::numeric_limits<double>::infinity(),
          std::string(what) + ": upper", item.upper,
          "of a RotationAngle must lie in [0, pi] rad, or be infinite");
      inner::expect_number(item.lower <= half, std::string(what) + ": lower", item.lower,
                           "of a RotationAngle must be <= pi rad");
    }
  }

 private:
  static Vec3 twice_sine(const JointFrames& f) {
    return cross(f.a(0), f.b(0)) + cross(f.a(1), f.b(1)) + cross(f.a(2), f.b(2));
  }
  static double cosine_and_one(const JointFrames& f) {
    return inner::dot_from_end(f.a(0), f.b(0)) + inner::dot_from_end(f.a(1), f.b(1)) +
           inner::dot_from_end(f.a(2), f.b(2));
  }
};

}  // namespace delassus
