/// Detection of what fast bodies will meet within the step.
#pragma once

#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/swing.hpp>
#include <delassus/collision/inner/time_of_impact.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/slice.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// `Continuous{NativeCollision{}}` in the place of the backend: A pair that would come to touch within the step, from farther
/// than the backend's margin, gets contacts now, with the way left to go as their gap. They hold the bodies at the place of
/// impact, whatever the speed; the next step finds them there. `WithCompounds`, `WithFilter` go around it. Convex shapes and
/// half-spaces only.
///
/// Let t be the time of impact, n the normal and r the arms of the points that meet then, with the velocities of the start of
/// the step. Where the motion is mostly a turn, the points themselves are held,
///
///   gap = t n · (v_A + ω_A × r_A − v_B − ω_B × r_B).
///
/// Where it is mostly a flight, the middle of the body that flies is, gap = t n · (v_A − v_B). An impulse beside the middle
/// would turn it and let it fly on. A body that turns while it flies is held by both.
///
/// For the same reason a ball within a fast body is held by its middle, also when the body touches already. Then it is held at
/// once, and so is the next point that its turn would bring through the plane of that contact.
template <class Backend = inner::Absent>
struct Continuous {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::continuous;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::continuous>;

  Backend backend{};  ///< finds what touches now

  Continuous() = default;
  /// Around this backend.
  explicit Continuous(Backend b) : backend(std::move(b)) {}

  void check() const { inner::check_if_it_can(backend); }

  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    CollisionReport report = backend.detect(colliders, h, contacts, filter);
    find_fast(colliders, h);
    if (fast_.empty()) return report;
    const std::size_t known = contacts.size();
    for (const Index i : fast_)
      for (Index j = 0; j < Index(colliders.size()); ++j) {
        if (j == i || (is_fast_[j] && j < i) || !ways_meet(colliders[i], colliders[j], h)) continue;
        const std::uint64_t pair = pair_key(colliders[i].key, colliders[j].key);
        if (!filter.lets(pair)) continue;
        const bool is_first = colliders[i].key < colliders[j].key;
        const Index a = is_first ? i : j, b = is_first ? j : i;
        ++report.queries;
        const auto touch = touching(contacts, known, pair);
        const Pair p{colliders[a], colliders[b], a, b, h, contacts};
        if (!touch) meet(p);
        for (const bool holds_a : {true, false})
          if (is_fast_[holds_a ? a : b]) {
            if (touch) hold_swing(p, holds_a, *touch);
            hold_core(p, holds_a, touch);
          }
      }
    if (contacts.size() > known) inner::sort_by_name(contacts);
    report.points = Index(contacts.size());
    return report;
  }

 private:
  /// Two that are asked about the step h, and where their contacts go.
  struct Pair {
    const Collider &a, &b;
    Index place_a, place_b;
    double h;
    std::vector<ContactPoint>& out;

    /// A row through the point in the middle that lets both close in by the gap.
    void add(const Vec3& middle, const Vec3& n, double gap, std::uint32_t name) const {
      out.push_back({.a = place_a,
                     .b = place_b,
                     .point_a = middle - 0.5 * gap * n,
                     .point_b = middle + 0.5 * gap * n,
                     .normal = n,
                     .gap = gap,
                     .pair = pair_key(a.key, b.key),
                     .feature = name});
    }
  };

  static bool is_asked(const Collider& c) {
    return c.shape.kind != ShapeKind::none && !c.shape.is_kept() && std::isfinite(inner::top_speed(c)) &&
           is_finite(c.pose.position) && is_finite(c.pose.rotation);
  }

  /// Whoever moves further in a step than half the margin that the backend gives any pair here, since two that do not are seen.
  /// Also who moves further than the ball of half its size, since what is thin is then seen on its far side.
  void find_fast(inner::Slice<const Collider> colliders, double h) {
    const CollisionSettings s = inner::settings_of(backend);
    double way = 0.5 * s.margin;
    if (s.margin < 0) {
      double smallest = std::numeric_limits<double>::infinity();
      for (const Collider& c : colliders)
        if (c.shape.has_volume()) smallest = std::min(smallest, length_scale(c.shape));
      way = 0.5 * inner::margin_limit * smallest;
    }
    fast_.clear();
    is_fast_.assign(colliders.size(), false);
    for (Index i = 0; i < Index(colliders.size()); ++i) {
      const Collider& c = colliders[i];
      if (!is_asked(c) || !c.shape.has_volume()) continue;
      if (!(inner::top_speed(c) * h > std::min(way, inner::core_of_motion(c.shape)))) continue;
      is_fast_[i] = true;
      fast_.push_back(i);
    }
  }

  /// Whether they may, and their ways through the step can meet.
  static bool ways_meet(const Collider& a, const Collider& b, double h) {
    return is_asked(b) && may_meet(a, b) &&
           (b.shape.kind == ShapeKind::half_space || swept(a, h).intersects(swept(b, h)));
  }
  static Aabb swept(const Collider& c, double h) {
    Aabb box = tight_box(c.shape, c.pose);
    if (!is_zero(c.angular_velocity)) {
      const Vec3 r = Vec3::Constant(outer_radius(c.shape));
      box = Aabb(Vec3(c.pose.position - r), Vec3(c.pose.position + r));
    }
    Aabb later(Vec3(box.min() + h * c.velocity), Vec3(box.max() + h * c.velocity));
    return later.extend(box);
  }

  /// The backend's contact of a pair with the least gap, if it has any.
  static std::optional<ContactPoint> touching(const std::vector<ContactPoint>& contacts, std::size_t known,
                                              std::uint64_t pair) {
    const ContactPoint* const end = contacts.data() + known;
    const ContactPoint* at = inner::lower_bound(contacts.data(), end, pair,
                                                [](const ContactPoint& p, std::uint64_t key) { return p.pair < key; });
    std::optional<ContactPoint> nearest;
    for (; at != end && at->pair == pair; ++at)
      if (!nearest || at->gap < nearest->gap) nearest = *at;
    return nearest;
  }

  /// Contacts of the patch that the two will have when they touch.
  void meet(const Pair& pair) {
    const Collider &a = pair.a, &b = pair.b;
    const double scale = inner::pair_scale(a.shape, b.shape),
                 thickness = inner::settings_of(backend).contact_distance;
    const inner::Impact hit = inner::time_of_impact(a, b, pair.h, scale, thickness + 1e-3 * scale);
    if (!hit.is_found) return;
    const Pose b_in_a = hit.a.to_local(hit.b);
    const double margin = thickness + 0.05 * scale;
    const SignedPair r = inner::distance_of(a.shape, b.shape, b_in_a, margin, scale, hit.normal_in_a, patch_);
    if (r.status != PairStatus::near) return;
    const Vec3 n = hit.a.rotation * r.normal;
    const double flight = dot(n, a.velocity - b.velocity);
    const Vec3 arm_a = hit.a.rotation * r.point_a, arm_b = hit.a.to_world(r.point_b) - hit.b.position;
    if (flight >= dot(n, cross(a.angular_velocity, arm_a) - cross(b.angular_velocity, arm_b))) {
      if (!(flight > 0)) return;
      const bool holds_a =
          a.is_movable && (!b.is_movable || squared_norm(a.velocity) > squared_norm(b.velocity));
      const Collider& held = holds_a ? a : b;
      pair.add(held.pose.position, n, hit.time * flight, whole_name);
      if (inner::is_turning(held)) add_ahead(pair, hit, n, {.a = r.point_a, .b = r.point_b, .name = end_name}, 0);
      return;
    }
    if (a.shape.has_volume() && b.shape.has_volume())
      contact_patch(a.shape, b.shape, b_in_a, r, margin, scale, patch_);
    const inner::Choice choice = chosen(r.normal);
    const std::size_t first = pair.out.size();
    for (int k = 0; k < choice.count; ++k) {
      PatchPoint p = patch_.point[choice.index[k]];
      p.name = inner::unused(p.name, first, pair.out);
      add_ahead(pair, hit, n, p, std::max(p.gap - r.distance, 0.0));
    }
  }
  /// All points of the patch, or the four that span it.
  inner::Choice chosen(const Vec3& n) const {
    const int limit = std::clamp(inner::settings_of(backend).max_points, 1, 4);
    if (patch_.count > limit) return inner::choose_anew(patch_, n, limit);
    inner::Choice all;
    for (int i = 0; i < patch_.count; ++i) all.add(i);
    return all;
  }

  /// A ball within the fast body, moved without turning, that would reach the other one in the step is held
  /// by its middle. One that is there stays, whichever way it moves: other rows may turn it.
  void hold_core(const Pair& pair, bool holds_a, const std::optional<ContactPoint>& touch) const {
    Collider a = pair.a, b = pair.b;
    Collider& core = holds_a ? a : b;
    if (!core.is_movable || !core.shape.has_volume()) return;
    const double radius = inner::core_of_motion(core.shape);
    core.shape = Sphere{radius};
    set_zero(core.angular_velocity);
    const inner::Impact hit = inner::time_of_impact(a, b, pair.h, radius, 1e-3 * radius);
    if (!hit.is_found && !hit.is_now) return;
    const Vec3 n = hit.a.rotation * hit.normal_in_a;
    const double flight = dot(n, a.velocity - b.velocity);
    if (!(flight > 0) && !hit.is_now) return;
    // What touches has nowhere to go but to turn about that point, and may turn by more than a row can
    // follow.
    const double way = touch ? std::min(hit.time * flight, std::max(touch->gap, 0.0)) : hit.time * flight;
    pair.add(core.pose.position, n, way, holds_a ? core_name : core_name + 1);
  }
  /// Of a body that touches, the next point that its turn brings to the plane of the contact is held there.
  void hold_swing(const Pair& pair, bool holds_a, const ContactPoint& touch) const {
    const Collider& other = holds_a ? pair.b : pair.a;
    Collider body = holds_a ? pair.a : pair.b;
    if (!body.is_movable || !body.shape.has_volume() || !inner::is_turning(body)) return;
    const Vec3 up = holds_a ? Vec3(-touch.normal) : touch.normal;
    const Vec3 on_other = holds_a ? touch.point_b : touch.point_a;
    body.velocity -= other.velocity;
    body.velocity -= std::min(0.0, dot(up, body.velocity)) * up;
    const double target = 1e-3 * inner::pair_scale(body.shape, other.shape);
    const inner::Swing swing = inner::swing_to_plane(body, up, dot(up, on_other), pair.h, target);
    const double closing = -dot(up, body.velocity + cross(body.angular_velocity, swing.arm));
    if (!swing.is_found || !(closing > 0) || !inner::meets(other, body, swing)) return;
    pair.add(body.pose.position + swing.arm, touch.normal, swing.time * closing,
             holds_a ? end_name + 1 : end_name + 2);
  }
  /// The point as a row that lets it close in by the way it has until then, if it does; on the body that moves,
  /// or between both.
  static void add_ahead(const Pair& pair, const inner::Impact& hit, const Vec3& n, const PatchPoint& p,
                        double more) {
    const Collider &a = pair.a, &b = pair.b;
    const Vec3 arm_a = hit.a.to_world(p.a) - hit.a.position, arm_b = hit.a.to_world(p.b) - hit.b.position;
    const Vec3 of_a = a.velocity + cross(a.angular_velocity, arm_a),
               of_b = b.velocity + cross(b.angular_velocity, arm_b);
    const Vec3 on_a = a.pose.position + arm_a, on_b = b.pose.position + arm_b;
    const double way = hit.time * dot(n, of_a - of_b);
    if (!(way > 0)) return;
    pair.add(!a.is_movable ? on_b : !b.is_movable ? on_a : Vec3(0.5 * (on_a + on_b)), n, way + more, p.name);
  }

  /// Names that no point of a patch has.
  static constexpr std::uint32_t whole_name = 0x3ffffff0u, core_name = 0x3ffffff1u, end_name = 0x3ffffff4u;

  Array<Index> fast_;
  Array<char> is_fast_;
  Patch patch_;
};

}  // namespace delassus
