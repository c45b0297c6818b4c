/// The area in which two faces touch: its size, its middle, and how far from there it lies on average.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/math/linear.hpp>

namespace delassus {

/// Under even pressure friction brakes a spin about `middle` with the moment μ λ_n `mean_distance`. All zero: not known, or
/// none.
struct ContactArea {
  double size = 0;             ///< ∫ dA, m²
  Vec3 middle = zero<Vec3>();  ///< ∫ x dA / ∫ dA, m
  double mean_distance = 0;    ///< ∫ |x − middle| dA / ∫ dA, m
};

namespace inner {

/// A round face: rim and middle.
struct RoundFace {
  Vec3 middle = zero<Vec3>();
  double radius = 0;  ///< m; 0: the face is not round

  bool has_on_rim(const Vec3& p) const { return std::abs(norm(p - middle) - radius) <= 1e-5 * radius; }
  /// Whether the side from p to q cuts off no more of the disc than that of an octagon does.
  bool has_chord(const Vec3& p, const Vec3& q) const {
    return radius > 0 && squared_norm(q - p) <= 0.6 * radius * radius && has_on_rim(p) && has_on_rim(q);
  }
};

/// Integrals over a polygon in a plane with the unit normal n, side by side. Each side p to q adds
/// the triangle from `from`, or takes it away.
class AreaSum {
 public:
  AreaSum(const Vec3& n, const Vec3& from) : n_(n), from_(from) {}

  void add_size(const Vec3& p, const Vec3& q, double sign = 1) {
    const double twice = sign * dot(n_, cross(p - from_, q - from_));
    size_ += 0.5 * twice;
    moment_ += twice / 6 * (p + q - 2 * from_);
  }
  /// ∫ |x| dA = ∫ ρ³/3 dφ = h/6 [s ρ + h² ln(s + ρ)], the side at the distance h, s along it, ρ² = h² + s².
  void add_distance(const Vec3& p, const Vec3& q, double sign = 1) {
    const Vec3 along = q - p, to_p = p - from_;
    const double length = norm(along);
    if (!(length > 0)) return;
    const double h = dot(n_, cross(to_p, along)) / length, s = dot(to_p, along) / length, t = s + length;
    const double at_s = std::sqrt(h * h + s * s), at_t = std::sqrt(h * h + t * t);
    if (!(std::abs(h) > 1e-9 * length)) return;  // the triangle is none
    // Of x + ρ, x < 0, nothing is left beside a small h: h²/(ρ − x) is the same.
    const auto sum = [&](double x, double rho) { return -x > 1e3 * std::abs(h) ? h * h / (rho - x) : x + rho; };
    distance_ += sign * h / 6 * (t * at_t - s * at_s + h * h * std::log(sum(t, at_t) / sum(s, at_s)));
  }
  double size() const { return size_; }
  Vec3 middle() const { return from_ + moment_ / size_; }
  double distance() const { return distance_; }

 private:
  Vec3 n_, from_, moment_ = zero<Vec3>();
  double size_ = 0, distance_ = 0;
};

/// Whether all sides of the polygon are chords of the round face.
template <class At>
bool is_whole(int count, const At& corner, const RoundFace& round) {
  for (int k = 0; k < count; ++k)
    if (!round.has_chord(corner(k), corner(k + 1 < count ? k + 1 : 0))) return false;
  return true;
}
inline ContactArea disc(const RoundFace& round) {
  return {3.14159265358979323846 * round.radius * round.radius, round.middle, 2 * round.radius / 3};
}

/// f(p, q) for every side of a polygon; a chord of a round face as four sides between points of its rim.
template <class At, class F>
void each_side(int count, const At& corner, const RoundFace& first, const RoundFace& second, const F& f) {
  for (int k = 0; k < count; ++k) {
    const Vec3 &p = corner(k), &q = corner(k + 1 < count ? k + 1 : 0);
    const RoundFace& round = first.has_chord(p, q) ? first : second;
    if (!round.has_chord(p, q)) {
      f(p, q);
      continue;
    }
    Vec3 last = p;
    for (int i = 1; i <= 4; ++i) {
      const Vec3 on = p + 0.25 * i * (q - p) - round.middle, next = i == 4 ? q : Vec3(round.middle + on * (round.radius / norm(on)));
      f(last, next);
      last = next;
    }
  }
}

/// Of the convex polygon with the corners `corner(0)` … `corner(count − 1)` in order, seen along the unit vector n. Sides
/// that are chords of a round face stand for its rim.
template <class At>
ContactArea area_of(int count, const At& corner, const Vec3& n, const RoundFace& first = {}, const RoundFace& second = {}) {
  if (count < 3) return {};
  if (is_whole(count, corner, first)) return disc(first);
  if (is_whole(count, corner, second)) return disc(second);
  AreaSum sizes(n, corner(0));
  each_side(count, corner, first, second, [&](const Vec3& p, const Vec3& q) { sizes.add_size(p, q); });
  if (!(std::abs(sizes.size()) > 0)) return {};
  const Vec3 middle = sizes.middle();
  AreaSum distances(n, middle);
  each_side(count, corner, first, second, [&](const Vec3& p, const Vec3& q) { distances.add_distance(p, q); });
  return {std::abs(sizes.size()), middle, distances.distance() / sizes.size()};
}

}  // namespace inner
}  // namespace delassus
