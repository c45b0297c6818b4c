/// Ragdolls, surfaces and soft bodies of examples/, stopped and taken up again. The scenes are those of the programs.
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "same_bits.hpp"

using namespace scenes;

TEST_CASE("restored, examples/ragdoll goes on bit for bit") {
  require_same_bits(5e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                         WithFilter{NativeCollision{}}, DirectGaussSeidel{.tolerance = 1e-6}};
  }, [](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    for (int k = 0; k < 6; ++k) rigid.add_fixed(Box{0.4, 2, 0.2}, {0.4 * k, 0, -0.2 * k - 0.1});
    rigid.add_fixed(HalfSpace{}, {0, 0, -1.2});
    const auto trunk = rigid.add({.position = {0, 0, 1}, .velocity = {1, 0, 0}, .mass = 40.0, .shape = Box{0.2, 0.3, 0.6}});
    const auto limb = [&](const Vec3& joint, double width, double length, double mass) {
      const auto part = rigid.add({.position = joint + Vec3(0, 0, length / 2),
                                   .velocity = {1, 0, 0},
                                   .mass = mass,
                                   .shape = Box{width, width, std::abs(length)}});
      loop.add(BallJoint::Item{anchor_at(rigid, trunk, joint), anchor_at(rigid, part, joint)});
    };
    limb({0, 0, 1.32}, 0.15, 0.25, 4);
    for (const double side : {-1., 1.}) {
      limb({0, 0.24 * side, 1.25}, 0.08, -0.6, 3);
      limb({0, 0.1 * side, 0.68}, 0.12, -0.6, 10);
    }
  });
}

TEST_CASE("restored, examples/balls_on_hills goes on bit for bit") {
  const auto height = [](double x, double y) { return -0.2 * (std::cos(M_PI * x) + std::cos(M_PI * y)); };
  require_same_bits(5e-3, [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, WithMeshes{NativeCollision{}}};
  }, [&](auto& loop) {
    auto& rigid = rigid_bodies(loop);
    std::vector<double> heights;
    for (int j = 0; j < 121; ++j)
      for (int i = 0; i < 121; ++i) heights.push_back(height(0.1 * (i - 60), 0.1 * (j - 60)));
    rigid.add_fixed(loop.template get<WithMeshes<NativeCollision>>().add(HeightField(121, 121, 0.1, 0.1, heights)));
    for (int i = 0; i < 25; ++i) {
      const double x = 2.0 * (i % 5 - 2) + 0.7, y = 2.0 * (i / 5 - 2) + 0.02 * i - 0.2;
      rigid.add({.position = {x, y, height(x, y) + 0.2}, .density = 1000., .shape = Sphere{0.15}});
    }
  });
}

TEST_CASE("restored, examples/soft_beam goes on bit for bit") {
  using Soft = TetrahedralFem<Corotational>;
  require_same_bits(0.01, [] {
    return AnimationLoop{World{RigidBodies{}, Soft{}}, Constraints{BallJoint{}},
                         ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.02}};
  }, [](auto& loop) {
    auto& soft = bodies<Soft>(loop.world());
    auto& rigid = rigid_bodies(loop);
    const auto beam = soft.add({.mesh = box_mesh({1, 0.1, 0.1}, {20, 2, 2}),
                                .elasticity = {.young = 2e6, .poisson = 0.3},
                                .density = 1000});
    soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9; });
    const Vec3 tip(1, 0.05, 0.05);
    const auto ball = rigid.add({.position = {1, 0.05, -0.25}, .mass = 0.1, .shape = Sphere{0.1}});
    loop.add(BallJoint::Item{anchor_at(rigid, ball, tip), soft.anchor_at(beam, tip)});
  }, SameBits::of_many_bodies());
}
