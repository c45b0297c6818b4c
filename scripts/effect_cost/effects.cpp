// Ten boxes of 1 kg for a number of steps, with one effect more or less: DELASSUS_EFFECT is its name in the
// list below. The difference of two runs under callgrind is the instructions of a step;
// scripts/effect_cost.py makes the table.
//   effects <apart|stacked> <steps>
#include <delassus/delassus.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace delassus;

namespace {

/// Sweeps from zero every step: what warm starts save.
struct ColdStart : AcceleratedGaussSeidel {
  template <class Problem, class Workspace>
  SolveReport solve(Problem& problem, Workspace& work) const {
    problem.each([&](auto p, Index i) {
      const auto& lambda = problem.rows().template pool<p>().lambda[i];
      problem.template assign<p>(i, (0 * lambda).eval());
    });
    return AcceleratedGaussSeidel::solve(problem, work);
  }
};

constexpr double h = 0.01;
const Contact coulomb{Coulomb{.friction = 0.6}};

auto with(auto... policies) { return AnimationLoop{World{RigidBodies{}}, policies...}; }

enum Effect {
  bodies_alone,
  frictionless,
  friction,
  restitution,
  cold_start,
  soft_contact,
  position_projection,
  law_without_item,
  stopwatch,
  double_buffer,
  sleeping_awake,
  sleeping_asleep,
  newton,
  ball_joint,
  hinge,
  hinge_far_limit,
  hinge_at_limit
};

template <Effect effect>
auto make() {
  const auto sweeps = AcceleratedGaussSeidel{.tolerance = 1e-6};
  if constexpr (effect == bodies_alone)
    return with();
  else if constexpr (effect == frictionless)
    return with(Constraints{Contact{Frictionless{}}}, sweeps);
  else if constexpr (effect == friction)
    return with(Constraints{coulomb}, sweeps);
  else if constexpr (effect == restitution)
    return with(Constraints{Contact{Restitution{Coulomb{.friction = 0.6}, 0.5}}}, sweeps);
  else if constexpr (effect == cold_start)
    return with(Constraints{coulomb}, ColdStart{{.tolerance = 1e-6}});
  else if constexpr (effect == soft_contact)
    return with(Constraints{coulomb}, sweeps, SoftContact{});
  else if constexpr (effect == position_projection)
    return with(Constraints{coulomb}, sweeps, PositionProjection{});
  else if constexpr (effect == law_without_item)
    return with(Constraints{coulomb, BallJoint{}}, sweeps);
  else if constexpr (effect == stopwatch)
    return with(Constraints{coulomb}, sweeps, Stopwatch{});
  else if constexpr (effect == double_buffer)
    return with(Constraints{coulomb}, sweeps, DoubleBuffer{});
  else if constexpr (effect == sleeping_awake)
    return with(Constraints{coulomb}, sweeps, Sleeping{.after = 1e9});
  else if constexpr (effect == sleeping_asleep)
    return with(Constraints{coulomb}, sweeps, Sleeping{});
  else if constexpr (effect == newton)
    return with(Constraints{coulomb}, ProximalNewton{.tolerance = 1e-6});
  else if constexpr (effect == ball_joint)
    return with(Constraints{BallJoint{}}, sweeps);
  else if constexpr (effect == hinge)
    return with(Constraints{Hinge{}}, sweeps);
  else
    return with(Constraints{Hinge{}, Limit<Turn>{}}, sweeps);
}

/// Boxes on the ground, three metres apart or on each other; or each hanging from the world at the middle of
/// its upper face.
template <Effect effect>
void run(bool is_stacked, int steps) {
  auto loop = make<effect>();
  auto& set = bodies<RigidBodies>(loop.world());
  constexpr bool hangs = effect >= ball_joint;
  if (!hangs) set.add_fixed(HalfSpace{});
  RigidBodies::Handle last;
  for (int i = 0; i < 10; ++i) {
    last = set.add({.position = {is_stacked ? 0 : 3.0 * i, 0, is_stacked ? 0.5 + i : 0.5},
                    .mass = 1.0,
                    .shape = Box{1, 1, 1}});
    if constexpr (hangs) {
      const Quat along_y = frame_along(unit_axis(1));
      const Anchor box = anchor(set, last, {0, 0, 0.5}, along_y),
                   hook = world_anchor({3.0 * i, 0, 1}, along_y);
      if constexpr (effect == ball_joint)
        loop.add(BallJoint::Item{hook, box});
      else
        loop.add(Hinge::Item{hook, box});
      if constexpr (effect == hinge_far_limit)
        loop.add(Limit<Turn>::Item{.a = hook, .b = box, .lower = -1, .upper = 1});
      if constexpr (effect == hinge_at_limit)
        loop.add(Limit<Turn>::Item{.a = hook, .b = box, .lower = 0, .upper = 1});
    }
  }
  for (int n = 0; n < steps; ++n) loop.step(h);
  std::printf("%.9g\n", set.position(last).z());
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return 2;
  run<Effect(DELASSUS_EFFECT)>(std::string(words[1]) == "stacked", std::atoi(words[2]));
}
