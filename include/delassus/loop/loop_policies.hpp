/// The types of a loop: its parts by role, and what they make of the step.
#pragma once

#include <delassus/loop/checks.hpp>
#include <delassus/loop/defaults.hpp>
#include <delassus/loop/held_policies.hpp>
#include <delassus/loop/order_of_overrides.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/plain_step.hpp>
#include <delassus/step/row_types.hpp>

#include <tuple>
#include <type_traits>

namespace delassus {

/// What is held whether or not the parts fit together.
template <class... Args>
struct HeldTypes : Policies<Args...> {
  template <class Role>
  using of = inner::policy_type<Policies<Args...>, Role>;
  using Held = inner::HeldPolicies<typename inner::DefaultsFor<Args...>::type, Args...>;
};

/// Parts that fit together.
template <class... Args>
struct SoundPolicies : HeldTypes<Args...> {
  using Base = Policies<Args...>;
  using Scratch = typename inner::widths_of<typename Base::World>::Scratch;
  using Rows = typename inner::rows_of<typename Base::World, typename Base::Laws>::type;
  using Operator = typename Base::Compliance::template Operator<Rows>;
  using Stages = typename inner::stages_of<Base>::type;
  using States = typename inner::states_of<SoundPolicies, Base>::type;
  static constexpr bool has_rows = Base::Laws::pool_count > 0;
  static constexpr bool has_problem = has_rows && inner::makes_problem<typename Base::Scheme> && !MovesAtOnce<typename Base::Integrator>;
  using Channels = typename inner::channels_of<typename inner::problem_of<Base>::type, Args...>::type;
};

/// Parts that do not: the sentence has been said, and the loop never steps.
template <class... Args>
struct UnsoundPolicies : HeldTypes<Args...> {
  using Scratch = inner::Pack<>;
  using Rows = void;
  using Operator = void;
  using Stages = StagesWithoutConstraints;
  using States = inner::States<UnsoundPolicies>;
  static constexpr bool has_rows = false, has_problem = false;
  using Channels = inner::Channels<void>;
};

namespace inner {

template <class... Args>
struct loop_policies {
  static constexpr bool are_sound = SoundLoop<Policies<Args...>, Args...>;
  using type = std::conditional_t<are_sound, SoundPolicies<Args...>, UnsoundPolicies<Args...>>;
};

}  // namespace inner
}  // namespace delassus
