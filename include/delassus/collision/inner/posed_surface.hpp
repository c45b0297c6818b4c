/// A surface of triangles, put where another can be compared with it.
#pragma once

#include <delassus/collision/feature_touch.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>
#include <delassus/math/pose.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace delassus::inner {

/// A TriangleMesh or a HeightField in a frame that is not its own; all arguments and results are in that
/// frame.
template <class Surface>
struct PosedSurface {
  const Surface& surface;
  Pose pose{};

  std::array<Vec3, 3> points_of(Index t) const {
    std::array<Vec3, 3> p = surface.points_of(t);
    for (Vec3& x : p) x = pose.to_world(x);
    return p;
  }
  Vec3 normal(Index t) const { return pose.rotation * surface.normal(t); }
  Triangle triangle(Index t) const {
    Triangle out = surface.triangle(t);
    for (Vec3& x : out.point) x = pose.to_world(x);
    out.normal = pose.rotation * out.normal;
    return out;
  }
  SharpEdge edge(Index t, const Triangle& triangle, int k) const {
    const Index other = surface.neighbour(t, k);
    return {triangle, k, other < 0 ? Vec3(zero<Vec3>()) : Vec3(pose.rotation * surface.normal(other))};
  }
  /// A box that holds one of the surface's own frame.
  Bounds bounds(const Bounds& own) const {
    const Vec3 centre = pose.to_world(Vec3(0.5 * (own.low + own.high))), half = 0.5 * (own.high - own.low);
    Vec3 reach;
    for (int k = 0; k < 3; ++k)
      reach[k] = std::abs(pose.rotation(k, 0)) * half[0] + std::abs(pose.rotation(k, 1)) * half[1] +
                 std::abs(pose.rotation(k, 2)) * half[2];
    return {centre - reach, centre + reach};
  }

  /// Whether no vertex around v lies farther along n, to 0.02 rad: n is in the normal cone of v.
  bool is_farthest(Index v, const Vec3& n) const {
    const Vec3 own = transposed_times(pose.rotation, n), at = surface.vertex(v);
    bool is_in_cone = true;
    surface.each_around(v, [&](Index w) {
      const Vec3 edge = surface.vertex(w) - at;
      const double rise = dot(own, edge);
      is_in_cone = is_in_cone && (rise <= 0 || rise * rise <= cone_slack * cone_slack * squared_norm(edge));
    });
    return is_in_cone;
  }

  /// Whether the vertex v may be what touches along n. Of a rigid surface it is what lies farthest; where
  /// vertices move by themselves, each that looks that way.
  bool may_touch_along(Index v, const Vec3& n) const {
    if constexpr (requires { surface.outward_at(v); })
      return dot(n, pose.rotation * surface.outward_at(v)) > 0;
    else
      return is_farthest(v, n);
  }

  /// Whether x, `depth` behind the surface at `foot` whose normal there is n, is to leave that way: no
  /// triangle is nearer, but for those in front of that plane, such as the floor to what is in the wall.
  bool is_way_out(const Vec3& x, const Vec3& foot, const Vec3& n, double depth) const {
    const Vec3 at = pose.to_local(x), normal = transposed_times(pose.rotation, n), base = pose.to_local(foot);
    const Bounds near = Bounds{at, at}.grown(depth);
    bool is_shortest = true;
    surface.visit([&](const Bounds& box) { return is_shortest && box.meets(near); },
                  [&](Index t) {
                    if (!is_shortest) return;
                    const Triangle other = plain(t);
                    if (norm(at - nearest_on(other, at)) >= 0.999 * depth) return;
                    const Vec3 middle = (other.point[0] + other.point[1] + other.point[2]) / 3;
                    is_shortest = dot(normal, middle - base) >= 0;
                  });
    return is_shortest;
  }

  /// Whether x, `depth` behind the surface at `foot` whose normal there is n, is nearer to its far side: to a
  /// triangle that looks away from n and is not at the foot, as the other side of a sharp edge is.
  bool is_near_far_side(const Vec3& x, const Vec3& foot, const Vec3& n, double depth) const {
    const Vec3 at = pose.to_local(x), normal = transposed_times(pose.rotation, n), base = pose.to_local(foot);
    const Bounds near = Bounds{at, at}.grown(depth);
    bool is_near = false;
    surface.visit([&](const Bounds& box) { return !is_near && box.meets(near); },
                  [&](Index t) {
                    if (is_near || !(dot(normal, surface.normal(t)) < 0)) return;
                    const Triangle other = plain(t);
                    is_near = norm(at - nearest_on(other, at)) < 0.999 * depth &&
                              norm(base - nearest_on(other, base)) > 1e-3 * depth;
                  });
    return is_near;
  }

  /// In the surface's own frame, without what it knows of its neighbours.
  Triangle plain(Index t) const { return {.point = surface.points_of(t), .normal = surface.normal(t)}; }
};

/// The triangles of a leaf of the surface's tree, posed once for all that they are compared with.
template <class Surface>
class PosedLeaf {
 public:
  struct Posed {
    Index t;
    std::array<Vec3, 3> point;
    Bounds box;
  };

  PosedLeaf(const PosedSurface<Surface>& of, std::span<const Index> items) {
    constexpr Index each = Surface::triangles_per_item;
    for (const Index i : items)
      for (Index t = i * each; t < (i + 1) * each; ++t) {
        Posed& posed = triangle_[count_++];
        posed.t = t;
        posed.point = of.points_of(t);
        for (const Vec3& p : posed.point) posed.box.add(p);
      }
  }
  const Posed* begin() const { return triangle_.data(); }
  const Posed* end() const { return triangle_.data() + count_; }

 private:
  std::array<Posed, std::size_t(FlatTree::leaf_size * Surface::triangles_per_item)> triangle_;
  std::size_t count_ = 0;
};

/// f(x, y) for every two posed triangles in leaves of both trees whose boxes are near(box, other_box), as must be all
/// boxes around them.
template <class A, class B, class Near, class F>
void each_pair(const PosedSurface<A>& a, const PosedSurface<B>& b, const Near& near, const F& f) {
  const auto meets = [&](const Bounds& x, const Bounds& y) { return near(a.bounds(x), b.bounds(y)); };
  FlatTree::cross(a.surface.tree(), b.surface.tree(), meets, [&](auto of_a, auto of_b) {
    const PosedLeaf<A> ours(a, of_a);
    const PosedLeaf<B> theirs(b, of_b);
    for (const auto& x : ours)
      for (const auto& y : theirs)
        if (near(x.box, y.box)) f(x, y);
  });
}

}  // namespace delassus::inner
