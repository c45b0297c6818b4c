/// Contacts of two surfaces of triangles by their features: vertices with triangles, edges with edges.
#pragma once

#include <delassus/collision/inner/posed_surface.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace delassus::inner {

/// A contact of two surfaces: triangles that have its features, and which of their edges crossed, −1 for a
/// vertex and a triangle. b − a = gap · normal.
struct FeatureContact {
  PatchPoint point;
  Vec3 normal;
  Index triangle_a, triangle_b;
  int edge_a = -1, edge_b = -1;
  bool is_dropped = false;
};

/// Names of contacts within their pair: a vertex of either side, or two edges.
inline std::uint32_t vertex_name(bool is_of_a, Index v) {
  return corner_name(is_of_a, std::uint32_t(v) & 0x3fffffffu);
}
inline bool is_vertex_of_a(std::uint32_t name) { return name >> 30 == 1; }
inline bool is_vertex_of_b(std::uint32_t name) { return name >> 30 == 2; }
inline std::uint32_t edges_name(Index t, int k, Index s, int l) {
  const std::uint32_t e = 3u * std::uint32_t(t) + std::uint32_t(k),
                      f = 3u * std::uint32_t(s) + std::uint32_t(l);
  return 3u << 30 | ((e * 0x9e3779b9u + f * 0x85ebca6bu) & 0x3fffffffu);
}

/// By name, and what shares one by where it is.
inline bool goes_before(const FeatureContact& x, const FeatureContact& y) {
  if (x.point.name != y.point.name) return x.point.name < y.point.name;
  if (x.triangle_a != y.triangle_a) return x.triangle_a < y.triangle_a;
  if (x.triangle_b != y.triangle_b) return x.triangle_b < y.triangle_b;
  return x.edge_a != y.edge_a ? x.edge_a < y.edge_a : x.point.gap < y.point.gap;
}

/// The vertex v at x, of triangle s, on triangle t of the other surface, whose normal is n.
inline FeatureContact vertex_contact(bool is_of_a, Index v, const Vec3& x, const Vec3& foot, double gap, const Vec3& n,
                                     Index s, Index t) {
  const std::uint32_t name = vertex_name(is_of_a, v);
  return is_of_a ? FeatureContact{{x, foot, gap, name}, -n, s, t} : FeatureContact{{foot, x, gap, name}, n, t, s};
}

/// Each vertex and each edge is compared by the triangle that owns it alone, and only where its own surface
/// allows the normal. A vertex behind a triangle must have its shortest way out there. Edges that crossed
/// must cross still when the bodies part as far as a shallower contact says: else that one parts them.
template <class A, class B>
class SurfaceCrossing {
 public:
  /// Of a surface with itself, `is_self`, neighbours do not meet.
  SurfaceCrossing(const PosedSurface<A>& a, const PosedSurface<B>& b, const TouchRange& range,
                  std::vector<FeatureContact>& out, bool is_self = false)
      : a_(a), b_(b), range_(range), out_(out), is_self_(is_self) {}

  /// All contacts in the range, by name; returns how many pairs of triangles were
  /// looked at.
  Index collect() {
    queries_ = 0;
    const auto near = [&](const Bounds& x, const Bounds& y) { return x.grown(range_.before).meets(y); };
    each_pair(a_, b_, near, [&](const auto& x, const auto& y) {
      if (x.t != y.t || !is_self_) compare(x, y);
    });
    drop_twins();
    for (FeatureContact& c : out_)
      c.is_dropped = c.edge_a >= 0 && c.point.gap < 0 && (is_parted(c) || is_through(c));
    std::erase_if(out_, [](const FeatureContact& c) { return c.is_dropped; });
    return queries_;
  }

 private:
  /// A vertex beside a triangle, or over an edge of flat ones, is found by all that share what it touches.
  void drop_twins() {
    inner::sort(out_, goes_before);
    for (std::size_t i = 1; i < out_.size(); ++i)
      for (std::size_t j = i; j-- > 0 && out_[j].point.name == out_[i].point.name;)
        if (squared_norm(out_[j].normal - out_[i].normal) < 1e-12 &&
            std::abs(out_[j].point.gap - out_[i].point.gap) < 1e-9 * range_.scale)
          out_[i].is_dropped = true;
    std::erase_if(out_, [](const FeatureContact& c) { return c.is_dropped; });
  }

  /// Whether two vertices of one surface are one or share an edge: their features are neighbours and do not
  /// meet.
  bool is_joined(Index v, Index w) const {
    if constexpr (requires { a_.surface.front(v); }) v = a_.surface.front(v), w = a_.surface.front(w);
    bool is_one = v == w;
    a_.surface.each_around(v, [&](Index u) { is_one = is_one || u == w; });
    return is_one;
  }

  /// The least height of the points over the plane.
  static double lowest(const std::array<Vec3, 3>& points, const Vec3& normal, const Vec3& on_plane) {
    double least = dot(normal, points[0] - on_plane);
    for (int k = 1; k < 3; ++k) least = std::min(least, dot(normal, points[k] - on_plane));
    return least;
  }

  /// Of one surface with itself every two triangles come in both orders. What lies wholly in front of a
  /// triangle by more than the range has no contact with its face, and none with its edges.
  void compare(const auto& x, const auto& y) {
    ++queries_;
    const Index t = x.t, s = y.t;
    const bool is_s_near = lowest(y.point, a_.normal(t), x.point[0]) <= range_.before,
               is_t_near = lowest(x.point, b_.normal(s), y.point[0]) <= range_.before;
    if (!is_s_near && !is_t_near) return;
    const Triangle T = a_.triangle(t), S = b_.triangle(s);
    for (int k = 0; k < 3; ++k) {
      if (b_.surface.owns_corner(s, k)) put_on(a_, t, T, b_, s, S, k, false);
      if (a_.surface.owns_corner(t, k) && !is_self_) put_on(b_, s, S, a_, t, T, k, true);
    }
    if ((is_self_ && t > s) || !is_s_near || !is_t_near) return;
    for (int k = 0; k < 3; ++k) {
      if (T.lean[k] < cone_slack || !a_.surface.owns_edge(t, k)) continue;
      for (int l = 0; l < 3; ++l)
        if (S.lean[l] >= cone_slack && b_.surface.owns_edge(s, l)) cross(t, T, k, s, S, l);
    }
  }

  /// Corner k of the triangle S on the triangle T, whose surface is `faces`.
  template <class Faces, class Points>
  void put_on(const Faces& faces, Index t, const Triangle& T, const Points& points, Index s,
              const Triangle& S, int k, bool is_point_of_a) {
    const Vec3& x = S.point[k];
    PointTouch touch;
    if (!touches(T, x, range_, touch)) return;
    if (is_self_)
      for (const Index v : T.corner)
        if (is_joined(v, S.corner[k])) return;
    if (touch.corner >= 0 && !faces.is_farthest(T.corner[touch.corner], touch.normal)) return;
    if (!points.may_touch_along(S.corner[k], -touch.normal)) return;
    if (touch.gap < 0 && !faces.is_way_out(x, touch.foot, touch.normal, -touch.gap)) return;
    out_.push_back(vertex_contact(is_point_of_a, S.corner[k], x, touch.foot, touch.gap, touch.normal, s, t));
  }

  void cross(Index t, const Triangle& T, int k, Index s, const Triangle& S, int l) {
    EdgeTouch touch;
    if (!touches(a_.edge(t, T, k), b_.edge(s, S, l), range_, touch)) return;
    if (is_self_)
      for (const int i : {k, (k + 1) % 3})
        for (const int j : {l, (l + 1) % 3})
          if (is_joined(T.corner[i], S.corner[j])) return;
    const PatchPoint point{touch.a, touch.b, touch.gap, edges_name(t, k, s, l)};
    out_.push_back({point, touch.normal, t, s, k, l});
  }

  /// Whether a shallower contact in another direction parts the edges of c as well.
  bool is_parted(const FeatureContact& c) const {
    const SharpEdge e = a_.edge(c.triangle_a, a_.triangle(c.triangle_a), c.edge_a),
                    f = b_.edge(c.triangle_b, b_.triangle(c.triangle_b), c.edge_b);
    EdgeTouch touch;
    for (const FeatureContact& o : out_) {
      if (!(o.point.gap < 0 && o.point.gap > 0.999 * c.point.gap) || dot(o.normal, c.normal) > 0.9) continue;
      SharpEdge moved = f;
      const Vec3 way = -1.001 * o.point.gap * o.normal;
      moved.from += way;
      moved.to += way;
      if (!touches(e, moved, range_, touch)) return true;
    }
    return false;
  }

  /// Whether a point of edges that crossed is nearer to the far side of the other solid: they are not what
  /// touches there. Of surfaces that move by themselves, which may have no inside, nothing is said.
  bool is_through(const FeatureContact& c) const {
    if constexpr (is_rigid<A> && is_rigid<B>)
      return a_.is_near_far_side(c.point.b, c.point.a, c.normal, -c.point.gap) ||
             b_.is_near_far_side(c.point.a, c.point.b, -c.normal, -c.point.gap);
    return false;
  }
  template <class Surface>
  static constexpr bool is_rigid = !requires(const Surface& s) {
    s.outward_at(Index{});
  };

  const PosedSurface<A>& a_;
  const PosedSurface<B>& b_;
  const TouchRange& range_;
  std::vector<FeatureContact>& out_;
  bool is_self_;
  Index queries_ = 0;
};

}  // namespace delassus::inner
