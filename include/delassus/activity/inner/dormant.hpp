/// Bodies and constraints that take no part in the steps until they are woken.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/geometry/support.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace delassus {

/// The dormant of a world: `active` of a body set and of a pool leaves them out, so that no stage meets them. They lie in
/// groups (an island that fell asleep, or a body switched off by hand) and are woken by the group.
template <class World, class Laws>
class Dormant {
 public:
  static constexpr Index awake = -1;

  /// A body as it was when it became dormant; what differs from it later has been touched by the host.
  struct Body {
    Index set, block, group;
    std::uint32_t generation;
    Pose pose;
    Aabb box;  ///< empty for a body without a bounded shape
  };
  struct Item {
    Index pool, place, group;
    std::uint32_t generation;
  };
  /// A body that answers to nothing, fixed or kinematic, and has a dormant item's other end, as it was then.
  struct Hold {
    Index set, block, group;
    std::uint32_t generation;
    Pose pose;
  };

  const std::vector<Body>& bodies() const { return bodies_; }
  const Array<Item>& items() const { return items_; }
  const std::vector<Hold>& holds() const { return holds_; }
  Index new_group() { return groups_++; }

  /// The group of a block, or `awake`.
  Index group_of(Index set, Index block) const {
    if (set < 0) return awake;
    const auto& groups = group_[set];
    return block < Index(groups.size()) ? groups[block] : awake;
  }

  template <class Set>
  void add(Set& set, Index s, Index block, Index group) {
    auto& groups = group_[s];
    if (Index(groups.size()) <= block) groups.resize(set.blocks(), awake);
    groups[block] = group;
    const Pose pose = set.pose(block);
    bodies_.push_back({s, block, group, set.handle(block).generation, pose, box_of(set, block, pose)});
    set.put_to_sleep(block);
  }

  /// The awake items of pool p whose ends all lie in `group` or do not move.
  template <class Pool>
  void add_items(const World& world, Pool& pool, Index p, Index group) {
    if constexpr (requires { pool.slots; }) {
      const Array<Index> active = pool.slots.active();
      for (const Index place : active) {
        const auto& item = pool.items[place];
        if constexpr (HasEnds<typename Pool::Item>) {
          bool holds_one = false, is_held = false;
          each_end(item, [&](const Anchor& end) {
            holds_one = holds_one || group_of(end.set, end.block) == group;
            is_held = is_held || can_move(world, end);
          });
          if (!holds_one || is_held) continue;
          items_.push_back({p, place, group, pool.slots.generation(place)});
          pool.slots.set_awake(place, false);
          each_end(item, [&](const Anchor& end) {
            if (group_of(end.set, end.block) == group) return;
            world.visit(end.set, [&](const auto& set, auto) { holds_.push_back({end.set, end.block, group, end.generation, set.pose(end.block)}); });
          });
        }
      }
    }
  }

  /// Whether some awake body behind the anchor answers to impulses.
  bool can_move(const World& world, const Anchor& a) const {
    bool can = false;
    world.visit(a.set, [&](const auto& set, auto) { can = set.is_awake(a.block) && set.moves(a.block); });
    return can;
  }

  /// Wakes the groups that `is_chosen(group)` names: bodies with their velocity zero, items with their last impulse.
  template <class Chosen>
  void wake(World& world, Laws& laws, const Chosen& is_chosen) {
    const auto gone = std::stable_partition(bodies_.begin(), bodies_.end(), [&](const Body& b) { return !is_chosen(b.group); });
    for (auto b = gone; b != bodies_.end(); ++b) {
      group_[b->set][b->block] = awake;
      world.each([&](auto& set, auto s) {
        if (s == b->set && is_same(set, *b)) set.wake(b->block);
      });
    }
    bodies_.erase(gone, bodies_.end());
    const auto idle = std::stable_partition(items_.begin(), items_.end(), [&](const Item& i) { return !is_chosen(i.group); });
    each_kept_pool(laws, [&](auto p, auto& pool) {
      for (auto i = idle; i != items_.end(); ++i)
        if (i->pool == p && pool.slots.is_current(i->place, i->generation)) pool.slots.set_awake(i->place, true);
    });
    items_.erase(idle, items_.end());
    std::erase_if(holds_, [&](const Hold& h) { return is_chosen(h.group); });
  }

  /// Whether this is still the body that became dormant.
  template <class Set>
  static bool is_same(const Set& set, const Body& b) {
    return !set.is_awake(b.block) && is_there(set, b);
  }
  /// Whether a `Body` or a `Hold` was not taken out.
  template <class Set>
  static bool is_there(const Set& set, const auto& b) {
    return set.is_alive(b.block) && set.handle(b.block).generation == b.generation;
  }

  template <class Set>
  static Aabb box_of(const Set& set, Index block, const Pose& pose) {
    return set.has_collider(block) ? box_of(set.shape(block), pose) : Aabb();
  }
  /// The box of a shape, grown by half of its largest width: what is outside is no neighbour. Empty without a bounded shape.
  static Aabb box_of(const Shape& shape, const Pose& pose) {
    if (shape.kind == ShapeKind::half_space) return {};
    const Aabb box = tight_box(shape, pose);
    const double half = 0.5 * max_entry(box.sizes());
    const Vec3 more(half, half, half);
    return Aabb(box.min() - more, box.max() + more);
  }

  void memory(auto& archive) { archive(bodies_, items_, holds_, group_, groups_); }

 private:
  std::vector<Body> bodies_;
  Array<Item> items_;
  std::vector<Hold> holds_;
  std::array<Array<Index>, World::set_count> group_;
  Index groups_ = 0;
};

}  // namespace delassus
