// Twenty-five balls on a height field of hills roll down until each lies in one of the hollows between.
// prints: 25 of 25 balls lie in hollows, the lowest at 0\.0 m above its own
#include <delassus/collision/with_meshes.hpp>
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

/// Hollows at the points (2 i, 2 j), 0.8 m below the hills between them. m.
double height(double x, double y) {
  const double pi = 3.14159265358979;
  return -0.2 * (std::cos(pi * x) + std::cos(pi * y));
}

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithMeshes{NativeCollision{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  std::vector<double> heights;
  for (int j = 0; j < 121; ++j)
    for (int i = 0; i < 121; ++i) heights.push_back(height(0.1 * (i - 60), 0.1 * (j - 60)));
  auto& collision = loop.get<WithMeshes<NativeCollision>>();
  rigid.add_fixed(collision.add(HeightField(121, 121, 0.1, 0.1, heights)));

  std::vector<RigidBodies::Handle> balls;
  for (int i = 0; i < 25; ++i) {
    const double x = 2.0 * (i % 5 - 2) + 0.7, y = 2.0 * (i / 5 - 2) + 0.02 * i - 0.2;
    balls.push_back(
        rigid.add({.position = {x, y, height(x, y) + 0.2}, .density = 1000., .shape = Sphere{0.15}}));
  }
  for (int i = 0; i < 3000; ++i) loop.step(5e-3);
  double lowest = 1, lying = 0;
  for (const auto ball : balls) {
    const double above = rigid.position(ball).z() - 0.15 + 0.4;
    lying += above > -1e-3 && above < 0.05;
    lowest = std::min(lowest, above);
  }
  std::printf("%.0f of 25 balls lie in hollows, the lowest at %.1f m above its own\n", lying, lowest);
}
