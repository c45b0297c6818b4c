/// A pair at rest, from step to step: the whole of our detection, boxes, pairs, certified distance, manifold
/// and names, against the bare answer of FCL (its contacts) and of libccd (one depth).
#include <delassus/adapters/ccd.hpp>
#include <delassus/adapters/fcl.hpp>
#include <delassus/collision/native.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace delassus;

enum Kinds { box_box, box_cylinder, cubes, hulls };
constexpr int pair_count = 64, step_count = 16;

/// 20 points on a ball cut off at the height ±0.4, so that the hull rests on a face of five corners.
ConvexHull resting_hull() {
  std::vector<Vec3> points;
  for (int ring = 0; ring < 4; ++ring) {
    const double z = ring == 0   ? -0.4
                     : ring == 3 ? 0.4
                     : ring == 1 ? -0.15
                                 : 0.15,
                 r = std::sqrt(0.25 - z * z);
    for (int k = 0; k < 5; ++k) {
      const double angle = 1.2566370614359172 * k + 0.6 * ring;
      points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  return ConvexHull(points).centred();
}

ConvexHull cube() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5});
  return ConvexHull(corners);
}

/// `pair_count` pairs, one body on the other with a shift of 0.1 m and 1e-6 m of depth; from step to step the
/// upper one moves as what rests does, 1e-7 m and 1e-7 rad.
struct Resting {
  ConvexHull hull;
  std::vector<Collider> steps[step_count];

  explicit Resting(Kinds kinds) : hull(kinds == cubes ? cube() : resting_hull()) {
    const Shape below = kinds <= box_cylinder ? Shape(Box{1, 1, 1}) : Shape(hull);
    const Shape above = kinds == box_cylinder ? Shape(Cylinder{0.5, 1}) : below;
    const double low = -support(above, Vec3(0, 0, -1)).z(), high = support(below, Vec3(0, 0, 1)).z();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (auto& colliders : steps)
      for (int k = 0; k < pair_count; ++k) {
        const double x = uniform(random), y = uniform(random), z = uniform(random), u = uniform(random),
                     v = uniform(random);
        Collider ground{.shape = below,
                        .pose = {.position = {3.0 * k, 0, 0}},
                        .is_movable = false,
                        .key = std::uint32_t(2 * k)};
        Collider body{.shape = above, .key = std::uint32_t(2 * k + 1)};
        body.pose.position = Vec3(3.0 * k + 0.1, 0.05, low + high - 1e-6) + 1e-7 * Vec3(x, y, z);
        body.pose.rotation = (Quat(1, 5e-8 * u, 5e-8 * v, 0.1).normalized()).toRotationMatrix();
        colliders.push_back(ground);
        colliders.push_back(body);
      }
  }
};

/// Thread CPU time per pair and step.
void per_pair(benchmark::State& state) {
  state.counters["ns_per_pair"] = benchmark::Counter(
      1e-9 * pair_count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Backend>
void whole(benchmark::State& state) {
  Resting scene{Kinds(state.range(0))};
  Backend backend;
  std::vector<ContactPoint> contacts;
  int step = 0;
  for (int i = 0; i < step_count; ++i) backend.detect(scene.steps[i], 1e-3, contacts);
  for (auto _ : state) {
    backend.detect(scene.steps[step++ % step_count], 1e-3, contacts);
    benchmark::DoNotOptimize(contacts.data());
  }
  per_pair(state);
  state.counters["contacts"] = double(contacts.size()) / pair_count;
}

/// Lets no pair: what is left of the whole is boxes, broad phase and the list of pairs.
struct LetNone {
  bool lets(std::uint64_t) const { return false; }
};

void boxes_alone(benchmark::State& state) {
  Resting scene{Kinds(state.range(0))};
  NativeCollision backend;
  std::vector<ContactPoint> contacts;
  int step = 0;
  for (auto _ : state) {
    backend.detect(scene.steps[step++ % step_count], 1e-3, contacts, LetNone{});
    benchmark::DoNotOptimize(contacts.data());
  }
  per_pair(state);
}

/// `answer(below, above)` for every pair.
template <class Answer>
void bare(benchmark::State& state, const Answer& answer) {
  Resting scene{Kinds(state.range(0))};
  int step = 0;
  double sum = 0;
  for (auto _ : state) {
    const auto& colliders = scene.steps[step++ % step_count];
    for (int k = 0; k < pair_count; ++k) sum += answer(colliders[2 * k], colliders[2 * k + 1]);
    benchmark::DoNotOptimize(sum);
  }
  per_pair(state);
}

std::shared_ptr<fcl::CollisionGeometryd> fcl_geometry(const Shape& s) {
  if (s.kind == ShapeKind::box)
    return std::make_shared<fcl::Boxd>(2 * s.size[0], 2 * s.size[1], 2 * s.size[2]);
  if (s.kind == ShapeKind::cylinder) return std::make_shared<fcl::Cylinderd>(s.size[0], 2 * s.size[1]);
  auto vertices =
      std::make_shared<std::vector<fcl::Vector3d>>(s.hull->vertices().begin(), s.hull->vertices().end());
  auto faces = std::make_shared<std::vector<int>>();
  for (Index f = 0; f < s.hull->face_count(); ++f) {
    faces->push_back(int(s.hull->face(f).size()));
    faces->insert(faces->end(), s.hull->face(f).begin(), s.hull->face(f).end());
  }
  return std::make_shared<fcl::Convexd>(vertices, int(s.hull->face_count()), faces);
}

fcl::Transform3d posed(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.rotation;
  t.translation() = pose.position;
  return t;
}

/// Geometries made once, transforms of the bodies as FCL keeps them; up to four contacts, of which FCL has
/// four for boxes and one for all others.
void fcl_collide(benchmark::State& state) {
  const Resting scene{Kinds(state.range(0))};
  const auto below = fcl_geometry(scene.steps[0][0].shape), above = fcl_geometry(scene.steps[0][1].shape);
  fcl::CollisionRequestd request(4, true, 1, false, true, fcl::GST_LIBCCD, 1e-6);
  fcl::CollisionResultd result;
  std::size_t count = 0, asked = 0;
  bare(state, [&](const Collider& a, const Collider& b) {
    result.clear();
    fcl::collide<double>(below.get(), posed(a.pose), above.get(), posed(b.pose), request, result);
    count += result.numContacts();
    ++asked;
    return result.numContacts() ? result.getContact(0).penetration_depth : 0.0;
  });
  state.counters["contacts"] = double(count) / double(asked);
}

/// libccd's own functions, with our support functions for callbacks. The deterministic direction of its GJK
/// is its own.
template <class Penetration>
void ccd_penetration(benchmark::State& state, const Penetration& penetration) {
  ccd_t settings;
  CCD_INIT(&settings);
  settings.support1 = settings.support2 = inner::ccd_support;
  settings.center1 = settings.center2 = inner::ccd_center;
  settings.max_iterations = 100;
  settings.mpr_tolerance = settings.epa_tolerance = settings.dist_tolerance = 1e-6;
  int missed = 0, asked = 0;
  bare(state, [&](const Collider& a, const Collider& b) {
    int budget = 1000;
    const inner::CcdBody x{a.shape, a.pose, 1, budget}, y{b.shape, b.pose, 1, budget};
    ccd_real_t depth = 0;
    ccd_vec3_t direction{}, position{};
    missed += penetration(&x, &y, &settings, &depth, &direction, &position) != 0;
    ++asked;
    return double(depth);
  });
  state.counters["missed"] = double(missed) / asked;
}
void ccd_mpr(benchmark::State& state) { ccd_penetration(state, ccdMPRPenetration); }
void ccd_epa(benchmark::State& state) { ccd_penetration(state, ccdGJKPenetration); }

void kinds(benchmark::internal::Benchmark* b) {
  b->ArgName("kinds")->Arg(box_box)->Arg(box_cylinder)->Arg(cubes)->Arg(hulls);
  b->Repetitions(9)->ReportAggregatesOnly(true)->MinTime(0.05)->Unit(benchmark::kMicrosecond);
}

BENCHMARK_TEMPLATE(whole, NativeCollision)->Apply(kinds);
BENCHMARK(boxes_alone)->Apply(kinds);
BENCHMARK_TEMPLATE(whole, FclCollision)->Apply(kinds);
BENCHMARK_TEMPLATE(whole, CcdCollision)->Apply(kinds);
BENCHMARK(fcl_collide)->Apply(kinds);
BENCHMARK(ccd_mpr)->Apply(kinds);
BENCHMARK(ccd_epa)->Apply(kinds);

}  // namespace
