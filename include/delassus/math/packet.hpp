/// Several numbers in one register: as many as one instruction of the target processor takes, by the
/// compilers' own vector types.
#pragma once

#include <cstddef>

namespace delassus {

#if defined(__AVX512F__)
inline constexpr std::size_t packet_bytes = 64;
#elif defined(__AVX__)
inline constexpr std::size_t packet_bytes = 32;
#else
inline constexpr std::size_t packet_bytes = 16;
#endif

/// How many packets the processor holds in registers.
#if defined(__AVX512F__) || defined(__aarch64__)
inline constexpr int packet_registers = 32;
#else
inline constexpr int packet_registers = 16;
#endif

namespace inner {

template <class T>
struct PacketTypes {
  typedef T Packet __attribute__((vector_size(packet_bytes)));
  typedef T Unaligned __attribute__((vector_size(packet_bytes), aligned(alignof(T)), may_alias));
};

}  // namespace inner

/// + − * / and comparisons act on each number, `x ? y : z` chooses number by number. T is float or double.
template <class T>
using Packet = typename inner::PacketTypes<T>::Packet;

template <class T>
inline constexpr int packet_size = int(packet_bytes / sizeof(T));

/// From any address: one instruction, where std::memcpy makes two if the compiler prefers vectors of half the
/// length.
template <class T>
[[gnu::always_inline]] inline Packet<T> load_packet(const T* from) {
  return *reinterpret_cast<const typename inner::PacketTypes<T>::Unaligned*>(from);
}
template <class T>
[[gnu::always_inline]] inline void store_packet(T* to, const Packet<T>& x) {
  *reinterpret_cast<typename inner::PacketTypes<T>::Unaligned*>(to) = x;
}

/// Two numbers, whatever the processor could take.
typedef double NumberPair __attribute__((vector_size(16)));

[[gnu::always_inline]] inline NumberPair load_pair(const double* from) {
  typedef double Unaligned __attribute__((vector_size(16), aligned(8), may_alias));
  return *reinterpret_cast<const Unaligned*>(from);
}
[[gnu::always_inline]] inline void store_pair(double* to, NumberPair x) {
  typedef double Unaligned __attribute__((vector_size(16), aligned(8), may_alias));
  *reinterpret_cast<Unaligned*>(to) = x;
}

/// |x|: the sign bits off.
[[gnu::always_inline]] inline Packet<double> size_of(const Packet<double>& x) {
  using Bits = Packet<long long>;
  return Packet<double>(Bits(x) & 0x7fffffffffffffffll);
}

[[gnu::always_inline]] inline bool any_is_positive(const Packet<double>& x) {
  for (int k = 0; k < packet_size<double>; ++k)
    if (x[k] > 0) return true;
  return false;
}

}  // namespace delassus
