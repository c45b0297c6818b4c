/// Detection that lets some pairs of bodies pass through each other: those a joint holds, and those named.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace delassus {

/// `WithFilter{NativeCollision{}}` in the place of the backend: bodies that hold each other by a joint do not
/// collide, nor do the pairs given to `ignore`. Filtered pairs cost no query. Groups and masks of the bodies
/// hold as ever. A change wakes nobody.
template <class Backend = inner::Absent>
struct WithFilter {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::filter;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::filter>;
  static constexpr bool asks_for_joints = true;  ///< the loop calls refresh before each detect

  Backend backend{};  ///< asks `lets` before it computes a distance, if it can
  bool joined = true;  ///< bodies with a joint between them pass through each other

  /// What the backend asks.
  template <class Filter>
  struct Both {
    const WithFilter& own;
    const Filter& filter;
    bool lets(std::uint64_t pair) const { return own.lets(pair) && filter.lets(pair); }
    bool pushed(std::uint64_t pair) const
      requires inner::KnowsWhoPushed<Filter>
    {
      return filter.pushed(pair);
    }
    bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) const
      requires inner::KnowsWhoMisses<Filter>
    {
      return filter.misses(pair, a, b, meets);
    }
  };

  WithFilter() = default;
  /// Around this backend; `lets_joined_pass` becomes `joined`.
  explicit WithFilter(Backend b, bool lets_joined_pass = true)
      : backend(std::move(b)), joined(lets_joined_pass) {}

  /// From now on these two bodies pass through each other: `filter.ignore(loop.world(), anchor(rigid, a),
  /// anchor(rigid, b))`. Forgotten when one of them is removed.
  template <class World>
  void ignore(const World& world, Anchor a, Anchor b) {
    resolve(world, a, b);
    if (place_of(a, b) == named_.end()) named_.push_back({a, b});
  }
  /// They collide again.
  template <class World>
  void heed(const World& world, Anchor a, Anchor b) {
    resolve(world, a, b);
    const auto place = place_of(a, b);
    if (place != named_.end()) named_.erase(place);
  }

  void check() const { inner::check_if_it_can(backend); }

  /// The loop says before each detection who is still there, and whom joints hold: each_joint(f) calls f(a,
  /// b).
  template <class World, class EachJoint>
  void refresh(const World& world, const EachJoint& each_joint) {
    erase_if(named_, [&](const Pair& p) { return !world.is_current(p.a) || !world.is_current(p.b); });
    pairs_.clear();
    for (const Pair& p : named_) pairs_.push_back(key(p.a, p.b));
    if (joined)
      each_joint([&](const Anchor& a, const Anchor& b) {
        if (!a.is_world() && !b.is_world()) pairs_.push_back(key(a, b));
      });
    inner::sort(pairs_);
  }

  /// `filter` is asked besides.
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter = {}) {
    const Both<Filter> both{*this, filter};
    if constexpr (requires { backend.detect(colliders, h, contacts, both); }) {
      return backend.detect(colliders, h, contacts, both);
    } else {
      CollisionReport report = backend.detect(colliders, h, contacts);
      std::erase_if(contacts, [&](const ContactPoint& c) { return !both.lets(c.pair); });
      report.points = Index(contacts.size());
      return report;
    }
  }
  /// Adds to `contacts` the pairs that were left out and meet within h seconds by the velocities at the end of the solve.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter)
    requires inner::DetectsMissed<Backend, Both<Filter>>
  {
    backend.detect_missed(colliders, h, contacts, Both<Filter>{*this, filter});
  }

  /// Whether two may collide, by their `pair_key`; of joints as at the last `refresh`.
  bool lets(std::uint64_t pair) const { return !inner::is_listed(pairs_, pair); }

  void memory(auto& archive) {
    archive(named_);
    inner::remember(backend, archive);
  }

 private:
  struct Pair {
    Anchor a, b;
  };

  static std::uint64_t key(const Anchor& a, const Anchor& b) {
    return pair_key(collider_key(a.set, a.block), collider_key(b.set, b.block));
  }
  auto place_of(const Anchor& a, const Anchor& b) {
    return std::find_if(named_.begin(), named_.end(),
                        [&](const Pair& p) { return key(p.a, p.b) == key(a, b); });
  }
  template <class World>
  static void resolve(const World& world, Anchor& a, Anchor& b) {
    world.resolve(a, "collision filter, first body");
    world.resolve(b, "collision filter, second body");
    DELASSUS_EXPECT(!a.is_world() && !b.is_world(),
                    "collision filter: the world has no shape; name two bodies");
    DELASSUS_EXPECT(a.set != b.set || a.block != b.block,
                    "collision filter: body " + inner::text(a.block) + " is named twice; name two bodies");
  }

  Array<Pair> named_;
  Array<std::uint64_t> pairs_;
};

}  // namespace delassus
