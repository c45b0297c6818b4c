// A mesh of triangles: fitting its tree after all vertices moved, ns per triangle, and detection of boxes on
// it, ns per box and step. Argument: cells along an edge, of two triangles each.
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_meshes.hpp>

#include <benchmark/benchmark.h>

#include <cmath>

using namespace delassus;

namespace {

TriangleMesh waves(Index cells) {
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (Index j = 0; j <= cells; ++j)
    for (Index i = 0; i <= cells; ++i)
      vertices.push_back({0.1 * i, 0.1 * j, 0.05 * std::sin(0.5 * i) * std::cos(0.4 * j)});
  for (Index j = 0; j < cells; ++j)
    for (Index i = 0; i < cells; ++i) {
      const Index v = j * (cells + 1) + i, up = v + cells + 1;
      triangles.push_back({v, v + 1, up + 1});
      triangles.push_back({v, up + 1, up});
    }
  return TriangleMesh(vertices, triangles);
}

void refit(benchmark::State& state) {
  TriangleMesh mesh = waves(Index(state.range(0)));
  for (auto _ : state) {
    mesh.refit();
    benchmark::DoNotOptimize(mesh.bounds());
  }
  state.counters["ns_per_triangle"] =
      benchmark::Counter(double(mesh.triangle_count()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(refit)->Arg(30)->Arg(100)->Arg(300);

void boxes_on_mesh(benchmark::State& state) {
  WithMeshes<NativeCollision> collision;
  const Index cells = Index(state.range(0)), boxes = 100;
  std::vector<Collider> colliders{{.shape = collision.add(waves(cells)), .is_movable = false, .key = 0}};
  for (Index i = 0; i < boxes; ++i) {
    const double x = 0.1 * cells * (0.1 + 0.08 * (i % 10)), y = 0.1 * cells * (0.1 + 0.08 * (i / 10));
    colliders.push_back(
        {.shape = Box{0.2, 0.2, 0.2}, .pose = {.position = {x, y, 0.13}}, .key = std::uint32_t(i + 1)});
  }
  std::vector<ContactPoint> contacts;
  for (auto _ : state) benchmark::DoNotOptimize(collision.detect(colliders, 1e-3, contacts));
  state.counters["ns_per_box"] = benchmark::Counter(
      double(boxes) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["contacts_per_box"] = double(contacts.size()) / boxes;
}
BENCHMARK(boxes_on_mesh)->Arg(100)->Arg(300);

}  // namespace
