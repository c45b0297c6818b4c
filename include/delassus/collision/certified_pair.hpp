/// A kernel's answer when it holds, the native kernel's when it does not.
#pragma once

#include <delassus/collision/certificate.hpp>
#include <delassus/collision/gjk_epa.hpp>
#include <delassus/collision/inner/straighten.hpp>
#include <delassus/collision/inner/two_boxes.hpp>

namespace delassus {

struct CertifiedPair {
  SignedPair pair;
  bool is_rejected = false;  ///< the kernel's answer failed its certificate
};

namespace inner {

/// What the kernel says; when it throws, a failed answer. A kernel that cannot throw costs nothing.
template <NarrowKernel Kernel>
SignedPair ask(Kernel& kernel, const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
               PairCache& cache) noexcept {
  try {
    return kernel.pair(a, b, b_in_a, margin, cache);
  } catch (...) {
    return {};
  }
}

/// A kernel whose depth is the least one, and whose distance has all its digits, says `gives_least_depth =
/// true`. Portals are not: their normal separates, but another may do so by less.
template <class Kernel>
concept GivesLeastDepth = requires {
  requires Kernel::gives_least_depth;
};

/// True when an answer that holds deserves a second opinion all the same. Of bodies apart, when the normal
/// proves less than 1 − 1e-6 of the `claimed` distance, which is a lean of 0.08°, or the gap is below 1e-5 of
/// the scale, where tolerances of others end. Of an overlap always, since the way out that portals find may
/// be the least of its neighbourhood only.
inline bool is_doubtful(double scale, double claimed, const SignedPair& r) {
  return r.status == PairStatus::near && !(r.distance >= std::max(1e-5 * scale, (1 - 1e-6) * claimed));
}

/// The kernel's answer when it is certain, else the better one of it and the native kernel's.
template <NarrowKernel Kernel>
CertifiedPair better_pair(Kernel& kernel, const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
                          double scale, const Vec3& guess) {
  PairCache cache{.guess = guess};
  const SignedPair answer = inner::ask(kernel, a, b, b_in_a, margin, cache);
  SignedPair r = answer;
  const bool holds = certify(a, b, b_in_a, margin, scale, r) && !is_beaten(a, b, b_in_a, guess, scale, r);
  if (holds && (GivesLeastDepth<Kernel> || !is_doubtful(scale, answer.distance, r))) return {r, false};
  cache.guess = guess;
  SignedPair native = GjkEpa{}.pair(a, b, b_in_a, margin, cache);
  if (!certify(a, b, b_in_a, margin, scale, native)) native = holds ? r : coarse_pair(a, b, b_in_a, guess);
  if (!holds) return {native, true};
  // Both normals separate: the one that does so by less, or proves more distance, is nearer to the truth.
  const double tolerance = 1e-3 * std::max(std::abs(r.distance), 1e-3 * scale);
  const bool is_nearer = native.status == PairStatus::far || native.distance >= r.distance;
  return {is_nearer ? native : r,
          native.status == PairStatus::near && native.distance > r.distance + tolerance};
}

}  // namespace inner

/// The signed distance of two shapes that are no half-spaces, up to `margin` (m), in the frame of A. `scale`
/// is the size of the smaller one, m; `guess` a normal that held before, or zero. Never fails: when even the
/// native answer is refused, one of the face normals separates.
template <NarrowKernel Kernel>
CertifiedPair certified_pair(Kernel& kernel, const Shape& a, const Shape& b, const Pose& b_in_a,
                             double margin, double scale, const Vec3& guess) {
  constexpr bool is_native = inner::GivesLeastDepth<Kernel>;
  CertifiedPair r{};
  if (is_native && a.kind == ShapeKind::box && b.kind == ShapeKind::box &&
      inner::two_boxes(a, b, b_in_a, margin, r.pair))
    return r;
  const CertifiedPair better = inner::better_pair(kernel, a, b, b_in_a, margin, scale, guess);
  r.pair = better.pair, r.is_rejected = better.is_rejected;
  if (r.pair.status != PairStatus::near || (is_native && has_closed_form(a, b))) return r;
  inner::Straighten{a, b, b_in_a, scale}(r.pair, is_native);
  return r;
}

}  // namespace delassus
