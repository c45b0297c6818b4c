/// One rod of a set: its beams, its elastic forces and its system matrix.
#pragma once

#include <delassus/bodies/inner/rigid_state.hpp>
#include <delassus/core/array.hpp>
#include <delassus/fem/inner/beam.hpp>
#include <delassus/fem/inner/held_nodes.hpp>
#include <delassus/fem/rod.hpp>
#include <delassus/linear/block_chain.hpp>
#include <delassus/rows/body_set.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace delassus::inner {

/// Frames of the segments of a line, x along each: the first has y towards `up`, the others turn about it no
/// more than they must.
inline Array<Quat> frames_along(const std::vector<Vec3>& points, const Vec3& up) {
  Array<Quat> frames;
  const double size = up.cwiseAbs().maxCoeff();
  Vec3 x = unit_axis(0), y = size > 0 ? Vec3(up / size) : up;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Vec3 piece = points[k + 1] - points[k], next = piece / piece.norm();
    // The smallest turn from x to next takes y along: y + (x × next) × y + …, written by Rodrigues' formula.
    const Vec3 turn = x.cross(next);
    if (k > 0) y = y + turn.cross(y) + turn.cross(turn.cross(y)) / (1 + x.dot(next));
    x = next;
    y -= x.dot(y) * x;
    if (!(y.norm() > 1e-6)) {  // none was said, or it is along the rod
      int least = 0;
      for (int i = 1; i < 3; ++i)
        if (std::abs(x[i]) < std::abs(x[least])) least = i;
      y = unit_axis(least) - x[least] * x;
    }
    y /= y.norm();
    frames.push_back(unit(Quat(columns<double>(x, y, x.cross(y)))));
  }
  return frames;
}

/// Node k of the rod is block blocks()[k] of the set. Beams are evaluated in double, whatever T is.
template <class T>
class ElasticLine {
 public:
  using Velocity = Vec<6, T>;
  using Block = Mat<6, 6, T>;

  ElasticLine() = default;
  /// The beams of a rod whose points are where it is put, with the frames of its segments.
  ElasticLine(const Rod& rod, const std::vector<Vec3>& points, const Array<Quat>& frames,
              Array<Index> blocks)
      : blocks_(std::move(blocks)) {
    const RodSection& s = rod.section;
    const double E = rod.young, G = E / (2 * (1 + rod.poisson));
    for (std::size_t e = 0; e < frames.size(); ++e) {
      const double L = (points[e + 1] - points[e]).norm(), sheared = L / (s.shear * G * s.area);
      const auto across = [&](double second) { return 1 / (sheared + L * L * L / (12 * E * second)); };
      const Quat second = frames[std::min(e + 1, frames.size() - 1)];
      beams_.push_back({L,
                        {E * s.area / L, across(s.second_z), across(s.second_y)},
                        {G * s.torsion / L, E * s.second_y / L, E * s.second_z / L},
                        Quat::Identity(),
                        unit(second.conjugate() * frames[e])});
    }
    prepare();
  }

  std::span<const Index> blocks() const { return blocks_; }
  const Array<Beam>& beams() const { return beams_; }
  /// N and N·m by node, at the places of the last `factor`.
  const Array<Velocity>& force() const { return force_; }

  /// ∫Ψ where the nodes are, J.
  double energy(const RigidState<T>& nodes) const {
    double sum = 0;
    for (std::size_t e = 0; e < beams_.size(); ++e) sum += beams_[e].energy(strain(e, nodes));
    return sum;
  }

  /// Makes elastic forces, K and the factor of A = mass M + stiffness K where the nodes are. Where there is
  /// no factor, as where a place is not finite, `solve` answers with numbers that are none.
  void factor(SystemScale scale, const RigidState<T>& nodes) {
    const bool is_implicit = scale.stiffness != 0;
    for (Velocity& f : force_) f.setZero();
    for (Block& b : diagonal_) b.setZero();
    for (std::size_t e = 0; e < beams_.size(); ++e)
      add_beam(e, beams_[e].at(strain(e, nodes), is_implicit), is_implicit);
    has_stiffness_ = is_implicit;
    if (!is_implicit) return;
    A_.set_zero();
    for (Index k = 0; k < Index(blocks_.size()); ++k) {
      is_held_[k] = nodes.inverse_mass[blocks_[k]] > T(0) ? 0 : 1;
      A_.add_diagonal(k, is_held_[k] ? Block(Block::Identity()) : system_block(k, scale, nodes));
      if (k > 0 && !is_held_[k] && !is_held_[k - 1])
        A_.add_pair(k, k - 1, Block(T(scale.stiffness) * beside_[k - 1]));
    }
    is_factored_ = A_.factor();
  }

  /// p += −s K v by blocks of the set.
  void add_stiffness_times_velocity(std::span<Velocity> p, std::span<const Velocity> v, T s) const {
    if (!has_stiffness_) return;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      subtract_times<false>(p[blocks_[k]], s, diagonal_[k], v[blocks_[k]]);
    for (std::size_t k = 0; k + 1 < blocks_.size(); ++k) {
      subtract_times<false>(p[blocks_[k + 1]], s, beside_[k], v[blocks_[k]]);
      subtract_times<true>(p[blocks_[k]], s, beside_[k], v[blocks_[k + 1]]);
    }
  }

  /// x ← A⁻¹ x on the blocks of the body.
  void solve(std::span<Velocity> x) const { held().solve(A_, blocks(), work_, x); }
  /// The rows and columns of A⁻¹ of some nodes, 6n × 6n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C) const {
    held().template compliance<6>(A_, nodes, C);
  }

  void memory(auto& archive) {
    archive(beams_, blocks_);
    if (archive.reads) prepare();
  }

 private:
  HeldNodes held() const { return {is_held_, is_factored_}; }
  void prepare() {
    const std::size_t n = blocks_.size();
    force_.assign(n, Velocity::Zero());
    work_ = force_;
    diagonal_.assign(n, Block::Zero());
    beside_.assign(n > 0 ? n - 1 : 0, Block::Zero());
    is_held_.assign(n, 0);
    A_.analyse(Index(n));
    has_stiffness_ = is_factored_ = false;
  }

  Beam::Strain strain(std::size_t e, const RigidState<T>& nodes) const {
    const Index a = blocks_[e], b = blocks_[e + 1];
    return beams_[e].strain(nodes.x[a], nodes.q[a].template cast<double>(), nodes.x[b],
                            nodes.q[b].template cast<double>());
  }

  void add_beam(std::size_t e, const Beam::State& s, bool with_stiffness) {
    add(force_[e], s.force[0], s.force[1]);
    add(force_[e + 1], s.force[2], s.force[3]);
    if (!with_stiffness) return;
    const auto& K = s.K;
    add(diagonal_[e], K[0][0], K[0][1], transposed(K[0][1]), K[1][1]);
    add(diagonal_[e + 1], K[2][2], K[2][3], transposed(K[2][3]), K[3][3]);
    // The second node's rows, the first one's columns.
    beside_[e].setZero();
    add(beside_[e], transposed(K[0][2]), transposed(K[1][2]), transposed(K[0][3]), transposed(K[1][3]));
  }
  static void add(Velocity& to, const Vec3& force, const Vec3& moment) {
    for (int i = 0; i < 3; ++i) to[i] += T(force[i]), to[i + 3] += T(moment[i]);
  }
  /// (a b; c d).
  static void add(Block& to, const Mat3& a, const Mat3& b, const Mat3& c, const Mat3& d) {
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        to(i, j) += T(a(i, j)), to(i, j + 3) += T(b(i, j));
        to(i + 3, j) += T(c(i, j)), to(i + 3, j + 3) += T(d(i, j));
      }
  }
  /// mass diag(m 1, R I Rᵀ) + stiffness K_kk.
  Block system_block(Index k, SystemScale scale, const RigidState<T>& nodes) const {
    const Index b = blocks_[k];
    Block A = T(scale.stiffness) * diagonal_[k];
    const Mat<3, 3, T> I = nodes.R[b] * nodes.inertia[b] * nodes.R[b].transpose();
    for (int i = 0; i < 3; ++i) {
      A(i, i) += T(scale.mass) * nodes.mass[b];
      for (int j = 0; j < 3; ++j) A(i + 3, j + 3) += T(scale.mass) * I(i, j);
    }
    return A;
  }
  template <bool is_transposed>
  static void subtract_times(Velocity& y, T s, const Block& K, const Velocity& x) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) y[i] -= s * (is_transposed ? K(j, i) : K(i, j)) * x[j];
  }

  Array<Beam> beams_;
  Array<Index> blocks_;
  Array<Velocity> force_;
  Array<Block> diagonal_,
      beside_;  ///< K; beside_[k] has the rows of node k + 1 and the columns of node k
  Array<char> is_held_;
  BlockChain<6, T> A_;
  bool has_stiffness_ = false, is_factored_ = false;
  mutable Array<Velocity> work_;
};

}  // namespace delassus::inner
