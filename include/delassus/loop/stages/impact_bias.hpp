/// Bias of an impact, which takes no time.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/loop/stages/bias.hpp>

#include <algorithm>
#include <tuple>

namespace delassus {

/// d = H v + bias, and λ from zero: joints let nothing through, H v⁺ = 0; contacts that close part with
/// u⁺ ≥ −e u⁻; soft rows give no impulse. Islands without a contact are not hit: d = 0, and what their joints
/// have of H v stays.
template <class World, class Laws, class Rows, class Islands, class Bounce>
void make_impact_bias(const World& world, const Laws& laws, Rows& rows, const Islands& islands,
                      Bounce& bounce) {
  using T = typename Rows::Scalar;
  for_each_index<Laws::pool_count>([&](auto p) {
    const auto& constraints = laws.template pool<p>();
    auto& pool = rows.template pool<p>();
    using Law = std::remove_cvref_t<decltype(constraints.law)>;
    for (Index i = 0; i < pool.items(); ++i) {
      pool.lambda[i].setZero();
      pool.bias[i].setZero();
      pool.d[i] = inner::rate(
          pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
      for (int k = 0; k < Law::rows; ++k)
        if (pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0) pool.compliance[i][k] = T(1e30);
      if constexpr (ContactLaw<Law>) {
        const double e = inner::restitution_of(constraints.law, constraints.item(i));
        pool.bias[i][0] = T(e * std::min(0.0, double(pool.d[i][0])));
        if constexpr (requires { bounce.pools; }) {
          std::get<p>(bounce.pools)[i].setZero();
          std::get<p>(bounce.pools)[i][0] = pool.bias[i][0];
        }
        pool.d[i] += pool.bias[i];
      } else if constexpr (requires { bounce.pools; }) {
        std::get<p>(bounce.pools)[i].setZero();
      }
    }
  });
  for (Index k = 0; k < islands.count(); ++k) {
    bool is_hit = false;
    for_each_index<Laws::pool_count>([&](auto p) {
      using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
      if constexpr (ContactLaw<Law>) is_hit = is_hit || !islands.items(p, k).empty();
    });
    if (is_hit) continue;
    for_each_index<Laws::pool_count>([&](auto p) {
      for (const Index i : islands.items(p, k)) rows.template pool<p>().d[i].setZero();
    });
  }
}

}  // namespace delassus
