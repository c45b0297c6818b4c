/// The same steps as a person would write them for one scene: the measure of what the general loop costs.
#pragma once

#include <delassus/math/positive.hpp>
#include <delassus/math/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace by_hand {

using namespace delassus;

inline const Vec3 gravity{0, 0, -9.81};

/// Particles with a mass and a load each, symplectic Euler.
struct Particles {
  std::vector<Vec3> x, v, load;
  std::vector<double> mass, inverse_mass;

  void add(const Vec3& position, const Vec3& velocity, double m) {
    x.push_back(position);
    v.push_back(velocity);
    load.push_back(Vec3::Zero());
    mass.push_back(m);
    inverse_mass.push_back(1 / m);
  }

  int step(double h) {
    int held = 0;
    const int n = int(x.size());
    for (int b = 0; b < n; ++b) {
      const Vec3 impulse = h * (load[b] + mass[b] * gravity), next = v[b] + inverse_mass[b] * impulse;
      load[b].setZero();
      if (!is_finite(next)) {
        ++held;
        continue;
      }
      x[b] += h * next;
      v[b] = next;
    }
    return held;
  }
};

/// Rigid bodies: the kick at fixed rotation, then the drift by the implicit midpoint rule.
struct Bodies {
  std::vector<Vec3> x, v, omega, force, torque;
  std::vector<Quat> q;
  std::vector<Mat3> R, inertia, inverse_inertia, inverse_inertia_world;
  std::vector<double> mass, inverse_mass;

  void add(const Vec3& position, const Vec3& velocity, const Vec3& rate, double m, const Mat3& moments) {
    x.push_back(position);
    v.push_back(velocity);
    omega.push_back(rate);
    force.push_back(Vec3::Zero());
    torque.push_back(Vec3::Zero());
    q.push_back(Quat::Identity());
    R.push_back(Mat3::Identity());
    inertia.push_back(moments);
    inverse_inertia.push_back(moments.inverse());
    inverse_inertia_world.push_back(moments.inverse());
    mass.push_back(m);
    inverse_mass.push_back(1 / m);
  }

  int step(double h) {
    int held = 0;
    const int n = int(x.size());
    for (int b = 0; b < n; ++b) {
      const Vec3 linear = v[b] + inverse_mass[b] * (h * (force[b] + mass[b] * gravity));
      const Vec3 angular = omega[b] + inverse_inertia_world[b] * (h * torque[b]);
      held += drift(b, linear, angular, h) ? 0 : 1;
    }
    return held;
  }

  /// x, R and ω of one body from the velocities after all impulses; false when they are not finite.
  bool drift(int b, const Vec3& linear, const Vec3& angular, double h) {
    force[b].setZero();
    torque[b].setZero();
    if (!is_finite(linear) || !is_finite(angular)) return false;
    x[b] += h * linear;
    v[b] = linear;
    const Vec3 rate = R[b].transpose() * angular, momentum = inertia[b] * rate, spatial = R[b] * momentum;
    q[b] = unit_again(q[b] * midpoint_turn<double>(inertia[b], rate, momentum, momentum, h));
    R[b] = rotation_matrix<double>(q[b]);
    inverse_inertia_world[b].noalias() = R[b] * inverse_inertia[b] * R[b].transpose();
    omega[b] = R[b] * rate_of<double>(inertia[b], R[b].transpose() * spatial);
    return true;
  }
};

/// One body on a ball joint: three rows, one exact solve, its residual measured.
struct Pendulum {
  Bodies body;
  Vec3 hook, arm;  ///< in the world, in the body
  Vec3 lambda = Vec3::Zero();
  double rate = 0.2;
  double residual = 0, violation = 0;

  int step(double h) {
    const Vec3 tip = body.x[0] + body.R[0] * arm, middle = 0.5 * (tip + hook), phi = tip - hook;
    violation = phi.cwiseAbs().maxCoeff();
    const Vec3 r = middle - body.x[0];
    const Vec3 linear = body.v[0] + body.inverse_mass[0] * (h * (body.force[0] + body.mass[0] * gravity));
    const Vec3 angular = body.omega[0] + body.inverse_inertia_world[0] * (h * body.torque[0]);

    // u = v + ω × r; H = (1, −r^), W = H A⁻¹ Hᵀ, d = H v_free + rate φ/h; one joint is solved exactly, λ = −W⁻¹ d.
    const Mat3 across = skew(r);
    const Mat3 turned = body.inverse_inertia_world[0] * across;  // A⁻¹ Hᵀ below
    Mat3 W = -across * turned;
    W.diagonal().array() += body.inverse_mass[0];
    const Vec3 d = linear + angular.cross(r) + (rate / h) * phi;

    lambda = -solve_positive<3, double>(W, d);
    const Vec3 u = d + W * lambda;
    const double velocity = std::max(d.norm(), u.norm());
    residual = velocity > 0 ? u.norm() / velocity : 0;
    return body.drift(0, linear + body.inverse_mass[0] * lambda, angular + turned * lambda, h) ? 0 : 1;
  }
};

}  // namespace by_hand
