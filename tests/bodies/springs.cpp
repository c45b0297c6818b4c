#include <delassus/bodies/springs.hpp>

#include <delassus/delassus.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace delassus;

namespace {

/// Some particles, one of them fixed, with springs to each other and to the world, and the same by hand,
/// dense.
struct Net {
  struct Edge {
    int a, b;  // b < 0: the point
    Vec3 point;
    double stiffness, damping, rest;
  };
  std::vector<Vec3> x, v;
  std::vector<double> mass;  // 0: fixed
  std::vector<Edge> edges;
  Vec3 gravity{0.3, 0, -9.81};

  explicit Net(unsigned seed, double damping) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-1, 1);
    const auto vector = [&] { return Vec3{draw(random), draw(random), draw(random)}; };
    for (int i = 0; i < 6; ++i) {
      x.push_back(3 * vector());
      v.push_back(i == 4 ? Vec3(Vec3::Zero()) : vector());
      mass.push_back(i == 4 ? 0 : 1.5 + draw(random));
    }
    // Some stretched, some pressed: rest lengths from 0 to twice the length.
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}, {3, 4}, {2, 3}, {5, -1}, {1, -1}}) {
      const Vec3 point = 3 * vector(), end = b < 0 ? point : x[b];
      edges.push_back(
          {a, b, point, 100 * (1.1 + draw(random)), damping, (1 + draw(random)) * (x[a] - end).norm()});
    }
  }

  template <class Loop>
  std::vector<Particles::Handle> fill(Loop& loop) const {
    auto& set = bodies<Particles>(loop.world());
    set.gravity = gravity;
    std::vector<Particles::Handle> handles;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (mass[i] > 0)
        handles.push_back(set.add({.position = x[i], .velocity = v[i], .mass = mass[i]}));
      else
        handles.push_back(set.add({.position = x[i], .is_fixed = true}));
    }
    for (const Edge& e : edges) {
      if (e.b < 0)
        set.add_spring(handles[e.a], e.point, e.stiffness, e.damping, e.rest);
      else
        set.add_spring(handles[e.a], handles[e.b], e.stiffness, e.damping, e.rest);
    }
    return handles;
  }

  /// v⁺ of (M + s_D D + s_K K)(v⁺ − v) = h (f − t K v), every matrix dense.
  Eigen::VectorXd next_velocity(double h, double s_D, double s_K, double t) const {
    const int n = 3 * int(x.size());
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), K = M, D = M;
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n), u = f;
    for (std::size_t i = 0; i < x.size(); ++i) {
      M.block<3, 3>(3 * i, 3 * i) = (mass[i] > 0 ? mass[i] : 1) * Mat3::Identity();
      f.segment<3>(3 * i) = mass[i] * gravity;
      u.segment<3>(3 * i) = v[i];
    }
    for (const Edge& e : edges) {
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(3, n);
      B.block<3, 3>(0, 3 * e.a).setIdentity();
      if (e.b >= 0) B.block<3, 3>(0, 3 * e.b) = -Mat3::Identity();
      const Vec3 span = x[e.a] - (e.b < 0 ? e.point : x[e.b]);
      const double length = span.norm();
      const Vec3 along = span / length;
      const Mat3 ee = along * along.transpose();
      const double across = std::max(0.0, 1 - e.rest / length);
      K += e.stiffness * B.transpose() * (ee + across * (Mat3::Identity() - ee)) * B;
      D += e.damping * B.transpose() * ee * B;
      f -= B.transpose() * along * (e.stiffness * (length - e.rest) + e.damping * along.dot(B * u));
    }
    Eigen::MatrixXd A = M + s_D * D + s_K * K;
    Eigen::VectorXd p = h * (f - t * K * u);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (mass[i] == 0) {
        A.middleRows<3>(3 * i).setZero();
        A.middleCols<3>(3 * i).setZero();
        A.block<3, 3>(3 * i, 3 * i).setIdentity();
        p.segment<3>(3 * i).setZero();
      }
    return u + A.ldlt().solve(p);
  }
};

template <class Integrator>
double worst_difference(Integrator integrator, double h, double s_D, double s_K, double t) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Net net(seed, 3.0);
    AnimationLoop loop{World{Particles{}}, integrator};
    const auto handles = net.fill(loop);
    loop.step(h);
    const Eigen::VectorXd expected = net.next_velocity(h, s_D, s_K, t);
    for (std::size_t i = 0; i < handles.size(); ++i)
      worst = std::max(
          worst, (bodies<Particles>(loop.world()).velocity(handles[i]) - expected.segment<3>(3 * i)).norm() /
                     expected.norm());
  }
  return worst;
}

}  // namespace

// A has condition below 1 + h²k/m · 10 ~ 1e3 at these numbers: 1e3 · 2^-53 · rows ~ 3e-12 at worst, 1e-12 in
// 20 samples.
TEST_CASE("one step of symplectic Euler on a net of springs is the dense one") {
  CHECK(worst_difference(SymplecticEuler{}, 0.1, 0, 0, 0) <= 1e-12);
}
TEST_CASE("one step of implicit Euler on a net of springs is the dense one") {
  const double h = 0.1;
  CHECK(worst_difference(ImplicitEuler{}, h, h, h * h, h) <= 1e-12);
}
TEST_CASE("one step of the midpoint rule on a net of springs is the dense one") {
  const double h = 0.1;
  CHECK(worst_difference(ImplicitMidpoint{}, h, h / 2, h * h / 4, h / 2) <= 1e-12);
}

// A spring pushes both ends alike, and the columns of K and D of two blocks sum to zero: A (v⁺ − v) keeps Σ m
// v to the rounding of the solve, condition · 2^-53 ~ 1e-13 of Σ m |v| a step at h²k/m = 4.
TEMPLATE_TEST_CASE("a free net of springs keeps its momentum", "", SymplecticEuler, ImplicitEuler,
                   ImplicitMidpoint) {
  AnimationLoop loop{World{Particles{}}, TestType{}};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  std::vector<Particles::Handle> at;
  for (int i = 0; i < 5; ++i)
    at.push_back(
        set.add({.position = {1.0 * i, 0.3 * i * i, 0}, .velocity = {0, 1.0 - i, 0.2 * i}, .mass = 1.0 + i}));
  for (int i = 0; i < 5; ++i) set.add_spring(at[i], at[(i + 1) % 5], 50.0, 0.5, 1.0);
  const Vec3 start = momentum(set);
  double worst = 0, scale = 0;
  for (int n = 0; n < 1000; ++n) {
    loop.step(0.01);
    worst = std::max(worst, (momentum(set) - start).norm());
    for (const auto& h : at) scale = std::max(scale, double(set.mass(h.index)) * set.velocity(h).norm());
  }
  CHECK(worst <= 1e-13 * scale);
}

TEST_CASE("a particle added after the first step moves, and so do those on springs") {
  AnimationLoop loop{World{Particles{}}, ImplicitEuler{}};
  auto& set = bodies<Particles>(loop.world());
  const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0});
  const auto b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  set.add_spring(a, b, 100);
  loop.step(0.01);
  std::vector<Particles::Handle> later;
  for (int i = 0; i < 50; ++i) later.push_back(set.add({.position = {0, 2.0 + i, 0}, .mass = 1.0}));
  for (int n = 2; n <= 10; ++n) loop.step(0.01);
  // All fall alike: v = −g t, ten roundings.
  CHECK(set.velocity(a).z() == Approx(-9.81 * 0.1).epsilon(1e-13));
  CHECK(set.velocity(b).z() == Approx(-9.81 * 0.1).epsilon(1e-13));
  for (const auto& p : later) CHECK(set.velocity(p).z() == Approx(-9.81 * 0.09).epsilon(1e-13));
}

TEST_CASE("a particle taken out takes its springs with it") {
  AnimationLoop loop{World{Particles{}}, ImplicitEuler{}};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0});
  const auto b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  const auto c = set.add({.position = {3, 0, 0}, .mass = 1.0});
  set.add_spring(a, b, 100, 0, 0.5);
  set.add_spring(b, c, 100, 0, 2.0);
  loop.step(0.01);
  set.remove(b);
  const Vec3 va = set.velocity(a), vc = set.velocity(c);
  for (int n = 0; n < 10; ++n) loop.step(0.01);
  CHECK(set.velocity(a) == va);
  CHECK(set.velocity(c) == vc);
}

// The closed form of implicit Euler: m (v⁺ − v) = −h (k (x + h v⁺) + c v⁺), x the stretch, in one direction.
TEST_CASE("a spring with a damper to a point is implicit Euler's in closed form") {
  const double h = 0.03, k = 200, c = 4, m = 2;
  AnimationLoop loop{World{Particles{}}, ImplicitEuler{}};
  auto& set = bodies<Particles>(loop.world());
  set.gravity.setZero();
  const auto mass = set.add({.position = {1.5, 0, 0}, .mass = m});
  set.add_spring(mass, Vec3::Zero(), k, c, 1.0);
  double x = 0.5, v = 0;
  for (int n = 0; n < 300; ++n) {
    v = (m * v - h * k * x) / (m + h * h * k + h * c);
    x += h * v;
    loop.step(h);
    REQUIRE(std::abs(set.position(mass).x() - 1 - x) <= 1e-13);  // 300 roundings of 1.5, without bias
  }
}

namespace {

/// Where a mass swung on a spring of rest length `rest` is after one second.
template <class Integrator>
Vec3 swung(double rest, int steps) {
  AnimationLoop loop{World{Particles{}}, Integrator{}};
  auto& set = bodies<Particles>(loop.world());
  const auto mass = set.add({.position = {1, 0, 0}, .velocity = {0, 1, 0}, .mass = 1.0});
  set.add_spring(mass, Vec3::Zero(), 60, 0, rest);
  for (int n = 0; n < steps; ++n) loop.step(1.0 / steps);
  return set.position(mass);
}

/// Orders measured on the last two pairs of runs, against one 80 times finer than the finest.
template <class Integrator>
std::vector<double> orders(double rest) {
  const Vec3 fine = swung<ImplicitMidpoint>(rest, 1 << 17);
  std::vector<double> errors;
  for (const int steps : {200, 400, 800, 1600})
    errors.push_back((swung<Integrator>(rest, steps) - fine).norm());
  return {std::log2(errors[1] / errors[2]), std::log2(errors[2] / errors[3])};
}

bool are_near(const std::vector<double>& measured, double p) {
  return std::all_of(measured.begin(), measured.end(),
                     [&](double order) { return order >= p - 0.15 && order <= p + 0.5; });
}

}  // namespace

TEST_CASE("a mass swung on a stretched spring is met with order 1, 1 and 2") {
  CHECK(are_near(orders<SymplecticEuler>(1.0), 1));
  CHECK(are_near(orders<ImplicitEuler>(1.0), 1));
  CHECK(are_near(orders<ImplicitMidpoint>(1.0), 2));
}

// K is cut where it would be negative, so the midpoint rule loses an order on a spring that is pressed in
// between.
TEST_CASE("a mass swung through a pressed spring is met with order 1") {
  CHECK(are_near(orders<SymplecticEuler>(0.3), 1));
  CHECK(are_near(orders<ImplicitEuler>(0.3), 1));
  CHECK(are_near(orders<ImplicitMidpoint>(0.3), 1));
}
