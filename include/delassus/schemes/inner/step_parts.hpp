/// What outlives the parts of a step that is done in several: for `Substeps`.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/schemes/inner/contacts_of_parts.hpp>
#include <delassus/step/detect.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace delassus {

/// Loads act in every part, kinematic bodies arrive in the last, impulses are those of all parts together.
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
    contacts_.clear();
    counted_ = {};
    stay_on_the_way(step.world(), count > 1);
    step.start = step.time();
    step.steps = 0;
    step.h /= count;
  }
  /// After a part, of which `left` are to come; after the last h is that of the step again.
  void end_part(auto& step, int left) {
    count(step.summary, left);
    if constexpr (Laws::has_contacts) contacts_.add(step.contact_cache);
    add_impulses(step.laws());
    is_first_ = false;
    if (left > 0) {
      step.world().each([&](auto& set, auto s) {
        if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
      });
      stay_on_the_way(step.world(), left > 1);
      step.last_h = step.h;
    } else {
      if constexpr (Laws::has_contacts) contacts_.give_to(step.laws(), step.contact_cache, step.summary);
      store_impulses(step.laws());
      step.h = h_;
      step.start = start_;
      step.steps = steps_ + 1;
      step.summary.time = step.time();
    }
  }

 private:
  /// Each part names the same bodies again that stay where they are, and asks questions of its own.
  void count(StepReport& summary, int left) {
    counted_.quarantined = std::max(counted_.quarantined, summary.quarantined);
    counted_.queries += summary.queries;
    counted_.rejects += summary.rejects;
    summary.quarantined = left > 0 ? 0 : counted_.quarantined;
    summary.queries = counted_.queries;
    summary.rejects = counted_.rejects;
  }
  void add_impulses(const Laws& laws) {
    each_kept_pool(laws, [&](auto p, const auto& pool) {
      auto& sum = std::get<p>(sums_);
      sum.resize(pool.impulse.size());
      for (std::size_t i = 0; i < sum.size(); ++i) {
        if (is_first_) set_zero(sum[i]);
        sum[i] += pool.impulse[i];
      }
    });
  }
  void store_impulses(Laws& laws) const {
    each_kept_pool(laws, [&](auto p, auto& pool) { pool.impulse = std::get<p>(sums_); });
  }
  /// Kinematic bodies arrive in the last part.
  static void stay_on_the_way(World& world, bool is_on_the_way) {
    world.each([&](auto& set, auto) {
      if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(is_on_the_way);
    });
  }

  double h_ = 0, start_ = 0;  ///< of the whole step, s
  long steps_ = 0;
  std::tuple<Array<Vec<L::rows>>...> sums_;
  inner::ContactsOfParts contacts_;
  StepReport counted_;  ///< of the parts so far
  typename World::template PerSet<VelocitiesOf> loads_;
  bool is_first_ = true;  ///< no part's impulses are in the sums
};

}  // namespace delassus
