/// What dormant bodies change in a step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/step/contact_cache.hpp>

#include <utility>

namespace delassus::inner {

/// For an activity whose state has begin, add_obstacles, has_looked, lacks_obstacles, wake_touched, wake_met, drop_points, watch and settle (see `Sleepers`).
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
      if (!own(step).add_obstacles(step.world(), book, step.h)) {
        book.points.clear();
        return found;
      }
      found = Base::find_contacts(step);
      again = own(step).wake_touched(step.world(), step.laws(), book, step.h);
      if (again) Base::gather(step);
    }
    own(step).drop_points(book);
    return found;
  }
  /// A sleeper that is met wakes, and the step begins anew with it; so it does where one comes near that was no obstacle.
  static bool find_missed(auto& step) {
    if (!own(step).has_looked()) return false;  // nor has detection seen these bodies
    const bool is_any = Base::find_missed(step);
    ContactCache& book = step.contact_cache;
    const bool begins_anew = is_any ? own(step).wake_met(step.world(), step.laws(), book) : own(step).lacks_obstacles(book, step.h);
    if (begins_anew) {
      const int solves = book.solves;
      step.summary = book.report_of_detect;
      Base::detect(step);
      step.last_h = step.h;
      book.solves = solves + 1;
    }
    return is_any || begins_anew;
  }
  static void advance(auto& step) {
    own(step).watch(step.activity(), step.world(), step.rows, step.islands, step.reports, step.h);
    Base::advance(step);
    own(step).settle(step.activity(), step.world(), step.laws(), step.islands);
  }

 private:
  static auto& own(auto& step) { return step.template state<role::Activity>(); }
};

}  // namespace delassus::inner
