/// What outlives a step, set aside and brought back: for schemes that repeat a step.
#pragma once

#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/archive.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/step/step_report.hpp>

#include <cstddef>
#include <type_traits>

namespace delassus::inner {

/// An archive of what a step changes, which shapes and meshes are not.
template <class Archive>
struct ArchiveOfStep {
  static constexpr bool reads = Archive::reads;
  static constexpr bool leaves_shapes = true;
  Archive& whole;

  template <class... X>
  void operator()(X&... x) {
    (inner::walk(*this, x), ...);
  }
  void bytes(auto* at, std::size_t count) { whole.bytes(at, count); }
  void size(auto& list) { whole.size(list); }
};

/// All that `AnimationLoop::memory` names, but for the state of the scheme, which says itself what of it is repeated, and for
/// materials, shapes and meshes, which no step changes. Room is made once.
class StepCopy {
 public:
  void keep(auto& step) {
    kept_.data.clear();
    ArchiveOfStep<ArchiveWriter> of_step{kept_};
    walk(step, of_step);
    last_report_ = step.summary;
  }
  void bring_back(auto& step) const {
    ArchiveReader reader(kept_.data);
    ArchiveOfStep<ArchiveReader> of_step{reader};
    walk(step, of_step);
    step.summary = last_report_;
  }

  std::size_t bytes() const { return kept_.data.size(); }

 private:
  static void walk(auto& step, auto& archive) {
    using Step = std::remove_reference_t<decltype(step)>;
    archive(step.world(), step.h, step.last_h, step.start, step.steps);
    step.states.template memory<false>(archive);
    each_kept_pool(step.laws(), [&](auto, auto& pool) { archive(pool); });
    if constexpr (Step::has_constraints) {
      archive(step.contact_cache);
      step.states.template memory<true>(archive);
      memory_if_any(step.solver_workspace, archive);
      if constexpr (Step::Laws::has_contacts) remember(step.collision(), archive);
    }
  }

  ArchiveWriter kept_;
  StepReport last_report_;
};

}  // namespace delassus::inner
