/// AC-12: Andrews' squeezing mechanism, seven bodies in a plane, driven by a motor of 0.033 N·m.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace squeezer {

using namespace delassus;

/// A constant moment about z, as a soft row that hardly has a stiffness: λ = h M for every integrator.
struct Moment {
  static constexpr int rows = 1;
  static constexpr bool bilateral = true;
  struct Item {
    Anchor a, b;
    double moment;  ///< N·m, on b
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    constexpr double stiffness = 1e-9;
    row.end(item.b, world.point(item.b)).about(0, unit_axis(2));
    row.phi(0, -item.moment / stiffness);
    row.soft(0, stiffness, 0);
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const { return Vec<1>(-b[0] / W(0, 0)); }
};

/// The angles of the mechanism, rad. Source: [HairerWanner1996], chapter VII.7.
struct Angles {
  double beta, theta, gamma, phi, delta, omega, epsilon;
};
inline constexpr Angles at_start{-0.0617138900142764496359, 0,
                                 0.455279819163070380256,   0.222668390165885884674,
                                 0.487364979543842550226,   -0.222668390165885884674,
                                 1.23054744454982119250};
inline constexpr Angles at_30_ms{15.8107711952,   -15.7563710584,  0.0408222401196, -0.5347301163421,
                                 0.5244099658799, 0.5347301163421, 1.0480807410420};

inline constexpr double rr = 7e-3, ra = 92e-5, d = 28e-3, da = 115e-4;
/// The centre of the rod that the crank drives, m.
inline Vec3 centre_of_rod(const Angles& q) {
  const double a = q.beta + q.theta;
  return {rr * std::cos(q.beta) - da * std::cos(a), rr * std::sin(q.beta) - da * std::sin(a), 0};
}

template <class... Policies>
auto make(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, DistanceJoint{}, Moment{}}, policies...};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const double xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273, xc = .014, yc = .072;
  const double e = 2e-2, ea = 1421e-5, sa = 1874e-5, sb = 1043e-5, sc = 18e-3, sd = 2e-2;
  const double ta = 2308e-5, tb = 916e-5, u = 4e-2, ua = 1228e-5, ub = 449e-5, zf = 2e-2, zt = 4e-2,
               fa = 1421e-5;
  const Angles& q = at_start;
  const auto cos = [](double x) { return std::cos(x); };
  const auto sin = [](double x) { return std::sin(x); };
  const auto add = [&](double x, double y, double mass, double inertia) {
    return set.add({.position = {x, y, 0}, .mass = mass, .inertia = Mat3(inertia * Mat3::Identity())});
  };
  const double pd = q.phi + q.delta, oe = q.omega + q.epsilon, bt = q.beta + q.theta;
  const auto b1 = add(ra * cos(q.beta), ra * sin(q.beta), .04325, 2.194e-6);
  const Vec3 rod = centre_of_rod(q);
  const auto b2 = add(rod.x(), rod.y(), .00365, 4.410e-7);
  const auto b3 = add(xb + sa * sin(q.gamma) + sb * cos(q.gamma), yb - sa * cos(q.gamma) + sb * sin(q.gamma),
                      .02373, 5.255e-6);
  const auto b4 = add(xa + zt * cos(q.delta) + (e - ea) * sin(pd),
                      ya + zt * sin(q.delta) - (e - ea) * cos(pd), .00706, 5.667e-7);
  const auto b5 = add(xa + ta * cos(q.delta) - tb * sin(q.delta), ya + ta * sin(q.delta) + tb * cos(q.delta),
                      .07050, 1.169e-5);
  const auto b6 = add(xa + u * sin(q.epsilon) + (zf - fa) * cos(oe),
                      ya - u * cos(q.epsilon) + (zf - fa) * sin(oe), .00706, 5.667e-7);
  const auto b7 = add(xa + ua * sin(q.epsilon) - ub * cos(q.epsilon),
                      ya - ua * cos(q.epsilon) - ub * sin(q.epsilon), .05498, 1.912e-5);

  // The axes of all bodies are the world's at the start.
  const auto at = [&](RigidBodies::Handle body, const Vec3& x) {
    return anchor(set, body, Vec3(x - set.position(body)));
  };
  const auto join = [&](RigidBodies::Handle a, RigidBodies::Handle b, const Vec3& x) {
    loop.add(BallJoint::Item{at(a, x), at(b, x)});
  };
  const auto pin = [&](RigidBodies::Handle a, const Vec3& x) {
    loop.add(BallJoint::Item{at(a, x), world_anchor(x)});
  };
  const Vec3 crank(rr * cos(q.beta), rr * sin(q.beta), 0),
      P(crank.x() - d * cos(bt), crank.y() - d * sin(bt), 0);
  pin(b1, {0, 0, 0});
  join(b1, b2, crank);
  join(b2, b3, P);
  join(b2, b4, P);
  join(b2, b6, P);
  pin(b3, {xb, yb, 0});
  pin(b5, {xa, ya, 0});
  pin(b7, {xa, ya, 0});
  join(b4, b5, {xa + zt * cos(q.delta), ya + zt * sin(q.delta), 0});
  join(b6, b7, {xa + u * sin(q.epsilon), ya - u * cos(q.epsilon), 0});
  const Vec3 hook(sd * cos(q.gamma) + sc * sin(q.gamma) + xb, sd * sin(q.gamma) - sc * cos(q.gamma) + yb, 0);
  loop.add(DistanceJoint::Item{
      .a = at(b3, hook), .b = world_anchor({xc, yc, 0}), .length = 7785e-5, .stiffness = 4530});
  loop.add(Moment::Item{world_anchor(Vec3::Zero()), anchor(set, b1), 0.033});
  return loop;
}

/// The angles, followed over the turns of the crank: each body's own turn since the start.
struct Turns {
  std::array<double, 7> turned{}, last{};

  template <class Loop>
  void follow(const Loop& loop) {
    for (int b = 0; b < 7; ++b) {
      const Mat3 R = loop.world().template set<0>().pose(b).rotation;
      const double now = std::atan2(R(1, 0), R(0, 0));
      turned[std::size_t(b)] += std::remainder(now - last[std::size_t(b)], 2 * EIGEN_PI);
      last[std::size_t(b)] = now;
    }
  }
  Angles angles() const {
    const Angles& q = at_start;
    const double beta = q.beta + turned[0], delta = q.delta + turned[4], epsilon = q.epsilon + turned[6];
    return {beta,
            q.beta + q.theta + turned[1] - beta,
            q.gamma + turned[2],
            q.phi + q.delta + turned[3] - delta,
            delta,
            q.omega + q.epsilon + turned[5] - epsilon,
            epsilon};
  }
};
inline double largest_difference(const Angles& a, const Angles& b) {
  return std::max({std::abs(a.beta - b.beta), std::abs(a.theta - b.theta), std::abs(a.gamma - b.gamma),
                   std::abs(a.phi - b.phi), std::abs(a.delta - b.delta), std::abs(a.omega - b.omega),
                   std::abs(a.epsilon - b.epsilon)});
}

/// How far the rod is from where it should be at 30 ms, m.
template <class Loop>
double error_at_30_ms(const Loop& loop) {
  return (loop.world().template set<0>().pose(1).position - centre_of_rod(at_30_ms)).norm();
}

}  // namespace squeezer
