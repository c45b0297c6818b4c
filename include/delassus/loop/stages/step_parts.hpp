/// What outlives the parts of a step that is done in several: for `Substeps`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/loop/stages/detect.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>
#include <tuple>
#include <vector>

namespace delassus {

/// Loads act in every part, kinematic bodies arrive in the last, impulses are those of all parts together,
/// and contacts go with their bodies:
///
///   gap ← gap + h H v_next,   point ← point + h (mean of the velocities of the ends that move).
///
/// So a row that was held at u₊ + φ/h ≥ 0 stays open, and momentum is kept as within a part; a normal keeps
/// its direction until the next detection.
template <class World, class Laws, class Rows>
class StepParts;

template <class... Sets, class... L, class Rows>
class StepParts<World<Sets...>, Constraints<L...>, Rows> {
 public:
  using World = delassus::World<Sets...>;
  using Laws = Constraints<L...>;
  double h = 0, start = 0;  ///< of the whole step, s
  long steps = 0;

  void begin(World& world, int count, double h_, double start_, long steps_) {
    h = h_, start = start_, steps = steps_;
    world.each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) std::get<s>(loads_) = set.loads();
    });
    is_first_ = true;
    stay_on_the_way(world, count > 1);
  }
  /// Before the next part; `left` of them are to come.
  void go_on(World& world, int left) {
    world.each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
    });
    stay_on_the_way(world, left > 1);
  }

  void add_impulses(const Laws& laws, const ContactBook& book) {
    for_each_index<Laws::pool_count>([&](auto p) {
      const auto& pool = laws.template pool<p>();
      if constexpr (requires { pool.impulse; })
        add(
            std::get<p>(sums_), pool.impulse, [](const auto& x) -> const auto& { return x; });
    });
    add(pushed_, book.results, [](const ContactResult& r) -> const Vec3& { return r.impulse; });
    is_first_ = false;
  }
  void give_impulses(Laws& laws, ContactBook& book) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      if constexpr (requires { pool.impulse; }) pool.impulse = std::get<p>(sums_);
    });
    for (std::size_t i = 0; i < pushed_.size(); ++i) book.results[i].impulse = pushed_[i];
    book.remember();
  }

  /// The contacts after a part of h seconds, before the next.
  template <class Work>
  void follow(const World& world, Laws& laws, const Work& work, double part) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      if constexpr (ContactLaw<Law>) {
        for (Index i = 0; i < pool.count(); ++i) {
          auto& record = pool.items[i].record;
          record.gap += part * closing<p>(world, work, i);
          Vec3 way = Vec3::Zero();
          int count = 0;
          for (const Anchor* end : {&record.a, &record.b})
            world.visit(end->set, [&](const auto& set, auto) {
              if (!set.moves(end->block)) return;
              way += part * linear_part(set.v_next[end->block]).template cast<double>();
              ++count;
            });
          if (count == 0) continue;
          record.point_a += way / count;
          record.point_b += way / count;
        }
      }
    });
  }

 private:
  /// Kinematic bodies arrive in the last part.
  static void stay_on_the_way(World& world, bool is_on_the_way) {
    world.each([&](auto& set, auto) {
      if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(is_on_the_way);
    });
  }
  template <class Sum, class From, class Impulse>
  void add(Sum& sum, const From& from, const Impulse& impulse) const {
    sum.resize(from.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (is_first_) sum[i].setZero();
      sum[i] += impulse(from[i]);
    }
  }
  /// (H v_next) of the normal row, with what the stabilisation displaced.
  template <int p, class Work>
  static double closing(const World& world, const Work& work, Index i) {
    double u = 0;
    world.each([&](const auto& set, auto s) {
      const auto& blocks = std::get<s>(work.rows.template pool<p>().sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
        const Index b = blocks.block[e];
        auto v = set.v_next[b];
        if constexpr (Work::projects_position) v += std::get<s>(work.displacement)[b];
        u += double(blocks.H[e].row(0).dot(v.transpose()));
      }
    });
    return u;
  }

  std::tuple<Array<Vec<L::rows>>...> sums_;
  std::vector<Vec3> pushed_;  ///< impulses of the contacts, N·s
  std::tuple<Array<typename Sets::Velocity>...> loads_;
  bool is_first_ = true;  ///< no part's impulses are in the sums
};

}  // namespace delassus
