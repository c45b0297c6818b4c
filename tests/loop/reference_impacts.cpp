// The wall and the pile of the demonstration at steps of theirs, solved by Gauss-Seidel to 1e-10, against the
// reference. docs/guide.md says at which steps neither gets there.
#include "reference_tests.hpp"

#include "../examples/demonstration/pile.hpp"

using namespace reference_tests;

TEST_CASE("a wall of a hundred boxes agrees with the reference") {
  auto loop = contact_loop(0.5, 0.03, 1e-4);
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int row = 0; row < 10; ++row)
    for (int k = 0; k < 10; ++k)
      rigid.add({.position = {0, 0.4 * (k - 4.75 + 0.5 * (row % 2)), 0.2 * (row + 0.5)},
                 .density = 2000,
                 .shape = Box{0.2, 0.4, 0.2}});
  rigid.add({.position = {-2.5, 0, 1.0}, .velocity = {8, 0, 0.5}, .density = 7800, .shape = Sphere{0.35}});
  compare(loop, 1.0 / 240, 1);
}

TEST_CASE("the reference gets there in a pile of two hundred, while it lands and after") {
  auto loop = contact_loop(0.4, NativeCollision{}.margin, 1e-4);
  auto& rigid = bodies<RigidBodies>(loop.world());
  demonstration::pile_parts::add_box_of_half_spaces(rigid);
  demonstration::pile_parts::add_bodies(rigid, 200);
  // Few contacts yet: the motion is unique.
  compare_at(loop, 1.0 / 240, {48});
  compare_at(loop, 1.0 / 240, {12, 24, 36, 52, 72, 102}, false);
}
