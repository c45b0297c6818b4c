/// Functions that a part may have: called where it has them.
#pragma once

#include <delassus/core/index.hpp>

namespace delassus::inner {

[[gnu::always_inline]] inline void check_if_it_can(const auto& part) {
  if constexpr (requires { part.check(); }) part.check();
}
/// What outlives a step.
[[gnu::always_inline]] inline void memory_if_any(auto& part, auto& archive) {
  if constexpr (requires { part.memory(archive); }) part.memory(archive);
}
/// Once a step, before its first solve.
[[gnu::always_inline]] inline void begin_step_if_it_can(auto& workspace) {
  if constexpr (requires { workspace.begin_step(); }) workspace.begin_step();
}
/// Room for so many rows.
[[gnu::always_inline]] inline void reset_if_it_can(auto& workspace, Index rows) {
  if constexpr (requires { workspace.reset(rows); }) workspace.reset(rows);
}

}  // namespace delassus::inner
