/// Motions, forces and inertias of a rigid body at the origin of a frame, along its axes.
#pragma once

#include <delassus/math/pose.hpp>
#include <delassus/math/twist.hpp>

namespace delassus::inner::tree {

// [Featherstone2008], chapter 2, with the halves in the order of `math/twist.hpp`: a motion is the velocity
// of the point of the body that is at the origin and the angular velocity, a force is the force and its
// moment about the origin.

/// The frame that is at b in a.
inline Pose composed(const Pose& a, const Pose& b) {
  return {a.to_world(b.position), a.rotation * b.rotation};
}

/// v × m, the rate of a motion m that is carried along by v.
inline Vec<6> cross_motion(const Vec<6>& v, const Vec<6>& m) {
  const Vec3 w = angular_part(v), n = angular_part(m);
  return twist<double>(cross(w, linear_part(m)) + cross(linear_part(v), n), cross(w, n));
}

/// v ×* f, the rate of a force f that is carried along by v.
inline Vec<6> cross_force(const Vec<6>& v, const Vec<6>& f) {
  const Vec3 w = angular_part(v), force = linear_part(f);
  return twist<double>(cross(w, force), cross(w, angular_part(f)) + cross(linear_part(v), force));
}

/// A motion in the frame at `child`.
inline Vec<6> motion_into(const Pose& child, const Vec<6>& m) {
  const Vec3 w = angular_part(m), v = linear_part(m) + cross(w, child.position);
  return twist<double>(transposed_times(child.rotation, v), transposed_times(child.rotation, w));
}

/// A force out of the frame at `child`.
inline Vec<6> force_out_of(const Pose& child, const Vec<6>& f) {
  const Vec3 force = child.rotation * linear_part(f), moment = child.rotation * angular_part(f);
  return twist<double>(force, moment + cross(child.position, force));
}

inline Mat3 turned(const Mat3& R, const Mat3& A) { return times_transposed(R * A, R); }

/// Of one or more rigid bodies, about the origin.
struct RigidInertia {
  double mass = 0;              ///< kg
  Vec3 moment = zero<Vec3>();   ///< mass times centre, kg·m
  Mat3 angular = zero<Mat3>();  ///< kg·m²

  Vec<6> operator*(const Vec<6>& v) const {
    const Vec3 x = linear_part(v), w = angular_part(v);
    return twist<double>(mass * x + cross(w, moment), angular * w + cross(moment, x));
  }
  RigidInertia& operator+=(const RigidInertia& other) {
    mass += other.mass;
    moment += other.moment;
    angular += other.angular;
    return *this;
  }
};

/// An inertia out of the frame at `child`.
inline RigidInertia inertia_out_of(const Pose& child, const RigidInertia& I) {
  const Vec3 h = child.rotation * I.moment;
  const Mat3 p = skew(child.position), ph = p * skew(h);
  return {I.mass, h + I.mass * child.position,
          turned(child.rotation, I.angular) - ph - transposed(ph) - I.mass * (p * p)};
}

/// What a body with all that hangs on it sets against an acceleration: force = linear a + mixed α, moment =
/// mixedᵀ a + angular α.
struct ArticulatedInertia {
  Mat3 linear, mixed, angular;

  static ArticulatedInertia of(const RigidInertia& I) {
    return {diagonal_of<3>(I.mass), -skew(I.moment), I.angular};
  }
  Vec<6> operator*(const Vec<6>& a) const {
    const Vec3 x = linear_part(a), w = angular_part(a);
    return twist<double>(linear * x + mixed * w, transposed_times(mixed, x) + angular * w);
  }
  ArticulatedInertia& operator+=(const ArticulatedInertia& other) {
    linear += other.linear;
    mixed += other.mixed;
    angular += other.angular;
    return *this;
  }
  /// −= u uᵀ / d.
  void subtract(const Vec<6>& u, double d) {
    const Vec3 f = linear_part(u), n = angular_part(u), over_f = f / d, over_n = n / d;
    linear -= times_transposed(over_f, f);
    mixed -= times_transposed(over_f, n);
    angular -= times_transposed(over_n, n);
  }
};

/// The same out of the frame at `child`.
inline ArticulatedInertia inertia_out_of(const Pose& child, const ArticulatedInertia& I) {
  const Mat3 p = skew(child.position), A = turned(child.rotation, I.linear),
             B = turned(child.rotation, I.mixed);
  const Mat3 mixed = B - A * p;
  return {A, mixed, turned(child.rotation, I.angular) - transposed_times(B, p) + p * mixed};
}

}  // namespace delassus::inner::tree
