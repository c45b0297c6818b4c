/// What dormant bodies change in a step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/step/contact_cache.hpp>

#include <utility>

namespace delassus::inner {

/// For an activity whose state has begin, add_obstacles, wake_touched, drop_points, watch and settle (see `Sleepers`).
template <class Base>
struct DormantStages : Base {
  static void begin(auto& step, double h) {
    Base::begin(step, h);
    own(step).begin(step.world(), step.laws(), h);
  }
  /// The sleepers near are obstacles, and whom an awake body reaches wakes before the step goes on.
  static CollisionReport find_contacts(auto& step) {
    ContactCache& book = step.contact_cache;
    CollisionReport found;
    for (bool again = true; again;) {
      if (!own(step).add_obstacles(step.world(), book)) {
        book.points.clear();
        return found;
      }
      found = Base::find_contacts(step);
      again = own(step).wake_touched(step.world(), step.laws(), book, step.h);
      if (again) book.gather(std::as_const(step).world());
    }
    own(step).drop_points(book);
    return found;
  }
  static void correct(auto& step) {
    Base::correct(step);
    own(step).watch(step.activity(), step.world(), step.rows, step.islands, step.reports, step.h);
  }
  static void advance(auto& step) {
    Base::advance(step);
    own(step).settle(step.activity(), step.world(), step.laws(), step.islands);
  }

 private:
  static auto& own(auto& step) { return step.template state<role::Activity>(); }
};

}  // namespace delassus::inner
