// A convex hull of points and a compound of two parts: their centres of mass, and where their bodies rest.
// prints: hammer of 1\.5[0-9] kg, centre 0\.12[0-9] m above the middle of its handle
#include <delassus/collision/with_compounds.hpp>
#include <delassus/delassus.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithCompounds{NativeCollision{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});

  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const ConvexHull hull(corners);
  const Vec3 centre = hull.centroid();  // (1/4, 1/4, 1/4): the body's origin
  const auto wedge = rigid.add({.position = centre, .density = 600.0, .shape = hull});  // copied

  const std::vector<CompoundPart> parts{
      {.shape = Cylinder{0.02, 0.3}, .density = 700},
      {.shape = Box{0.1, 0.04, 0.04}, .position = {0, 0, 0.15}, .density = 7800}};
  const Compound hammer(parts);
  const Shape shape = loop.get<WithCompounds<NativeCollision>>().add(hammer);
  rigid.add({.position = Vec3(3, 0, 0.16) + hammer.centre(),
             .mass = hammer.mass(),
             .inertia = hammer.inertia(),
             .shape = shape});

  for (int n = 0; n < 200; ++n) loop.step(5e-3);
  std::printf("hammer of %.2f kg, centre %.3f m above the middle of its handle\n", hammer.mass(), hammer.centre().z());
  std::printf("wedge of %.0f kg rests at %.3f m\n", rigid.mass(wedge), rigid.position(wedge).z());
}
