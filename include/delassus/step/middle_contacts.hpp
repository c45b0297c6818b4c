/// Contacts seen where a step is half done, for integrators whose rows are of the middle.
#pragma once

#include <delassus/collision/collider.hpp>
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
/// place and normal that its namesake of the middle has. One without a namesake goes with its bodies.
class MiddleContacts {
 public:
  void see(auto& step) {
    ContactCache& cache = step.contact_cache;
    if (cache.results.empty()) return;
    const auto& world = std::as_const(step).world();
    colliders_ = cache.colliders;
    for (Collider& c : colliders_)
      world.visit(int(c.key >> 28), [&](const auto& set, auto) { c.pose = set.pose(Index(c.key & ((1u << 28) - 1))); });
    const CollisionReport found = step.collision().detect(std::span<const Collider>(colliders_), step.h, points_);
    step.summary.queries += found.queries;
    step.summary.rejects += found.rejects;
    move_records(cache);
    each_contact_pool(step.laws(), [](auto, auto& pool) {
      for (auto& item : pool.items) item.point = item.record->point(), item.frame = contact_frame(item.record->normal);
    });
  }

 private:
  static bool comes_before(const ContactPoint& p, const ContactRecord& r) {
    return p.pair != r.pair ? p.pair < r.pair : p.feature < r.feature;
  }
  void move_records(ContactCache& cache) const {
    auto p = points_.begin();
    for (std::size_t i = 0; i < cache.results.size(); ++i) {
      ContactRecord& record = cache.results[i].record;
      while (p != points_.end() && comes_before(*p, record)) ++p;
      if (p != points_.end() && p->pair == record.pair && p->feature == record.feature) {
        record.point_a = p->point_a, record.point_b = p->point_b;
        record.normal = p->normal;
        record.gap = p->gap;
        ++p;
      } else {
        carry(cache.points[i], cache.colliders, record);
      }
    }
  }
  /// Along with those of its bodies that move.
  void carry(const ContactPoint& p, const Array<Collider>& from, ContactRecord& record) const {
    const auto moved = [&](Index k, const Vec3& x) -> Vec3 { return colliders_[k].pose.to_world(from[k].pose.to_local(x)); };
    const Vec3 x = p.point();
    const bool is_both = from[p.a].is_movable && from[p.b].is_movable;
    const Vec3 to = is_both ? Vec3(0.5 * (moved(p.a, x) + moved(p.b, x))) : moved(from[p.a].is_movable ? p.a : p.b, x);
    record.point_a = p.point_a + (to - x), record.point_b = p.point_b + (to - x);
  }

  Array<Collider> colliders_;
  std::vector<ContactPoint> points_;
};

}  // namespace delassus::inner
