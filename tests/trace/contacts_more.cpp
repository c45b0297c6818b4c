/// Other laws of contact: pyramids, no friction, springs, a law of its own for some materials; soft and whole
/// stabilisation.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/constraints/contact/penalty.hpp>
#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/stabilisation/soft_contact.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

/// Whatever touches material 2.
struct Slippery {
  static bool takes(Index a, Index b) { return a == 2 || b == 2; }
};

auto pyramids() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Pyramid{.friction = 0.5}}}};
}
auto springs() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{Contact{Penalty{Coulomb{.friction = 0.4}, 2e4, 50}}}};
}
auto two_laws() {
  return AnimationLoop{World{RigidBodies{}},
                       Constraints{ContactFor<Frictionless, Slippery>{}, Contact{Coulomb{.friction = 0.5}}},
                       GaussSeidel{.tolerance = 1e-9, .max_iterations = 5000}};
}
auto softly() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                       SoftContact{.frequency = 8}};
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("contacts_more");
  const Options faces{.h = 0.01, .is_redundant = true};
  all.add("heap_of_pyramids", faces, [] {
    auto loop = pyramids();
    add_heap(loop);
    return loop;
  });
  all.add("balls_on_springs", {.h = 0.01}, [] {
    auto loop = springs();
    add_balls(loop);
    return loop;
  });
  all.add("ice_and_ground", faces, [] {
    auto loop = two_laws();
    loop.materials().add({.friction = 0.5});
    loop.materials().add({.friction = 0});
    auto& set = rigid_of(loop);
    set.add({.shape = HalfSpace{}, .motion = Motion::fixed, .material = 1});
    set.add({.position = {0, 0, 0.3},
             .velocity = {3, 0, 0},
             .mass = 1.0,
             .shape = Box{0.6, 0.5, 0.4},
             .material = 1});
    set.add({.position = {2, 0.1, 0.2},
             .velocity = {1, 0, 0},
             .mass = 2.0,
             .shape = Box{0.6, 0.5, 0.4},
             .material = 2});
    return loop;
  });
  all.add("tumble_on_soft_contacts", faces, [] {
    auto loop = softly();
    add_tumble(loop);
    return loop;
  });
  return all.main(argc, argv);
}
