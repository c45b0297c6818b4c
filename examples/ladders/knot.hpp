/// An overhand knot in a rope that hangs straight else, and whether a rope is knotted still.
#pragma once

#include <delassus/math/linear.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace ladders {

using delassus::Mat3, delassus::Vec3;

/// The centre line of an overhand knot about the origin, from `reach` above it to `reach` below, as points
/// that lie close. The torus knot ((2 + cos 3t) cos 2t, (2 + cos 3t) sin 2t, sin 3t), a trefoil, without its
/// outer arc |t| < π/6 between two crossings; from both ends of that gap a quarter of a circle leads to the
/// straight ends. Its strands keep 1.65 apart, and half a turn about the x axis changes nothing.
inline std::vector<Vec3> overhand_knot(double reach) {
  using std::numbers::pi;
  constexpr int fine = 4000;
  const double bend = 1.3, top = std::sqrt(3.) + bend;
  std::vector<Vec3> out;
  for (int k = 0; k <= fine; ++k) {  // the straight end comes to the knot's front on its last eight units
    const double above = (reach - top) * (1 - double(k) / fine), u = std::min(1., above / 8);
    out.push_back({0, u * u * (3 - 2 * u) - 1, top + above});
  }
  for (int k = 1; k < fine; ++k) {
    const double angle = 0.5 * pi * k / fine;
    out.push_back({bend * (std::cos(angle) - 1), -1, top - bend * std::sin(angle)});
  }
  for (int k = 0; k <= fine; ++k) {
    const double t = pi / 6 + (pi - pi / 6) * k / fine, r = 2 + std::cos(3 * t);
    out.push_back({r * std::cos(2 * t) - 1 - bend, -std::sin(3 * t), r * std::sin(2 * t)});
  }
  for (std::size_t k = out.size() - 1; k-- > 0;) out.push_back({out[k].x(), -out[k].y(), -out[k].z()});
  return out;
}

/// Points on a line, each `length` from the next as the crow flies, from the line's start on.
inline std::vector<Vec3> equal_chords(const std::vector<Vec3>& line, double length) {
  std::vector<Vec3> out{line[0]};
  for (std::size_t k = 1; k < line.size(); ++k)
    while ((line[k] - out.back()).norm() >= length) {
      // |a + t e| = length on the piece from line[k − 1] to line[k]
      const Vec3 a = line[k - 1] - out.back(), e = line[k] - line[k - 1];
      const double A = e.squaredNorm(), B = a.dot(e), C = a.squaredNorm() - length * length;
      out.push_back(line[k - 1] + (std::sqrt(B * B - A * C) - B) / A * e);
    }
  return out;
}

/// The determinant |Δ(−1)| of the knot that a line of straight pieces becomes when its first end goes on
/// upwards (z) and its last downwards, and the two meet far away: 1 without a knot, 3 of an overhand knot, 5
/// of a figure of eight.
///
/// Seen along one direction, the over-passing arc a of each crossing and the two that end under it, b and c,
/// give the row 2 a − b − c = 0 of the knot's colourings; the determinant is that of all rows and columns but
/// one.
inline double knot_determinant(std::vector<Vec3> line) {
  double size = 1;
  for (const Vec3& x : line) size = std::max(size, (x - line[0]).norm());
  const Vec3 far(30 * size, 0, 0), up(0, 0, 10 * size);
  const Vec3 first = line.front() + up, last = line.back() - up;
  line.insert(line.begin(), {Vec3(first + far), first});
  line.insert(line.end(), {last, Vec3(last + far)});
  const Mat3 askew = Eigen::AngleAxisd(0.1234, Vec3(0.3, 0.5, 0.7).normalized()).toRotationMatrix();
  for (Vec3& x : line) x = askew * x;

  struct Pass {
    double at;  ///< piece, and where on it
    int crossing;
    bool is_over;
  };
  std::vector<Pass> passes;
  const std::size_t n = line.size();
  const auto box = [&](std::size_t k) {  // as seen along y
    const Vec3 &a = line[k], &b = line[(k + 1) % n];
    return Eigen::AlignedBox2d(Eigen::Vector2d(std::min(a.x(), b.x()), std::min(a.z(), b.z())),
                               Eigen::Vector2d(std::max(a.x(), b.x()), std::max(a.z(), b.z())));
  };
  int crossings = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n; ++k) {
      if ((k + 1) % n == i || !box(i).intersects(box(k))) continue;
      // a + s u = b + t v
      const Vec3 a = line[i], u = line[i + 1] - a, b = line[k], v = line[(k + 1) % n] - b, ab = b - a;
      const double det = u.x() * v.z() - u.z() * v.x();
      const double s = (ab.x() * v.z() - ab.z() * v.x()) / det, t = (ab.x() * u.z() - ab.z() * u.x()) / det;
      if (!(s >= 0 && s < 1 && t >= 0 && t < 1)) continue;
      const bool is_over = a.y() + s * u.y() > b.y() + t * v.y();
      passes.push_back({double(i) + s, crossings, is_over});
      passes.push_back({double(k) + t, crossings, !is_over});
      ++crossings;
    }
  if (crossings < 2) return 1;
  std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) { return a.at < b.at; });
  Eigen::MatrixXd colours = Eigen::MatrixXd::Zero(crossings, crossings);
  int arc = 0;
  for (const Pass& pass : passes)
    if (pass.is_over) {
      colours(pass.crossing, arc) += 2;
    } else {
      colours(pass.crossing, arc) -= 1;
      arc = (arc + 1) % crossings;
      colours(pass.crossing, arc) -= 1;
    }
  return std::abs(colours.topLeftCorner(crossings - 1, crossings - 1).determinant());
}

}  // namespace ladders
