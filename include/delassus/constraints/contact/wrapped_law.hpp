/// A contact law around a contact law: what it does not change, the one inside answers.
#pragma once

#include <type_traits>
#include <utility>

namespace delassus::inner {

/// The law inside all wrappers. A wrapper says `using wraps = Law;`, holds it as `law`, and adds to what a
/// contact is: parameters, a target velocity, a relative compliance. Its `Parameters` are the law's or derive from them,
/// so that the law inside takes them as its own; the solution at fixed neighbours stays that law's.
template <class Law>
[[gnu::always_inline]] constexpr const auto& innermost(const Law& law) {
  if constexpr (requires { typename Law::wraps; })
    return innermost(law.law);
  else
    return law;
}

template <class Law>
using innermost_t = std::remove_cvref_t<decltype(innermost(std::declval<const Law&>()))>;

}  // namespace delassus::inner
