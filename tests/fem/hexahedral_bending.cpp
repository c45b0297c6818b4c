// Beams and bars of hexahedra against closed forms and against tetrahedra of the same nodes.
#include "catch.hpp"
#include "hexahedral_scenes.hpp"

using namespace delassus;
using namespace soft_scenes;

namespace {

/// The tip of a clamped beam of 1 m × 0.1 m × 0.1 m, E = 1e6 Pa, under a small load across: its deflection as
/// a share of Timoshenko's, κ = 5/6.
template <class Set>
double tip(typename Set::Mesh mesh, double poisson) {
  Set set;
  set.gravity.setZero();
  const auto beam = set.add({.mesh = std::move(mesh), .elasticity = {.young = 1e6, .poisson = poisson}});
  set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
  const double P = 0.01, E = 1e6, G = E / 2 / (1 + poisson), I = 1e-4 / 12;
  // Spread evenly over the end: a node's share is that of the areas around it.
  const auto& points = set.mesh(beam).points;
  std::vector<Vec3> u(set.blocks(), Vec3::Zero());
  for (const auto& t : surface(set.mesh(beam))) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    if (std::min({a[0], b[0], c[0]}) < 1 - 1e-9) continue;
    for (const Index i : t) u[i][1] -= P * (b - a).cross(c - a).norm() / 6 / 0.01;
  }
  set.factor({.mass = 0, .stiffness = 1});
  set.solve(u);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i][0] > 1 - 1e-9) sum -= u[i][1], ++count;
  return sum / count / (P / (3 * E * I) + P / (5.0 / 6 * G * 0.01));
}

}  // namespace

TEST_CASE(
    "a cantilever of 40 hexahedra bends as Timoshenko's, where tetrahedra of the same nodes give a third") {
  const std::array<Index, 3> cells{10, 2, 2};  // 270 unknowns
  const double at_03 = tip<HexahedralFem<Linear>>(hexahedral_box({1, 0.1, 0.1}, cells), 0.3),
               at_049 = tip<HexahedralFem<Linear>>(hexahedral_box({1, 0.1, 0.1}, cells), 0.49);
  CHECK(at_03 > 0.95);
  CHECK(at_03 < 1);
  CHECK(at_049 > 0.90);
  CHECK(at_049 < 1);
  // Wilson's and Taylor's element of the literature has 0.976, and 0.902 at ν = 0.49.
  CHECK(std::abs(at_03 - 0.976) < 1.1e-3);
  CHECK(at_049 > 0.902);
  CHECK(std::abs(tip<TetrahedralFem<Linear>>(box_mesh({1, 0.1, 0.1}, cells), 0.3) - 0.351) < 1e-3);
  CHECK(std::abs(tip<TetrahedralFem<Linear>>(box_mesh({1, 0.1, 0.1}, cells), 0.49) - 0.096) < 1e-3);
}

TEST_CASE("hexahedra do not lock as Poisson's ratio goes to one half") {
  const std::array<Index, 3> cells{20, 2, 2};
  double last = 1;
  for (const double poisson : {0.3, 0.45, 0.49, 0.499, 0.4999}) {
    const double now = tip<HexahedralFem<Linear>>(hexahedral_box({1, 0.1, 0.1}, cells), poisson);
    CHECK(now > 0.95);
    CHECK(now < last);
    last = now;
  }
  // The limit is reached, not approached as E/λ: a hundredfold λ changes nothing.
  CHECK(std::abs(tip<HexahedralFem<Linear>>(hexahedral_box({1, 0.1, 0.1}, cells), 0.499999) - last) < 1e-4);
}

TEST_CASE("one brick through the thickness bends under a couple as a beam does, whatever its length") {
  // A couple at the ends of a row of bricks, sides free: Wilson's modes make each exact. ν = 0 has no clamp.
  HexahedralFem<Linear> set;
  set.gravity.setZero();
  const auto beam =
      set.add({.mesh = hexahedral_box({4, 1, 1}, {4, 1, 1}), .elasticity = {.young = 1e3, .poisson = 0}});
  set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
  std::vector<Vec3> u(set.blocks(), Vec3::Zero());
  for (Index k = 0; k < set.blocks(); ++k) {
    const Vec3& x = set.mesh(beam).points[k];
    if (x[0] > 4 - 1e-9) u[k][0] = x[1] > 0.5 ? 0.5 : -0.5;  // moment M = 1 N·m about z
  }
  set.factor({.mass = 0, .stiffness = 1});
  set.solve(u);
  const double deflection = 4.0 * 4 / 2 / (1e3 / 12);  // M L²/(2 E I)
  for (Index k = 0; k < set.blocks(); ++k)
    if (set.mesh(beam).points[k][0] > 4 - 1e-9) CHECK(std::abs(-u[k][1] / deflection - 1) < 1e-10);
}

TEST_CASE("a slender cantilever under a load that bends it far lies on the elastica") {
  // Of P L²/(E I) = 2: the tip sinks by 0.49346 L and comes back by 0.16064 L.
  HexahedralFem<Corotational> set;
  set.gravity.setZero();
  const double side = 0.05, EI = 1e6 * side * side * side * side / 12;
  const auto beam = set.add(
      {.mesh = hexahedral_box({1, side, side}, {20, 1, 1}), .elasticity = {.young = 1e6, .poisson = 0}});
  set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
  double change = 1;
  for (int n = 1; n <= 60; ++n) {  // Newton's method, the load in ten parts
    const double P = 2 * EI * std::min(1.0, n / 10.0);
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec3> x(set.blocks(), Vec3::Zero());
    set.add_forces(x);
    for (Index k = 0; k < set.blocks(); ++k)
      if (set.mesh(beam).points[k][0] > 1 - 1e-9) x[k][1] -= P / 4;
    set.solve(x);
    change = 0;
    for (Index b = 0; b < set.blocks(); ++b) {
      set.displace(b, x[b]);
      change = std::max(change, x[b].norm());
    }
  }
  CHECK(change < 1e-10);
  Vec3 end = Vec3::Zero();
  for (Index k = 0; k < set.blocks(); ++k)
    if (set.mesh(beam).points[k][0] > 1 - 1e-9)
      end += (set.position(set.handle(k)) - set.mesh(beam).points[k]) / 4;
  // Shear adds 3 E I/(κ G A L²) = 0.15 %, a strain of 4 % about as much of what is not its linear law.
  CHECK(std::abs(-end[1] / 0.493457480396712 - 1) < 0.01);
  CHECK(std::abs(-end[0] / 0.160641720825167 - 1) < 0.02);
}

TEMPLATE_TEST_CASE(
    "a bar of distorted hexahedra that is pulled or pressed follows its material's closed form", "",
    Corotational, StVenantKirchhoff, StableNeoHookean) {
  // (stretch, width, P/E) at ν = 0.3: E (λ − 1) and 1 − ν (λ − 1); ½ (λ³ − λ) and √(1 − ν (λ² − 1)); and
  // roots in 30 digits.
  const auto closed_form = [](double stretch) -> std::array<double, 2> {
    if constexpr (std::is_same_v<TestType, Corotational>) return {1 - 0.3 * (stretch - 1), stretch - 1};
    if constexpr (std::is_same_v<TestType, StVenantKirchhoff>)
      return {std::sqrt(1 - 0.3 * (stretch * stretch - 1)), 0.5 * (stretch * stretch * stretch - stretch)};
    if (stretch < 1) return {1.09464698867832, -0.705854241014314};
    return stretch < 1.7 ? std::array<double, 2>{0.86708612354576, 0.404445520062712}
                         : std::array<double, 2>{0.771045340652879, 0.732113421429001};
  };
  for (const double stretch : {0.5, 1.5, 2.0}) {
    if (std::is_same_v<TestType, StVenantKirchhoff> && stretch < 1) continue;  // gives way below 1/√3
    const auto [width, stress] = closed_form(stretch);
    HexahedralFem<TestType> set;
    set.gravity.setZero();
    HexahedralMesh mesh = hexahedral_box({1, 1, 1}, {3, 2, 2});
    for (Vec3& p : mesh.points)
      if (p[0] > 0.1 && p[0] < 0.9) p[0] += 0.1 * std::cos(7 * p[1] + 5 * p[2]);
    const auto bar = set.add({.mesh = mesh, .elasticity = {.young = 1, .poisson = 0.3}});
    const auto bent = [across = width, stretch](const Vec3& X) {
      return Vec3(stretch * X[0], across * X[1], across * X[2]);
    };
    set.fix(bar, [](const Vec3& x) { return x[0] < 1e-9 || x[0] > 1 - 1e-9; });
    for (Index k = 0; k < set.blocks(); ++k) {
      const Vec3 X = mesh.points[k];
      set.place(set.handle(k),
                bent(X) + (set.moves(k) ? 1e-3 : 0.0) * Vec3(std::cos(X[1]), std::sin(9 * X[0]), 1));
    }
    settle(set, 40);
    double worst = 0, pull = 0;
    const auto f = [&] {
      for (Index k = 0; k < set.blocks(); ++k) set.release(set.handle(k));  // what the ends hold is seen
      return elastic_forces(set);
    }();
    for (Index k = 0; k < set.blocks(); ++k) {
      worst = std::max(worst, (set.position(set.handle(k)) - bent(mesh.points[k])).norm());
      if (mesh.points[k][0] > 1 - 1e-9) pull -= f[k][0];
    }
    CHECK(worst < 1e-8);
    CHECK(std::abs(pull - stress) < 1e-8);
  }
}

TEST_CASE(
    "a block of almost incompressible rubber that is squeezed by a fifth keeps its volume, and does not "
    "lock") {
  double force[2];
  int n = 0;
  for (const double poisson : {0.49, 0.4999}) {
    HexahedralFem<StableNeoHookean> set;
    set.gravity.setZero();
    HexahedralMesh mesh = bricks(4);
    const auto block = set.add({.mesh = mesh, .elasticity = {.young = 1, .poisson = poisson}});
    set.fix(block, [](const Vec3& x) { return x[2] < 1e-9 || x[2] > 1 - 1e-9; });
    for (int part = 1; part <= 10; ++part) {
      for (Index k = 0; k < set.blocks(); ++k)
        if (mesh.points[k][2] > 1 - 1e-9) set.place(set.handle(k), mesh.points[k] - Vec3(0, 0, 0.02 * part));
      settle(set, part < 10 ? 6 : 20);
    }
    for (const Vec3& f : elastic_forces(set)) CHECK(f.norm() < 1e-10);
    for (Index k = 0; k < set.blocks(); ++k) set.release(set.handle(k));  // what the plates hold is seen
    const auto f = elastic_forces(set);
    force[n] = 0;
    for (Index k = 0; k < set.blocks(); ++k)
      if (mesh.points[k][2] > 1 - 1e-9) force[n] += f[k][2];
    ++n;
    for (Index k = 0; k < set.blocks(); ++k) mesh.points[k] = set.position(set.handle(k));
    double V = 0;
    for (Index e = 0; e < 64; ++e) V += volume(mesh, e);
    // Compressed by p/κ ~ 0.3/(0.33/(1 − 2ν)) N/m²; the trilinear volume is not quite the sum of V det F.
    if (poisson > 0.499) CHECK(std::abs(V - 1) < 1e-3);
  }
  // With p bounded the force has a limit. Tetrahedra of half the cells' size need ten times as much.
  CHECK(force[0] > 0.3);
  CHECK(force[1] > force[0]);
  CHECK(force[1] < 1.05 * force[0]);
}
