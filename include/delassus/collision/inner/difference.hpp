/// The Minkowski difference A − B of two convex bodies, through its support function.
#pragma once

#include <delassus/geometry/support.hpp>

namespace delassus::inner {

/// w = a − b, a point of A's core and one of B's, all in the frame of A.
struct DifferencePoint {
  Vec3 w, a, b;
};

/// Two bodies with B posed in the frame of A.
template <ConvexSupport A, ConvexSupport B>
struct Difference {
  const A& a;
  const B& b;
  const Pose& b_in_a;

  double radius() const { return core_radius(a) + core_radius(b); }

  /// The point of the cores' difference farthest along d, which need not be a unit vector.
  DifferencePoint core(const Vec3& d) const {
    DifferencePoint p;
    p.a = core_support(a, d);
    p.b = b_in_a.to_world(core_support(b, Vec3(-transposed_times(b_in_a.rotation, d))));
    p.w = p.a - p.b;
    return p;
  }

  /// h(n) = max n · (A − B) for a unit n: the depth along n. min over n is the depth; −h(n) bounds the
  /// distance below.
  double reach(const Vec3& n) const { return dot(n, core(n).w) + radius(); }
};

template <class A, class B>
Difference(const A&, const B&, const Pose&) -> Difference<A, B>;

}  // namespace delassus::inner
