/// Seeded pairs of shapes in random poses, and their true depth found by brute force.
#pragma once

#include <delassus/collision/inner/difference.hpp>
#include <delassus/collision/signed_pair.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace samples {

using namespace delassus;

/// Scatters `count` points on a ball: a hull with all of them as vertices.
inline ConvexHull ball_hull(int count, unsigned seed, double radius) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i)
    points.push_back(radius * Vec3{normal(random), normal(random), normal(random)}.normalized());
  return ConvexHull(points).centred();
}

inline Vec3 any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return Vec3(x, y, z).normalized();
}

inline Mat3 any_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Quat(w, x, y, z).normalized().toRotationMatrix();
}

inline double thickness(const Shape& s) {
  switch (s.kind) {
    case ShapeKind::box:
    case ShapeKind::ellipsoid:
      return std::min({s.size[0], s.size[1], s.size[2]});
    case ShapeKind::cylinder:
      return std::min(s.size[0], s.size[1]);
    case ShapeKind::cone:  // the radius of the ball inside
      return 2 * s.size[0] * s.size[1] / (s.size[0] + std::hypot(s.size[0], 2 * s.size[1]));
    case ShapeKind::convex_hull:
      return s.hull->inner_radius();
    default:
      return s.size[0];
  }
}

/// Face normals and edge directions, in the frame that R turns into.
inline void features(const Shape& s, const Mat3& R, std::vector<Vec3>& normals, std::vector<Vec3>& edges) {
  if (s.kind == ShapeKind::box)
    for (int k = 0; k < 3; ++k) {
      normals.insert(normals.end(), {R.col(k), -R.col(k)});
      edges.push_back(R.col(k));
    }
  if (s.kind == ShapeKind::cylinder) normals.insert(normals.end(), {R.col(2), -R.col(2)});
  if (s.kind == ShapeKind::cone) normals.push_back(-R.col(2));
  if (s.kind == ShapeKind::cylinder || s.kind == ShapeKind::capsule) edges.push_back(R.col(2));
  if (s.kind != ShapeKind::convex_hull) return;
  for (Index f = 0; f < s.hull->face_count(); ++f) {
    normals.push_back(R * s.hull->normal(f));
    const auto loop = s.hull->face(f);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Index u = loop[i], v = loop[(i + 1) % loop.size()];
      if (u < v) edges.push_back(R * (s.hull->vertices()[v] - s.hull->vertices()[u]).normalized());
    }
  }
}

struct Sample {
  Shape a, b;
  Pose b_in_a;
  double reach(const Vec3& n) const { return inner::Difference{a, b, b_in_a}.reach(n); }
};

/// Lowers h(n) from n by shrinking steps: along the support point's tangent, and at random.
inline double descend(const Sample& s, Vec3& n, std::mt19937& random) {
  double h = s.reach(n), step = 0.1;
  for (int i = 0; i < 400 && step > 1e-9; ++i) {
    const Vec3 w = inner::Difference{s.a, s.b, s.b_in_a}.core(n).w, slope = w - w.dot(n) * n;
    bool is_lower = false;
    for (int k = 0; k < 3 && !is_lower; ++k) {
      const Vec3 move = k == 0 && slope.norm() > 0 ? Vec3(-slope.normalized()) : any_direction(random);
      for (const double sign : {1.0, -1.0}) {
        const Vec3 trial = (n + sign * step * move).normalized();
        const double value = s.reach(trial);
        if (value < h) {
          h = value;
          n = trial;
          is_lower = true;
          break;
        }
      }
    }
    step = is_lower ? std::min(0.3, 1.6 * step) : 0.7 * step;
  }
  return h;
}

/// min h(n): over all face normals, all products of edges and 500 spread directions; for round shapes the
/// best of these are refined. Exact for overlapping polytopes, whose minimum is at one of the candidates.
inline double true_depth(const Sample& s, std::mt19937& random) {
  std::vector<Vec3> normals, normals_b, edges_a, edges_b;
  features(s.a, Mat3::Identity(), normals, edges_a);
  features(s.b, s.b_in_a.rotation, normals_b, edges_b);
  for (const Vec3& n : normals_b) normals.push_back(-n);
  for (const Vec3& u : edges_a)
    for (const Vec3& v : edges_b)
      if (u.cross(v).norm() > 1e-9)
        normals.insert(normals.end(), {u.cross(v).normalized(), -u.cross(v).normalized()});
  for (int i = 0; i < 500; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 500, r = std::sqrt(1 - z * z), angle = 2.399963229728653 * i;
    normals.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  if (s.b_in_a.position.norm() > 0) normals.push_back(s.b_in_a.position.normalized());
  std::vector<std::pair<double, Vec3>> found;
  for (const Vec3& n : normals) found.emplace_back(s.reach(n), n);
  std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  double best = found[0].first;
  const auto is_polytope = [](const Shape& x) {
    return x.kind == ShapeKind::box || x.kind == ShapeKind::convex_hull;
  };
  if (is_polytope(s.a) && is_polytope(s.b)) return best;
  std::vector<Vec3> starts;
  for (const auto& [h, n] : found) {
    bool is_new = starts.size() < 6;
    for (const Vec3& other : starts) is_new = is_new && other.dot(n) < 0.99;
    if (is_new) starts.push_back(n);
  }
  for (Vec3 n : starts) best = std::min(best, descend(s, n, random));
  return best;
}

/// Support points of both along n, one over the other: when `apart` ≥ 0 it is the distance and n the normal.
inline Sample at_distance(const Shape& a, const Shape& b, const Mat3& rotation, const Vec3& n, double apart) {
  const Vec3 on_a = support(a, n), on_b = rotation * support(b, Vec3(-(rotation.transpose() * n)));
  return {a, b, {.position = on_a - on_b + apart * n, .rotation = rotation}};
}

enum class Depth { deep, hundredth, ten_thousandth, touch, gap_thousandth, gap_half };
inline constexpr Depth depths[] = {Depth::deep,  Depth::hundredth,      Depth::ten_thousandth,
                                   Depth::touch, Depth::gap_thousandth, Depth::gap_half};

/// A pose at the wanted depth along a direction, every second time a face normal. When apart or touching, the
/// distance along it is the true one; when deep, the truth may be less.
inline Sample any_pose(const Shape& a, const Shape& b, Depth depth, bool use_face, std::mt19937& random,
                       double& apart) {
  Sample s{a, b, {.rotation = any_rotation(random)}};
  std::vector<Vec3> normals, normals_b, edges;
  features(a, Mat3::Identity(), normals, edges);
  features(b, s.b_in_a.rotation, normals_b, edges);
  for (const Vec3& n : normals_b) normals.push_back(-n);
  std::uniform_real_distribution<double> uniform;
  Vec3 n = any_direction(random);
  if (use_face && !normals.empty()) n = normals[std::size_t(uniform(random) * double(normals.size()))];
  const double scale = std::min(length_scale(a), length_scale(b)),
               thin = std::min(thickness(a), thickness(b));
  switch (depth) {
    case Depth::deep:
      apart = -thin * (0.1 + 0.5 * uniform(random));
      break;
    case Depth::hundredth:
      apart = -1e-2 * scale;
      break;
    case Depth::ten_thousandth:
      apart = -1e-4 * scale;
      break;
    case Depth::touch:
      apart = 0;
      break;
    case Depth::gap_thousandth:
      apart = 1e-3 * scale;
      break;
    case Depth::gap_half:
      apart = 0.5 * scale;
      break;
  }
  return at_distance(a, b, s.b_in_a.rotation, n, apart);
}

}  // namespace samples
