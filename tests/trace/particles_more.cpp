/// Grains on rigid bodies, rods between points, springs without their coupling, single precision.
#include <delassus/bodies/particles.hpp>
#include <delassus/compliance/uncoupled.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/schemes/predictive_scheme.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

auto mixed() {
  return AnimationLoop{World{RigidBodies{}, Particles{}},
                       Constraints{Contact{Coulomb{.friction = 0.4}}, DistanceJoint{}}};
}

auto rods() { return AnimationLoop{World{Particles{}}, Constraints{DistanceJoint{}}}; }
auto predicted_springs() {
  return AnimationLoop{World{Particles{}}, Constraints{DistanceJoint{}},
                       ImplicitEuler{},    UncoupledCompliance{},
                       PredictiveScheme{}, GaussSeidel{.tolerance = 1e-12, .max_iterations = 5000}};
}
auto in_floats() {
  return AnimationLoop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("particles_more");
  // Grains fall on the ground and on a box, one hangs on it by a spring.
  all.add("grains_and_box", {.h = 0.01, .is_redundant = true}, [] {
    auto loop = mixed();
    auto& rigid = rigid_of(loop);
    auto& grains = bodies<Particles>(loop.world());
    rigid.add_fixed(HalfSpace{});
    const auto box = rigid.add(
        {.position = {0, 0, 0.35}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
    for (int k = 0; k < 3; ++k)
      grains.add({.position = {0.3 + 0.2 * k, 0.02 * k, 0.8 + 0.2 * k},
                  .velocity = {-0.5, 0.1 * k, 0},
                  .mass = 0.2,
                  .radius = 0.08});
    loop.add(DistanceJoint::Item{.a = anchor(grains, grains.handle(0)),
                                 .b = anchor(rigid, box, {0.25, 0, 0.25}),
                                 .length = 0.3,
                                 .stiffness = 30});
    return loop;
  });
  all.add("double_pendulum_of_rods", {.h = 0.005, .change = 0.5}, [] {
    auto loop = rods();
    auto& set = rigid_of(loop);
    const auto a = set.add({.position = {1, 0, 0}, .mass = 1.0}),
               b = set.add({.position = {1, 0.5, 0}, .velocity = {0, 0, 2}, .mass = 0.3});
    loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({0, 0, 0}), 1});
    loop.add(DistanceJoint::Item{anchor(set, b), anchor(set, a), 0.5});
    return loop;
  });
  all.add("springs_uncoupled_predicted", {.h = 0.01}, [] {
    auto loop = predicted_springs();
    auto& set = rigid_of(loop);
    std::vector<Particles::Handle> p;
    for (int i = 0; i < 5; ++i) p.push_back(set.add({.position = {0.2 * i, 0, 0}, .mass = 0.1}));
    for (int i = 0; i < 4; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.2);
    loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
    loop.add(DistanceJoint::Item{anchor(set, p[4]), world_anchor({0.8, 0.1, 0.5}), 0.5});
    return loop;
  });
  // A float has 24 bits: 1e-5 of the largest entry is a hundred roundings.
  all.add("tumble_in_floats", {.h = 0.01, .tolerance = 1e-5, .is_redundant = true}, [] {
    auto loop = in_floats();
    add_tumble(loop);
    return loop;
  });
  return all.main(argc, argv);
}
