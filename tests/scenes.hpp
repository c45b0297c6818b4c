/// Scenes that several rooms and every collision backend run: stacks, a block on a plane, a bouncing ball.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace scenes {

using namespace delassus;

inline constexpr double g = 9.81;

template <class Loop>
auto& rigid_bodies(Loop& loop) {
  return loop.world().template set<0>();
}

/// Eight points: a cube whose faces, edges and corners the backend has to find by itself.
inline ConvexHull cube_of_points(double edge = 1) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(edge * Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5));
  return ConvexHull(corners);
}

/// `count` bodies of unit height and mass on the ground z = 0, each set down without a gap, a little off the one below.
template <class Set>
std::vector<typename Set::Handle> add_stack(Set& set, int count, const Shape& shape, double jitter = 1e-3,
                                            const Vec3& at = Vec3::Zero()) {
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> off(-jitter, jitter);
  std::vector<typename Set::Handle> handles;
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < count; ++i) {
    const double x = off(random), y = off(random);
    handles.push_back(set.add({.position = at + Vec3(x, y, 0.5 + i), .mass = 1.0, .shape = shape}));
  }
  return handles;
}

/// A collision backend that answers with the contacts it was given: problems without geometry.
struct GivenContacts {
  using plays = role::Collision;
  std::vector<ContactPoint> points{};

  CollisionReport detect(std::span<const Collider>, double, std::vector<ContactPoint>& out) {
    out = points;
    return {.points = Index(out.size())};
  }
};

/// `bodies` boxes of random sizes, masses, poses and velocities, without gravity, and `contacts` points between them, all
/// of gap `gap` and of random normals; `grounded` makes body 0 fixed. All bodies hang together when contacts >= bodies − 1.
template <class Set>
std::vector<ContactPoint> add_cluster(Set& set, int bodies, int contacts, unsigned seed, double gap = 0,
                                      bool grounded = true) {
  std::mt19937 random(seed);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto vector = [&](double size) {
    const double x = draw(-size, size), y = draw(-size, size), z = draw(-size, size);
    return Vec3(x, y, z);
  };
  set.gravity.setZero();
  for (int i = 0; i < bodies; ++i)
    set.add({.position = vector(2),
             .orientation = exponential<double>(vector(3)),
             .velocity = vector(1),
             .angular_velocity = vector(1),
             .mass = std::exp(draw(-2, 2)),
             .shape = Box{draw(0.3, 2), draw(0.3, 2), draw(0.3, 2)},
             .motion = grounded && i == 0 ? Motion::fixed : Motion::dynamic});
  std::vector<ContactPoint> points;
  for (int k = 0; k < contacts; ++k) {
    const int b = k < bodies - 1 ? k + 1 : 1 + int(random() % unsigned(bodies - 1)), a = int(random() % unsigned(b));
    const Vec3 middle = 0.5 * (set.pose(a).position + set.pose(b).position) + vector(0.5), n = vector(1).normalized();
    points.push_back({.a = a,
                      .b = b,
                      .point_a = middle - 0.5 * gap * n,
                      .point_b = middle + 0.5 * gap * n,
                      .normal = n,
                      .gap = gap,
                      .pair = std::uint64_t(a) << 32 | std::uint64_t(b),
                      .feature = std::uint32_t(k)});
  }
  std::sort(points.begin(), points.end(), [](const ContactPoint& p, const ContactPoint& q) {
    return p.pair != q.pair ? p.pair < q.pair : p.feature < q.feature;
  });
  return points;
}

/// A⁻¹ = diag(1/m, R I⁻¹ Rᵀ) of all rigid bodies as a dense matrix.
template <class Set>
Eigen::MatrixXd dense_inverse(const Set& set) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6 * set.blocks(), 6 * set.blocks());
  for (Index b = 0; b < set.blocks(); ++b) {
    if (!set.moves(b)) continue;
    const Mat3 R = set.pose(b).rotation;
    const Mat3 inertia = R * set.inertia(b).template cast<double>() * R.transpose();
    out.block<3, 3>(6 * b, 6 * b) = Mat3::Identity() / double(set.mass(b));
    out.block<3, 3>(6 * b + 3, 6 * b + 3) = inertia.inverse();
  }
  return out;
}

/// Three rows of u = frame · (v_b − v_a) at `point`, as a dense H over all rigid bodies. Number < 0: the world.
template <class Set>
void add_dense_rows(Eigen::MatrixXd& H, int row, const Set& set, Index a, Index b, const Vec3& point, const Mat3& frame) {
  for (const auto& [body, sign] : {std::pair{a, -1.0}, std::pair{b, 1.0}}) {
    if (body < 0) continue;
    const Vec3 arm = point - set.pose(body).position;
    for (int k = 0; k < 3; ++k) {
      const Vec3 direction = frame.row(k).transpose();
      H.block<1, 3>(row + k, 6 * body) += sign * direction.transpose();
      H.block<1, 3>(row + k, 6 * body + 3) += sign * arm.cross(direction).transpose();
    }
  }
}

/// What a stack did while it stood.
struct Standing {
  double drift = 0;           ///< of the top, from where it was set down, m
  double penetration = 0;     ///< largest, m
  double kinetic_energy = 0;  ///< largest of the last second, J
  double residual = 0;        ///< largest of all steps
  int unconverged = 0;        ///< steps whose status was not `converged`
  int most_sweeps = 0;
  int rejects = 0;  ///< answers of the backend that its certificate refused
};

template <class Loop, class Handle>
Standing stand(Loop& loop, Handle top, double seconds = 60, double h = 1.0 / 60) {
  auto& set = rigid_bodies(loop);
  const Vec3 start = set.position(top);
  const int steps = int(std::lround(seconds / h));
  Standing seen;
  for (int n = 0; n < steps; ++n) {
    const StepReport report = loop.step(h);
    seen.drift = std::max(seen.drift, (set.position(top) - start).norm());
    seen.penetration = std::max(seen.penetration, report.max_penetration);
    seen.residual = std::max(seen.residual, report.residual);
    seen.unconverged += report.status == Status::converged ? 0 : 1;
    seen.most_sweeps = std::max(seen.most_sweeps, report.sweeps);
    seen.rejects += report.rejects;
    if ((steps - n) * h <= 1) seen.kinetic_energy = std::max(seen.kinetic_energy, kinetic_energy(set));
  }
  return seen;
}

}  // namespace scenes
