/// Which way two bodies part whose centres are one point.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>

#include <cstdint>

namespace delassus::inner {

/// A place in the unit cube for a body of this key: the additive recurrence of the root φ of φ⁴ = φ + 1,
///
///   x_k = key φ⁻ᵏ mod 1,   k = 1, 2, 3.
///
/// The places of n keys in a row stay some n^(−1/3) apart. Source: [Roberts2018].
inline Vec3 place_of_key(std::uint32_t key) {
  constexpr double phi = 1.2207440846057596;
  Vec3 place;
  for (double k = key, *x = place.data(); x != place.data() + 3; ++x) {
    k /= phi;
    *x = k - std::floor(k);
  }
  return place;
}

/// From A to B, as if both were moved apart a little, each to a place of its own: then many bodies in one point
/// part in all directions, by normals that do not contradict each other, for v = s · place with s large enough
/// meets all. One direction for all would make a row of n, whose ends part n times as fast as neighbours.
inline Vec3 fallback_normal(std::uint32_t a, std::uint32_t b) { return place_of_key(b) - place_of_key(a); }

}  // namespace delassus::inner
