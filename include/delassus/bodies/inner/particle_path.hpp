/// One particle on its way through a step, for schemes that lead it there themselves.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <cstddef>

namespace delassus::inner {

/// What `RigidPath` does with bodies, of points; the state is their places.
template <class T>
class ParticlePath {
 public:
  using Vector = Vec<3, T>;
  using State = Array<Vector>;

  void resize(std::size_t n) { points_.resize(n); }
  void begin(const State& x, Index b, const Vector& v) {
    points_[b] = {x[b], v, x[b], zero<Vector>(), zero<Vector>(), zero<Vector>(), zero<Vector>()};
  }
  const Vector& start_velocity(Index b) const { return points_[b].v; }
  void back(State& x, Index b) const { x[b] = points_[b].x; }

  /// x ← x₀ + h w.
  Vector drift(State& x, Index b, const Vector& w, T h, bool moves) const {
    x[b] = points_[b].x;
    if (moves) x[b] += h * w;
    return w;
  }

  template <int C, class Set>
  Mat<3, C, T> answer(const Set& set, Index b, const Mat<3, C, T>& X, T h) const {
    return h * set.template solve_block<C>(b, X);
  }

  Vector gyroscopic(const State&, Index, const Vector&) const { return zero<Vector>(); }
  Vector to_stage(State& x, Index b, T t, bool moves) const {
    const Point& p = points_[b];
    x[b] = moves ? Vector(p.x + t * p.slope_x) : p.x;
    return moves ? Vector(p.v + t * p.slope_v) : p.v;
  }
  void keep_stage(const State& x, Index b) { points_[b].stage = x[b]; }
  void look_along(State& x, Index b, const Vector& v, T t) const { x[b] = points_[b].stage + t * v; }
  void note_slope(const State&, Index b, const Vector& v, const Vector& a, T weight) {
    Point& p = points_[b];
    p.slope_x = v;
    p.slope_v = a;
    p.sum_x += weight * v;
    p.sum_v += weight * a;
  }
  Vector to_end(State& x, Index b, T h, bool moves) const {
    const Point& p = points_[b];
    x[b] = moves ? Vector(p.x + h * p.sum_x) : p.x;
    return moves ? Vector(p.v + h * p.sum_v) : p.v;
  }

 private:
  struct Point {
    Vector x, v, stage, slope_x, slope_v, sum_x, sum_v;
  };
  Array<Point> points_;
};

}  // namespace delassus::inner
