/// Islands at rest sleep, and wake when something touches them.
#pragma once

#include <delassus/activity/inner/dormant.hpp>
#include <delassus/activity/inner/dormant_stages.hpp>
#include <delassus/activity/inner/supports.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/bits.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/solvers/solve_report.hpp>
#include <delassus/step/contact_cache.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace delassus {

template <class World, class Laws>
class Sleepers;

/// An island falls asleep when for `after` seconds on end each of its bodies was slower than `speed` and `angular_speed` and
/// was not in free fall. In that time its solve met the tolerance, and no moving kinematic body touched it. Asleep it has no
/// rows, no pairs and no velocity, and its contacts are not listed; its joints keep their last impulse. It wakes:
///
///   1. When an awake body touches it or will within the step, in time for that step.
///   2. When the host gives one of its bodies a force, a velocity, a surface velocity or another place, or changes the gravity.
///   3. When a body it lies on or near or is joined to, fixed or kinematic, is moved, added or taken out.
///   4. When one of its own bodies or joints is taken out, or gets a new joint.
///
/// An edit of a law's own numbers or of materials wakes nobody: Call `loop.wake_all()`.
struct Sleeping {
  using plays = role::Activity;
  double speed = 5e-3;          ///< m/s
  double angular_speed = 5e-3;  ///< rad/s
  double after = 0.5;           ///< s

  template <class Base>
  using stages = inner::DormantStages<Base>;
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = Sleepers<typename P::World, typename P::Laws>;

  void check() const {
    inner::expect_not_negative("Sleeping: speed", speed, "m/s");
    inner::expect_not_negative("Sleeping: angular_speed", angular_speed, "rad/s");
    inner::expect_positive("Sleeping: after", after, "s");
  }
};

/// Who sleeps, and since when the others are quiet.
template <class World, class Laws>
class Sleepers {
  using Supports = inner::Supports<World, Laws>;

 public:
  /// Who sleeps, in the groups that fell asleep together.
  const Dormant<World, Laws>& dormant() const { return dormant_; }

  /// Wakes everybody.
  void wake_all(World& world, Laws& laws) {
    dormant_.wake(world, laws, [](Index) { return true; });
  }
  /// Wakes the group of block `block` of set `set`; nothing for one that is awake.
  void wake(World& world, Laws& laws, Index set, Index block) {
    const Index group = dormant_.group_of(set, block);
    if (group >= 0) dormant_.wake(world, laws, [&](Index g) { return g == group; });
  }

  // --- what the stages call ----------------------------------------------------------------------------------------

  /// Begin: whatever is not as it was when its group fell asleep wakes that group.
  void begin(World& world, Laws& laws, double h) {
    near_ = {};
    supports_.look_at_gravity(world, [&](Index set) {
      for (const auto& body : dormant_.bodies())
        if (body.set == set) call(body.group);
    });
    supports_.look(world, h, [&](const Aabb& near) {
      for (const auto& body : dormant_.bodies())
        if (near.is_empty() || body.box.is_empty() || !near.is_apart(body.box)) call(body.group);
    });
    if (dormant_.bodies().empty()) return;
    for (const auto& body : dormant_.bodies())
      world.visit(body.set, [&](const auto& set, auto) {
        if (!Dormant<World, Laws>::is_same(set, body) || has_moved(set, body) || !is_null(set.load(body.block)) || Supports::runs(set, body.block))
          call(body.group);
      });
    for (const auto& hold : dormant_.holds())
      world.visit(hold.set, [&](const auto& set, auto) {
        if (!Dormant<World, Laws>::is_there(set, hold) || has_moved(set, hold)) call(hold.group);
      });
    look_at_items(laws);
    answer(world, laws);
  }

  /// Detect: sleepers near the way of an awake body in the step of h (s) are obstacles. False when nobody who can move is awake.
  bool add_obstacles(const World& world, ContactCache& book, double h) {
    near_.extend(ways_of(book, h));
    if (near_.is_empty()) return false;
    for (const auto& body : dormant_.bodies())
      if (!body.box.is_empty() && !body.box.is_apart(near_))
        world.visit(body.set, [&](const auto& set, auto s) { book.add(set, s, body.block, false); });
    return true;
  }

  /// Whether somebody who can move was awake then.
  bool has_looked() const { return !near_.is_empty(); }

  /// Whether the solved motion comes near sleepers that were no obstacles.
  bool lacks_obstacles(const ContactCache& book, double h) {
    const Aabb before = near_, ways = ways_of(book, h);
    if (before.contains(ways)) return false;
    near_.extend(ways);
    for (const auto& body : dormant_.bodies())
      if (!body.box.is_empty() && body.box.is_apart(before) && !body.box.is_apart(near_)) return true;
    return false;
  }

  /// Wakes whoever a contact point of an awake body reaches within the step; false when there was nobody.
  bool wake_touched(World& world, Laws& laws, const ContactCache& book, double h) {
    double gravity = 0;
    world.each([&](const auto& set, auto) { gravity = std::max(gravity, norm(inner::gravity_of(set))); });
    for (const ContactPoint& p : book.points) {
      const Collider &a = book.colliders[p.a], &b = book.colliders[p.b];
      const Index group = std::max(group_of(a), group_of(b));
      if (group < 0) continue;
      const Vec3 va = a.velocity + cross(a.angular_velocity, p.point_a - a.pose.position);
      const Vec3 vb = b.velocity + cross(b.angular_velocity, p.point_b - b.pose.position);
      if (p.gap + h * dot(vb - va, p.normal) <= h * h * gravity) call(group);
    }
    return answer(world, laws);
  }

  /// Wakes whoever the solved motion meets; false when there was nobody.
  bool wake_met(World& world, Laws& laws, const ContactCache& book) {
    for (const ContactPoint& p : book.missed) call(std::max(group_of(book.colliders[p.a]), group_of(book.colliders[p.b])));
    return answer(world, laws);
  }

  /// Contact points of sleepers that are not reached make no rows.
  void drop_points(ContactCache& book) const {
    std::erase_if(book.points, [&](const ContactPoint& p) {
      return group_of(book.colliders[p.a]) >= 0 || group_of(book.colliders[p.b]) >= 0;
    });
  }

  /// Before Advance: how long each awake body has been quiet, and the least of each island.
  template <class Rows, class T>
  void watch(const Sleeping& limits, World& world, const Rows& rows, const Islands<T>& islands,
             std::span<const SolveReport> reports, double h) {
    island_quiet_.assign(islands.count(), std::numeric_limits<double>::infinity());
    for (Index k = 0; k < islands.count(); ++k)
      if (worse(reports[k].status, Status::stalled) != Status::stalled) island_quiet_[k] = 0;
    Index first = 0;
    world.each([&](auto& set, auto s) {
      auto& quiet = quiet_[s];
      quiet.resize(set.blocks(), 0);
      const double gravity = norm(inner::gravity_of(set));
      bool may_sleep = true;
      if constexpr (requires { set.may_sleep(); }) may_sleep = set.may_sleep();
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        // Nearly all of gravity must be held; without gravity, what acts must need longer than `after` to reach `speed`.
        const double most = h * (gravity > 0 ? 0.1 * gravity : limits.speed / limits.after);
        const bool is_quiet = may_sleep && !Supports::runs(set, b) && is_slow(set, b, limits) &&
                              (set.v_next[b] - set.velocity()[b]).template head<3>().template cast<double>().norm() <= most;
        quiet[b] = is_quiet ? quiet[b] + h : 0;
        const Index island = islands.island_of(first + b);
        if (island >= 0) island_quiet_[island] = std::min(island_quiet_[island], quiet[b]);
      }
      first += set.blocks();
    });
    keep_awake_where_driven(world, rows, islands);
  }

  /// Advance: islands that were quiet long enough fall asleep, and so do single bodies that nothing pulls.
  template <class T>
  void settle(const Sleeping& limits, World& world, Laws& laws, const Islands<T>& islands) {
    Array<Index>& group = island_group_;
    group.assign(islands.count(), -1);
    Index first = 0;
    bool any = false;
    world.each([&](auto& set, auto s) {
      falling_asleep_.clear();
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        const Index k = islands.island_of(first + b);
        if ((k >= 0 ? island_quiet_[k] : quiet_[s][b]) >= limits.after) falling_asleep_.push_back(b);
      }
      for (const Index b : falling_asleep_) {
        const Index k = islands.island_of(first + b);
        Index g = k >= 0 ? group[k] : -1;
        if (g < 0) g = dormant_.new_group();
        if (k >= 0) group[k] = g;
        dormant_.add(set, s, b, g);
        quiet_[s][b] = 0;
        any = true;
      }
      first += set.blocks();
    });
    if (!any) return;
    for (const Index g : group)
      if (g >= 0)
        each_pool(laws, [&](auto p, auto& pool) { dormant_.add_items(world, pool, p, g); });
  }

  void memory(auto& archive) { archive(dormant_, quiet_, supports_); }

 private:
  Index group_of(const Collider& c) const {
    return dormant_.group_of(Index(c.key >> 28), Index(c.key & ((1u << 28) - 1)));
  }

  /// A box of all that the awake bodies sweep.
  static Aabb ways_of(const ContactCache& book, double h) {
    Aabb ways;
    for (const Collider& c : book.colliders) {
      if (!c.is_movable) continue;
      const Aabb box = Dormant<World, Laws>::box_of(c.shape, c.pose);
      if (box.is_empty()) continue;
      const Vec3 way = h * c.velocity;
      ways.extend(box);
      if (is_finite(way)) ways.extend(Aabb(Vec3(box.min() + way), Vec3(box.max() + way)));
    }
    return ways;
  }

  void call(Index group) {
    if (group < 0) return;
    if (Index(called_.size()) <= group) called_.resize(group + 1, 0);
    called_[group] = 1;
    called_any_ = true;
  }
  bool answer(World& world, Laws& laws) {
    if (!called_any_) return false;
    dormant_.wake(world, laws, [&](Index g) { return g < Index(called_.size()) && called_[g] != 0; });
    std::fill(called_.begin(), called_.end(), 0);
    called_any_ = false;
    return true;
  }

  /// Whether it has a velocity, or another pose than it had then.
  template <class Set, class Body>
  static bool has_moved(const Set& set, const Body& then) {
    const Pose now = set.pose(then.block);
    return !is_null(set.velocity()[then.block]) || !is_equal(now.position, then.pose.position) ||
           !is_equal(now.rotation, then.pose.rotation);
  }
  /// Whether all bits are the same, or all but those of signs zero; without a branch for each number there are vectors
  /// of them.
  template <class M>
  static bool is_equal(const M& a, const M& b) {
    Bits<M> apart = 0;
    for (int k = 0; k < int(M::SizeAtCompileTime); ++k)
      apart |= inner::bits_as<Bits<M>>(a.data()[k]) ^ inner::bits_as<Bits<M>>(b.data()[k]);
    return apart == 0;
  }
  template <class M>
  static bool is_null(const M& a) {
    Bits<M> set = 0;
    for (int k = 0; k < int(M::SizeAtCompileTime); ++k) set |= inner::bits_as<Bits<M>>(a.data()[k]);
    return Bits<M>(set << 1) == 0;
  }
  template <class M>
  using Bits = std::conditional_t<sizeof(typename M::Scalar) == 8, std::uint64_t, std::uint32_t>;

  void look_at_items(const Laws& laws) {
    for (const auto& item : dormant_.items())
      each_kept_pool(laws, [&](auto p, const auto& pool) {
        if (item.pool == p && !pool.slots.is_current(item.place, item.generation)) call(item.group);
      });
    each_kept_pool(laws, [&](auto, const auto& pool) {
      for (Index i = 0; i < pool.count(); ++i)
        each_end(pool.item(i), [&](const Anchor& end) { call(dormant_.group_of(end.set, end.block)); });
    });
  }

  template <class Set>
  static bool is_slow(const Set& set, Index b, const Sleeping& limits) {
    const auto v = set.v_next[b].template cast<double>().eval();
    bool is_slow = v.template head<3>().norm() <= limits.speed;
    if constexpr (Set::width == 6) is_slow = is_slow && v.template tail<3>().norm() <= limits.angular_speed;
    return is_slow;
  }

  /// An island that a moving kinematic body touches stays awake.
  template <class Rows, class T>
  void keep_awake_where_driven(const World& world, const Rows& rows, const Islands<T>& islands) {
    for (Index k = 0; k < islands.count(); ++k)
      each_pool(rows, [&](auto p, const auto& pool) {
        for (const Index i : islands.items(p, k))
          world.each([&](const auto& set, auto s) {
            const auto& blocks = inner::part<s>(pool.sets);
            for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
              if (!set.moves(blocks.block[e]) && !is_zero(set.velocity()[blocks.block[e]])) island_quiet_[k] = 0;
          });
      });
  }

  Dormant<World, Laws> dormant_;
  std::array<Array<double>, World::set_count> quiet_;  ///< s
  Supports supports_;
  Array<double> island_quiet_;
  Array<Index> island_group_, falling_asleep_;
  Array<char> called_;
  bool called_any_ = false;
  Aabb near_;  ///< where sleepers are obstacles
};

}  // namespace delassus
