/// A kernel's answer when it holds, the native kernel's when it does not.
#pragma once

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/gjk_epa.hpp>

namespace delassus {

struct CertifiedPair {
  SignedPair pair;
  bool is_rejected = false;  ///< the kernel's answer failed its certificate
};

/// The signed distance of two shapes that are no half-spaces, up to `margin` (m), in the frame of A. `scale`
/// is the size of the smaller one, m; `guess` a normal that held before, or zero. Never fails: when even the
/// native answer is refused, one of the face normals separates.
template <NarrowKernel Kernel>
CertifiedPair certified_pair(Kernel& kernel, const Shape& a, const Shape& b, const Pose& b_in_a,
                             double margin, double scale, const Vec3& guess) {
  PairCache cache{.guess = guess};
  SignedPair r = kernel.pair(a, b, b_in_a, margin, cache);
  if (certify(a, b, b_in_a, margin, scale, r) && !is_beaten(a, b, b_in_a, guess, scale, r)) return {r, false};
  r = GjkEpa{}.pair(a, b, b_in_a, margin, cache);
  if (!certify(a, b, b_in_a, margin, scale, r)) r = coarse_pair(a, b, b_in_a, guess);
  return {r, true};
}

}  // namespace delassus
