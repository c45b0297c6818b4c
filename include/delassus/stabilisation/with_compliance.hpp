/// A floor under the compliance of every row: what is rigid yields a little, by a number in m/N.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <concepts>

namespace delassus {

/// `WithCompliance{Baumgarte{}, 1e-7}`: A joint or contact under the force f comes to rest with φ = −C f, C in m/N
/// (rad/(N·m) of a row of angles). With the bias β φ/h that the stabilisation gives, that is
///
///   u + β φ/h + R λ = 0,   R = β C/h²,   f = λ/h.
///
/// Then no λ is infinite. Rows that contradict each other share what is missing like springs, λ is unique where constraints
/// are redundant, and a body's depth of rest does not depend on h.
///
/// Friction rows stay rigid, for a compliance on them would creep; springs of their own rows too. A stabilisation without a
/// rate of its own (`PositionProjection`, which sees no φ in the velocity solve) has β = 0, and nothing yields.
template <class S = inner::Absent>
struct WithCompliance {
  using plays = role::Stabilisation;
  static constexpr unsigned layers = inner::layers_of<S> | inner::layer::compliance;
  // Of a stabilisation that overrides stages, see `PositionProjection`.
  template <class Base, class Inside = S>
  using stages = typename Inside::template stages<Base>;
  template <class P, class Inside = S>
  using State = typename Inside::template State<P>;
  S stabilisation{};  ///< whose rates are kept
  double least = 0;  ///< C, m/N

  void check() const {
    stabilisation.check();
    inner::expect_not_negative("WithCompliance: compliance", least, "m/N");
  }
  double equality(double phi, double h) const { return stabilisation.equality(phi, h); }
  double penetration(double phi, double h) const { return stabilisation.penetration(phi, h); }
  double relative_compliance(double h) const requires requires { stabilisation.relative_compliance(h); }
  { return stabilisation.relative_compliance(h); }
  /// Of the stabilisation inside, where it corrects positions.
  double push(double phi, double h) const requires requires { stabilisation.push(phi, h); }
  { return stabilisation.push(phi, h); }
  /// Likewise.
  double close(double phi, double h) const requires requires { stabilisation.close(phi, h); }
  { return stabilisation.close(phi, h); }
  /// R of an equality, 1/kg.
  double joint_compliance(double h) const { return equality(near, h) / near * least / h; }
  /// R of a lower or upper row, 1/kg.
  double contact_compliance(double h) const { return penetration(-near, h) / -near * least / h; }

  static constexpr double near = 1e-9;  ///< m, where no recovery is capped
};

/// Around what is no stabilisation, as in `WithCompliance{1e-7}`, or has a compliance; the loop's checks say so.
template <class S>
  requires(!(Stabilisation<S> && inner::Fills<S, role::Stabilisation, inner::layer::compliance>))
struct WithCompliance<S> : inner::Hollow {
  using plays = role::Stabilisation;
  using inner::Hollow::Hollow;
};

/// `WithCompliance{Baumgarte{}}`: C = 0.
template <class S>
WithCompliance(S) -> WithCompliance<S>;
/// `WithCompliance{Baumgarte{}, C}`.
template <class S>
WithCompliance(S, double) -> WithCompliance<S>;
static_assert(Stabilisation<WithCompliance<Baumgarte>>);

}  // namespace delassus
