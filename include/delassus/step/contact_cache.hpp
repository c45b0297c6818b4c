/// The contacts of a loop: what collision detection found, and the impulses.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/contact_record.hpp>
#include <delassus/step/contact_memory.hpp>
#include <delassus/step/contact_result.hpp>
#include <delassus/step/foreseen_impacts.hpp>
#include <delassus/step/friction_places.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
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
  /// The same where `ranges` says who describes which.
  template <class World>
  void gather(const World& world, const auto& ranges) {
    anchors_.clear();
    world.each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (set.has_collider(b)) anchors_.push_back({.set = s, .block = b});
    });
    colliders.resize(anchors_.size());
    materials_.resize(anchors_.size());
    Index first = 0;
    world.each([&](const auto& set, auto s) {
      Index last = first;
      while (last < Index(anchors_.size()) && anchors_[last].set == Index(s)) ++last;
      ranges(last - first, 128, [&](inner::Range range) {
        for (Index i = first + range.first; i < first + range.last; ++i) {
          const Index b = anchors_[i].block;
          colliders[i] = collider_of(set, s, b, collider_moves(set, b));
          materials_[i] = set.material(b);
        }
      });
      first = last;
    });
  }
  /// Gives them the velocities that they will have in a step of h (s), as far as it is known: what pushed nothing in the last
  /// step falls. What pushed something that moves will hardly go as it goes now.
  template <class World>
  void foresee(const World& world, double h) {
    find_who_pushed();
    Index i = 0;
    world.each([&](const auto& set, auto s) {
      const Vec3 fall = h * inner::gravity_of(set);
      for (; i < Index(colliders.size()) && anchors_[i].set == Index(s); ++i) {
        Collider& c = colliders[i];
        if (!c.is_movable) continue;
        const bool is_free = is_alone(set, anchors_[i].block);
        c.goes_alone = is_free && pushed_[i] != pushed_movable;
        if (is_free && pushed_[i] == pushed_nothing) c.velocity += fall;
      }
    });
  }
  /// The motion that was solved for: v + share (v_next − v).
  template <class World>
  void take_solved_motion(const World& world, double share) {
    Index i = 0;
    world.each([&](const auto& set, auto s) {
      for (; i < Index(colliders.size()) && anchors_[i].set == Index(s); ++i) {
        const Index b = anchors_[i].block;
        if (!colliders[i].is_movable || !is_finite(set.v_next[b])) continue;
        const auto& v = set.velocity()[b];
        colliders[i].velocity = part_way(linear_part(v), linear_part(set.v_next[b]), share);
        if constexpr (std::remove_cvref_t<decltype(set)>::width == 6)
          colliders[i].angular_velocity = part_way(angular_part(v), angular_part(set.v_next[b]), share);
      }
    });
  }
  /// What detection asks: whether a pair pushed when it was last solved.
  struct Pushed {
    const BasicContactMemory<Scalar>& memory;
    inner::ForeseenImpacts& foreseen;  ///< of this step
    bool lets(std::uint64_t) const { return true; }  ///< all pairs are asked for
    bool pushed(std::uint64_t pair) const { return memory.pushed(pair); }  ///< in the last solve
    /// Whether it is to lose the contacts of an impact to come.
    bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) const { return foreseen.misses(pair, a, b, meets); }
  };
  bool pushed(std::uint64_t pair) const { return memory_.pushed(pair); }  ///< in the last solve
  Pushed who_pushed() { return {memory_, foreseen}; }  ///< the filter of a detection
  inner::ForeseenImpacts foreseen;                     ///< of this step
  /// Asks which of them pushed. Pre: the colliders have the velocities by which the contacts were found.
  void weigh_foreseen(const auto& world, double h, double share, const auto& is_asked, const auto& each_joint) {
    foreseen.weigh(world, colliders, points, results, h, share, is_asked, each_joint);
  }

  int solves = 0;                    ///< of the step, but the first
  StepReport report_of_detect;       ///< as the first solve found it
  std::vector<ContactPoint> missed;  ///< pairs that were left out and meet after all
  /// By how much of their size the two of such a pair would overlap when a step of h (s) is over.
  double overlap_of(const ContactPoint& p, double h) const {
    const Collider &a = colliders[p.a], &b = colliders[p.b];
    const double closing = dot(p.normal, a.velocity_at(p.point() - 0.5 * p.travel) - b.velocity_at(p.point() + 0.5 * p.travel));
    return (h * closing - p.gap) / inner::pair_scale(a.shape, b.shape);
  }
  const Anchor& anchor_of(Index collider) const { return anchors_[collider]; }  ///< its body
  Index material_of(Index collider) const { return materials_[collider]; }  ///< its number in the table of materials
  /// Adds them to the points of the step.
  void join_missed() {
    for (ContactPoint& p : inner::Slice<ContactPoint>(missed)) points.push_back(static_cast<ContactPoint&&>(p));
    inner::sort_by_name(points);
    inner::part_equal_names(points);
  }

  /// Body b of set s as a collider; one that is not movable meets only those that are.
  template <class Set>
  void add(const Set& set, Index s, Index b, bool is_movable) {
    colliders.push_back(collider_of(set, s, b, is_movable));
    anchors_.push_back({.set = s, .block = b});
    materials_.push_back(set.material(b));
  }
  /// Body b of set s as detection sees it.
  template <class Set>
  [[gnu::always_inline]] static Collider collider_of(const Set& set, Index s, Index b, bool is_movable) {
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
    return c;
  }

  /// Whether it is apart by more than the least margin, one of the two answers to no impulse, and the other hits nothing else that moves.
  /// Who does not answer keeps no momentum, so that the other is pushed at its own point and not in the middle of the gap, of which friction
  /// would make a moment.
  bool lands(const ContactPoint& p) const {
    const Collider &a = colliders[p.a], &b = colliders[p.b];
    return a.is_movable != b.is_movable && (a.is_movable ? a : b).goes_alone && is_zero(p.travel) &&
           p.gap > inner::margin_share * inner::pair_scale(a.shape, b.shape);
  }
  /// Turns points into records.
  void record() {
    results.resize(points.size());
    record({0, Index(points.size())});
  }
  /// Of some of them. Pre: there is room for the results.
  void record(inner::Range range) {
    for (std::size_t i = std::size_t(range.first); i < std::size_t(range.last); ++i) {
      const ContactPoint& p = points[i];
      set_zero(results[i].impulse);
      results[i].starts_cold = false;
      // Member by member: a record that is made and then assigned is copied once more.
      ContactRecord& record = results[i].record;
      assign(record.a, anchors_[p.a]);
      assign(record.b, anchors_[p.b]);
      assign(record.point_a, p.point_a);
      assign(record.point_b, p.point_b);
      assign(record.normal, p.normal);
      record.gap = p.gap;
      record.pair = p.pair;
      record.feature = p.feature;
      record.material_a = materials_[p.a];
      record.material_b = materials_[p.b];
      set_zero(record.friction_arm);
      assign(record.travel, p.travel);
      if (p.gap > 0 && lands(p)) record.travel = p.point_b - p.point_a;
    }
  }

  /// The impulse that result `i` had last step, by the id of its contact. Else that of the nearest unclaimed one of its
  /// pair, within what both can have moved in a step of h (s) and 2e-2 of the smaller one's size. Zero when there is none.
  Vec3 remembered(Index i, double h) { return remembered(i, h, memory_.search()); }
  /// The same from several threads at once, see `BasicContactMemory::take`.
  using Search = typename BasicContactMemory<Scalar>::Search;
  Vec3 remembered(Index i, double h, Search& by) {  ///< `by`: of the thread
    const ContactRecord& record = results[i].record;
    return memory_.take(record.pair, record.feature, record.point(), [&] {
      const Collider &a = colliders[points[i].a], &b = colliders[points[i].b];
      return 0.02 * inner::pair_scale(a.shape, b.shape) + h * (inner::top_speed(a) + inner::top_speed(b));
    }, by);
  }
  /// The search of the one thread that asks in the order of all items.
  Search& search() { return memory_.search(); }
  /// Makes a search of another thread ready.
  void begin(Search& search) const { search.begin(memory_.capacity()); }

  /// Lets friction of patches act where it does.
  void place_friction() { friction_places_.find(points, results, memory_); }

  /// Keeps this step's impulses for the next one.
  void remember() { remember(inner::OneRange{}); }
  /// The same where `ranges` says who keeps which.
  void remember(const auto& ranges) {
    const auto entries = memory_.renew(results.size());
    ranges(Index(results.size()), 256, [&](inner::Range range) __attribute__((always_inline)) {
      for (std::size_t i = std::size_t(range.first); i < std::size_t(range.last); ++i)
        entries[i] = {results[i].record.pair, results[i].record.feature, false, results[i].record.point(),
                      results[i].starts_cold ? Vec3(zero<Vec3>()) : results[i].impulse};
    });
    memory_.sort();
  }
  void memory(auto& archive) { archive(memory_); }

 private:
  static constexpr char pushed_nothing = 0, pushed_still = 1, pushed_movable = 2;

  /// Whom each collider pushed in the last step: what moves, if it did, else what does not.
  void find_who_pushed() {
    pushed_.assign(colliders.size(), pushed_nothing);
    keys_.clear();
    for (const Collider& c : colliders) keys_.push_back(c.key);
    Index a = -1;
    for (const auto& e : memory_.entries()) {
      if (is_zero(e.impulse)) continue;
      a = place_of(std::uint32_t(e.pair >> 32), a);  // pair by pair the first one is the same, mostly
      const Index b = place_of(std::uint32_t(e.pair), a);
      if (a < 0 || b < 0) continue;
      pushed_[a] = std::max(pushed_[a], colliders[b].is_movable ? pushed_movable : pushed_still);
      pushed_[b] = std::max(pushed_[b], colliders[a].is_movable ? pushed_movable : pushed_still);
    }
  }
  /// Of a collider by its key, by which they are sorted; -1 where there is none. Where every body has a collider, it is as far from
  /// the one at `near` as their keys are.
  Index place_of(std::uint32_t key, Index near) const {
    const std::uint32_t* const first = keys_.data();
    const std::size_t guess = near < 0 ? key : std::size_t(near) + (key - first[near]);
    if (guess < keys_.size() && first[guess] == key) return Index(guess);
    const std::uint32_t *const end = first + keys_.size(), *const at = inner::lower_bound(first, end, key);
    return at != end && *at == key ? Index(at - first) : Index(-1);
  }

  static Vec3 part_way(const auto& from, const auto& to, double share) {
    const Vec3 end = converted<double>(to);
    if (share == 1) return end;
    const Vec3 start = converted<double>(from);
    return start + share * (end - start);
  }
  /// Whether no force couples block b to others.
  static bool is_alone(const auto& set, Index b) {
    if constexpr (requires { set.is_alone(b); }) return set.is_alone(b);
    else if constexpr (requires { set.is_separable(); }) return set.is_separable();
    else return false;
  }
  /// Of a collider that more than its own block moves, the set says so.
  template <class Set>
  static bool collider_moves(const Set& set, Index b) {
    if constexpr (requires { set.collider_moves(b); }) return set.collider_moves(b);
    else return set.moves(b);
  }

  Array<Anchor> anchors_;
  Array<Index> materials_;
  Array<char> pushed_;
  Array<std::uint32_t> keys_;  ///< of the colliders
  BasicContactMemory<Scalar> memory_;
  BasicFrictionPlaces<Scalar> friction_places_;
};

using ContactCache = BasicContactCache<double>;  ///< with impulses remembered in double

}  // namespace delassus
