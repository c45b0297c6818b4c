/// Impacts that were foreseen by the motion at the start of a step, and that the motion which was solved for has not.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/summary.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/step/contact_result.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace delassus::inner {

/// Detection foresees an impact of two bodies by what it knows of their motion: each falls freely. A joint, a force or another contact
/// may lead them elsewhere. What pushed there is asked again after the solve, by v_next without its own push; where a joint holds one
/// of the two also by their velocities at the start, as the joint answered to the push as well. Who does not meet loses its
/// contacts, and so does who meets after another impact of the same body. The step is solved again, and those that meet by that
/// motion come back.
class ForeseenImpacts {
 public:
  void clear() { pairs_.clear(); }

  /// Takes down who pushed, of those that is_asked(a, b) lets, and who of the same bodies was to meet when. `share`: of v_next in the mean
  /// that moves the bodies.
  template <class World>
  void weigh(const World& world, Slice<const Collider> colliders, Slice<const ContactPoint> points, Slice<const ContactResult> results, double h,
             double share, const auto& is_asked, const auto& each_joint) {
    for (Pair& p : pairs_) p.has_pushed = false;
    bool is_any = false;
    for (const ContactPoint& p : points) is_any = is_any || !is_zero(p.travel);
    if (!is_any) return;
    is_any = false;
    each_pair(points, [&](std::size_t first, std::size_t last) {
      bool is_ahead = false, pushes = false;
      for (std::size_t i = first; i < last; ++i) {
        is_ahead = is_ahead || !is_zero(points[i].travel);
        pushes = pushes || !is_zero(results[i].impulse);
      }
      if (!is_ahead || !pushes || !is_asked(results[first].record.a, results[first].record.b)) return;
      is_any = true;
      Pair& p = pair_of(points[first].pair);
      p.has_pushed = true;
      p.is_held = false;
      weigh(world, results[first].record.a, points.data() + first, results.data() + first, last - first, -share, p.a);
      weigh(world, results[first].record.b, points.data() + first, results.data() + first, last - first, share, p.b);
    });
    if (!is_any) return;
    each_joint([&](const Anchor& a, const Anchor& b) {
      for (Pair& p : pairs_)
        for (const Anchor* const end : {&a, &b}) p.is_held = p.is_held || (end->set >= 0 && p.has(collider_key(end->set, end->block)));
    });
    each_pair(points, [&](std::size_t first, std::size_t last) {
      const std::uint64_t pair = points[first].pair;
      bool shares_body = false;
      for (const Pair& p : pairs_) shares_body = shares_body || p.has(std::uint32_t(pair >> 32)) || p.has(std::uint32_t(pair));
      if (!shares_body) return;
      const double at = time_of(colliders, points, first, last, h);
      if (!(at < 1)) return;
      Pair& p = pair_of(pair);
      if (!(p.at < never)) p.at = at;
    });
  }

  /// What detection asks, see `KnowsWhoMisses`. Nobody misses twice in a step.
  bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) {
    Pair* const p = find(pair);
    if (!p || !p->has_pushed || p->is_missed) return false;
    Collider x = a, y = b;
    x.velocity -= p->a.push, x.angular_velocity -= p->a.turn;
    y.velocity -= p->b.push, y.angular_velocity -= p->b.turn;
    bool is_met = meets(x, y);
    if (is_met && p->is_held) {
      x.velocity = p->a.velocity, x.angular_velocity = p->a.angular_velocity;
      y.velocity = p->b.velocity, y.angular_velocity = p->b.angular_velocity;
      is_met = meets(x, y);
    }
    p->is_missed = p->is_new = !is_met || is_after_another(*p);
    return p->is_missed;
  }

  /// Takes the contacts of those that were just found to miss out of the points; whether there were any.
  bool drop(std::vector<ContactPoint>& points) {
    bool is_any = false;
    for (const Pair& p : pairs_) is_any = is_any || p.is_new;
    if (!is_any) return false;
    const std::size_t before = points.size();
    std::size_t kept = 0;
    for (const ContactPoint& c : points) {
      const Pair* const p = find(c.pair);
      if (!p || !p->is_new) points[kept++] = c;
    }
    while (points.size() > kept) points.pop_back();
    for (Pair& p : pairs_) p.is_new = false;
    return kept < before;
  }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  /// Shares of the step, and of a size: impacts at one time, and none.
  static constexpr double same_time = 1e-5, at_rest = 1e-3;

  struct Motion {
    Vec3 push = zero<Vec3>(), turn = zero<Vec3>();                  ///< what the pair's own push added to both velocities, m/s and rad/s
    Vec3 velocity = zero<Vec3>(), angular_velocity = zero<Vec3>();  ///< at the start of the step
    bool moves = false;
  };
  struct Pair {
    std::uint64_t pair = 0;
    Motion a{}, b{};
    double at = never;  ///< when they were to meet by the motion that was known first, a share of the step
    bool has_pushed = false, is_held = false, is_missed = false, is_new = false;

    std::uint32_t key_a() const { return std::uint32_t(pair >> 32); }
    std::uint32_t key_b() const { return std::uint32_t(pair); }
    bool has(std::uint32_t key) const { return key_a() == key || key_b() == key; }
  };

  /// f(first, last) for the points of each pair.
  static void each_pair(Slice<const ContactPoint> points, const auto& f) {
    for (std::size_t first = 0, last; first < points.size(); first = last) {
      for (last = first; last < points.size() && points[last].pair == points[first].pair;) ++last;
      f(first, last);
    }
  }

  /// When the first of the points closes; never where nothing meets.
  static double time_of(Slice<const Collider> colliders, Slice<const ContactPoint> points, std::size_t first, std::size_t last, double h) {
    const Collider &a = colliders[points[first].a], &b = colliders[points[first].b];
    const double least = at_rest * pair_scale(a.shape, b.shape);
    double at = never;
    for (std::size_t i = first; i < last; ++i) {
      const ContactPoint& p = points[i];
      const double closing = h * dot(p.normal, Vec3(a.velocity_at(p.point() - 0.5 * p.travel) - b.velocity_at(p.point() + 0.5 * p.travel)));
      if (closing > least) at = std::min(at, std::max(p.gap, 0.0) / closing);
    }
    return at;
  }

  /// Whether one of the two meets somebody else before: it will go another way then.
  bool is_after_another(const Pair& p) const {
    for (const Pair& q : pairs_)
      if (!q.is_missed && q.at < p.at - same_time && ((p.a.moves && q.has(p.key_a())) || (p.b.moves && q.has(p.key_b())))) return true;
    return false;
  }

  Pair* find(std::uint64_t pair) {
    Pair *const end = pairs_.data() + pairs_.size(), *const at = place_of(pair);
    return at != end && at->pair == pair ? at : nullptr;
  }
  Pair* place_of(std::uint64_t pair) {
    return lower_bound(pairs_.data(), pairs_.data() + pairs_.size(), pair, [](const Pair& p, std::uint64_t key) { return p.pair < key; });
  }
  Pair& pair_of(std::uint64_t pair) {
    if (Pair* const known = find(pair)) return *known;
    return *pairs_.insert(place_of(pair), Pair{.pair = pair});
  }

  /// Of one of the bodies; the impulses of the results act on it `share` times.
  template <class World>
  static void weigh(const World& world, const Anchor& of, const ContactPoint* points, const ContactResult* results, std::size_t count, double share,
                    Motion& m) {
    m = {};
    world.visit(of.set, [&](const auto& set, auto) {
      using Set = std::remove_cvref_t<decltype(set)>;
      m.moves = set.moves(of.block);
      m.velocity = converted<double>(linear_part(set.velocity()[of.block]));
      if constexpr (Set::width == 6) m.angular_velocity = converted<double>(angular_part(set.velocity()[of.block]));
      if constexpr (requires { set.inverse_mass(of.block); }) {
        const double over_mass = share * double(set.inverse_mass(of.block));
        for (std::size_t i = 0; i < count; ++i) m.push += over_mass * results[i].impulse;
      }
      if constexpr (requires { set.centre(of.block), set.inverse_inertia(of.block); }) {
        const auto* const k = set.inverse_inertia(of.block).data();  // symmetric
        Vec3 moment = zero<Vec3>();
        for (std::size_t i = 0; i < count; ++i) {
          const Vec3 at = points[i].point() + (share < 0 ? -0.5 : 0.5) * points[i].travel;
          moment += share * cross(Vec3(at - set.centre(of.block)), results[i].impulse);
        }
        for (int i = 0; i < 3; ++i) m.turn[i] = double(k[i]) * moment[0] + double(k[i + 3]) * moment[1] + double(k[i + 6]) * moment[2];
      }
    });
  }

  Array<Pair> pairs_;  ///< of this step, by key
};

}  // namespace delassus::inner
