/// Square roots of packets, apart from `packet.hpp` since the processor's header takes a compiler 60 MB.
#pragma once

#include <delassus/math/packet.hpp>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace delassus {

/// Square roots, rounded as std::sqrt rounds them. No compiler has an operator for them.
[[gnu::always_inline]] inline Packet<double> root_of(const Packet<double>& x) {
#if defined(__AVX512F__)
  return Packet<double>(_mm512_sqrt_pd(__m512d(x)));
#elif defined(__AVX__)
  return Packet<double>(_mm256_sqrt_pd(__m256d(x)));
#elif defined(__SSE2__)
  return Packet<double>(_mm_sqrt_pd(__m128d(x)));
#elif defined(__aarch64__)
  return Packet<double>(vsqrtq_f64(float64x2_t(x)));
#else
  Packet<double> root;
  for (int k = 0; k < packet_size<double>; ++k) root[k] = __builtin_sqrt(x[k]);
  return root;
#endif
}

}  // namespace delassus
