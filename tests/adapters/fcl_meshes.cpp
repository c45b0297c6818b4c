#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <delassus/adapters/fcl.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>

using namespace delassus;
using namespace scenes;

TEST_CASE("with FCL, meshes, compounds and fast bodies are the engine's own") {
  SceneOf<WithFilter<WithCompounds<WithMeshes<FclCollision>>>> scene;
  auto& compounds = scene.collision.backend;
  MeshScene native;
  for (int i = 0; i < 2; ++i) {
    const auto floor = flat_grid(3, 11, 0.2);
    if (i == 0)
      scene.add(compounds.backend.add(floor), {0, 0, 0}, Mat3::Identity(), false);
    else
      native.add(native.collision.add(floor), {0, 0, 0}, Mat3::Identity(), false);
  }
  const Shape halves =
      compounds.add(Compound(std::vector<CompoundPart>{{.shape = Box{1, 1, 0.5}, .position = {0, 0, -0.25}},
                                                       {.shape = Box{1, 1, 0.5}, .position = {0, 0, 0.25}}}));
  scene.add(halves, {0.1, 0.2, 0.4999});
  native.add(Box{1, 1, 1}, {0.1, 0.2, 0.4999});
  for (auto step : {0, 1}) (void)step, scene.detect(), native.detect();
  REQUIRE(native.contacts.size() == 4);
  REQUIRE(scene.contacts.size() == 4);
  for (const ContactPoint& p : scene.contacts) {
    double nearest = 1;
    for (const ContactPoint& q : native.contacts)
      nearest = std::min(nearest, (p.point_b - q.point_b).norm() + std::abs(p.gap - q.gap));
    CHECK(nearest < 1e-15);
  }
  scene.add(Sphere{0.01}, {0.1, 0.2, 1.6}).velocity = {0, 0, -1000};
  scene.detect_ahead(1e-3);
  CHECK(scene.contacts.size() == 6);  // the ball on the upper half, and its core
}
