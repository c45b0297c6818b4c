/// The bits of a number as a number of another type: std::bit_cast for C++20 libraries that have none yet.
#pragma once

#include <cstring>
#include <type_traits>

namespace delassus::inner {

template <class To, class From>
inline To bits_as(const From& x) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
  To bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

}  // namespace delassus::inner
