/// The implicit midpoint rule, one Newton step, constraints linearised at the guess q + h v/2.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/integrators/inner/midpoint_stages.hpp>
#include <delassus/integrators/integrator.hpp>

namespace delassus {

/// (M + h/2 D + h²/4 K) (v⁺ − v) = h (f − h/2 K v),  q⁺ = q ⊕ h (v + v⁺)/2. Second order where K = −∂f/∂q; first order
/// where a set leaves terms out of K to keep A definite, as pressed and damped springs do. Keeps quadratic invariants of
/// linear forces. Bilateral rows hold for the mean velocity, H taken at q ⊕ h v/2, and what v has
/// across them fades by a tenth a step. Contacts are detected there too, unless bodies are soft, and what rolls is of second order
/// (`turn_contacts`). Rigid bodies that all these hold turn by that mean, gyroscopic term included, however slender they are: see
/// `inner::HeldTurn`.
struct ImplicitMidpoint {
  using plays = role::Integrator;
  static constexpr int order = 2;  ///< read by `ErrorControlled`
  using each_block_alone = ImplicitMidpoint;
  static constexpr double theta = 0.5;  ///< share of v⁺ in the velocity that moves q
  static constexpr bool takes_middle_contacts = true;  ///< read by the step: contacts of what is not soft are seen in the middle too
  /// Solves of a step with contacts, at least 1: each after the first takes the middle that the mean velocity of the last one leads to.
  int looks = 1;

  void check() const { inner::expect_at_least_one("ImplicitMidpoint: looks", looks); }
  template <class Base>
  using stages = inner::MidpointStages<Base>;
  template <class P>
    requires(P::Laws::pool_count > 0)
  using State = inner::MidpointState<P>;

  SystemScale scale(double h) const { return {.mass = 1, .damping = h / 2, .stiffness = h * h / 4}; }
  /// p ← h (f − h/2 K v), N·s.
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    if constexpr (requires { set.add_stiffness_times_velocity(p, h); }) set.add_stiffness_times_velocity(p, h / 2);
    times(p, h);
  }
  void advance(auto& set, double h) const { set.advance_midpoint(h); }
};
static_assert(Integrator<ImplicitMidpoint>);

}  // namespace delassus
