/// What the parts of a loop keep between the stages of a step, and from step to step.
#pragma once

#include <delassus/core/if_it_has.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/core/roles.hpp>

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// A part that keeps something declares `template <class P> State`, P having the types of all parts.
template <class F, class P>
concept HasState = requires { typename F::template State<P>; };

template <class F, class P>
struct state_of {
  using type = std::tuple<>;
};
template <class F, class P>
  requires HasState<F, P>
struct state_of<F, P> {
  using type = std::tuple<typename F::template State<P>>;
};

/// Whether `Key` asks for F: by its role, or by its own type, as for what a law overrides.
template <class F, class Key>
inline constexpr bool answers_to = std::is_same_v<F, Key> || Plays<F, Key>;

/// The states of those among F... that have one.
template <class P, class... F>
class States {
 public:
  template <class Key>
  static constexpr bool has = ((answers_to<F, Key> && HasState<F, P>) || ...);

  template <class Key>
  auto& of() {
    return part<place<Key>()>(states_);
  }
  template <class Key>
  const auto& of() const {
    return part<place<Key>()>(states_);
  }

  /// What outlives a step, of all but the activity (false) or of it alone (true).
  template <bool of_activity>
  void memory(auto& archive) {
    const auto one = [&]<class Part>(std::type_identity<Part>) {
      if constexpr (HasState<Part, P> && Plays<Part, role::Activity> == of_activity)
        memory_if_any(of<Part>(), archive);
    };
    (one(std::type_identity<F>{}), ...);
  }

 private:
  template <class Key>
  static consteval std::size_t place() {
    std::size_t at = 0;
    bool is_found = false;
    ((is_found = is_found || answers_to<F, Key>, at += !is_found && HasState<F, P> ? 1 : 0), ...);
    return at;
  }

  [[no_unique_address]] typename pack_of<decltype(std::tuple_cat(std::declval<typename state_of<F, P>::type>()...))>::type states_;
};

}  // namespace delassus::inner
