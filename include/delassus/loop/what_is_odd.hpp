/// What the first step of a loop found odd, in words.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/loop/inner/look_at_start.hpp>
#include <delassus/loop/why_quarantined.hpp>
#include <delassus/step/step_report.hpp>

#include <string>

namespace delassus {

/// After the first step of a loop; empty where nothing was odd, and after any other step. It may be meant: the step was made.
template <class Loop>
std::string what_is_odd(const Loop& loop) {
  const auto& step = loop.data();
  const StepReport& report = step.report();
  std::string said;
  if (report.starts_apart)
    said = "the ends of a joint are " + inner::text(report.max_joint_violation) +
           " m (or rad) apart at the start, and the steps pull them together; place the bodies so that its anchors meet";
  if constexpr (!Loop::Data::Laws::has_contacts)
    if (report.overlaps_unseen) {
      const inner::SolidPair pair = inner::find_overlap(step);  // the step may have parted them
      const auto who = [&](Index set, Index block) {
        std::string name;
        loop.world().visit(set, [&](const auto& of, auto) { name = inner::full_name(of, block); });
        return name;
      };
      said += (said.empty() ? "" : "; ") +
              (pair ? who(pair.set_a, pair.block_a) + " and " + who(pair.set_b, pair.block_b) + " overlap" : std::string("shapes overlapped")) +
              ", and no contact law keeps them apart; name Contact{...} in Constraints{...}, or give them groups that do not meet";
    }
  return said;
}

}  // namespace delassus
