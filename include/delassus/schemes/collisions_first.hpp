/// The order of the stages in which contacts may push during the free motion.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/schemes/inner/push_apart.hpp>
#include <delassus/step/plain_step.hpp>

#include <type_traits>

namespace delassus {

/// Detect, let penalty contacts push, then the plain order. With an explicit integrator (A = M) a `Penalty` contact acts
/// as a force of the free motion and has no row; with an implicit one it stays a row, the spring of implicit Euler.
struct CollisionsFirst {
  using plays = role::Scheme;

  /// Contacts that pushed before the free motion cannot push again in a second solve.
  template <class Base>
  struct stages : Base {
    static constexpr bool looks_ahead = false;  ///< no pair is left out that may meet
  };

  void run(auto& step) const {
    stage::detect(step);
    if constexpr (std::remove_reference_t<decltype(step)>::Laws::has_contacts) {
      const SystemScale A = step.integrator().scale(step.h);
      if (A.stiffness == 0 && A.damping == 0) push_apart(step.world(), step.laws(), step.contact_cache, step.h);
    }
    stage::move(step);
  }
};

}  // namespace delassus
