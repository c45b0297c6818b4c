// A mesh of triangles: fitting its tree after all vertices moved, ns per triangle, and detection of boxes on
// it, ns per box and step. Argument: cells along an edge, of two triangles each. Then a meshed ball in a
// hollow of such a mesh, ns per pair and step; argument: triangles around the ball.
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

/// A closed ball of n × n/2 cells.
TriangleMesh ball(double radius, Index n) {
  std::vector<Vec3> vertices{{0, 0, -radius}};
  std::vector<std::array<Index, 3>> triangles;
  const Index rings = n / 2;
  const double pi = 3.14159265358979;
  for (Index j = 1; j < rings; ++j)
    for (Index i = 0; i < n; ++i) {
      const double u = 2 * pi * i / n, v = pi * (double(j) / rings - 0.5);
      vertices.push_back(
          {radius * std::cos(v) * std::cos(u), radius * std::cos(v) * std::sin(u), radius * std::sin(v)});
    }
  vertices.push_back({0, 0, radius});
  const Index top = Index(vertices.size()) - 1;
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    triangles.push_back({0, 1 + next, 1 + i});
    triangles.push_back({top, top - n + i, top - n + next});
    for (Index j = 0; j + 2 < rings; ++j) {
      const Index a = 1 + j * n + i, b = 1 + j * n + next;
      triangles.push_back({a, b, b + n});
      triangles.push_back({a, b + n, a + n});
    }
  }
  return TriangleMesh(vertices, triangles);
}

void ball_on_mesh(benchmark::State& state) {
  WithMeshes<NativeCollision> collision;
  std::vector<Collider> colliders{{.shape = collision.add(waves(100)), .is_movable = false, .key = 0},
                                  {.shape = collision.add(ball(0.5, Index(state.range(0)))), .key = 1}};
  colliders[1].pose.position = {5.03, 4.96, 0.5};
  std::vector<ContactPoint> contacts;
  CollisionReport report;
  for (auto _ : state) benchmark::DoNotOptimize(report = collision.detect(colliders, 1e-3, contacts));
  state.counters["contacts"] = double(contacts.size());
  state.counters["triangle_pairs"] = double(report.queries);
}
BENCHMARK(ball_on_mesh)->Arg(20)->Arg(80)->Arg(320);

}  // namespace
