/// Detection that does not feel the seams between bodies that lie level side by side.
#pragma once

#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/support.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// `Seamless{NativeCollision{}}` in the place of the backend: A body that slides over tiles does not hit the edges of the next
/// one. WithMeshes, WithCompounds and WithFilter go around it.
///
/// Its rule is for a body A that touches B by the normal n (from A) at the point p of B. Another body C that begins at the plane
/// of that contact, |min n·C − n·p| ≤ `level`, is no obstacle to A in another direction than n, as long as A lies on B. Their
/// contacts are left out, but where they bear. They bear where they overlap and their normal is within 30° of n.
///
/// A lip lower than `level` is passed, and closed as an overlap where it is stood on. Source: none; the idea of
/// leaving out features that lie in the plane of another contact is common in games' engines.
template <class Backend = inner::Absent>
struct Seamless {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::seamless;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::seamless>;

  Backend backend{};  ///< finds the contacts, seams included
  double level = 1e-3;  ///< m

  Seamless() = default;
  /// Around this backend; `largest_step` becomes `level`.
  explicit Seamless(Backend b, double largest_step = 1e-3) : backend(std::move(b)), level(largest_step) {}

  void check() const {
    inner::expect_positive("Seamless: level", level, "m");
    inner::check_if_it_can(backend);
  }

  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    CollisionReport report = backend.detect(colliders, h, contacts, filter);
    leave_out_seams(colliders, contacts);
    if constexpr (inner::KnowsWhoPushed<Filter>) known_ = contacts;
    report.points = Index(contacts.size());
    return report;
  }
  /// Adds to `contacts` the pairs that were left out and meet within h seconds by the velocities at the end of the solve.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter)
    requires inner::DetectsMissed<Backend, Filter>
  {
    backend.detect_missed(colliders, h, contacts, filter);
    if (contacts.empty()) return;
    // A seam is seen by what the body lies on.
    std::vector<ContactPoint>& all = with_known_;
    all = known_;
    all.insert(all.end(), contacts.begin(), contacts.end());
    inner::sort_by_name(all);
    leave_out_seams(colliders, all);
    std::erase_if(contacts, [&](const ContactPoint& c) {
      return std::none_of(all.begin(), all.end(), [&](const ContactPoint& p) { return p.pair == c.pair && p.feature == c.feature; });
    });
    known_ = all;
  }

 private:
  std::vector<ContactPoint> known_, with_known_;  ///< of this step

  /// The contacts [first, last) of a pair, seen from one of its bodies; normal from `body` to `other`, of the nearest of them the
  /// gap and the point on `other`.
  struct Side {
    Index body, other, first, last;
    Vec3 normal, point;
    double gap;
  };

  void leave_out_seams(std::span<const Collider> colliders, std::vector<ContactPoint>& contacts) {
    sides_.clear();
    for (Index first = 0, last; first < Index(contacts.size()); first = last) {
      const ContactPoint& c = contacts[first];
      Index nearest = first;
      for (last = first; last < Index(contacts.size()) && contacts[last].pair == c.pair; ++last)
        if (contacts[last].gap < contacts[nearest].gap) nearest = last;
      const ContactPoint& p = contacts[nearest];
      if (colliders[c.a].is_movable) sides_.push_back({c.a, c.b, first, last, p.normal, p.point_b, p.gap});
      if (colliders[c.b].is_movable) sides_.push_back({c.b, c.a, first, last, -p.normal, p.point_a, p.gap});
    }
    inner::sort(sides_, [](const Side& x, const Side& y) {
      return x.body != y.body ? x.body < y.body : x.first < y.first;
    });
    is_seam_.assign(contacts.size(), 0);
    bool any = false;
    for (std::size_t i = 0, end; i < sides_.size(); i = end) {
      for (end = i; end < sides_.size() && sides_[end].body == sides_[i].body;) ++end;
      for (std::size_t next = i; next < end; ++next)
        for (std::size_t lain_on = i; lain_on < end; ++lain_on) {
          if (!is_seam(colliders, sides_[lain_on], sides_[next])) continue;
          std::fill(is_seam_.begin() + sides_[next].first, is_seam_.begin() + sides_[next].last, 1);
          any = true;
        }
    }
    if (!any) return;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
      if (!is_seam_[k]) contacts[kept++] = contacts[k];
    contacts.resize(kept);
  }

  /// Whether `next` is a body beyond a seam of the one lain on. Never both of each other: one of two must bear.
  bool is_seam(std::span<const Collider> colliders, const Side& lain_on, const Side& next) const {
    constexpr double parallel = 1 - 1e-8, near = 0.866;
    const double along = dot(lain_on.normal, next.normal);
    const bool touches = lain_on.gap <= 0.1 * level, bears = next.gap <= 0 && along > near;
    if (lain_on.first == next.first || !touches || bears || along > parallel) return false;
    return is_level(colliders, lain_on, next) && !is_level(colliders, next, lain_on);
  }

  /// |min n·C − n·p| ≤ level, C beyond the plane of `lain_on`; false where it reaches to no point.
  bool is_level(std::span<const Collider> colliders, const Side& lain_on, const Side& next) const {
    const Collider& c = colliders[next.other];
    const Vec3& n = lain_on.normal;
    return c.shape.has_volume() && std::abs(-reach(c, -n) - dot(n, lain_on.point)) <= level;
  }
  /// max n·x over the body, m.
  static double reach(const Collider& c, const Vec3& n) {
    const Vec3 local = transposed_times(c.pose.rotation, n);
    return dot(n, c.pose.position) + dot(local, support(c.shape, local));
  }

  Array<Side> sides_;
  Array<char> is_seam_;
};

}  // namespace delassus
