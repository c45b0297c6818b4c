/// What all types of loops have.
#pragma once

#include "laws.hpp"  // before all else

#include "program_threads.hpp"

#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/study/audit.hpp>

#include <utility>

namespace delassus_run {

/// An Audit that sleeps unless it is asked for.
struct AuditWhereAsked {
  using plays = role::Listener;
  using listens = Audit::listens;
  Audit audit;
  bool is_asked = false;

  template <class Stage>
  void after(Stage stage, const auto& loop) {
    if (is_asked) audit.after(stage, loop);
  }
};

/// An empty one of these laws and parts, and of what all types have.
template <class Laws, class... Parts>
auto loop_of(const Asked& asked, Laws laws, Parts... parts) {
  return AnimationLoop{World{RigidBodies{}}, std::move(laws), WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = asked.tolerance},
                       AuditWhereAsked{.audit = {}, .is_asked = asked.audits}, program_threads(asked.threads), std::move(parts)...};
}

}  // namespace delassus_run
