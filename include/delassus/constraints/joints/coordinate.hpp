/// The free axes of a joint as numbers: how far b has turned about an axis of a, how far it is along it, how far from it.
#pragma once

#include <delassus/constraints/joints/joint_rows.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/wrapping.hpp>

#include <concepts>
#include <numbers>

namespace delassus {

/// The angle (rad) by which b's frame is turned about a_z against a's. It is the twist of the turn from a to b,
///
///   θ = atan2(a_y · b_x − a_x · b_y, a_x · b_x + a_y · b_y),   θ̇ = (a_z + b_z) · (ω_b − ω_a)/(1 + a_z · b_z).
///
/// Where the axes are parallel, θ̇ is simply a_z · (ω_b − ω_a). Singular at b_z = −a_z, where it says 0 and takes
/// a_z. Source: the twist 2 atan2(z, w) of the quaternion, written in its rotation matrix.
struct Turn {
  static constexpr bool winds = true;  ///< known up to whole turns
  static constexpr const char* force_unit = "N·m";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 1;  ///< rad: 60 rad/s at 60 steps a second

  /// θ of one pose, rad, from −π to π.
  static double value(const JointFrames& f) {
    const Vec3 ax = f.a(0), ay = f.a(1), bx = f.b(0), by = f.b(1);
    return std::atan2(inner::dot_from_end(ay, bx) - inner::dot_from_end(ax, by), inner::dot_from_end(ax, bx) + inner::dot_from_end(ay, by));
  }
  /// u_k += factor · θ̇.
  static void write(auto& joint, int k, double factor) {
    const double both = 1 + inner::dot_from_end(joint.a(2), joint.b(2));
    joint.about(k,
                both > 1e-12 ? Vec3(factor / both * (joint.a(2) + joint.b(2))) : Vec3(factor * joint.a(2)));
  }
  static void check(const auto& item, const char* what) { inner::expect_frames(item, what); }
};

/// How far (m) b's point is from a's along a_z: s = a_z · (x_b − x_a), in every pose.
struct Slide {
  static constexpr bool winds = false;  ///< a pose tells all of it
  static constexpr const char* force_unit = "N";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 0.05;  ///< m

  /// s of one pose, m.
  static double value(const JointFrames& f) { return inner::dot_from_end(f.a(2), f.xb - f.xa); }
  /// u_k += factor · ṡ.
  static void write(auto& joint, int k, double factor) { joint.along(k, factor * joint.a(2)); }
  static void check(const auto& item, const char* what) { inner::expect_frame(item.a, what, "first"); }
};

/// How far (m) two points are apart: l = |x_b − x_a|, l̇ = e · (v_b − v_a) with e from a to b. Where the points coincide e is
/// the world's z axis. `Limit<Length>` with an `upper` is a string, with both a telescope; `Motor<Length>` is a winch.
struct Length {
  static constexpr bool winds = false;  ///< a pose tells all of it
  static constexpr const char* force_unit = "N";  ///< of what acts on it, for refusals
  static constexpr double limit_margin = 0.05;  ///< m

  /// l of one pose, m.
  static double value(const JointFrames& f) { return norm(Vec3(f.xb - f.xa)); }
  /// u_k += factor · l̇. Both ends may act at x_b: the row pulls along their line.
  static void write(auto& joint, int k, double factor) {
    const Vec3 span = joint.xb - joint.xa;
    const double l = norm(span);
    joint.along(k, l > 0 ? Vec3(factor / l * span) : Vec3(factor * unit_axis(2)));
  }
  static void check(const auto&, const char*) {}
};

/// What `Limit`, `Motor` and `Drive` act on.
template <class C>
concept AxisCoordinate = requires(const JointFrames& frames) {
  { C::value(frames) } -> std::convertible_to<double>;
};

namespace inner {

/// `value` shifted by whole turns to the one nearest to `last`: a wheel is followed while it makes less than
/// half a turn a step.
template <class Coordinate>
double unwound(double value, double last) {
  if (Coordinate::winds) {
    constexpr double turn = 2 * std::numbers::pi;
    return value + turn * std::round((last - value) / turn);
  }
  return value;
}

}  // namespace inner

/// What laws on one coordinate of a pair of ends share: their items say `position`, which the loop brings up
/// to date once a step. It starts from 0, or from what the item says: 4π is the third turn.
template <class Coordinate>
struct OnAxis {
  static constexpr unsigned turns = Coordinate::winds ? ~0u : 0u;  ///< see `turning_rows`

  void follow(auto& item, const auto& world) const {
    item.position = position(item, {item.a, item.b, world});
  }
  /// The coordinate in a pose near that of `item.position`.
  static double position(const auto& item, const JointFrames& frames) {
    return inner::unwound<Coordinate>(Coordinate::value(frames), item.position);
  }
};

}  // namespace delassus
