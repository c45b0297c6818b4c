/// Contacts seen where a step is half done, for integrators whose rows are of the middle.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/rows/contact_record.hpp>
#include <delassus/step/contact_cache.hpp>

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Bodies of one shape that keeps its form, of which detection twice a step costs little.
template <class Set>
concept KeepsItsForm = requires(const Set& set) { set.never_moves(0); };

/// Whether contacts have their rows in the middle of a step: the integrator says so, and no body is soft.
template <class P>
inline constexpr bool has_middle_contacts = P::Laws::has_contacts && requires { requires P::Integrator::takes_middle_contacts; } &&
    all_parts(std::type_identity<typename P::World>{}, []<class S>() { return KeepsItsForm<S>; });

/// Detection where the bodies are in the middle of the step. The contacts stay those of its start, with their gaps and names; each gets the
/// place and normal that its namesake of the middle has. One without a namesake goes with its bodies, and so does one with which
/// two bodies meet: it keeps its normal.
class MiddleContacts {
 public:
  void see(auto& step) {
    ContactCache& cache = step.contact_cache;
    if (cache.results.empty()) return;
    const auto& world = std::as_const(step).world();
    colliders_ = cache.colliders;
    for (Collider& c : colliders_)
      world.visit(int(c.key >> 28), [&](const auto& set, auto) {
        const Index b = Index(c.key & ((1u << 28) - 1));
        c.pose = set.pose(b);
        c.velocity = converted<double>(linear_part(set.velocity()[b]));
      });
    const CollisionReport found = step.collision().detect(std::span<const Collider>(colliders_), step.h, points_);
    step.summary.queries += found.queries;
    step.summary.rejects += found.rejects;
    move_records(cache, step.h);
    each_contact_pool(step.laws(), [](auto, auto& pool) {
      for (auto& item : pool.items) item.point = item.record->point(), item.frame = contact_frame(item.record->normal);
    });
  }

 private:
  static bool comes_before(const ContactPoint& p, const ContactRecord& r) {
    return p.pair != r.pair ? p.pair < r.pair : p.feature < r.feature;
  }
  void move_records(ContactCache& cache, double h) const {
    auto p = points_.begin();
    bool is_impact = false;
    for (std::size_t i = 0; i < cache.results.size(); ++i) {
      ContactRecord& record = cache.results[i].record;
      while (p != points_.end() && comes_before(*p, record)) ++p;
      if (i == 0 || cache.results[i - 1].record.pair != record.pair) is_impact = meet(cache, i, h);
      if (!is_impact && p != points_.end() && p->pair == record.pair && p->feature == record.feature) {
        record.point_a = p->point_a, record.point_b = p->point_b;
        record.normal = p->normal;
        record.gap = p->gap;
        ++p;
      } else {
        carry(cache.points[i], cache.colliders, record);
      }
    }
  }
  /// Whether the pair whose first contact is the i-th is apart and closes in by more than what counts as touching, at each of its contacts.
  /// One that pushed in the last step has met: what rolls fast leaves the point at which it touched as fast.
  bool meet(const ContactCache& cache, std::size_t i, double h) const {
    if (cache.pushed(cache.points[i].pair)) return false;
    for (std::size_t k = i; k < cache.points.size() && cache.points[k].pair == cache.points[i].pair; ++k) {
      const ContactPoint& p = cache.points[k];
      const Collider &a = cache.colliders[p.a], &b = cache.colliders[p.b];
      const Vec3 on_a = p.point() - 0.5 * p.travel, on_b = p.point() + 0.5 * p.travel;
      const Vec3 speed = colliders_[p.a].velocity + cross(a.angular_velocity, Vec3(on_a - a.pose.position)) - colliders_[p.b].velocity -
                         cross(b.angular_velocity, Vec3(on_b - b.pose.position));
      const double touch = touch_share * pair_scale(a.shape, b.shape);
      if (!(p.gap > -touch && h * dot(p.normal, speed) > touch)) return false;
    }
    return true;
  }
  /// Along with those of its bodies that move.
  void carry(const ContactPoint& p, const Array<Collider>& from, ContactRecord& record) const {
    const auto moved = [&](Index k, const Vec3& x) -> Vec3 { return colliders_[k].pose.to_world(from[k].pose.to_local(x)); };
    const Vec3 x = p.point();
    if (!is_zero(p.travel)) {
      const Vec3 on_a = moved(p.a, x - 0.5 * p.travel), on_b = moved(p.b, x + 0.5 * p.travel), middle = 0.5 * (on_a + on_b);
      record.point_a = middle - 0.5 * p.gap * p.normal, record.point_b = middle + 0.5 * p.gap * p.normal;
      record.travel = on_b - on_a;
      return;
    }
    const bool is_both = from[p.a].is_movable && from[p.b].is_movable;
    const Vec3 to = is_both ? Vec3(0.5 * (moved(p.a, x) + moved(p.b, x))) : moved(from[p.a].is_movable ? p.a : p.b, x);
    record.point_a = p.point_a + (to - x), record.point_b = p.point_b + (to - x);
  }

  Array<Collider> colliders_;
  std::vector<ContactPoint> points_;
};

}  // namespace delassus::inner
