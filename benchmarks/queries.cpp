/// What a host asks between steps, of all bodies one by one and of a tree of them: rays, nearest points,
/// overlaps.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/body_tree.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace delassus;

/// Boxes, balls and cylinders of about 1 m in a cube with one to every 8 m³, over a plane.
struct Hall {
  World<RigidBodies> world{RigidBodies{}};
  std::mt19937 random{1};
  double reach;

  explicit Hall(Index count) : reach(std::cbrt(double(count))) {
    auto& set = world.get<RigidBodies>();
    set.add_fixed(HalfSpace{}, {0, 0, -reach - 1});
    const Shape shapes[] = {Box{1, 1, 1}, Sphere{0.5}, Cylinder{0.4, 1}};
    for (Index i = 0; i < count; ++i) set.add({.position = any(reach), .mass = 1.0, .shape = shapes[i % 3]});
  }
  Vec3 any(double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
  }
  /// All move by a centimetre.
  void stir() {
    auto& set = world.get<RigidBodies>();
    for (Index b = 1; b < set.blocks(); ++b)
      set.place(set.handle(b), set.position(set.handle(b)) + any(0.01));
  }
};

/// One question of each kind, ns.
template <class Ask>
void questions(benchmark::State& state, const Ask& ask) {
  Hall hall(Index(state.range(0)));
  BodyTree tree;
  tree.refresh(hall.world);
  std::vector<SurfacePoint> found;
  for (auto _ : state) {
    const Vec3 at = hall.any(hall.reach), way = hall.any(1);
    benchmark::DoNotOptimize(ask(hall.world, tree, at, way, found));
  }
}

void rays_of_all(benchmark::State& s) {
  questions(s, [](auto& w, auto&, auto& at, auto& way, auto&) { return ray_cast(w, at, way).distance; });
}
void rays_of_tree(benchmark::State& s) {
  questions(
      s, [](auto& w, auto& tree, auto& at, auto& way, auto&) { return ray_cast(w, tree, at, way).distance; });
}
void nearest_of_all(benchmark::State& s) {
  questions(s, [](auto& w, auto&, auto& at, auto&, auto&) { return closest_point(w, at).distance; });
}
void nearest_of_tree(benchmark::State& s) {
  questions(s,
            [](auto& w, auto& tree, auto& at, auto&, auto&) { return closest_point(w, tree, at).distance; });
}
void overlaps_of_all(benchmark::State& s) {
  questions(s, [](auto& w, auto&, auto& at, auto&, auto& found) {
    overlaps(w, Sphere{1}, {.position = at}, found);
    return found.size();
  });
}
void overlaps_of_tree(benchmark::State& s) {
  questions(s, [](auto& w, auto& tree, auto& at, auto&, auto& found) {
    overlaps(w, tree, Sphere{1}, {.position = at}, found);
    return found.size();
  });
}
void refresh(benchmark::State& state) {
  Hall hall(Index(state.range(0)));
  BodyTree tree;
  tree.refresh(hall.world);
  for (auto _ : state) {
    state.PauseTiming();
    if (state.range(1)) hall.stir();
    state.ResumeTiming();
    tree.refresh(hall.world);
  }
}

BENCHMARK(rays_of_all)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(rays_of_tree)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(nearest_of_all)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(nearest_of_tree)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(overlaps_of_all)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(overlaps_of_tree)->Arg(10)->Arg(1000)->Arg(10000);
BENCHMARK(refresh)
    ->ArgNames({"bodies", "all_move"})
    ->Args({1000, 0})
    ->Args({1000, 1})
    ->Args({10000, 0})
    ->Args({10000, 1});

}  // namespace
