/// Sums over numbers that lie one behind the other.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/packet.hpp>

#include <cstddef>

namespace delassus {

/// y += a x, n numbers each; they do not overlap.
template <class T>
inline void add_multiple(T a, const T* x, T* y, Index n) {
  constexpr Index lanes = packet_size<T>;
  Index i = 0;
  for (; i + lanes <= n; i += lanes) store_packet(y + i, load_packet(y + i) + a * load_packet(x + i));
  for (; i < n; ++i) y[i] += a * x[i];
}

/// y ← a y, n numbers.
template <class T>
inline void scale(T a, T* y, Index n) {
  constexpr Index lanes = packet_size<T>;
  Index i = 0;
  for (; i + lanes <= n; i += lanes) store_packet(y + i, a * load_packet(y + i));
  for (; i < n; ++i) y[i] *= a;
}

/// y += Σ_c a_c x_c over `count` rows x_c of n numbers, `stride` numbers apart, from c = 0 on; they do not
/// overlap y.
template <class T>
inline void add_multiples(const T* a, int count, const T* x, std::ptrdiff_t stride, T* y, Index n) {
  constexpr Index lanes = packet_size<T>;
  Index i = 0;
  for (; i + 2 * lanes <= n; i += 2 * lanes) {
    Packet<T> one = load_packet(y + i), other = load_packet(y + i + lanes);
    const T* from = x + i;
    for (int c = 0; c < count; ++c, from += stride)
      one += a[c] * load_packet(from), other += a[c] * load_packet(from + lanes);
    store_packet(y + i, one), store_packet(y + i + lanes, other);
  }
  for (; i < n; ++i)
    for (int c = 0; c < count; ++c) y[i] += a[c] * x[c * stride + i];
}

/// Σ x_i y_i: by two packets at a time whose lanes are added last, then what is left over.
template <class T>
inline T sum_of_products(const T* x, const T* y, Index n) {
  constexpr Index lanes = packet_size<T>;
  T sum = 0;
  Index i = 0;
  if (n >= lanes) {
    Packet<T> even = load_packet(x) * load_packet(y);
    i = lanes;
    if (n >= 2 * lanes) {
      Packet<T> odd = load_packet(x + i) * load_packet(y + i);
      for (i += lanes; i + 2 * lanes <= n; i += 2 * lanes) {
        even += load_packet(x + i) * load_packet(y + i);
        odd += load_packet(x + i + lanes) * load_packet(y + i + lanes);
      }
      even += odd;
      if (i + lanes <= n) even += load_packet(x + i) * load_packet(y + i), i += lanes;
    }
    for (int k = 0; k < lanes; ++k) sum += even[k];
  }
  for (; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

}  // namespace delassus
