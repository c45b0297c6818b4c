#include "catch.hpp"

#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/delassus.hpp>

#include <cmath>
#include <vector>

namespace compounds_tests {

using namespace delassus;

TEST_CASE("a table of five parts falls on a height field, stands on its legs, falls asleep and is woken") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithCompounds{WithMeshes{NativeCollision{}}}, Sleeping{.after = 0.2},
                     GaussSeidel{.tolerance = 1e-7, .max_iterations = 1000}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& collision = loop.get<WithCompounds<WithMeshes<NativeCollision>>>();
  rigid.add_fixed(collision.backend.add(HeightField(9, 9, 0.37, 0.41, std::vector<double>(81, 0.0))));
  std::vector<CompoundPart> parts{{.shape = Box{1, 1, 0.1}, .position = {0, 0, 0.45}}};
  for (const double x : {-0.4, 0.4})
    for (const double y : {-0.4, 0.4})
      parts.push_back({.shape = Box{0.1, 0.1, 0.4}, .position = {x, y, 0.2}});
  const Compound table(parts);
  const Shape shape = collision.add(table);
  const auto body = rigid.add({.position = Vec3(0.1, 0, 0.02) + table.centre(),
                               .mass = table.mass(),
                               .inertia = table.inertia(),
                               .shape = shape});
  for (int i = 0; i < 200; ++i) loop.step(5e-3);
  CHECK(std::abs(rigid.position(body).z() - table.centre().z()) <
        1e-5);  // touching, within the solver's tolerance
  CHECK(rigid.velocity(body).norm() == 0);
  CHECK_FALSE(rigid.is_awake(body.index));

  // A ball lands on the top, rolls off and past the legs: the table wakes.
  const auto ball = rigid.add({.position = {0.1, 0, 0.7}, .mass = 1., .shape = Sphere{0.1}});
  for (int i = 0; i < 40; ++i) loop.step(5e-3);
  CHECK(rigid.is_awake(body.index));
  CHECK(std::abs(rigid.position(ball).z() - 0.6) < 1e-3);
}

}  // namespace compounds_tests
