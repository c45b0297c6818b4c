/// Rows of the table of acceptance about contacts, pairs and fast bodies, for every backend:
/// docs/evidence/collision.md lists them.
#pragma once

#include "collision/boxes.hpp"
#include "collision/table.hpp"


#include <array>
#include <set>
#include <thread>

namespace scenes {

/// How many contacts each way of resting has, touching, sunk in and hovering; up to eight are asked for.
template <class Backend>
void check_counts() {
  const ConvexHull cube = cube_hull();
  const double half_turn = std::acos(-1.0);
  const Mat3 upright = Mat3::Identity(), lying = turned(half_turn / 2, Vec3::UnitX());
  struct Row {
    Shape body;
    Mat3 rotation;
    std::size_t contacts;
  };
  const std::vector<Row> rows{{Sphere{0.5}, upright, 1},
                              {Box{1, 1, 1}, upright, 4},
                              {Box{1, 1, 1}, turned(half_turn / 4, Vec3::UnitX()), 2},
                              {cube, upright, 4},
                              {cube, turned(half_turn / 4, Vec3::UnitX()), 2},
                              {Cylinder{0.4, 1}, upright, 8},
                              {Cylinder{0.4, 1}, lying, 2},
                              {Capsule{0.3, 1}, lying, 2},
                              {Cone{0.3, 0.4}, upright, 8},
                              {Ellipsoid{0.5, 0.3, 0.4}, upright, 1}};
  for (const Row& row : rows)
    for (const bool floor_is_first : {true, false})
      for (const double gap : {0.0, -1e-4, 1e-4, 1e-12, -1e-12}) {
        SceneOf<Backend> scene;
        scene.collision.max_points = 8;
        const double low = (row.rotation * support(row.body, Vec3(-row.rotation.row(2).transpose())))[2];
        if (floor_is_first) scene.add(Box{10, 10, 1}, {0, 0, 0}, upright, false);
        scene.add(row.body, {0.1, 0.2, 0.5 - low + gap}, row.rotation);
        if (!floor_is_first) scene.add(Box{10, 10, 1}, {0, 0, 0}, upright, false);
        for (int step = 0; step < 2; ++step) {
          scene.detect();
          CAPTURE(name(row.body.kind), gap, floor_is_first, step);
          REQUIRE(scene.contacts.size() == row.contacts);
          for (const ContactPoint& c : scene.contacts) {
            CHECK((c.normal - (floor_is_first ? 1 : -1) * Vec3::UnitZ()).norm() < 1e-9);
            CHECK(std::abs(c.gap - gap) < 1e-9);
          }
        }
      }
  SceneOf<Backend> octagon;
  octagon.add(Box{1, 1, 1}, {0, 0, 0}, upright, false);
  octagon.add(Box{1, 1, 1}, {0, 0, 1}, turned(half_turn / 4, Vec3::UnitZ()));
  octagon.detect();
  CHECK(octagon.contacts.size() == 4);
  // The corners of the overlap [−0.2, 0.5] × [−0.5, 0.3].
  SceneOf<Backend> shifted;
  shifted.add(Box{1, 1, 1}, {0, 0, 0}, upright, false);
  shifted.add(Box{1, 1, 1}, {0.3, -0.2, 0.9999}, upright);
  shifted.detect();
  REQUIRE(shifted.contacts.size() == 4);
  for (const ContactPoint& c : shifted.contacts) {
    CHECK(std::abs(c.point_a[0] - (c.point_a[0] < 0.15 ? -0.2 : 0.5)) < 1e-6);
    CHECK(std::abs(c.point_a[1] - (c.point_a[1] < -0.1 ? -0.5 : 0.3)) < 1e-6);
  }
}

/// The places of contacts, from a tilt of nothing to one of 1e-3, which moves a corner by 1.5e-3 at most.
template <class Backend>
void check_no_jump_by_tilt() {
  const ConvexHull cube = cube_hull();
  for (const Shape& body : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1})})
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0.3, 1, 0), Vec3(1, 1, 1)}) {
      std::vector<ContactPoint> first;
      for (const double tilt : {0.0, 1e-9, 1e-3}) {
        SceneOf<Backend> scene;
        scene.collision.max_points = 8;
        scene.collision.margin = 0.01;
        scene.add(Box{4, 4, 1}, {0, 0, 0}, Mat3::Identity(), false);
        scene.add(body, {0, 0, 1}, turned(tilt, axis));
        scene.detect();
        if (tilt == 0) first = scene.contacts;
        REQUIRE(scene.contacts.size() >= 4);
        for (const ContactPoint& c : first) {
          double nearest = 1;
          for (const ContactPoint& d : scene.contacts)
            nearest = std::min(nearest, (c.point_a - d.point_a).norm());
          CAPTURE(name(body.kind), tilt);
          CHECK(nearest <= 1e-3 + 1.5 * tilt);
        }
      }
    }
}

/// A body slides 1 mm a step for 200 steps with the noise of a resting contact.
template <class Backend>
void check_names() {
  const ConvexHull cube = cube_hull();
  for (const Shape& floor : {Shape(Box{20, 20, 1}), Shape(Box{1.1, 1.1, 1})})
    for (const Shape& body : {Shape(Box{1, 1, 1}), Shape(cube), Shape(Cylinder{0.5, 1})}) {
      SceneOf<Backend> scene;
      scene.add(floor, {0, 0, 0}, Mat3::Identity(), false);
      scene.add(body, {-0.2, 0, 1}, turned(0.2, Vec3::UnitZ()));
      std::set<std::uint32_t> before;
      int kept = 0, total = 0;
      for (int step = 0; step < 200; ++step) {
        scene.colliders[1].pose.position += Vec3(1e-3, 3e-4, 0);
        scene.colliders[1].pose.position[2] = 1 + 1e-5 * std::sin(7.0 * step);
        scene.colliders[1].pose.rotation =
            turned(1e-6 * std::sin(5.0 * step), Vec3(1, 0.3, 0)) * turned(0.2, Vec3::UnitZ());
        scene.detect();
        std::set<std::uint32_t> now;
        for (const ContactPoint& c : scene.contacts) now.insert(c.feature);
        REQUIRE(now.size() == scene.contacts.size());
        for (const std::uint32_t f : now)
          if (step > 0) ++total, kept += before.count(f) > 0;
        before = now;
      }
      CAPTURE(name(floor.kind), name(body.kind), kept, total);
      CHECK(kept >= 0.95 * total);
      CHECK(total >= 4 * 199);
    }
}

/// Bodies of all kinds thrown together, moving a little for some steps: every number of every contact.
template <class Backend>
std::vector<double> heap(const ConvexHull& hull, bool is_reversed = false) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SceneOf<Backend> scene;
  scene.add(HalfSpace{}, {0, 0, -1}, Mat3::Identity(), false);
  const std::vector<Shape> shapes{Sphere{0.4}, Box{1, 0.6, 0.8}, Capsule{0.25, 0.8},      Cylinder{0.35, 0.8},
                                  hull,        Cone{0.4, 0.9},   Ellipsoid{0.5, 0.3, 0.4}};
  std::vector<Vec3> motion;
  for (std::size_t i = 0; i < 42; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    scene.add(shapes[i % shapes.size()], 1.5 * Vec3(x, y, z), any_rotation(random), i % 7 != 0);
  }
  if (is_reversed) std::reverse(scene.colliders.begin(), scene.colliders.end());
  std::vector<double> numbers;
  for (int step = 0; step < 6; ++step) {
    for (Collider& c : scene.colliders)
      if (c.is_movable)
        c.pose.position += 1e-3 * Vec3(std::sin(c.key + step), std::cos(c.key), std::sin(3 * c.key));
    scene.detect();
    for (const ContactPoint& c : scene.contacts) {
      numbers.insert(numbers.end(),
                     {double(c.pair >> 32), double(c.pair & 0xffffffffu), double(c.feature), c.gap});
      for (int k = 0; k < 3; ++k) numbers.insert(numbers.end(), {c.normal[k], c.point_a[k], c.point_b[k]});
    }
  }
  return numbers;
}

/// A run again, the bodies listed the other way round, and four loops of detection in four threads at a time.
template <class Backend>
void check_same_bits() {
  const ConvexHull hull = ball_hull(20, 7, 0.5);
  const std::vector<double> first = heap<Backend>(hull);
  REQUIRE(first.size() > 6 * 50 * 13);
  CHECK(heap<Backend>(hull) == first);
  CHECK(heap<Backend>(hull, true) == first);
  std::array<std::vector<double>, 4> seen;
  std::vector<std::thread> threads;
  for (auto& numbers : seen) threads.emplace_back([&] { numbers = heap<Backend>(hull); });
  for (std::thread& t : threads) t.join();
  for (const auto& numbers : seen) CHECK(numbers == first);
}

/// 1 000 and 10 000 boxes, most of them at rest for a while and then all moving: the pairs of brute force,
/// each once.
template <class Broad>
void check_pairs() {
  for (const int count : {1000, 10000}) {
    const double reach = 0.5 * std::cbrt(2.0 * count);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Aabb> boxes;
    for (int i = 0; i < count; ++i) {
      const double x = uniform(random), y = uniform(random), z = uniform(random);
      boxes.push_back(
          Aabb(reach * Vec3(x, y, z) - Vec3::Constant(0.5), reach * Vec3(x, y, z) + Vec3::Constant(0.5)));
    }
    Broad broad, again;
    for (int step = 0; step < (count > 1000 ? 2 : 12); ++step) {
      for (int i = 0; i < count; i += step % 3 ? 20 : 1) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        const Vec3 move = 0.05 * Vec3(x, y, z);
        boxes[std::size_t(i)] = Aabb(boxes[std::size_t(i)].min() + move, boxes[std::size_t(i)].max() + move);
      }
      std::vector<CandidatePair> pairs, repeated;
      broad.find(boxes, pairs);
      again.find(boxes, repeated);
      CHECK(pairs == repeated);
      std::sort(pairs.begin(), pairs.end());
      CHECK(pairs == brute_force(boxes));
    }
  }
}

/// Balls of 5 cm at 100 m/s against a plate of 1 cm, at 200 phases of the step of 1/60 s: none passes, and
/// the way to go that its contact says is the way to touch, to 1e-4 m.
template <class Backend>
void check_bullets() {
  const double h = 1.0 / 60, touch = 0.055;
  for (int phase = 0; phase < 200; ++phase) {
    SceneOf<Backend> scene;
    scene.add(Box{4, 4, 0.01}, {0, 0, 0}, Mat3::Identity(), false);
    scene.add(Sphere{0.05}, {0.1, 0.2, touch + 1e-3 + 100 * h * (phase + 0.5) / 200}).velocity = {0, 0, -100};
    double& height = scene.colliders[1].pose.position[2];
    for (int step = 0; step < 3; ++step) {
      scene.detect_ahead(h);
      const double way = deepest_gap(scene.contacts);  // infinite without a contact
      CAPTURE(phase, step, height, way);
      if (way < 100 * h) CHECK(std::abs(height - touch - way) < 1e-4);
      height -= std::min(100 * h, std::max(way, 0.0));
      REQUIRE(height > touch - 1e-4);
    }
    CHECK(height < touch + 1e-4);
  }
}

}  // namespace scenes
