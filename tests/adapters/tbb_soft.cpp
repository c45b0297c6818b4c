// Soft bodies on several threads: the same bits at any number, beside the loop that names none.
#include <delassus/adapters/tbb.hpp>

#include <delassus/compliance/lazy.hpp>
#include <delassus/delassus.hpp>
#include <delassus/fem/cloth.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/hexahedral_fem.hpp>
#include <delassus/fem/quadratic_tetrahedral_fem.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <oneapi/tbb/global_control.h>

#include <array>
#include <cstdint>
#include <utility>

namespace tbb_soft_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// As many threads as a test asks for, however many processors there are.
const oneapi::tbb::global_control eight(oneapi::tbb::global_control::max_allowed_parallelism, 8);

/// The scene adds its bodies to a loop that `make` makes of its policies, steps it, and returns a hash.
template <class Scene, class... More>
std::uint64_t hash_of(const Scene& scene, More... more) {
  return scene([&](auto... policies) { return AnimationLoop{std::move(policies)..., more...}; });
}
template <class Scene>
void check_same_bits(const Scene& scene) {
  const std::uint64_t alone = hash_of(scene);
  CHECK(hash_of(scene, Serial{}) == alone);
  for (const int threads : {1, 2, 3, 8}) {
    CAPTURE(threads);
    CHECK(hash_of(scene, Threads{threads}) == alone);
  }
}
std::uint64_t hash_after(auto& loop, int steps, double h) {
  for (int k = 0; k < steps; ++k) loop.step(h);
  return state_hash(loop);
}

/// Boxes on the four quarters of a plate of this size at height z, which fall on it.
void drop_boxes(auto& set, double x, double y, double z, double side) {
  for (int k = 0; k < 4; ++k)
    set.add({.position = {x * (0.25 + 0.5 * (k % 2)), y * (0.25 + 0.5 * (k / 2)), z + 0.55 * side},
             .velocity = {0.1 * k, 0, -0.3},
             .mass = 0.3,
             .shape = Box{side, side, side}});
}

/// A block on the floor with boxes on it, of elements and a material that are asked for.
template <class Soft, class Rigid = RigidBodies, class Material, class Mesh>
auto block_on_floor(const Mesh& mesh, const Material& material, const Vec3& size, int steps) {
  return [=](auto make) {
    auto loop = make(World{Rigid{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}, NativeCollision{.margin = 0.002});
    auto& rigid = bodies<Rigid>(loop.world());
    rigid.add_fixed(HalfSpace{});
    bodies<Soft>(loop.world())
        .add({.mesh = mesh, .elasticity = material, .position = {0, 0, 0.005}, .contact_radius = 0.004});
    drop_boxes(rigid, size.x(), size.y(), size.z() + 0.01, 0.06);
    const auto hash = hash_after(loop, steps, 0.01);
    CHECK(loop.report().contacts > 0);
    return hash;
  };
}

}  // namespace

TEST_CASE("three thousand nodes in contact: the same bits by any number of threads") {
  const Vec3 size(0.38, 0.28, 0.18);
  check_same_bits(block_on_floor<TetrahedralFem<Corotational>>(box_mesh(size, {19, 14, 9}),
                                                               Corotational{.young = 5e4}, size, 2));
}

TEST_CASE("elements of every kind and a float factor: the same bits by any number of threads") {
  const Vec3 size(0.3, 0.2, 0.1);
  check_same_bits(block_on_floor<TetrahedralFem<Corotational>>(box_mesh(size, {12, 8, 4}),
                                                               Corotational{.young = 5e4}, size, 8));
  check_same_bits(block_on_floor<TetrahedralFem<StableNeoHookean>>(box_mesh(size, {12, 8, 4}),
                                                                   StableNeoHookean{.young = 5e4}, size, 8));
  check_same_bits(
      block_on_floor<TetrahedralFem<Linear>>(box_mesh(size, {12, 8, 4}), Linear{.young = 5e4}, size, 8));
  check_same_bits(block_on_floor<HexahedralFem<Corotational>>(hexahedral_box(size, {12, 8, 4}),
                                                              Corotational{.young = 5e4}, size, 5));
  check_same_bits(block_on_floor<QuadraticTetrahedralFem<StableNeoHookean>>(
      quadratic(box_mesh(size, {6, 4, 2})), StableNeoHookean{.young = 5e4}, size, 4));
  check_same_bits(block_on_floor<TetrahedralFem<Corotational, float>, RigidBodiesF>(
      box_mesh(size, {12, 8, 4}), Corotational{.young = 5e4}, size, 5));
}

TEST_CASE("a sheet on a ball: the same bits by any number of threads") {
  using Sheets = Cloth<Corotational>;
  check_same_bits([](auto make) {
    auto loop = make(World{RigidBodies{}, Sheets{}}, Constraints{Contact{Coulomb{.friction = 0.3}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01});
    rigid_bodies(loop).add_fixed(Sphere{0.3}, {0.5, 0.5, -0.32});
    bodies<Sheets>(loop.world())
        .add({.mesh = sheet(1, 1, {24, 24}, 1e-3),
              .elasticity = {.young = 1e5},
              .density = 500,
              .contact_radius = 0.01});
    return hash_after(loop, 15, 1. / 100);
  });
}

TEST_CASE("many bodies and held nodes and joints: the same bits by any number of threads") {
  using Soft = TetrahedralFem<Corotational>;
  check_same_bits([](auto make) {
    auto loop = make(World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.6}}, BallJoint{}}, ImplicitEuler{});
    auto& soft = bodies<Soft>(loop.world());
    rigid_bodies(loop).add_fixed(HalfSpace{Vec3(0, 0, 1), -0.6});
    for (int i = 0; i < 9; ++i) {
      // The first has nodes enough for all workers.
      const std::array<Index, 3> cells =
          i == 0 ? std::array<Index, 3>{16, 5, 5} : std::array<Index, 3>{4, 2, 2};
      const auto block = soft.add({.mesh = box_mesh({1, 0.5, 0.5}, cells),
                                   .elasticity = {.young = 1e5, .poisson = 0.3},
                                   .density = 500,
                                   .position = {0, 1. * i, 0},
                                   .contact_radius = 0.01});
      soft.fix(block, [](const Vec3& x) { return x.x() < 1e-9; });
      const Vec3 tip(1, 1. * i + 0.25, 0.25);
      const auto ball =
          rigid_bodies(loop).add({.position = tip - Vec3(0, 0, 0.5), .mass = 1. + i, .shape = Sphere{0.05}});
      loop.add(BallJoint::Item{anchor_at(rigid_bodies(loop), ball, tip), soft.anchor_at(block, tip)});
    }
    return hash_after(loop, 30, 1. / 100);
  });
}

TEST_CASE("bodies that come and go and a checkpoint: the same bits by any number of threads") {
  using Soft = TetrahedralFem<Corotational>;
  check_same_bits([](auto make) {
    auto loop =
        make(World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, ImplicitEuler{});
    auto& soft = bodies<Soft>(loop.world());
    rigid_bodies(loop).add_fixed(HalfSpace{});
    const auto add = [&](std::array<Index, 3> cells, double x) {
      return soft.add({.mesh = box_mesh({0.4, 0.4, 0.4}, cells),
                       .elasticity = {.young = 1e5},
                       .position = {x, 0, 0.02},
                       .velocity = {0, 0.1, -0.5},
                       .contact_radius = 0.01});
    };
    const auto first = add({7, 7, 7}, 0);
    add({8, 7, 6}, 1);
    hash_after(loop, 5, 1. / 100);
    auto copy = loop.world().clone();  // the world of another time, with the same bodies
    hash_after(loop, 3, 1. / 100);
    soft.remove(first);
    add({6, 8, 8}, 2);  // in its place
    hash_after(loop, 5, 1. / 100);
    const std::uint64_t hash = state_hash(loop);
    loop.world() = std::move(copy);
    return hash ^ hash_after(loop, 5, 1. / 100);
  });
}

TEST_CASE("midpoint rule and reused factors: the same bits by any number of threads") {
  using Soft = TetrahedralFem<Corotational>;
  const auto scene = [](auto loop) {
    rigid_bodies(loop).add_fixed(HalfSpace{});
    bodies<Soft>(loop.world())
        .add({.mesh = box_mesh({0.3, 0.3, 0.3}, {7, 7, 7}),
              .elasticity = {.young = 1e5},
              .position = {0, 0, 0.02},
              .velocity = {0.2, 0, -0.5},
              .contact_radius = 0.01});
    return hash_after(loop, 15, 1. / 200);
  };
  check_same_bits([&](auto make) {
    return scene(make(World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.3}}},
                      ImplicitMidpoint{}));
  });
  check_same_bits([&](auto make) {
    return scene(make(World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.3}}},
                      ImplicitEuler{}, LazyCompliance{.violation = 1e-5, .tolerance = 1e-4}));
  });
}

}  // namespace tbb_soft_tests
