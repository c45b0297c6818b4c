/// What the parts of a step have together, whatever divides it.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>
#include <tuple>
#include <vector>

namespace delassus {

/// The loads, which act in every part, and the impulses, which are those of all parts together; how the loop
/// counted before the step.
template <class World, class Laws>
class PartSums;

template <class... Sets, class... L>
class PartSums<World<Sets...>, Constraints<L...>> {
 public:
  using World = delassus::World<Sets...>;
  using Laws = Constraints<L...>;
  double h = 0, start = 0;  ///< of the whole step, s
  long steps = 0;

  /// Kinematic bodies arrive in the last part.
  static void stay_on_the_way(World& world, bool is_on_the_way) {
    world.each([&](auto& set, auto) {
      if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(is_on_the_way);
    });
  }
  void keep_loads(World& world) {
    world.each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) std::get<s>(loads_) = set.loads();
    });
    is_first_ = true;
  }
  void give_loads(World& world) const {
    world.each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
    });
  }
  /// Whether no impulses have been added since the loads were kept.
  bool is_first() const { return is_first_; }
  void add_impulses(const Laws& laws) {
    for_each_index<Laws::pool_count>([&](auto p) {
      const auto& pool = laws.template pool<p>();
      if constexpr (requires { pool.impulse; }) {
        auto& sum = std::get<p>(sums_);
        sum.resize(pool.impulse.size());
        for (std::size_t i = 0; i < sum.size(); ++i) {
          if (is_first_) sum[i].setZero();
          sum[i] += pool.impulse[i];
        }
      }
    });
    is_first_ = false;
  }
  void give_impulses(Laws& laws) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      if constexpr (requires { pool.impulse; }) pool.impulse = std::get<p>(sums_);
    });
  }

 private:
  std::tuple<std::vector<Vec<L::rows>>...> sums_;
  std::tuple<std::vector<typename Sets::Velocity>...> loads_;
  bool is_first_ = true;
};

}  // namespace delassus
