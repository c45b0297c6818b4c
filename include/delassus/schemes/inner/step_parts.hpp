/// What outlives the parts of a step that is done in several: for `Substeps`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/step/contact_cache.hpp>

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
template <class World, class Laws>
class StepParts;

template <class World, class... L>
class StepParts<World, Constraints<L...>> {
 public:
  using Laws = Constraints<L...>;

  /// From here on h is h/count.
  void begin(auto& step, int count) {
    h_ = step.h, start_ = step.start, steps_ = step.steps;
    step.world().each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) std::get<s>(loads_) = set.loads();
    });
    is_first_ = true;
    stay_on_the_way(step.world(), count > 1);
    step.start = step.time();
    step.steps = 0;
    step.h /= count;
  }
  /// After a part, of which `left` are to come; after the last h is that of the step again.
  void end_part(auto& step, int left) {
    if constexpr (sizeof...(L) > 0) add_impulses(step.laws(), step.contact_cache);
    if (left > 0) {
      step.world().each([&](auto& set, auto s) {
        if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
      });
      stay_on_the_way(step.world(), left > 1);
      if constexpr (Laws::has_contacts) follow(step);
      step.last_h = step.h;
    } else {
      if constexpr (sizeof...(L) > 0) store_impulses(step.laws(), step.contact_cache);
      step.h = h_;
      step.start = start_;
      step.steps = steps_ + 1;
      step.summary.time = step.time();
    }
  }

 private:
  void add_impulses(const Laws& laws, const ContactCache& book) {
    each_kept_pool(laws, [&](auto p, const auto& pool) {
      add(std::get<p>(sums_), pool.impulse, [](const auto& x) -> const auto& { return x; });
    });
    add(pushed_, book.results, [](const ContactResult& r) -> const Vec3& { return r.impulse; });
    is_first_ = false;
  }
  void store_impulses(Laws& laws, ContactCache& book) const {
    each_kept_pool(laws, [&](auto p, auto& pool) { pool.impulse = std::get<p>(sums_); });
    for (std::size_t i = 0; i < pushed_.size(); ++i) book.results[i].impulse = pushed_[i];
    book.remember();
  }

  /// The contacts after a part of step.h seconds, before the next.
  void follow(auto& step) const {
    const double part = step.h;
    const World& world = step.world();
    each_contact_pool(step.laws(), [&](auto p, auto& pool) {
      for (Index i = 0; i < pool.count(); ++i) {
        auto& item = pool.items[i];
        item.gap += part * closing<p>(step, i);
        Vec3 way = zero<Vec3>();
        int count = 0;
        for (const Anchor* end : {&item.record->a, &item.record->b})
          world.visit(end->set, [&](const auto& set, auto) {
            if (!set.moves(end->block)) return;
            way += part * linear_part(set.v_next[end->block]).template cast<double>();
            ++count;
          });
        if (count > 0) item.point += way / count;
      }
    });
  }

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
      if (is_first_) set_zero(sum[i]);
      sum[i] += impulse(from[i]);
    }
  }
  /// (H v_next) of the normal row, with what the stabilisation displaced.
  template <int p>
  static double closing(auto& step, Index i) {
    double u = 0;
    step.world().each([&](const auto& set, auto s) {
      const auto& blocks = inner::part<s>(step.rows.template pool<p>().sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
        const Index b = blocks.block[e];
        auto v = set.v_next[b];
        if constexpr (requires { step.template state<role::Stabilisation>().displacement; })
          v += std::get<s>(step.template state<role::Stabilisation>().displacement)[b];
        u += double(dot(blocks.H[e].row(0), v.transpose()));
      }
    });
    return u;
  }

  double h_ = 0, start_ = 0;  ///< of the whole step, s
  long steps_ = 0;
  std::tuple<Array<Vec<L::rows>>...> sums_;
  std::vector<Vec3> pushed_;  ///< impulses of the contacts, N·s
  typename World::template PerSet<VelocitiesOf> loads_;
  bool is_first_ = true;  ///< no part's impulses are in the sums
};

}  // namespace delassus
