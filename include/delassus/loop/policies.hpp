/// Finding the policy of a role in an argument list, whatever its order.
#pragma once

#include <delassus/core/roles.hpp>

#include <tuple>
#include <type_traits>

namespace delassus::inner {

/// The first of `Policies` that plays `Role`, or `Default`.
template <class Role, class Default, class... Policies>
struct pick {
  using type = Default;
};
template <class Role, class Default, class P, class... Rest>
struct pick<Role, Default, P, Rest...>
    : std::conditional_t<Plays<P, Role>, std::type_identity<P>, pick<Role, Default, Rest...>> {};

template <class Role, class... Policies>
inline constexpr int count_of = (0 + ... + int(Plays<Policies, Role>));

/// Whether the tuple has an element of this type.
template <class P, class Tuple>
inline constexpr bool holds_type = false;
template <class P, class... Parts>
inline constexpr bool holds_type<P, std::tuple<Parts...>> = (std::is_same_v<P, Parts> || ...);

/// In place of a part that is not there: the sentence has been said.
template <class P>
P& no_part();

}  // namespace delassus::inner
