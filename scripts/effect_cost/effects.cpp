// Ten boxes of 1 kg for a number of steps, with one effect more or less: DELASSUS_EFFECT is its name in the
// list below. The difference of two runs under callgrind is the instructions of a step;
// scripts/effect_cost.py makes the table.
//   effects <apart|stacked> <one|other> <steps>       the other: asleep for awake, at the limit for far from
//                                                     it, what is recorded or published for what is not
#include <delassus/delassus.hpp>
#include <delassus/haptics/haptic_channel.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/solvers/proximal_newton.hpp>

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

/// The effect only makes a loop that is not asked for uninstantiated.
template <int effect>
auto with(auto... policies) {
  return AnimationLoop{World{RigidBodies{}}, policies...};
}

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
  sleeping,
  newton,
  penalty,
  prediction,
  substeps,
  recorder,
  coupling,
  haptics,
  ball_joint,
  hinge,
  hinge_limit,
  hinge_motor
};

template <Effect effect>
auto make([[maybe_unused]] bool is_other) {
  const auto sweeps = AcceleratedGaussSeidel{.tolerance = 1e-6};
  if constexpr (effect == bodies_alone)
    return with<effect>();
  else if constexpr (effect == frictionless)
    return with<effect>(Constraints{Contact{Frictionless{}}}, sweeps);
  else if constexpr (effect == friction)
    return with<effect>(Constraints{coulomb}, sweeps);
  else if constexpr (effect == restitution)
    return with<effect>(Constraints{Contact{Restitution{Coulomb{.friction = 0.6}, 0.5}}}, sweeps);
  else if constexpr (effect == cold_start)
    return with<effect>(Constraints{coulomb}, ColdStart{{.tolerance = 1e-6}});
  else if constexpr (effect == soft_contact)
    return with<effect>(Constraints{coulomb}, sweeps, SoftContact{});
  else if constexpr (effect == position_projection)
    return with<effect>(Constraints{coulomb}, sweeps, PositionProjection{});
  else if constexpr (effect == law_without_item)
    return with<effect>(Constraints{coulomb, BallJoint{}}, sweeps);
  else if constexpr (effect == stopwatch)
    return with<effect>(Constraints{coulomb}, sweeps, Stopwatch{});
  else if constexpr (effect == double_buffer)
    return with<effect>(Constraints{coulomb}, sweeps, DoubleBuffer{});
  else if constexpr (effect == sleeping)
    return with<effect>(Constraints{coulomb}, sweeps, Sleeping{.after = is_other ? 0.5 : 1e9});
  else if constexpr (effect == newton)
    return with<effect>(Constraints{coulomb}, ProximalNewton{.tolerance = 1e-6});
  else if constexpr (effect == penalty)
    return with<effect>(Constraints{Contact{Penalty{Coulomb{.friction = 0.6}, 1e5, 100}}}, sweeps);
  else if constexpr (effect == prediction)
    return with<effect>(Constraints{coulomb}, sweeps, PredictiveScheme{});
  else if constexpr (effect == substeps)
    return with<effect>(Constraints{coulomb}, sweeps, Substeps{.count = 4});
  else if constexpr (effect == recorder)
    return with<effect>(Constraints{coulomb}, sweeps, Recorder{"ten boxes", "", 30});
  else if constexpr (effect == coupling)
    return with<effect>(Constraints{coulomb, VirtualCoupling{}}, sweeps);
  else if constexpr (effect == haptics)
    return with<effect>(Constraints{coulomb, VirtualCoupling{}}, sweeps, HapticChannel{});
  else if constexpr (effect == ball_joint)
    return with<effect>(Constraints{BallJoint{}}, sweeps);
  else if constexpr (effect == hinge)
    return with<effect>(Constraints{Hinge{}}, sweeps);
  else if constexpr (effect == hinge_motor)
    return with<effect>(Constraints{Hinge{}, Motor<Turn>{}}, sweeps);
  else
    return with<effect>(Constraints{Hinge{}, Limit<Turn>{}}, sweeps);
}

/// Boxes on the ground, three metres apart or on each other; or each hanging from the world at the middle of
/// its upper face.
template <Effect effect>
void run(bool is_stacked, bool is_other, int steps) {
  auto loop = make<effect>(is_other);
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
      if constexpr (effect == hinge_limit)
        loop.add(Limit<Turn>::Item{.a = hook, .b = box, .lower = is_other ? 0.0 : -1.0, .upper = 1});
      if constexpr (effect == hinge_motor)
        loop.add(Motor<Turn>::Item{.a = hook, .b = box, .speed = 0, .max_force = 100});
    }
  }
  // A hand holds the last box where it is.
  if constexpr (effect == coupling || effect == haptics) {
    const auto hand = set.add({.position = set.position(last), .motion = Motion::kinematic});
    const auto held = loop.add(VirtualCoupling::Item{anchor(set, last), anchor(set, hand), 1000, 1});
    if constexpr (effect == haptics) loop.template channel<HapticChannel>().connect(held);
  }
  for (int n = 0; n < steps; ++n) loop.step(h);
  std::printf("%.9g\n", set.position(last).z());
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  run<Effect(DELASSUS_EFFECT)>(std::string(words[1]) == "stacked", std::string(words[2]) == "other",
                               std::atoi(words[3]));
}
