/// The minimum of the support function of A − B next to a normal, by Newton's method.
#pragma once

#include <delassus/collision/inner/difference.hpp>
#include <delassus/core/fixed_array.hpp>

#include <algorithm>

namespace delassus::inner {

/// With n(θ) = n + θ₁ x₁ + θ₂ x₂ and w(n) = a − b, the point of A − B farthest along n, the depth h = n · w
/// has
///
///   slope xᵢ · w,   curvature Kᵢⱼ = xᵢ · ∂w/∂θⱼ − δᵢⱼ h,   and its minimum at θ = −K⁻¹ (xᵢ · w).
///
/// Rounding ε of w turns that n by ε / K; it would be √(2 ε / K) if found by comparing depths. Where an edge
/// e of one body lies across n, the least h is on the ridge n · e = 0, w being the point of the edge that is
/// over the origin: the same step along t = n × e, and back to the ridge. Edges of both fix n, n ∝ e_A × e_B.
template <class D>
struct NewtonNormal {
  D difference;

  /// `start` itself where a step leads away from it, or there is no minimum.
  Vec3 operator()(const Vec3& start) const {
    Vec3 n = start;
    for (int round = 0; round < 8; ++round) {
      const Vec3 next = turned(n);
      if (!(dot(next, start) > nearby)) return start;
      const double turn2 = squared_norm(next - n);
      n = next;
      if (turn2 < 1e-14) break;  // the next step is its square
    }
    return n;
  }

 private:
  /// How far a step looks to either side, rad: (1e-6)² is what ∂w/∂θ is wrong by, rounding 1e-10.
  static constexpr double look = 1e-6, nearby = 0.9998;

  /// Two points of a body, the same one where it has no edge.
  struct Edge {
    Vec3 from, to;
    Vec3 along() const { return to - from; }
    double length2() const { return squared_norm(along()); }
    Vec3 at(double share) const { return from + share * along(); }
  };


  Vec3 turned(const Vec3& n) const {
    const Vec3 x = unit_across(n), y = cross(n, x);
    const FixedArray<DifferencePoint, 5> p{difference.core(n), difference.core(n + look * x),
                                           difference.core(n - look * x), difference.core(n + look * y),
                                           difference.core(n - look * y)};
    const Edge a = widest(p, &DifferencePoint::a), b = widest(p, &DifferencePoint::b);
    // A point moves by its radius of curvature times 1e-6; an edge is longer than 1e-3 of all.
    const double shortest2 = 1e-6 * (squared_norm(p[0].a) + squared_norm(p[0].w));
    const bool has_a = a.length2() > shortest2, has_b = b.length2() > shortest2;
    const Vec3 both = cross(a.along(), b.along());
    if (has_a && has_b && squared_norm(both) > 1e-12 * a.length2() * b.length2())
      return normalized(both) * (dot(both, n) < 0 ? -1.0 : 1.0);
    if (has_a) return on_ridge(&DifferencePoint::a, &DifferencePoint::b, 1, n, a);
    if (has_b) return on_ridge(&DifferencePoint::b, &DifferencePoint::a, -1, n, b);
    return on_smooth(n, x, y, p);
  }

  /// The two points of one body that lie farthest from one another.
  static Edge widest(const FixedArray<DifferencePoint, 5>& p, Vec3 DifferencePoint::*point) {
    Edge widest{p[0].*point, p[0].*point};
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < i; ++j)
        if (const Edge e{p[i].*point, p[j].*point}; e.length2() > widest.length2()) widest = e;
    return widest;
  }

  /// `p`: support points along n, n ± look x, n ± look y.
  Vec3 on_smooth(const Vec3& n, const Vec3& x, const Vec3& y, const FixedArray<DifferencePoint, 5>& p) const {
    const Vec3 by_x = (p[1].w - p[2].w) / (2 * look), by_y = (p[3].w - p[4].w) / (2 * look);
    const double level = dot(n, p[0].w);  // of the cores: their radius adds as much to K as to h
    const double xx = dot(x, by_x) - level, yy = dot(y, by_y) - level, xy = 0.5 * (dot(x, by_y) + dot(y, by_x)),
                 determinant = xx * yy - xy * xy;
    if (!(xx > 0 && determinant > 0)) return n;
    const double u = dot(x, p[0].w), v = dot(y, p[0].w);
    return normalized(n - (yy * u - xy * v) / determinant * x - (xx * v - xy * u) / determinant * y);
  }

  /// `edged` are the points of the body with the edge, `other` those of the other one; `sign` is +1 where the
  /// edge is A's.
  Vec3 on_ridge(Vec3 DifferencePoint::*edged, Vec3 DifferencePoint::*other, double sign, const Vec3& start,
                Edge e) const {
    // The ends as they are along n: those of a cone turn with n, though not when n turns along the edge.
    const auto ridge = [&](const Vec3& n, Edge& edge) {
      const Vec3 way = sign * look * normalized(edge.along());
      edge = {difference.core(n - way).*edged, difference.core(n + way).*edged};
      return Vec3(normalized(n - dot(n, edge.along()) / edge.length2() * edge.along()));
    };
    const auto w = [&](const Vec3& n, const Edge& edge, double share) {
      return Vec3(sign * (edge.at(share) - difference.core(n).*other));
    };
    const Vec3 n = ridge(start, e);
    const double share = std::clamp(-sign * dot(w(n, e, 0), e.along()) / e.length2(), 0.0, 1.0);
    const Vec3 t = normalized(cross(n, e.along())), middle = w(n, e, share);
    Edge before = e, after = e;
    const Vec3 n_before = ridge(n - look * t, before), n_after = ridge(n + look * t, after);
    const Vec3 by_t = (w(n_after, after, share) - w(n_before, before, share)) / (2 * look);
    const double curvature = dot(t, by_t) - dot(n, middle);
    if (!(curvature > 0)) return start;
    return ridge(n - dot(t, middle) / curvature * t, e);
  }
};

template <class D>
NewtonNormal(D) -> NewtonNormal<D>;

}  // namespace delassus::inner
