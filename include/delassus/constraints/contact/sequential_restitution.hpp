/// Restitution whose impacts go from contact to contact, as in Newton's cradle.
#pragma once

#include <delassus/constraints/contact/sequential_impacts.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/constraints/newton_impact.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>

namespace delassus {

/// Contacts that close are hit one after the other, u_n⁺ = −e u_n⁻ each, until none of them closes. Three balls that
/// touch, e = 1, the first with speed 1, end with (0, 0, 1). Under `Restitution` all are hit at once, and end with
/// (−1/3, 2/3, 2/3). Both keep momentum, and energy at e = 1. Which one a scene shows is a choice of the model: Bodies
/// that are stiff against what lies between them pass an impact on, as balls do.
///
/// The order is that of the contacts, round after round. What closes after `most_rounds` is left to the simultaneous
/// law. Joints answer after the impacts, in the solve of the step. Source: docs/references.md, [Brogliato2016],
/// chapters 5 and 6.
template <class Law = inner::Absent>
struct SequentialRestitution {
  using wraps = Law;
  static constexpr int rows = Law::rows;
  static constexpr auto kinds = Law::kinds;
  static constexpr auto refines = refine::check | refine::set_restitution;
  using overrides = inner::overrides_around_t<Law, SequentialImpacts, NewtonImpact>;

  Law law{};  ///< meets each impact, and the step after them
  double restitution = 0;  ///< e in [0, 1], where neither the pair nor the materials say otherwise
  int most_rounds = 1000;  ///< of all contacts; at least 0

  /// Of one contact: those of the law inside, and e.
  struct Parameters : Law::Parameters {
    double restitution;  ///< e
  };

  void check() const {
    inner::who_refines<refine::check>(law).check();
    inner::expect_zero_to_one("SequentialRestitution: restitution", restitution);
    inner::expect_at_least_zero("SequentialRestitution: most_rounds", most_rounds);
  }

  Parameters parameters() const { return {law.parameters(), restitution}; }
  static void set_restitution(Parameters& p, double restitution) { p.restitution = restitution; }
};

/// Around what is no contact law, as in `SequentialRestitution{0.5}`; the loop's checks say so.
template <class Law>
  requires(!inner::LawOfContact<Law>)
struct SequentialRestitution<Law> : inner::Hollow {
  using inner::Hollow::Hollow;
};

/// `SequentialRestitution{Coulomb{}, e}`.
template <class Law>
SequentialRestitution(Law, double) -> SequentialRestitution<Law>;
/// `SequentialRestitution{Coulomb{}, e, most_rounds}`.
template <class Law>
SequentialRestitution(Law, double, int) -> SequentialRestitution<Law>;
/// `SequentialRestitution{Coulomb{}}`: e is that of the materials, else 0.
template <class Law>
SequentialRestitution(Law) -> SequentialRestitution<Law>;

}  // namespace delassus
