// HC-17: level floors of many parts, over which bodies slide.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/collision/seamless.hpp>
#include <delassus/collision/with_meshes.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace ladders {

namespace {

using std::numbers::pi;

/// [−2, 18] × [−2, 2] at z = 0 in 60 × 12 squares of two triangles, whose inner corners are moved by up to
/// 0.3 of a square within the plane.
TriangleMesh floor_of_triangles() {
  const int columns = 60, rows = 12;
  unsigned state = 7;
  const auto draw = [&] { return 0.6 * ((state = state * 1664525u + 1013904223u) / 4294967296. - 0.5); };
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const bool is_inner = i > 0 && j > 0 && i < columns && j < rows;
      const double dx = is_inner ? draw() : 0, dy = is_inner ? draw() : 0;
      vertices.push_back({(i + dx) * 20 / columns - 2, (j + dy) * 4 / rows - 2, 0});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Index v = j * (columns + 1) + i, up = v + columns + 1;
      triangles.push_back({v, v + 1, up + 1});
      triangles.push_back({v, up + 1, up});
    }
  return TriangleMesh(vertices, triangles);
}

/// A body slides without friction over a floor that is level but made of parts, at 2 m/s for 7 s: none of
/// their seams may be felt. add_floor(loop) lays it.
template <class Collision>
void slide_over(Ladder& ladder, const char* parts, const Vec3& start, double aside,
                const Collision& collision, const auto& add_floor) {
  struct Slider {
    const char* name;
    Shape shape;
    double height;
    Quat turn;
  };
  const Quat upright = Quat::Identity(), lying(Eigen::AngleAxisd(pi / 2, Vec3::UnitX()));
  for (const Slider& s :
       {Slider{"sphere", Sphere{0.5}, 0.5, upright}, Slider{"box", Box{1, 1, 1}, 0.5, upright},
        Slider{"lying capsule", Capsule{0.3, 0.6}, 0.3, lying}})
    ladder.rung(format("%s over %s", s.name, parts), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, collision};
      auto& set = bodies<RigidBodies>(loop.world());
      add_floor(loop);
      const auto body = set.add({.position = start + Vec3(0, 0, s.height),
                                 .orientation = s.turn,
                                 .velocity = {2, aside, 0},
                                 .mass = 1.0,
                                 .shape = s.shape});
      double hop = 0;
      const Seen seen = run(ladder, loop, 7, frame,
                            [&](int) { hop = most(hop, std::abs(set.position(body).z() - s.height)); });
      return {{"hop / size", hop, 1e-3, 1e-6},
              {"speed lost", std::abs(set.velocity(body).x() / 2 - 1), 1e-2, 1e-6},
              energy_mark(seen, 0.5 * 4)};
    });
}

template <class Collision>
void slide_over_tiles(Ladder& ladder, const Collision& collision) {
  slide_over(ladder, "40 tiles", {2, 0, 0}, 0, collision, [](auto& loop) {
    auto& set = bodies<RigidBodies>(loop.world());
    for (int k = 0; k < 40; ++k) set.add_fixed(Box{0.5, 4, 1}, {0.5 * k, 0, -0.5});
  });
}

}  // namespace

void seams(Ladder& ladder) { slide_over_tiles(ladder, NativeCollision{}); }
void seams_left_out(Ladder& ladder) { slide_over_tiles(ladder, Seamless{NativeCollision{}}); }

// One mesh of triangles of random shape, crossed askew.
void slide_over_triangles(Ladder& ladder) {
  using Meshes = WithMeshes<NativeCollision>;
  slide_over(ladder, "1440 triangles", {0, 0.1, 0}, 0.05, Meshes{NativeCollision{}}, [](auto& loop) {
    bodies<RigidBodies>(loop.world()).add_fixed(loop.template get<Meshes>().add(floor_of_triangles()));
  });
}

}  // namespace ladders
