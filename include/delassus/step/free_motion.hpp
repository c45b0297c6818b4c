/// Free motion: what the bodies would do without constraints.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/body_set.hpp>

namespace delassus {

/// v_free = v + A⁻¹ p, p the integrator's impulse and A⁻¹ the set's or another `inverse`. Blocks that do not
/// move keep v.
template <class Set, class Inverse, class I>
void free_motion(Set& set, Inverse&& inverse, const I& integrator, Array<typename Set::Velocity>& p,
                 double h) {
  inverse.factor(integrator.scale(h));
  p.resize(set.blocks());
  for (auto& x : p) set_all(x, typename Set::Scalar(0));
  integrator.impulse(set, p, h);
  const auto& v = set.velocity();
  if (inner::is_coupled(set)) {
    if constexpr (requires { set.solve(p); }) {
      inverse.solve(p);
      for (const Index b : set.active()) set.v_free[b] = v[b] + p[b];
    }
  } else {
    for (const Index b : set.active()) {
      assign(set.v_free[b], v[b]);
      if (set.moves(b)) set.v_free[b] += set.template solve_block<1>(b, p[b]);
    }
  }
}

}  // namespace delassus
