/// The policies of a loop, those that its arguments leave out included.
#pragma once

#include <delassus/core/pack.hpp>
#include <delassus/core/roles.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

template <class Role, class... Policies>
inline constexpr int count_of = (0 + ... + int(Plays<Policies, Role>));

/// `is.template operator()<Part>()` for every set of a World, or every law of Constraints.
template <template <class...> class Whole, class... Part>
consteval bool all_parts(std::type_identity<Whole<Part...>>, [[maybe_unused]] auto is) {
  return (is.template operator()<Part>() && ...);
}

/// Whether the tuple has an element of this type.
template <class P, class Tuple>
inline constexpr bool holds_type = false;
template <class P, class... Parts>
inline constexpr bool holds_type<P, std::tuple<Parts...>> = (std::is_same_v<P, Parts> || ...);

/// In place of a part that is not there: the sentence has been said.
template <class P>
P& no_policy();

/// The arguments of a loop, and in `Defaults`, a tuple, what they leave out.
template <class Defaults, class... Policies>
class HeldPolicies {
 public:
  explicit HeldPolicies(Policies... policies) : given_{{static_cast<Policies&&>(policies)}...} {}

  template <class P>
  static constexpr bool has = (std::is_same_v<P, Policies> || ...);

  /// The one of this role, whose type is `Part`.
  template <class Role, class Part, class Self>
  [[gnu::always_inline]] static auto& policy(Self& self) {
    if constexpr (count_of<Role, Policies...> > 0) {
      return part_of_type<Part>(self.given_);
    } else {
      constexpr bool is_default = holds_type<Part, Defaults>;
      static_assert(is_default,
                    "delassus: this AnimationLoop has no policy of this role: without constraints, and under JointByJoint, there is no "
                    "solver and no compliance; do not ask for it, or take another scheme");
      if constexpr (is_default) return part_of_type<Part>(self.defaults_);
      else return no_policy<Part>();
    }
  }
  /// The one of this type among the arguments.
  template <class P, class Self>
  static auto& get(Self& self) {
    static_assert(has<P>,
                  "delassus: this AnimationLoop has no policy of this type; name it among the arguments, or ask for the policy "
                  "of a role, loop.policy<role::Solver>(), which finds the defaults too");
    if constexpr (has<P>) return part_of_type<P>(self.given_);
    else return no_policy<P>();
  }
  /// f(policy) for every argument, in their order.
  template <class F>
  [[gnu::always_inline]] void each(F&& f) {
    given_.each(f);
  }
  [[gnu::always_inline]] void each_with_defaults(auto&& f) const {
    given_.each(f);
    defaults_.each(f);
  }
  const Pack<Policies...>& given() const { return given_; }

 private:
  Pack<Policies...> given_;
  [[no_unique_address]] typename pack_of<Defaults>::type defaults_{};
};

}  // namespace delassus::inner
