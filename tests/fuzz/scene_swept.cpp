// Scenes with contacts, restitution, rods and springs, by accelerated sweeps.
#include "scene.hpp"

#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>

using namespace delassus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.5}}, DistanceJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 60}};
  const auto add = [](auto& to, auto& bytes, const Anchor& a, const Anchor& b) {
    const double length = fuzz::amount(bytes);
    to.add(DistanceJoint::Item{
        .a = a, .b = b, .length = length, .stiffness = bytes.chance(128) ? 0 : fuzz::amount(bytes)});
  };
  return fuzz::play(loop, add, data, size);
}
