/// An array whose length is known, inside of what holds it.
#pragma once

#include <cstddef>

namespace delassus {

/// What std::array is, for n > 0, with members that are inlined in a debug build too, so that a program has no functions of it.
template <class T, std::size_t n>
struct FixedArray {
  using value_type = T;

  T entries[n];

  [[gnu::always_inline]] constexpr T& operator[](std::size_t i) { return entries[i]; }
  [[gnu::always_inline]] constexpr const T& operator[](std::size_t i) const { return entries[i]; }
  [[gnu::always_inline]] constexpr T* data() { return entries; }
  [[gnu::always_inline]] constexpr const T* data() const { return entries; }
  [[gnu::always_inline]] constexpr T* begin() { return entries; }
  [[gnu::always_inline]] constexpr const T* begin() const { return entries; }
  [[gnu::always_inline]] constexpr T* end() { return entries + n; }
  [[gnu::always_inline]] constexpr const T* end() const { return entries + n; }
  [[gnu::always_inline]] static constexpr std::size_t size() { return n; }
  [[gnu::always_inline]] constexpr void fill(const T& x) {
    for (T& entry : entries) entry = x;
  }
  friend constexpr bool operator==(const FixedArray& a, const FixedArray& b) {
    bool is_equal = true;
    for (std::size_t i = 0; i < n; ++i) is_equal = is_equal && a.entries[i] == b.entries[i];
    return is_equal;
  }
};

template <class T, class... More>
FixedArray(T, More...) -> FixedArray<T, 1 + sizeof...(More)>;

}  // namespace delassus
