/// Penalty contact: a spring and a damper along the normal in place of a rigid surface.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/soft.hpp>

#include <algorithm>
#include <concepts>

namespace delassus {

/// Which velocity a penalty contact sees: the one after the step, or the mean ū of those before and after it.
struct AtEnd {};
/// See `AtEnd`: the mean ū.
struct AtMean {};
/// When a penalty contact looks at the velocity.
template <class W>
concept SpringTime = std::same_as<W, AtEnd> || std::same_as<W, AtMean>;

/// `Contact{Penalty{Coulomb{.friction = 0.5}, 1e5, 50}}`: stiffness k (N/m) and damping c (N·s/m) of each contact point, where its
/// materials have no others,
///
///   f_n = max(0, k δ − c u_n),  δ = −gap,   with the friction of `Law` on top.
///
/// As rows the spring is implicit Euler's, λ_n = max(0, h (k (δ − h u_n) − c u_n)) at the velocity after the step.
/// It is stable for every k and h, and never a source of energy. Under the scheme `CollisionsFirst` with an explicit
/// integrator it is a force of the free motion at the start of the step, with no row and no solve. There it is stable
/// for h √(k/m) < 2 only.
///
/// `Penalty{Coulomb{.friction = 0.5}, 1e5, 50, AtMean{}}` has λ_n = max(0, h (k (δ − h ū/2) − c ū)) instead, the midpoint
/// rule's, under `ImplicitMidpoint` only. It is of second order, where the other is of first and damps. The damper, whose
/// force jumps at the touch, leaves first order to the touch. For springs that the step resolves, h √(k/m) ≤ ½: What is
/// first seen h v deep is given the energy of that, (h √(k/m))² of the impact's.
template <class Law = inner::Absent, SpringTime When = AtEnd>
struct Penalty {
  using wraps = Law;
  static constexpr bool takes_mean = std::same_as<When, AtMean>;  ///< read by the loop, which then gives the rows of the midpoint rule
  static constexpr int rows = Law::rows;
  static constexpr auto kinds = Law::kinds;
  static constexpr auto refines = refine::check | refine::soften;
  using overrides = typename inner::overrides_of<Law>::type;

  Law law{};  ///< gives the friction
  double stiffness = 0;  ///< k > 0, N/m
  double damping = 0;    ///< c ≥ 0, N·s/m
  [[no_unique_address]] When when{};  ///< `AtEnd` or `AtMean`

  /// Of one contact: its materials may have others.
  struct Parameters : Law::Parameters {
    double stiffness;  ///< k, N/m
    double damping;    ///< c, N·s/m
  };

  void check() const {
    inner::who_refines<refine::check>(law).check();
    inner::expect_positive("Penalty: stiffness", stiffness, "N/m");
    inner::expect_not_negative("Penalty: damping", damping, "N·s/m");
    inner::check_soft_number(stiffness, "Penalty: stiffness", "N/m");
    inner::check_soft_number(damping, "Penalty: damping", "N·s/m");
  }

  Parameters parameters() const { return {law.parameters(), stiffness, damping}; }

  /// The normal row becomes a spring. The damper waits until the bodies touch.
  void soften(const Parameters& p, auto& row, double gap) const { row.soft(0, p.stiffness, gap < 0 ? p.damping : 0.0); }

  /// The force (N, in the contact's frame) at gap and relative velocity u. Friction never turns the slip round within h:
  /// |f_t| ≤ min(μ f_n, |u_t| / (h w)), w the inverse mass that the bodies show along the slip, 1/kg.
  Vec<rows> force(const Parameters& p, double gap, const Vec<rows>& u, double w, double h) const {
    Vec<rows> f = Vec<rows>::Zero();
    if (gap >= 0) return f;
    f[0] = std::max(0.0, -p.stiffness * gap - p.damping * u[0]);
    if constexpr (rows == 3) {
      const double slip = std::hypot(u[1], u[2]);
      if (slip > 0 && w > 0) {
        const double size = std::min(p.friction * f[0], slip / (h * w));
        f[1] = -size * u[1] / slip;
        f[2] = -size * u[2] / slip;
      }
    }
    return f;
  }
};

/// Around what is no contact law, as in `Penalty{1e5, 50}`; the loop's checks say so.
template <class Law, SpringTime When>
  requires(!inner::LawOfContact<Law>)
struct Penalty<Law, When> : inner::Hollow {
  using inner::Hollow::Hollow;
};

/// `Penalty{Coulomb{}, k}` has no damper.
template <class Law>
Penalty(Law, double) -> Penalty<Law>;
/// Without numbers: refused by `check`, as k must be > 0.
template <class Law>
Penalty(Law) -> Penalty<Law>;
/// `Penalty{Coulomb{}, k, c}`.
template <class Law>
Penalty(Law, double, double) -> Penalty<Law>;
/// `Penalty{Coulomb{}, k, c, AtMean{}}`.
template <class Law, SpringTime When>
Penalty(Law, double, double, When) -> Penalty<Law, When>;

}  // namespace delassus
