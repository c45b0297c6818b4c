/// Why a step ended as `quarantined`: whom to look at first, in one sentence.
#pragma once

#include <delassus/bodies/inner/quarantine_record.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <string>

namespace delassus {
namespace inner {

/// The body behind a block: of a node its body and the node.
template <class Set>
std::string full_name(const Set& set, Index block) {
  if constexpr (requires { set.name(block); }) return set.name(block);
  else return set.who(block);
}

}  // namespace inner

/// Of the last step of a loop; empty when it left no body where it was. Names the first body whose force or torque was not
/// finite, else a gravity that is not, else the first body that was left. In that case a number was too large (1e308 m/s), a
/// law wrote one that is none, or no solution was found.
template <class Loop>
std::string why_quarantined(const Loop& loop) {
  const Index count = loop.report().quarantined;
  if (count == 0) return {};
  std::string loaded, pulled, first;
  loop.world().each([&](const auto& set, auto) {
    if constexpr (requires { set.quarantine_record(); }) {
      const inner::QuarantineRecord& record = set.quarantine_record();
      if (record.count == 0) return;
      if (loaded.empty() && record.loaded >= 0)
        loaded = inner::full_name(set, record.loaded) + ": the force or torque it was given for this step is not finite";
      if (pulled.empty() && !is_finite(set.gravity))
        pulled = inner::full_name(set, record.first) + ": the gravity of its set is not finite";
      if (first.empty())
        first = inner::full_name(set, record.first) + ": the step found no finite velocity for it, though loads and gravity are finite";
    }
  });
  const std::string& cause = !loaded.empty() ? loaded : !pulled.empty() ? pulled : first;
  return cause + "; " + (count == 1 ? "it" : std::to_string(count) + " bodies") + " stayed where " +
         (count == 1 ? "it was" : "they were");
}

}  // namespace delassus
