/// Around detection: surfaces of soft bodies, fast bodies, seams, another broad phase; restitution in sleep.
#include <delassus/collision/seamless.hpp>
#include <delassus/collision/sweep_and_prune.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/fem/cloth.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/integrators/implicit_euler.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

template <class Collision>
auto with(Collision collision) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, collision};
}
auto sheet_on_ball() {
  AnimationLoop loop{
      World{RigidBodies{}, Cloth<Corotational>{}}, Constraints{Contact{Coulomb{.friction = 0.3}}},
      ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.01}, WithSurfaces{NativeCollision{}}};
  rigid_of(loop).add_fixed(Sphere{0.3});
  bodies<Cloth<Corotational>>(loop.world())
      .add({.mesh = sheet(0.6, 0.6, {2, 2}, 2e-3),
            .elasticity = {.young = 5e4},
            .density = 100,
            .position = {-0.27, -0.35, 0.34},
            .contact_radius = 0.01});
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("collision_more");
  const Options faces{.h = 0.01, .is_redundant = true};
  all.add("sheet_surfaces", faces, sheet_on_ball);
  all.add("fast_rods_and_wall", faces, [] {
    auto loop = with(NativeCollision{});
    auto& set = rigid_of(loop);
    set.add_fixed(Box{0.02, 4, 4}, {2, 0, 0});
    set.add_fixed(HalfSpace{}, {0, 0, -0.5});
    set.add({.position = {0, 0, 0.3}, .velocity = {40, 0, 0}, .mass = 0.1, .shape = Sphere{0.03}});
    set.add({.position = {0, 0.5, 0.3},
             .velocity = {20, 1, 0},
             .angular_velocity = {0, 0, 30},
             .mass = 0.5,
             .shape = Capsule{0.03, 0.6}});
    return loop;
  });
  all.add("box_over_tiles", faces, [] {
    auto loop = with(Seamless{NativeCollision{}});
    auto& set = rigid_of(loop);
    for (int k = 0; k < 4; ++k) set.add_fixed(Box{1, 2, 0.2}, {1.0 * k, 0, -0.1 + 2e-4 * (k % 2)});
    set.add({.position = {0, 0, 0.2}, .velocity = {4, 0.2, 0}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.4}});
    return loop;
  });
  all.add("heap_sweep_and_prune", faces, [] {
    auto loop = with(NativeDetection<GjkEpa, SweepAndPrune>{});
    add_heap(loop);
    return loop;
  });
  all.add("mesh_on_mesh", faces, [] {
    auto loop = with(WithMeshes{NativeCollision{}});
    auto& set = rigid_of(loop);
    auto& meshes = loop.template get<WithMeshes<NativeCollision>>();
    const std::vector<Vec3> points{{0, 0, 0.4}, {0.3, 0, -0.2}, {-0.2, 0.3, -0.2}, {-0.2, -0.3, -0.2}};
    const std::vector<std::array<Index, 3>> corners{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const TriangleMesh pyramid(points, corners);
    set.add_fixed(HalfSpace{});
    const Mat3 inertia = Vec3(0.05, 0.05, 0.04).asDiagonal();
    const Shape shape = meshes.add(pyramid);
    set.add({.position = {0, 0, 0.25}, .mass = 2.0, .inertia = inertia, .shape = shape});
    set.add({.position = {0.1, 0.05, 1},
             .orientation = exponential<double>({0.5, 0.2, 0}),
             .mass = 1.0,
             .inertia = inertia,
             .shape = shape});
    return loop;
  });
  return all.main(argc, argv);
}
