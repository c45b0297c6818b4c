/// What comparisons of packets say of all their numbers at once.
#pragma once

#include <delassus/math/packet.hpp>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace delassus {

/// True in each lane or false.
using LaneMask = decltype(Packet<double>{} < Packet<double>{});

/// Whether it is true in some lane.
[[gnu::always_inline]] inline bool any_lane(const LaneMask& is) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(__m512i(is), __m512i(is)) != 0;
#elif defined(__AVX__)
  return !_mm256_testz_si256(__m256i(is), __m256i(is));
#elif defined(__SSE2__)
  return _mm_movemask_pd(__m128d(is)) != 0;
#else
  bool any = false;
  for (int k = 0; k < packet_size<double>; ++k) any = any || is[k] != 0;
  return any;
#endif
}

}  // namespace delassus
