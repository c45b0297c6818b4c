// Scenes with contacts and hinges, by one factorization of an island's joints; the midpoint rule, positions
// projected.
#include "scene.hpp"

#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

using namespace delassus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.7}}, Hinge{}},
                     DirectGaussSeidel{.tolerance = 1e-8, .max_iterations = 60}};
  const auto add = [](auto& to, auto&, const Anchor& a, const Anchor& b) { to.add(Hinge::Item{a, b}); };
  fuzz::Scene(std::move(loop), add, data, size).run();
  return 0;
}
