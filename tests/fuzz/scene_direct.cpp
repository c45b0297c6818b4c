// Scenes with contacts, hinges and welds, by one factorization of an island's joints; the midpoint rule,
// positions projected.
#include "scene.hpp"

#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

using namespace delassus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.7}}, Hinge{}, Weld{}},
                     DirectGaussSeidel{.tolerance = 1e-8, .max_iterations = 60}};
  const auto add = [](auto& to, auto& bytes, const Anchor& a, const Anchor& b) {
    if (bytes.chance(128))
      to.add(Weld::Item{a, b});
    else
      to.add(Hinge::Item{a, b});
  };
  return fuzz::play(loop, add, data, size);
}
