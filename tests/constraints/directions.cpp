// H of every law against central differences: of φ where the law has one, of the points' distance else.
#include <delassus/delassus.hpp>

#include <random>
#include <string>
#include <vector>

#include "catch.hpp"

using namespace delassus;

namespace {

using TwoSets = World<RigidBodies, Particles>;

/// Four movable bodies at random poses: two rigid bodies, two particles, and what an end can be.
struct Scene {
  TwoSets world{RigidBodies{}, Particles{}};
  std::mt19937 random;
  std::vector<RigidBodies::Handle> rigid;
  std::vector<Particles::Handle> points;

  explicit Scene(unsigned seed) : random(seed) {
    for (int i = 0; i < 2; ++i) {
      rigid.push_back(set<RigidBodies>().add(
          {.position = vector(), .orientation = turn(), .mass = 1.0, .shape = Box{1, 2, 3}}));
      points.push_back(set<Particles>().add({.position = vector(), .mass = 1.0}));
    }
  }
  template <class S>
  S& set() {
    return bodies<S>(world);
  }
  double draw() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {draw(), draw(), draw()}; }
  Quat turn() { return Quat(draw(), draw(), draw(), draw()).normalized(); }

  /// 0, 1: the rigid bodies · 2, 3: the particles · 4: the world.
  Anchor end(int kind) {
    Anchor a = kind < 2   ? anchor(set<RigidBodies>(), rigid[kind], vector())
               : kind < 4 ? anchor(set<Particles>(), points[kind - 2])
                          : world_anchor(vector());
    world.resolve(a, "end");
    return a;
  }
  /// An end of that kind that is at `point` now.
  Anchor end_at(int kind, const Vec3& point) {
    Anchor a = end(kind);
    if (kind < 2)
      a.local = set<RigidBodies>().pose(a.block).to_local(point);
    else if (kind < 4)
      set<Particles>().place(points[kind - 2], point);
    else
      a.local = point;
    return a;
  }

  /// Moves coordinate c: 0–5, 6–11 of the rigid bodies, 12–14, 15–17 of the particles; m or rad.
  void move(int c, double by) {
    if (c < 12)
      set<RigidBodies>().displace(c / 6, Vec<6>::Unit(c % 6) * by);
    else
      set<Particles>().displace((c - 12) / 3, Vec3::Unit(c % 3) * by);
  }
};
constexpr int coordinates = 18;

/// The rows of one item of a law, H dense in the coordinates of `move`.
template <class Law>
struct Written {
  Mat<Law::rows, coordinates> H = Mat<Law::rows, coordinates>::Zero();
  Vec<Law::rows> phi;

  Written(const Law& law, const typename Law::Item& item, const TwoSets& world) {
    PoolRows<Law::rows, double, 6, 3> rows;
    rows.reset(1);
    law.linearize(item, world, RowWriter(world, rows, 0));
    rows.close();
    phi = rows.phi[0];
    const auto& rigid = std::get<0>(rows.sets);
    const auto& points = std::get<1>(rows.sets);
    for (std::size_t e = 0; e < rigid.block.size(); ++e)
      H.template middleCols<6>(6 * rigid.block[e]) += rigid.H[e];
    for (std::size_t e = 0; e < points.block.size(); ++e)
      H.template middleCols<3>(12 + 3 * points.block[e]) += points.H[e];
  }
};

/// Largest |H − Δ value/2ε|; value(): rows as a function of the configuration. ε = 1e-6: the third derivative
/// of coordinates below 4 m adds ε² · 4, rounding 4 · 2^-53/ε ~ 4e-10.
template <int R, class Value>
double difference(Scene& scene, const Mat<R, coordinates>& H, const Value& value) {
  const double step = 1e-6;
  double worst = 0;
  for (int c = 0; c < coordinates; ++c) {
    scene.move(c, step);
    const Vec<R> up = value();
    scene.move(c, -2 * step);
    const Vec<R> down = value();
    scene.move(c, step);
    worst = std::max(worst, (H.col(c) - (up - down) / (2 * step)).cwiseAbs().maxCoeff());
  }
  return worst;
}

/// f(first kind, second kind, scene) for rigid–rigid, rigid–particle, rigid–world, particle–particle,
/// particle–world, and the other way round, ten poses each.
template <class F>
void each_pair(F&& f) {
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {0, 4}, {2, 3}, {2, 4}, {2, 0}, {4, 0}, {4, 2}})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      Scene scene(seed);
      CAPTURE(a, b, seed);
      f(a, b, scene);
    }
}

}  // namespace

TEST_CASE("H of a closed ball joint is the derivative of its violation") {
  each_pair([](int a, int b, Scene& scene) {
    const Vec3 point = scene.vector();
    const BallJoint::Item item{scene.end_at(a, point), scene.end_at(b, point)};
    const Written<BallJoint> rows({}, item, scene.world);
    CHECK(rows.phi.norm() <= 1e-15 * 8);
    CHECK(difference<3>(scene, rows.H, [&] { return Written<BallJoint>({}, item, scene.world).phi; }) <=
          1e-8);
  });
}

// Open, its row is the relative velocity of the material points at one place, where both impulses act: the
// particle's, or the middle of the anchors.
TEST_CASE("H of an open ball joint is the relative velocity at the one point where its impulses act") {
  each_pair([](int a, int b, Scene& scene) {
    const BallJoint::Item item{scene.end(a), scene.end(b)};
    const Vec3 xa = scene.world.point(item.a), xb = scene.world.point(item.b);
    const Vec3 point = a == 2 || a == 3 ? xa : b == 2 || b == 3 ? xb : Vec3(0.5 * (xa + xb));
    const auto at_point = [&](Anchor end) {
      if (end.set == 0) end.local = scene.set<RigidBodies>().pose(end.block).to_local(point);
      return end;
    };
    const Anchor first = at_point(item.a), second = at_point(item.b);
    const Written<BallJoint> rows({}, item, scene.world);
    CHECK(difference<3>(scene, rows.H,
                        [&] { return Vec3(scene.world.point(first) - scene.world.point(second)); }) <= 1e-8);
  });
}

TEST_CASE("H of a distance joint is the derivative of its violation, closed or open") {
  each_pair([](int a, int b, Scene& scene) {
    const DistanceJoint::Item item{scene.end(a), scene.end(b), 0.7};
    const Written<DistanceJoint> rows({}, item, scene.world);
    CHECK(rows.phi[0] == Approx((scene.world.point(item.a) - scene.world.point(item.b)).norm() - 0.7));
    // Second derivatives grow like 1/length; the shortest of these is 0.2 m, which adds (1e-6)²/0.2² · 4.
    CHECK(difference<1>(scene, rows.H, [&] { return Written<DistanceJoint>({}, item, scene.world).phi; }) <=
          1e-8);
  });
}

TEST_CASE("H of a contact is the relative velocity at its point, along normal and tangents") {
  using Law = Contact<Coulomb>;
  each_pair([](int a, int b, Scene& scene) {
    const Vec3 normal = scene.vector().normalized(), point = scene.vector();
    const double gap = 0.1 * scene.draw();
    Law::Item item;
    item.record = {.a = scene.end_at(a, point),
                   .b = scene.end_at(b, point),
                   .point_a = point - 0.5 * gap * normal,
                   .point_b = point + 0.5 * gap * normal,
                   .normal = normal,
                   .gap = gap};
    item.frame = contact_frame(normal);
    const Written<Law> rows({}, item, scene.world);
    CHECK(rows.phi[0] == gap);
    CHECK(difference<3>(scene, rows.H, [&] {
            return Vec3(item.frame * (scene.world.point(item.record.b) - scene.world.point(item.record.a)));
          }) <= 1e-8);
  });
}

TEST_CASE("the frame of a contact is right-handed and orthonormal for every normal") {
  Scene scene(7);
  const auto check = [](const Vec3& n) {
    const Mat3 frame = contact_frame(n);
    CHECK(frame.row(0).transpose() == n);
    // A dozen roundings of numbers up to 1/(1 + n_z) = 4.
    CHECK((frame * frame.transpose() - Mat3::Identity()).norm() <= 8e-15);
    CHECK(frame.determinant() == Approx(1).epsilon(1e-14));
  };
  for (int k = 0; k < 3; ++k) {
    check(Vec3::Unit(k));
    check(-Vec3::Unit(k));
  }
  for (int n = 0; n < 1000; ++n) check(scene.vector().normalized());
  for (double tilt : {1e-8, 1e-12, 1e-16}) check(Vec3(tilt, tilt, -1).normalized());
}

TEST_CASE("a distance joint between coinciding points acts along z") {
  Scene scene(1);
  const Vec3 point = scene.vector();
  const DistanceJoint::Item item{scene.end_at(2, point), world_anchor(point), 0.0};
  const Written<DistanceJoint> rows({}, item, scene.world);
  CHECK(rows.phi[0] == 0);
  CHECK(rows.H.middleCols<3>(12) == Vec3::UnitZ().transpose());
}
