/// What a host calls of the loop, where it is more than a line: included by animation_loop.hpp.
#pragma once

#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/inner/look_at_start.hpp>
#include <delassus/loop/inner/step_under_way.hpp>

namespace delassus {

template <class... Args>
AnimationLoop<Args...>::AnimationLoop(Args... policies) : Data(typename Data::Policies::Held(static_cast<Args&&>(policies)...)) {
  if constexpr (is_sound) check_policies();
}

template <class... Args>
void AnimationLoop<Args...>::memory(auto& archive) {
  archive(world(), this->h, this->last_h, this->start, this->steps);
  this->states.template memory<false>(archive);
  each_kept_pool(laws(), [&](auto, auto& pool) {
    archive(pool);
    if (archive.reads) inner::adopt(world(), pool);
  });
  if constexpr (has_constraints) {
    archive(this->contact_cache, this->material_pairs);
    this->states.template memory<true>(archive);  // it names constraints
    inner::memory_if_any(this->solver_workspace, archive);
    if constexpr (Laws::has_contacts) inner::remember(Data::collision(), archive);
    forget_rows();
  }
}

template <class... Args>
void AnimationLoop<Args...>::check_policies() const {
  this->policies.each_with_defaults([](const auto& part) __attribute__((always_inline)) { inner::check_if_it_can(part); });
  each_pool(laws(), [&](auto, const auto& pool) { inner::check_if_it_can(pool.law); });
}

template <class... Args>
StepReport AnimationLoop<Args...>::step(double seconds) {
  if constexpr (is_sound)
    if constexpr (inner::scheme_runs<typename Data::Policies::Scheme, Data>()) {
      check_policies();  // their numbers may have been edited since
      const bool is_first = this->last_h == 0;
      const inner::StepUnderWay running(world(), this->is_under_way);
      stage::begin(data(), seconds);
      if (is_first && !Laws::has_contacts) [[unlikely]] inner::look_for_overlaps(data());
      Data::scheme().run(data());
      if (is_first) [[unlikely]] inner::look_at_joints(data());
      inner::notify<stage::Step>(data());
    }
  return report();
}

template <class... Args>
template <class Item>
auto AnimationLoop<Args...>::add(Item item) {
  return inner::add_constraint<is_sound>(world(), laws(), this->is_under_way, item);
}

}  // namespace delassus
