/// What a user says of a new deformable body, and the checks that refuse what cannot be one.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/place_of_nodes.hpp>
#include <delassus/geometry/tetrahedral_mesh.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/math/rotation.hpp>

#include <cstdint>
#include <string>

namespace delassus {

/// A deformable body as it is added: a mesh at rest, put in its place. SI units.
///
/// `contact_radius` > 0 (m) makes every node of the surface a sphere for collision; at 0 nothing collides.
/// Nodes are in a group of their own and leave it out, so that the spheres of one body do not meet each
/// other.
template <ElasticMaterial M, class Mesh = TetrahedralMesh>
struct SoftBody {
  Mesh mesh{};  ///< at rest, m, in its own axes
  M elasticity{};  ///< one material for the whole body
  double density = 1000;  ///< kg/m³
  Vec3 position = Vec3::Zero();  ///< of the origin of its axes, world, m
  Quat orientation = Quat::Identity();  ///< its axes to the world, unit
  Vec3 velocity = Vec3::Zero();  ///< of every node, world, m/s
  double contact_radius = 0;  ///< m, ≥ 0
  Index material = 0;  ///< of its contacts: a number that `Materials` gave
  std::uint32_t group = 2;  ///< a bit for every group it is in
  /// The groups it meets; its own is refused where it has a contact_radius.
  std::uint32_t collides_with = ~2u;
};

namespace inner {

template <class T, ElasticMaterial M, class Mesh>
void check_soft_body(const SoftBody<M, Mesh>& body, const std::string& who) {
  check_mesh(body.mesh, who);
  check_material(body.elasticity, who);
  check_place_of_nodes<T>(body, who, "nodes");
  for (Index e = 0; e < Index(body.mesh.cells().size()); ++e) {
    const double mass = body.density * volume(body.mesh, e);
    DELASSUS_EXPECT(has_inverse<T>(mass), who + ": the mass of " + Mesh::cell + " #" + std::to_string(e) +
                                              ", " + without_inverse<T>(text(mass), "kg"));
  }
}

template <class Mesh>
double least_volume(const Mesh& mesh, Index e) {
  return volume(mesh, e);
}

/// Refuses a sound mesh whose elements have no volume left where it was put.
template <class Mesh>
void check_placed(const Mesh& mesh, const Vec3& position, const std::string& who) {
  for (Index e = 0; e < Index(mesh.cells().size()); ++e)
    DELASSUS_EXPECT(least_volume(mesh, e) > 0, who + ": at " + text(position) + " m rounding leaves " +
                                                   Mesh::cell + " #" + std::to_string(e) +
                                                   " no volume; put the body nearer to the origin");
}

}  // namespace inner
}  // namespace delassus
