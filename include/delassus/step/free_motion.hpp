/// Free motion: what the bodies would do without constraints.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/rows/body_set.hpp>

namespace delassus {

/// v_free = v + A⁻¹ p, p the integrator's impulse and A⁻¹ the set's or another `inverse`. Blocks that do not
/// move keep v. `ranges` says who does which blocks where A does not couple them.
template <class Set, class Inverse, class I, class Ranges>
void free_motion(Set& set, Inverse&& inverse, const I& integrator, Array<typename Set::Velocity>& p, double h,
                 const Ranges& ranges) {
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
    const auto& active = set.active();
    ranges(
        Index(active.size()), 128, [&](inner::Range range) __attribute__((always_inline)) {
          for (Index k = range.first; k < range.last; ++k) {
            const Index b = active[std::size_t(k)];
            assign(set.v_free[b], v[b]);
            if (set.moves(b)) set.v_free[b] += set.template solve_block<1>(b, p[b]);
          }
        });
  }
}

/// The same by one thread.
template <class Set, class Inverse, class I>
void free_motion(Set& set, Inverse&& inverse, const I& integrator, Array<typename Set::Velocity>& p,
                 double h) {
  free_motion(set, static_cast<Inverse&&>(inverse), integrator, p, h, inner::OneRange{});
}

}  // namespace delassus
