// Questions between steps: a ray, the nearest surface, who is in a sphere, a distance, and the force of each contact.
// prints: floor carries 9\.81 N
#include <delassus/collision/body_tree.hpp>
#include <delassus/collision/queries.hpp>
#include <delassus/delassus.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, DistanceJoint{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto floor = rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto ball = rigid.add({.position = {2, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.2}, .group = 2, .collides_with = 0});
  const double h = 5e-3;
  for (int i = 0; i < 40; ++i) loop.step(h);

  const SurfacePoint hit = ray_cast(loop.world(), Vec3(-1, 0, 0.5), Vec3(1, 0, 0), 100.0);
  if (hit && hit.anchor.block == box.index) std::printf("ray meets the box at %.2f m\n", hit.distance);
  const SurfacePoint near = closest_point(loop.world(), Vec3(0, 0, 1.2), 10.0, 1);  // bodies of group 1 only
  std::printf("nearest surface: %.2f m\n", near.distance);
  std::vector<SurfacePoint> found;
  overlaps(loop.world(), Sphere{1}, {.position = {0, 0, 1}}, found);
  std::printf("%zu bodies in the sphere\n", found.size());
  std::printf("box and ball are %.2f m apart\n", separation(rigid, box, rigid, ball).distance);

  BodyTree tree;
  tree.refresh(loop.world());  // after each step; then many questions are cheap
  std::printf("asked by a tree: %.2f m\n", ray_cast(loop.world(), tree, Vec3(-1, 0, 0.5), Vec3(1, 0, 0)).distance);

  Vec3 carried = Vec3::Zero();
  for (const ContactResult& c : loop.contacts())  // c.impulse (N·s) acts on body b of the pair
    if (c.record.a.block == floor.index) carried += c.impulse / h;
  std::printf("floor carries %.2f N\n", carried.z());
  loop.each_constraint([](int pool, Index item, const auto& impulse, double error, double step) {
    std::printf("law %d, item %d: %.2f N along its first row, error %.0e m/s\n", pool, item, impulse[0] / step, error);
  });

  if (hit) loop.add(DistanceJoint::Item{.a = hit.anchor, .b = world_anchor({-1, 0, 0.5}), .length = hit.distance});
  loop.step(h);
}
