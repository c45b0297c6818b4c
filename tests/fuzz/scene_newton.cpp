// Scenes with contacts alone by Newton's method, in which bodies fall asleep.
#include "scene.hpp"

#include <delassus/activity/sleeping.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/solvers/proximal_newton.hpp>

using namespace delassus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.7}}},
                     ProximalNewton{.tolerance = 1e-8, .max_iterations = 60, .max_sweeps = 200}, Sleeping{.after = 0.01}};
  const auto add = [](auto&, auto&, const Anchor&, const Anchor&) {
    throw InvalidArgument("this scene has no joints");
  };
  return fuzz::play(loop, add, data, size);
}
