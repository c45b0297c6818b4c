/// Coulomb's law for several contacts at once, one a lane: what `Coulomb` and `cone.hpp` do for one.
#pragma once

#include <delassus/constraints/contact/cone.hpp>
#include <delassus/math/lane_masks.hpp>
#include <delassus/math/lanes.hpp>

#include <limits>

namespace delassus::inner {

/// What `Coulomb::prepare` made of W that a slip asks for.
struct SlipLanes {
  Lanes schur[4], to_normal[2], from_normal[2], over_normal, alpha, friction;
};

[[gnu::always_inline]] inline Lanes square_of_two(const Lanes& a, const Lanes& b) { return a * a + b * b; }
[[gnu::always_inline]] inline LaneVector choose(const LaneMask& is, const LaneVector& a,
                                                const LaneVector& b) {
  return {{is ? a[0] : b[0], is ? a[1] : b[1], is ? a[2] : b[2]}};
}
[[gnu::always_inline]] inline LaneVector minus(const LaneVector& a, const LaneVector& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}

[[gnu::always_inline]] inline LaneMask is_in_cone(const LaneVector& x, const Lanes& friction) {
  const Lanes limit = friction * x[0];
  return (x[0] >= all_lanes(0)) & (square_of_two(x[1], x[2]) <= limit * limit);
}

/// `project_on_cone`.
inline LaneVector project_lanes_on_cone(const LaneVector& x, const Lanes& friction) {
  const Lanes zero = all_lanes(0), tangential = root_of(square_of_two(x[1], x[2]));
  const Lanes normal = (x[0] + friction * tangential) / (1 + friction * friction);
  const Lanes scale = friction * normal / tangential;
  const LaneVector nothing{{zero, zero, zero}}, on_it{{normal, scale * x[1], scale * x[2]}};
  return choose(is_in_cone(x, friction), x, choose(friction * tangential <= -x[0], nothing, on_it));
}

/// `Coulomb::slip` by the same iteration. `of.alpha` is the last root, and becomes this one.
inline LaneVector slip_of(const LaneVector& b, SlipLanes& of) {
  constexpr double eps = std::numeric_limits<double>::epsilon(), tolerance = 16 * eps, near = 3e-6;
  const Lanes zero = all_lanes(0), infinite = all_lanes(std::numeric_limits<double>::infinity());
  const Lanes *S = of.schur, *k = of.to_normal, mu = of.friction;
  const Lanes bn = b[0] * of.over_normal;
  const Lanes c1 = b[1] - of.from_normal[0] * b[0], c2 = b[2] - of.from_normal[1] * b[0];
  const Lanes a1 = S[3] * c1 - S[2] * c2, a2 = S[0] * c2 - S[1] * c1;
  const Lanes trace = S[0] + S[3], determinant = S[0] * S[3] - S[2] * S[1];
  const Lanes across = mu * (k[0] * c1 + k[1] * c2);
  const Lanes p2 = -mu * bn, p1 = p2 * trace + across, p0 = p2 * determinant + mu * (k[0] * a1 + k[1] * a2);
  const Lanes q2 = square_of_two(c1, c2), q1 = 2 * (a1 * c1 + a2 * c2), q0 = square_of_two(a1, a2);
  const LaneMask has_friction = mu != zero;
  Lanes low = zero, high = infinite, here = of.alpha;
  LaneMask goes_on = has_friction;
  if (any_lane(goes_on & (here == zero))) {
    const Lanes start = (root_of(q2) - across) / p2 - trace + 0.5 * q1 / q2;
    here = ((here == zero) & (start > zero) & (start < infinite)) ? start : here;
  }
  for (int iteration = 0; iteration < 60 && any_lane(goes_on); ++iteration) {
    const Lanes P = (p2 * here + p1) * here + p0, dP = 2 * p2 * here + p1;
    const Lanes Q = (q2 * here + q1) * here + q0, dQ = 2 * q2 * here + q1;
    const Lanes root = root_of(Q), over = 1 / Q, gap = P - root, miss = size_of(gap);
    goes_on &= ~((miss <= tolerance * root) | (high - low <= tolerance * here));
    if (!any_lane(goes_on)) break;
    low = gap < zero ? here : low;  // of a lane that is done nobody asks again
    high = gap < zero ? high : here;
    const Lanes slope = dP - 0.5 * P * dQ * over;
    const Lanes bend = 2 * p2 - over * (dP * dQ + P * (q2 - 0.75 * dQ * dQ * over));
    const Lanes step = here - gap * slope / (slope * slope - 0.5 * gap * bend);
    const LaneMask is_inside = (slope > zero) & (step > low) & (step < high);
    const Lanes beyond = high < infinite ? 0.5 * (low + high) : larger_lanes(4 * here, 0.05 * trace);
    const Lanes next = is_inside ? step : beyond;
    const LaneMask is_last = (next == here) | (is_inside & (miss <= near * root));
    here = goes_on ? next : here;
    goes_on &= ~is_last;
  }
  of.alpha = has_friction ? here : of.alpha;
  const Lanes over = 1 / ((here + trace) * here + determinant);
  const Lanes x1 = -(a1 + here * c1) * over, x2 = -(a2 + here * c2) * over;
  const Lanes normal = -(bn + k[0] * x1 + k[1] * x2), length = root_of(square_of_two(x1, x2));
  const Lanes scale = mu * normal / length;
  const LaneMask is_sound = (normal > zero) & (length > zero);
  const LaneVector on_cone{{normal, scale * x1, scale * x2}},
      straight{{normal < zero ? zero : normal, zero, zero}};
  return choose(has_friction, choose(is_sound, on_cone, straight), {{-bn, zero, zero}});
}

/// `coulomb_natural_map`.
inline LaneVector natural_map_of(const LaneVector& lambda, const LaneVector& u, const Lanes& friction,
                                 const Lanes& scale) {
  const Lanes zero = all_lanes(0);
  const LaneMask is_open = (lambda[0] == zero) & (u[0] >= zero) & (lambda[1] == zero) & (lambda[2] == zero);
  const LaneVector modified{{u[0] + friction * root_of(square_of_two(u[1], u[2])), u[1], u[2]}};
  const LaneVector x = times(scale, lambda), y = minus(x, modified);
  const LaneVector otherwise =
      choose(is_in_cone(y, friction), modified, minus(x, project_lanes_on_cone(y, friction)));
  return choose(is_open, lambda, otherwise);
}

/// `Coulomb::projection_step`. `W` has lanes of the contacts' own blocks, by columns.
inline LaneVector projection_step_of(const double* W, const LaneVector& lambda, const LaneVector& u,
                                     const Lanes& friction) {
  const auto entry = [W](int row, int column) { return load_lanes(W + (3 * column + row) * lane_count); };
  const Lanes zero = all_lanes(0), w01 = entry(0, 1), w02 = entry(0, 2);
  Lanes normal = entry(0, 0), tangential = larger_lanes(entry(1, 1), entry(2, 2)) + size_of(entry(1, 2));
  const Lanes more = 1 + root_of(square_of_two(w01, w02) / (normal * tangential));
  normal *= more, tangential *= more;
  const Lanes z = normal * lambda[0] - u[0] - friction * root_of(square_of_two(u[1], u[2]));
  const Lanes y1 = lambda[1] - u[1] / tangential, y2 = lambda[2] - u[2] / tangential;
  const Lanes square = square_of_two(y1, y2), limit = friction * z, size = root_of(square);
  const LaneMask is_in = (z >= zero) & (normal * normal * square <= limit * limit);
  const Lanes pushed = friction * tangential * size;
  const Lanes n = (z + pushed) / (normal + friction * friction * tangential);
  const Lanes share = size > zero ? friction * n / size : zero;
  const LaneVector nothing{{zero, zero, zero}}, on_it{{n, share * y1, share * y2}};
  return choose(is_in, {{z / normal, y1, y2}}, choose(pushed > -z, on_it, nothing));
}

}  // namespace delassus::inner
