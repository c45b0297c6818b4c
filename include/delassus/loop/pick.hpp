/// Finding the policy of a role in an argument list, whatever its order.
#pragma once

#include <delassus/core/roles.hpp>

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

}  // namespace delassus::inner
