// The surfaces of deformable bodies in contact between their nodes.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "catch.hpp"
#include "collision/mesh_scene.hpp"
#include "soft_scenes.hpp"

namespace soft_surfaces_tests {

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;
using Detection = WithSurfaces<WithMeshes<NativeCollision>>;

struct Scene {
  AnimationLoop<World<RigidBodies, Soft>, Constraints<Contact<Coulomb>>, ImplicitEuler, Detection, GaussSeidel>
      loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
           ImplicitEuler{.rayleigh_stiffness = 0.02}, Detection{WithMeshes{NativeCollision{.margin = 0.02}}},
           GaussSeidel{.tolerance = 1e-8, .max_iterations = 2000}};
  Soft& soft = bodies<Soft>(loop.world());
  RigidBodies& rigid = bodies<RigidBodies>(loop.world());
  WithMeshes<NativeCollision>& meshes = loop.get<Detection>().backend;
  static constexpr double radius = 0.01, h = 0.01;

  /// A block of 1 × 1 × 0.4 m in cells of half a metre, its foot on z = 0 held.
  Soft::BodyHandle add_bed() {
    const auto bed = soft.add({.mesh = box_mesh({1, 1, 0.4}, {2, 2, 1}),
                               .elasticity = {.young = 1e5},
                               .contact_radius = radius});
    soft.fix(bed, [](const Vec3& x) { return x.z() < 1e-9; });
    return bed;
  }
  /// Of all contacts of a rigid body, what it receives, N.
  Vec3 force_on(RigidBodies::Handle body) const {
    Vec3 sum = Vec3::Zero();
    for (const ContactResult& c : loop.contacts()) {
      if (c.record.a.set == 0 && c.record.a.block == body.index) sum -= c.impulse / h;
      if (c.record.b.set == 0 && c.record.b.block == body.index) sum += c.impulse / h;
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("what lands between the nodes of a soft bed rests on it, and the bed carries its weight") {
  const Mat3 inertia = (0.02 * Mat3::Identity()).eval();
  for (const int kind : {0, 1, 2}) {  // a ball, a box, and the box as a mesh
    Scene s;
    s.add_bed();
    const Shape shape = kind == 0   ? Shape(Sphere{0.1})
                        : kind == 1 ? Shape(Box{0.2, 0.2, 0.2})
                                    : s.meshes.add(scenes::box_mesh(0.2, 0.2, 0.2));
    // In the middle between nodes: those next to it are 0.25 m away along x and y, and no edge is below.
    const auto body =
        s.rigid.add({.position = {0.3, 0.2, 0.53}, .mass = 5., .inertia = inertia, .shape = shape});
    for (int n = 0; n < 300; ++n) s.loop.step(Scene::h);
    CAPTURE(kind);
    CHECK(s.rigid.position(body).z() > 0.45);
    CHECK(s.rigid.position(body).z() < 0.4 + Scene::radius + 0.1);
    // Damped for 3 s; 1e-3 of the weight is what the bed still swings.
    CHECK((s.force_on(body) - Vec3(0, 0, 5 * 9.81)).norm() < 1e-2 * 5 * 9.81);
  }
}

TEST_CASE("a soft cube rests on a meshed floor, which carries its weight") {
  for (const bool is_spiked : {false, true}) {
    Scene s;
    // A plain in large triangles, or pyramids 0.1 m high between the nodes of the cube.
    std::vector<double> heights(25, 0.0);
    if (is_spiked)
      for (const int i : {6, 8, 16, 18}) heights[i] = 0.1;
    const auto floor = s.rigid.add_fixed(
        is_spiked ? s.meshes.add(HeightField(5, 5, 0.25, 0.25, heights)) : s.meshes.add(scenes::flat_grid(2, 3)));
    const auto cube = s.soft.add({.mesh = box_mesh({1, 1, 1}, {2, 2, 2}),
                                  .elasticity = {.young = 2e5},
                                  .density = 100,
                                  .position = {-0.5, -0.5, is_spiked ? 0.12 : 0.02},
                                  .contact_radius = Scene::radius});
    for (int n = 0; n < 400; ++n) s.loop.step(Scene::h);
    CAPTURE(is_spiked);
    CHECK((s.force_on(floor) + Vec3(0, 0, 100 * 9.81)).norm() < 1e-2 * 100 * 9.81);
    for (Index k = 0; k < 27; ++k) CHECK(s.soft.position(s.soft.node(cube, k)).z() > 0.5 * Scene::radius);
  }
}

}  // namespace soft_surfaces_tests
