/// Values of different types side by side, reached by their number or by their type.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

namespace delassus::inner {

// What std::tuple is, as a plain aggregate: a debug build makes two functions for each element where it makes twelve of a
// tuple's. `Pack<A, B> pack{{a}, {b}};`

template <std::size_t i, class T>
struct PackPart {
  [[no_unique_address]] T value;
};
template <class Places, class... T>
struct PackOf;
template <std::size_t... i, class... T>
struct PackOf<std::index_sequence<i...>, T...> : PackPart<i, T>... {
  /// f(part) for all, in their order.
  template <class F>
  [[gnu::always_inline]] constexpr void each(F&& f) {
    (f(this->PackPart<i, T>::value), ...);
  }
  template <class F>
  [[gnu::always_inline]] constexpr void each(F&& f) const {
    (f(this->PackPart<i, T>::value), ...);
  }
};
template <class... T>
using Pack = PackOf<std::index_sequence_for<T...>, T...>;

template <std::size_t i, class T>
[[gnu::always_inline]] constexpr T& part(PackPart<i, T>& pack) {
  return pack.value;
}
template <std::size_t i, class T>
[[gnu::always_inline]] constexpr const T& part(const PackPart<i, T>& pack) {
  return pack.value;
}
/// The one part of this type.
template <class T, std::size_t i>
[[gnu::always_inline]] constexpr T& part_of_type(PackPart<i, T>& pack) {
  return pack.value;
}
template <class T, std::size_t i>
[[gnu::always_inline]] constexpr const T& part_of_type(const PackPart<i, T>& pack) {
  return pack.value;
}

/// The pack of the types that a tuple has.
template <class Tuple>
struct pack_of;
template <class... T>
struct pack_of<std::tuple<T...>> {
  using type = Pack<T...>;
};

}  // namespace delassus::inner
