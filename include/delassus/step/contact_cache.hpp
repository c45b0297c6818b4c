/// The contacts of a loop: what collision detection found, and the impulses.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/core/array.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/contact_record.hpp>
#include <delassus/step/contact_memory.hpp>
#include <delassus/step/contact_result.hpp>
#include <delassus/step/friction_places.hpp>

#include <span>
#include <vector>

namespace delassus {

/// The contacts of a loop: records of this step, their impulses, and those of the last one by contact id.
template <class Scalar>
class BasicContactCache {
 public:
  Array<Collider> colliders;  ///< of this step, what `gather` found
  std::vector<ContactPoint> points;  ///< what collision detection answered
  Array<ContactResult> results;  ///< in the order of `points`: by pair, then by feature

  /// One collider for every body with a shape.
  template <class World>
  void gather(const World& world) {
    colliders.clear();
    anchors_.clear();
    materials_.clear();
    world.each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (set.has_collider(b)) add(set, s, b, collider_moves(set, b));
    });
  }

  /// Body b of set s as a collider; one that is not movable meets only those that are.
  template <class Set>
  void add(const Set& set, Index s, Index b, bool is_movable) {
    Collider c;
    c.shape = set.shape(b);
    c.pose = set.pose(b);
    const auto& v = set.velocity()[b];
    c.velocity = converted<double>(linear_part(v));
    if constexpr (Set::width == 6) c.angular_velocity = converted<double>(angular_part(v));
    else set_zero(c.angular_velocity);
    c.is_movable = is_movable;
    c.group = set.group(b);
    c.collides_with = set.collides_with(b);
    c.key = collider_key(s, b);
    colliders.push_back(c);
    anchors_.push_back({.set = s, .block = b});
    materials_.push_back(set.material(b));
  }

  /// Turns points into records.
  void record() {
    results.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ContactPoint& p = points[i];
      set_zero(results[i].impulse);
      results[i].starts_cold = false;
      results[i].record = {.a = anchors_[p.a],
                           .b = anchors_[p.b],
                           .point_a = p.point_a,
                           .point_b = p.point_b,
                           .normal = p.normal,
                           .gap = p.gap,
                           .pair = p.pair,
                           .feature = p.feature,
                           .material_a = materials_[p.a],
                           .material_b = materials_[p.b]};
    }
  }

  /// The impulse that result `i` had last step, by the id of its contact. Else that of the nearest unclaimed one of its
  /// pair, within what both can have moved in a step of h (s) and 2e-2 of the smaller one's size. Zero when there is none.
  Vec3 remembered(Index i, double h) {
    const ContactRecord& record = results[i].record;
    return memory_.take(record.pair, record.feature, record.point(), [&] {
      const Collider &a = colliders[points[i].a], &b = colliders[points[i].b];
      return 0.02 * inner::pair_scale(a.shape, b.shape) + h * (inner::top_speed(a) + inner::top_speed(b));
    });
  }

  /// Lets friction of patches act where it does.
  void place_friction() { friction_places_.find(points, results, memory_); }

  /// Keeps this step's impulses for the next one.
  void remember() {
    const auto entries = memory_.renew(results.size());
    for (std::size_t i = 0; i < results.size(); ++i)
      entries[i] = {results[i].record.pair, results[i].record.feature, false, results[i].record.point(),
                    results[i].starts_cold ? Vec3(zero<Vec3>()) : results[i].impulse};
    memory_.sort();
  }
  void memory(auto& archive) { archive(memory_); }

 private:
  /// Of a collider that more than its own block moves, the set says so.
  template <class Set>
  static bool collider_moves(const Set& set, Index b) {
    if constexpr (requires { set.collider_moves(b); }) return set.collider_moves(b);
    else return set.moves(b);
  }

  Array<Anchor> anchors_;
  Array<Index> materials_;
  BasicContactMemory<Scalar> memory_;
  BasicFrictionPlaces<Scalar> friction_places_;
};

using ContactCache = BasicContactCache<double>;  ///< with impulses remembered in double

}  // namespace delassus
