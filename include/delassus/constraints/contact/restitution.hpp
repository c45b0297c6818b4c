/// Restitution: a wrapper that gives a contact law's normal row a target velocity.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/constraints/newton_impact.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>

namespace delassus {

/// A contact that closes within the step parts with e of the speed that it has at the surface: see `rebound`. `NewtonImpact`
/// makes the bias, and keeps the impulses of each island from adding energy (`EnergyGuard`).
template <class Law = inner::Absent>
struct Restitution {
  using wraps = Law;
  static constexpr int rows = Law::rows;
  static constexpr auto kinds = Law::kinds;
  static constexpr auto refines = refine::check | refine::set_restitution;
  using overrides = inner::overrides_around_t<Law, NewtonImpact>;

  Law law{};  ///< solved, with the target velocity in b
  double restitution = 0;  ///< e in [0, 1], where neither the pair nor the materials say otherwise

  /// Of one contact: those of the law inside, and e.
  struct Parameters : Law::Parameters {
    double restitution;  ///< e
  };

  void check() const {
    inner::who_refines<refine::check>(law).check();
    inner::expect_zero_to_one("Restitution: restitution", restitution);
  }

  Parameters parameters() const { return {law.parameters(), restitution}; }
  static void set_restitution(Parameters& p, double restitution) { p.restitution = restitution; }
};

/// Around what is no contact law, as in `Restitution{0.5}`; the loop's checks say so.
template <class Law>
  requires(!inner::LawOfContact<Law>)
struct Restitution<Law> : inner::Hollow {
  using inner::Hollow::Hollow;
};

/// `Restitution{Coulomb{}, e}`.
template <class Law>
Restitution(Law, double) -> Restitution<Law>;
/// `Restitution{Coulomb{}}`: e is that of the materials, else 0.
template <class Law>
Restitution(Law) -> Restitution<Law>;

}  // namespace delassus
