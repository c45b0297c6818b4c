/// What dormant bodies change in a step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/step/contact_cache.hpp>

#include <utility>

namespace delassus {

/// Detection while some sleep: the sleepers near are obstacles, and whom an awake body reaches wakes before the step goes on.
template <class World, class Laws, class State, class Detect>
CollisionReport detect_awake(World& world, Laws& laws, State& activity, ContactCache& book, double h, const Detect& detect) {
  CollisionReport found;
  for (bool again = true; again;) {
    if (!activity.add_obstacles(world, book)) {
      book.points.clear();
      return found;
    }
    found = detect();
    again = activity.wake_touched(world, laws, book, h);
    if (again) book.gather(std::as_const(world));
  }
  activity.drop_points(book);
  return found;
}

namespace inner {

/// For an activity whose state has begin, add_obstacles, wake_touched, drop_points, watch and settle (see `Sleepers`).
template <class Base>
struct DormantStages : Base {
  static void begin(auto& step, double h) {
    Base::begin(step, h);
    own(step).begin(step.world(), step.laws(), h);
  }
  static CollisionReport find_contacts(auto& step) {
    return detect_awake(step.world(), step.laws(), own(step), step.contact_cache, step.h,
                        [&] { return Base::find_contacts(step); });
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

}  // namespace inner
}  // namespace delassus
