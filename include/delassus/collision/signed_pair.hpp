/// The one question a narrow-phase kernel answers: how far are two convex bodies apart, or how deep do they
/// overlap?
#pragma once

#include <delassus/geometry/support.hpp>

#include <concepts>
#include <cstdint>

namespace delassus {

/// far: farther apart than the margin · near: the distance is known, negative when the bodies overlap ·
/// failed: no answer.
enum class PairStatus : std::uint8_t { far, near, failed };

/// The minimal translation that brings two bodies into touch. In the frame of A, m.
struct SignedPair {
  PairStatus status = PairStatus::failed;
  double distance = 0;                                  ///< < 0 is the depth of penetration
  Vec3 normal = zero<Vec3>();                           ///< unit, from A to B, also when they overlap
  Vec3 point_a = zero<Vec3>(), point_b = zero<Vec3>();  ///< witnesses: b − a = distance · normal
};

namespace inner {

/// Puts the witnesses at these heights along the normal, in the middle of where they were across it.
inline void put_witnesses(double height_a, double height_b, SignedPair& r) {
  const Vec3 middle = 0.5 * (r.point_a + r.point_b), across = middle - r.normal * dot(r.normal, middle);
  r.point_a = across + height_a * r.normal;
  r.point_b = across + height_b * r.normal;
}

}  // namespace inner

/// What the engine remembers of a pair for its kernel: the last normal in the frame of A, zero when there is
/// none.
struct PairCache {
  Vec3 guess = zero<Vec3>();
};

/// A kernel answers for shapes other than half-spaces, with B posed in the frame of A. It need not be right:
/// each answer is certified, and replaced when it fails, as it is when the kernel throws. It must give the
/// same answer when asked again.
template <class K>
concept NarrowKernel = requires(K& k, const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
                                PairCache& cache) {
  { k.pair(a, b, b_in_a, margin, cache) } -> std::same_as<SignedPair>;  // signed distance up to `margin`, m
};

}  // namespace delassus
