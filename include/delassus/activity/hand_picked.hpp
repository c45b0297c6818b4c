/// A part of the world that the host switches off and on.
#pragma once

#include <delassus/activity/inner/dormant.hpp>
#include <delassus/activity/inner/dormant_stages.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/step/contact_cache.hpp>

namespace delassus {

template <class World, class Laws>
class SwitchedOff;

/// `loop.switch_off(body)` takes a body out of the steps, `loop.switch_on(body)` puts it back with the velocity it had. Off, it
/// stays where it is, costs nothing, and is an immovable obstacle to those who are on; constraints all of whose ends are
/// off or fixed have no rows.
struct HandPicked {
  using plays = role::Activity;
  static constexpr bool switches_bodies = true;  ///< read by the loop, which then has switch_off and switch_on

  template <class Base>
  using stages = inner::DormantStages<Base>;
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = SwitchedOff<typename P::World, typename P::Laws>;
};

/// Who is off, and how fast it was.
template <class World, class Laws>
class SwitchedOff {
 public:
  /// Who is off.
  const Dormant<World, Laws>& dormant() const { return dormant_; }

  /// Switches everybody on.
  void wake_all(World& world, Laws& laws) {
    while (!dormant_.bodies().empty()) wake(world, laws, dormant_.bodies().back().set, dormant_.bodies().back().block);
  }

  /// Switches one body on.
  void wake(World& world, Laws& laws, Index set, Index block) {
    const Index group = dormant_.group_of(set, block);
    if (group < 0) return;
    dormant_.wake(world, laws, [&](Index g) { return g == group; });
    world.each([&](auto& bodies, auto s) {
      if (s != set || !bodies.is_alive(block)) return;
      using Velocity = typename std::remove_reference_t<decltype(bodies)>::Velocity;
      bodies.set_fixed(block, false);
      bodies.velocity()[block] = velocity_[group].template head<Velocity::RowsAtCompileTime>().template cast<typename Velocity::Scalar>();
    });
  }

  /// Switches one body off; nothing for one that is off or does not move by itself.
  template <class Set>
  void put_to_sleep(World& world, Laws& laws, Set& set, Index s, Index block) {
    if (dormant_.group_of(s, block) >= 0 || !set.moves(block)) return;
    const Index group = dormant_.new_group();
    velocity_.resize(group + 1);
    set_zero(velocity_[group]);
    velocity_[group].template head<Set::width>() = set.velocity()[block].template cast<double>();
    dormant_.add(set, s, block, group);
    set.set_fixed(block, true);
    each_pool(laws, [&](auto p, auto& pool) { dormant_.add_items(world, pool, p, group); });
  }

  // --- what the stages call ----------------------------------------------------------------------------------------

  void begin(World& world, Laws& laws, double) {
    // A body taken out while it was off leaves the list; the others miss the step for which they were given a force.
    for (std::size_t k = 0; k < dormant_.bodies().size();) {
      const auto body = dormant_.bodies()[k];
      bool is_there = false;
      world.each([&](auto& set, auto s) {
        if (s != body.set || !(is_there = Dormant<World, Laws>::is_same(set, body))) return;
        if constexpr (requires { set.loads(); }) set_zero(set.loads()[body.block]);
      });
      if (is_there) ++k;
      else dormant_.wake(world, laws, [&](Index g) { return g == body.group; });
    }
  }
  /// Bodies that are off are obstacles to those who are on; always true.
  bool add_obstacles(const World& world, ContactCache& book, double) const {
    for (const auto& body : dormant_.bodies())
      world.visit(body.set, [&](const auto& set, auto s) {
        if (set.has_collider(body.block)) book.add(set, s, body.block, false);
      });
    return true;
  }
  /// Always: true.
  bool has_looked() const { return true; }
  /// Contacts switch nobody on: false.
  bool wake_touched(const auto&...) const { return false; }
  /// All are obstacles: false.
  bool lacks_obstacles(const auto&...) const { return false; }
  /// Nor does what is met within the step: false.
  bool wake_met(const auto&...) const { return false; }
  /// Keeps every contact point.
  void drop_points(const auto&...) const {}
  /// Who is off does not depend on speeds.
  void watch(const auto&...) const {}
  /// Nobody is switched off by a step.
  void settle(const auto&...) const {}

  void memory(auto& archive) { archive(dormant_, velocity_); }

 private:
  Dormant<World, Laws> dormant_;
  Array<Vec<6>> velocity_;  ///< by group: m/s, rad/s
};

}  // namespace delassus
