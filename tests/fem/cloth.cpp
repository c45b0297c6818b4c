#include <delassus/fem/cloth.hpp>

#include <cmath>
#include <string>

#include "catch.hpp"
#include "cloth_scenes.hpp"
#include "fem_tests.hpp"

namespace cloth_tests {

using namespace delassus;
using namespace fem_tests;

template <class M>
double energy_of(const PlaneStress<M>& material, const Vec3& a, const Vec3& b) {
  return material.at(columns(a, b, Vec3(Vec3::Zero()))).energy();
}

TEMPLATE_TEST_CASE("patch test: inside a sheet the nodes follow what its border does, also in a turned plane",
                   "", Corotational, StVenantKirchhoff) {
  const double thickness = 0.02;
  Cloth<TestType> set;
  set.gravity.setZero();
  const PlaneStress<TestType> material{.young = 1000, .poisson = 0.4};
  const auto body = set.add({.mesh = square(4, thickness, 0.25), .elasticity = material});
  const auto rest = set.mesh(body).points;
  const Mat3 turn = rotation_matrix<double>(exponential(Vec3(2 * Vec3(1, 2, -2) / 3)));
  const Vec3 a = turn * Vec3(1.1, 0.02, 0), b = turn * Vec3(0.05, 1.03, 0);
  const auto placed = [&](Index k) { return Vec3(rest[k][0] * a + rest[k][1] * b); };
  set.fix(body, [](const Vec3& x) { return std::min(x[0], x[1]) < 1e-9 || std::max(x[0], x[1]) > 1 - 1e-9; });
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k),
              placed(k) +
                  (set.moves(k) ? 0.02 * Vec3(std::cos(3. * k), std::sin(5. * k), 0.5) : Vec3(Vec3::Zero())));
  settle(set, 12);  // Newton's method doubles its digits
  double worst = 0;
  int inside = 0;
  for (Index k = 0; k < set.node_count(body); ++k)
    if (set.moves(k))
      worst = std::fmax(worst, (set.position(set.node(body, k)) - placed(k)).norm()), ++inside;
  CHECK(inside == 9);
  CHECK(worst < 1e-12);
  const auto f = elastic_forces(set);
  for (Index k = 0; k < set.blocks(); ++k)
    if (set.moves(k)) CHECK(f[k].norm() < 1e-13);  // E t h = 5 N times ε, and some tens of terms
  CHECK(std::abs(set.elastic_energy() - thickness * energy_of(material, a, b)) < 1e-13);
}

TEST_CASE("a sheet turned and moved as a whole has no elastic force and no energy") {
  check_rigid_motion<Cloth<Corotational>>(square(4, 0.1, 0.25));
  check_rigid_motion<Cloth<StVenantKirchhoff>>(square(4, 0.1, 0.25));
}

TEMPLATE_TEST_CASE("forces of a sheet are the derivative of its energy, their sum and their moment vanish",
                   "", Corotational, StVenantKirchhoff) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Cloth<TestType> set;
    set.add({.mesh = square(3, 0.1, 0.25, seed), .elasticity = {.young = 1, .poisson = 0.4}});
    const Quat turn = exponential(Vec3(2 * Vec3(1, 2, -2) / 3));
    for (Index b = 0; b < set.blocks(); ++b) set.place(set.handle(b), turn * set.position(set.handle(b)));
    scatter(set, 0.08, seed);  // a quarter of a cell: stretched, pressed and folded
    // Step⁴ = 1e-16 times E t / l⁴ ~ 1e5 N/m⁵ where a cell is pressed to l = 3 cm, and its some ten triangles;
    // ε Ψ / step = 1e-16 · 1e-2 / 1e-4.
    check_derivative(set, 1e-10);
    check_balance(set, 1e-2);
  }
}

TEMPLATE_TEST_CASE(
    "the stiffness of a sheet is the derivative of its forces where it is stretched and curved", "",
    Corotational, StVenantKirchhoff) {
  Cloth<TestType> set;
  const auto body =
      set.add({.mesh = square(4, 0.05, 0.2), .elasticity = {.young = 1e4, .poisson = 0.3}, .density = 1000});
  const auto rest = set.mesh(body).points;
  for (Index k = 0; k < set.node_count(body); ++k) {  // in every direction, so that nothing of K is cut
    const double x = rest[k][0], y = rest[k][1];
    set.place(set.node(body, k),
              Vec3(1.2 * x + 0.05 * y, 0.02 * x + 1.15 * y, 0.05 * std::sin(5 * x + 3 * y)));
  }
  check_tangent(set, 1e-7);  // step² of h² ∂³f/∂x³ ~ h² E t/h_cell³ over m = 1 kg: 1e-10 · 1e-3 · 3e4 / 1
}

TEST_CASE("the stiffness of a folded and pressed sheet is symmetric and positive semidefinite") {
  Cloth<Corotational> set;
  set.add({.mesh = square(2, 0.05, 0.2), .elasticity = {.young = 1, .poisson = 0.3}});
  scatter(set, 0.25, 5);
  set.factor({.mass = 1, .stiffness = 1});
  const Index n = 3 * set.blocks();
  std::vector<double> K(std::size_t(n * n));
  double largest = 0, skewed = 0;
  for (Index j = 0; j < n; ++j) {
    for (Vec3& v : set.velocity()) v.setZero();
    set.velocity()[j / 3][j % 3] = 1;
    std::vector<Vec3> p(set.blocks(), Vec3::Zero());
    set.add_stiffness_times_velocity(p, -1);
    for (Index i = 0; i < n; ++i) K[i * n + j] = p[i / 3][i % 3];
    largest = std::max(largest, K[j * n + j]);
  }
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < i; ++j) skewed = std::max(skewed, std::abs(K[i * n + j] - K[j * n + i]));
  CHECK(skewed < 1e-15 * largest);
  // Cholesky of K + n ε |K| 1: every pivot is positive.
  for (Index i = 0; i < n; ++i) K[i * n + i] += 1e-14 * largest;
  double least = largest;
  for (Index k = 0; k < n; ++k) {
    const double pivot = K[k * n + k];
    least = std::min(least, pivot);
    for (Index i = k + 1; i < n; ++i)
      for (Index j = k + 1; j < n; ++j) K[i * n + j] -= K[i * n + k] * K[k * n + j] / pivot;
  }
  CHECK(least > 0);
}

TEMPLATE_TEST_CASE("a strip pulled by its end stretches as its law says, and gets narrower", "", Corotational,
                   StVenantKirchhoff) {
  // Corotational: P = E e, lateral stretch 1 − ν e. St. Venant–Kirchhoff: P = E l (l² − 1)/2 and Green's
  // strain across −ν times that along.
  constexpr bool is_green = std::is_same_v<TestType, StVenantKirchhoff>;
  const double E = 2e4, nu = 0.3, t = 0.01, l = 1.2;
  const double P = is_green ? E * l * (l * l - 1) / 2 : E * (l - 1);
  const double across = is_green ? std::sqrt(1 - nu * (l * l - 1)) : 1 - nu * (l - 1);
  Cloth<TestType> set;
  set.gravity.setZero();
  const auto body = set.add({.mesh = sheet(2, 0.5, {8, 2}, t), .elasticity = {.young = E, .poisson = nu}});
  const auto rest = set.mesh(body).points;
  const auto node = [&](Index i, Index j) { return set.node(body, i + 9 * j); };
  set.fix(node(0, 0));
  // The left edge is drawn by what the right one is: the body is in balance, and Newton's method starts where
  // its modes are held by tension.
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k), {1.1 * rest[k][0], 0.98 * rest[k][1], 0});
  for (int n = 0; n < 30; ++n) {
    for (Index j = 0; j <= 2; ++j) {
      const double share = P * t * 0.25 * (j == 1 ? 1 : 0.5);
      set.apply_force(node(8, j), {share, 0, 0});
      set.apply_force(node(0, j), {-share, 0, 0});
    }
    set.factor({.mass = 1e-6, .stiffness = 1});  // a mass that holds what may turn
    std::vector<Vec3> x(set.blocks(), Vec3::Zero());
    set.add_forces(x);
    set.solve(x);
    for (Index b = 0; b < set.blocks(); ++b) set.displace(b, x[b]);
    set.begin_step(0);
    for (auto& load : set.loads()) load.setZero();
  }
  CHECK(std::abs((set.position(node(8, 0)) - set.position(node(0, 0))).norm() / 2 - l) < 1e-8);
  CHECK(std::abs((set.position(node(4, 2)) - set.position(node(4, 0))).norm() / 0.5 - across) < 1e-8);
}

TEST_CASE(
    "the energy of a sheet around a cylinder goes to D A kappa^2 / 2, whatever its mesh and direction") {
  // Only half a cell at the border is without curvature: the error halves with the cells; on irregular ones
  // what parabolas miss of the circle comes to it. Bending is what the whole has more than a membrane.
  const double E = 1e5, nu = 0.3, t = 0.01, R = 1.5, D = E * t * t * t / (12 * (1 - nu * nu));
  for (const double jitter : {0., 0.2})
    for (const double angle : {0., 0.6, -0.6}) {
      double last = 0;
      for (const Index n : {8, 16, 32}) {
        Cloth<Corotational> solid, membrane;
        const SheetMesh mesh = square(n, t, jitter);
        roll(solid, solid.add({.mesh = mesh, .elasticity = {.young = E, .poisson = nu}}), R, angle);
        roll(membrane, membrane.add({.mesh = mesh, .elasticity = {.young = E, .poisson = nu, .bending = 0}}),
             R, angle);
        const double bending = solid.elastic_energy() - membrane.elastic_energy();
        const double error = 1 - bending / (D / (2 * R * R));
        CAPTURE(jitter, angle, n, error);
        CHECK(error > 0);
        if (n == 32) CHECK(error < 1.5 / 32);  // half a cell at four borders, of which two count at the most
        if (n > 8) CHECK(error < 0.75 * last);
        if (n > 8 && jitter == 0) CHECK(std::abs(std::log2(last / error) - 1) < 0.1);
        last = error;
      }
    }
}

TEST_CASE("a strip that is loaded at its end bends by F L^3 / 3 D b, to second order") {
  // ν = 0: a plate bends as a beam does. The clamp is in the middle of the first cells, whose nodes are held.
  const double E = 1e6, t = 0.01, width = 0.25, F = 1e-4, D = E * t * t * t / 12;
  double last = 0;
  for (const Index n : {8, 16, 32}) {
    Cloth<Corotational> set;
    set.gravity.setZero();
    const double h = 1 / (double(n) - 0.5), L = 1;
    const auto body =
        set.add({.mesh = sheet(n * h, width, {n, 2}, t), .elasticity = {.young = E, .poisson = 0}});
    set.fix(body, [&](const Vec3& x) { return x[0] < 1.5 * h; });
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec3> x(set.blocks(), Vec3::Zero());
    for (Index j = 0; j <= 2; ++j) x[n + (n + 1) * j] = Vec3(0, 0, F * (j == 1 ? 0.5 : 0.25));
    set.solve(x);
    const double error = x[n + (n + 1)][2] / (F * L * L * L / (3 * D * width)) - 1;
    CAPTURE(n, error);
    CHECK(std::abs(error) < 1. / double(n * n));
    if (n > 8) CHECK(std::abs(std::log2(last / error) - 2) < 0.2);
    last = error;
  }
}

TEST_CASE("a square membrane under tension swings as a drum does, to second order") {
  // Stretched alike in both directions by e: the pull per width at rest is N = E t e/(1 − ν), a deflection w
  // has ½ N/(1 + e) |∂w/∂X|², and so ω² = 2 π² N/((1 + e) ρ t a²), all of the sheet at rest.
  const double E = 1e6, nu = 0.3, t = 1e-3, e = 0.05, rho = 1000;
  const double exact = std::sqrt(2 * M_PI * M_PI * E * e / ((1 - nu) * (1 + e) * rho));
  double last = 0;
  for (const Index n : {8, 16, 32}) {
    Cloth<Corotational> set;
    set.gravity.setZero();
    const auto body = set.add(
        {.mesh = square(n, t), .elasticity = {.young = E, .poisson = nu, .bending = 0}, .density = rho});
    set.fix(body,
            [](const Vec3& x) { return std::min(x[0], x[1]) < 1e-9 || std::max(x[0], x[1]) > 1 - 1e-9; });
    const auto rest = set.mesh(body).points;
    for (Index k = 0; k < set.node_count(body); ++k) set.place(set.node(body, k), (1 + e) * rest[k]);
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec3> v(set.blocks(), Vec3::Zero());
    for (Index b = 0; b < set.blocks(); ++b)
      if (set.moves(b)) v[b][2] = std::sin(M_PI * rest[b][0]) * std::sin(M_PI * rest[b][1]);
    const double error = 1 - lowest_frequency(set, v, 30) / exact;
    CAPTURE(n, error);
    CHECK(std::abs(error) < 1. / double(n * n));
    if (n > 8) CHECK(std::abs(std::log2(last / error) - 2) < 0.1);
    last = error;
  }
}

TEST_CASE("a strip that hangs gets longer by rho g L^2 / 2E, in single precision too") {
  const double E = 1e6, rho = 1000, g = 9.81;
  const auto sag = [&]<class T>(T) {
    Cloth<Corotational, T> set;
    const auto strip = set.add({.mesh = sheet(0.2, 1, {2, 8}, 1e-2),
                                .elasticity = {.young = E, .poisson = 0},
                                .density = rho,
                                .orientation = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()))});
    set.fix(strip, [](const Vec3& x) { return x[2] > 1 - 1e-6; });
    for (int n = 0; n < 20; ++n) {  // the mass holds what swings until tension does; it costs digits a step
      set.factor({.mass = 1, .stiffness = 1});
      std::vector<Vec<3, T>> x(set.blocks(), Vec<3, T>::Zero());
      set.add_forces(x);
      set.solve(x);
      for (Index b = 0; b < set.blocks(); ++b) set.displace(b, x[b]);
    }
    return -set.position(set.node(strip, 1)).z();
  };
  // Each row of nodes carries what it should, but not each node: half of them have one triangle more. That
  // strains the last cells, an eighth of the strip, with 1/64 of the whole.
  CHECK(std::abs(sag(1.0) / (rho * g / (2 * E)) - 1) < 1e-3);
  CHECK(std::abs(sag(1.0f) / sag(1.0) - 1) < 1e-3);  // 6e-8 of 1 m, of 5e-3, and ten times that
}

TEST_CASE("a point of a sheet moves with its triangle, and one beside it is refused") {
  Cloth<Corotational> set;
  const auto body = set.add({.mesh = square(3, 0.01, 0.2), .position = {1, 0, 0}});
  const Vec3 place(1.3, 0.6, 0), a(1.1, 0.1, 0.3), b(-0.1, 0.9, -0.2);
  const Anchor anchor = set.anchor_at(body, place);
  CHECK((set.point(anchor) - place).norm() < 1e-15);
  const auto rest = set.mesh(body).points;
  for (Index k = 0; k < set.blocks(); ++k) set.place(set.node(body, k), rest[k][0] * a + rest[k][1] * b);
  CHECK((set.point(anchor) - (1.3 * a + 0.6 * b)).norm() < 1e-15);
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < set.anchor_blocks(anchor); ++k)
    sum += set.along(anchor, k, set.point(anchor), {1, 2, 3});
  CHECK((sum - Vec3(1, 2, 3)).norm() < 1e-15);
  CHECK_THROWS_AS(set.anchor_at(body, {1.3, 0.6, 1e-3}), InvalidArgument);
}

TEST_CASE("a sheet whose numbers are none is refused by one sentence") {
  const auto refusal = [](const SheetMesh& mesh, const PlaneStress<Corotational>& material,
                          double density = 1000) {
    Cloth<Corotational> set;
    try {
      set.add({.mesh = mesh, .elasticity = material, .density = density});
    } catch (const InvalidArgument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto says = [](const std::string& sentence, const char* words) {
    return sentence.find(words) != std::string::npos;
  };
  const SheetMesh mesh = sheet(1, 1, {2, 2}, 1e-3);
  CHECK(refusal(mesh, {.poisson = 0.5}).empty());
  CHECK(says(refusal(mesh, {.poisson = 0.51}), "Poisson's ratio 0.51 must lie in (-1, 0.5]"));
  CHECK(says(refusal(mesh, {.poisson = -1}), "must lie in (-1, 0.5]"));
  CHECK(says(refusal(mesh, {.young = 0}), "Young's modulus 0 Pa must be finite and > 0"));
  CHECK(says(refusal(mesh, {.young = std::nan("")}), "Pa must be finite and > 0"));
  CHECK(says(refusal(mesh, {.bending = -1}), "the share of bending -1 must be finite and >= 0"));
  CHECK(says(refusal(mesh, {}, 0), "density 0 kg/m³ must be finite and > 0"));
}

}  // namespace cloth_tests
