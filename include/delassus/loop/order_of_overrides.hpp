/// In which order the parts of a loop override the stages of a step.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/loop/states.hpp>
#include <delassus/step/plain_stages.hpp>
#include <delassus/step/stages_without_constraints.hpp>

#include <type_traits>
#include <utility>

namespace delassus::inner {

template <class F>
concept OverridesStages = requires { typename F::template stages<PlainStages>; };

/// Base, overridden by each of F... in turn: the last is the outermost, and is asked first.
template <class Base, class... F>
struct overridden {
  using type = Base;
};
template <class Base, class F, class... Rest>
struct overridden<Base, F, Rest...> : overridden<Base, Rest...> {};
template <class Base, OverridesStages F, class... Rest>
struct overridden<Base, F, Rest...> {
  using Stages = typename F::template stages<Base>;
  static constexpr bool derives = std::is_convertible_v<Stages*, Base*>;
  static_assert(derives, "delassus: what a policy overrides derives from its parameter, or the stages of the policies below it "
                         "are lost; write `template <class Base> struct stages : Base`");
  using type = typename overridden<std::conditional_t<derives, Stages, Base>, Rest...>::type;
};

/// Those of O... that are not among F... yet.
template <class Found, class... O>
struct distinct {
  using type = Found;
};
template <class... F, class O, class... Rest>
struct distinct<Overrides<F...>, O, Rest...>
    : distinct<std::conditional_t<(std::is_same_v<O, F> || ...), Overrides<F...>, Overrides<F..., O>>, Rest...> {};

template <class Found, class... L>
struct overrides_of_laws {
  using type = Found;
};
template <class Found, class L, class... Rest>
struct overrides_of_laws<Found, L, Rest...> {
  template <class... O>
  static typename distinct<Found, O...>::type add(Overrides<O...>);
  using type = typename overrides_of_laws<decltype(add(std::declval<typename overrides_of<L>::type>())), Rest...>::type;
};

/// By role: innermost who runs the parts of stages, then what laws override, each once, compliance, stabilisation, integrator and scheme, and outermost the activity.
template <class P, class Laws = typename P::Laws>
struct order_of_overrides;
template <class P, class... L>
struct order_of_overrides<P, Constraints<L...>> {
  template <class... O>
  static Overrides<typename P::Execution, O..., typename P::Compliance, typename P::Stabilisation, typename P::Integrator,
                   typename P::Scheme, typename P::Activity>
      gather(Overrides<O...>);
  using type = decltype(gather(std::declval<typename overrides_of_laws<Overrides<>, L...>::type>()));
};

template <class P>
struct stages_of {
  template <class... F>
  static overridden<PlainStages, F...> over(Overrides<F...>);
  using type = typename decltype(over(std::declval<typename order_of_overrides<P>::type>()))::type;
};
template <class P>
  requires(P::Laws::pool_count == 0)
struct stages_of<P> {
  using type = StagesWithoutConstraints;
};

/// What they keep, in terms of all types of the loop. Without constraints there is nothing to override, and a whole-step integrator or a scheme may keep something.
template <class All, class P>
struct states_of {
  template <class... F>
  static States<All, F...> gather(Overrides<F...>);
  using type = decltype(gather(std::declval<typename order_of_overrides<P>::type>()));
};

}  // namespace delassus::inner
