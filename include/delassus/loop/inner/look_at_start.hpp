/// What is odd at the start of a scene: the first step of a loop looks for it and says it in its report.
#pragma once

#include <delassus/loop/inner/solids.hpp>

#include <algorithm>

namespace delassus::inner {

/// Two rigid bodies or particles whose shapes overlap, in the order of the sets and blocks of the world.
template <class Step>
[[gnu::cold, gnu::noinline]] SolidPair find_overlap(const Step& step) {
  Overlaps<Solid> overlaps;
  step.world().each([&](const auto& set, auto s) {
    if constexpr (requires { set.never_moves(0); })
      for (const Index b : set.active())
        if (set.has_collider(b))
          overlaps.add(set.shape(b), set.pose(b), set.group(b), set.collides_with(b), Index(s), b, !set.never_moves(b));
  });
  for (;;) {
    const SolidPair pair = overlaps.next();
    bool are_joined = false;
    step.each_joint([&](const auto& x, const auto& y) {
      const auto is_on = [](const auto& end, Index set, Index block) { return end.set == set && end.block == block; };
      are_joined = are_joined || (is_on(x, pair.set_a, pair.block_a) && is_on(y, pair.set_b, pair.block_b)) ||
                   (is_on(x, pair.set_b, pair.block_b) && is_on(y, pair.set_a, pair.block_a));
    });
    if (!are_joined || !pair) return pair;
  }
}

/// The longest arm of a joint, from the centre of a body to its end, m; of ends in the centres, the way between these.
template <class Step>
double longest_arm(const Step& step) {
  double longest = 0;
  step.each_joint([&](const auto& a, const auto& b) {
    const auto centre = [&](const auto& end) {
      Vec3 x = step.world().point(end);
      step.world().visit(end.set, [&](const auto& set, auto) { x = set.pose(end.block).position; });
      return x;
    };
    const Vec3 x = centre(a), y = centre(b);
    const double arms = norm(Vec3(step.world().point(a) - x)) + norm(Vec3(step.world().point(b) - y));
    longest = std::max(longest, arms > 0 ? arms : norm(Vec3(x - y)));
  });
  return longest;
}

/// Says in the report of the first step, before the bodies move, whether shapes overlap that nothing keeps apart.
template <class Step>
[[gnu::cold, gnu::noinline]] void look_for_overlaps(Step& step) {
  if constexpr (!Step::Laws::has_contacts) step.summary.overlaps_unseen = bool(find_overlap(step));
}
/// The same of joints whose ends are apart by more than a tenth of the longest arm, when the step has linearised them.
template <class Step>
[[gnu::cold, gnu::noinline]] void look_at_joints(Step& step) {
  if constexpr (Step::has_constraints)
    if (step.summary.max_joint_violation > 1e-6)
      step.summary.starts_apart = step.summary.max_joint_violation > 0.1 * longest_arm(step);
}

}  // namespace delassus::inner
