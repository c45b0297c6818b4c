/// Springs with damping between points, and the system matrix they make under an implicit integrator.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/linear/block_cholesky.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/soft.hpp>

#include <string>
#include <utility>
#include <span>

namespace delassus {

/// Between blocks `a` and `b`, or `a` and `point` of the world when b < 0. N/m, N·s/m, m.
struct Spring {
  /// A block of the set.
  Index a = -1, b = -1;  ///< another block, or −1
  Vec3 point = zero<Vec3>();  ///< world, m; read where b < 0
  /// @var stiffness
  /// N/m, ≥ 0.
  /// @var damping
  /// N·s/m, ≥ 0.
  double stiffness = 0, damping = 0, rest = 0;  ///< length without a force, m, from 0 to 1e20
};

/// f_a = −(k (l − L) + c ė) e with e the unit vector from b to a, l the length, and for A
///
///   K = k [(1 − L/l)₊ (1 − e eᵀ) + e eᵀ],   D = c e eᵀ.
///
/// The first term of K is negative while a spring is pressed (l < L). It is cut at zero there, so that A stays
/// positive definite. The step is then implicit in the spring's direction only.
template <class T>
class Springs {
 public:
  using Block = Mat<3, 3, T>;           ///< of A
  using Velocity = Vec<3, T>;           ///< also of places and forces
  using Vec3 = Vec<3, DoubleIn<T>>;     ///< in double, whatever T is
  using Mat3 = Mat<3, 3, DoubleIn<T>>;  ///< in double, whatever T is

  /// Refuses numbers that are negative or not finite, and a spring of one end; `who` begins the message.
  void add(const Spring& spring, const std::string& who) {
    inner::expect_not_negative(who + ": spring stiffness", spring.stiffness, "N/m");
    inner::expect_not_negative(who + ": spring damping", spring.damping, "N·s/m");
    inner::expect_not_negative(who + ": rest length", spring.rest, "m");
    DELASSUS_EXPECT(spring.rest <= 1e20, who + ": rest length " + inner::text(spring.rest) + " must be <= 1e20 m");
    inner::check_soft_number(spring.stiffness, (who + ": spring stiffness").c_str(), "N/m");
    inner::check_soft_number(spring.damping, (who + ": spring damping").c_str(), "N·s/m");
    DELASSUS_EXPECT(is_finite(spring.point), who + ": the spring's point is not finite");
    DELASSUS_EXPECT(spring.a != spring.b, who + ": a spring needs two different ends");
    springs_.push_back(spring);
    hold(spring);
    analysed_blocks_ = -1;
  }
  /// Takes out every spring that holds this block.
  void remove_of(Index block) {
    erase_if(springs_, [&](const Spring& s) { return s.a == block || s.b == block; });
    find_held();
    analysed_blocks_ = -1;
  }

  bool is_empty() const { return springs_.empty(); }  ///< no spring at all
  bool holds(Index block) const { return block < Index(is_held_.size()) && is_held_[block] != 0; }  ///< a spring ends there
  /// Whether the last `factor` met a spring between two blocks that move.
  bool is_coupled() const { return is_coupled_; }
  /// f(a, b) for blocks that A couples.
  void each_tie(auto&& f) const {
    if (!is_coupled_) return;
    for (const auto& [a, b] : pairs_) f(a, b);
  }

  /// Σ k (l − L)²/2 at the places x (m), J.
  double energy(std::span<const Velocity> x) const {
    double sum = 0;
    for (const Spring& s : springs_) {
      const double stretch = norm(span(s, x)) - s.rest;
      sum += 0.5 * s.stiffness * stretch * stretch;
    }
    return sum;
  }

  void add_forces(std::span<Velocity> p, std::span<const Velocity> x, std::span<const Velocity> v) const {
    for (const Spring& s : springs_) {
      const Vec3 d = span(s, x);
      const double length = norm(d);
      if (length == 0) continue;
      const Vec3 e = d / length;
      const double pull = s.stiffness * (length - s.rest) + s.damping * dot(e, rate(s, v));
      push(p, s, -pull * e);
    }
  }

  /// p += s ∂f/∂x v = −s K v.
  void add_stiffness_times_velocity(std::span<Velocity> p, std::span<const Velocity> x,
                                    std::span<const Velocity> v, T scale) const {
    for (const Spring& s : springs_) push(p, s, -double(scale) * (stiffness(s, x) * rate(s, v)));
  }

  /// Makes A and its factors. `active` are the live blocks; those with inverse mass 0 do not move.
  void factor(SystemScale scale, std::span<const Velocity> x, const Array<T>& mass,
              const Array<T>& inverse_mass, const Array<Index>& active) {
    const bool is_plain = springs_.empty() || (scale.stiffness == 0 && scale.damping == 0);
    is_coupled_ = false;
    inverse_mass_ = inverse_mass.data();
    inverse_scale_ = T(1 / scale.mass);
    if (is_plain) {
      inverse_.clear();
      return;
    }
    const Index n = Index(x.size());
    pairs_.clear();
    inverse_.assign(n, zero<Block>());
    for (const Index b : active) inverse_[b] = T(scale.mass) * mass[b] * Block::Identity();
    for (const Spring& s : springs_) {
      const Block K = system(s, x, scale);
      inverse_[s.a] += K;
      if (s.b < 0) continue;
      inverse_[s.b] += K;
      if (inverse_mass[s.a] > 0 && inverse_mass[s.b] > 0) pairs_.emplace_back(s.a, s.b);
    }
    is_coupled_ = !pairs_.empty();
    if (is_coupled_) factor_coupled(scale, x, inverse_mass, n);
    else
      for (Index b = 0; b < n; ++b)
        inverse_[b] = inverse_mass[b] > 0 ? Block(inverse_[b].inverse()) : Block(zero<Block>());
  }

  /// (mass scale · m_b)⁻¹ x: as if no spring were there.
  template <int C>
  Mat<3, C, T> solve_mass(Index b, const Mat<3, C, T>& x) const {
    return (inverse_scale_ * inverse_mass_[b]) * x;
  }
  /// A_b⁻¹ x for each column of x: right where A does not couple b to another block.
  template <int C>
  Mat<3, C, T> solve_block(Index b, const Mat<3, C, T>& x) const {
    if (inverse_.empty()) return (inverse_scale_ * inverse_mass_[b]) * x;
    return inverse_[b] * x;
  }

  /// x ← A⁻¹ x; entries of blocks that do not move become zero.
  void solve(std::span<Velocity> x) const {
    for (std::size_t b = 0; b < x.size(); ++b)
      if (!(inverse_mass_[b] > 0)) set_zero(x[b]);
    if (is_coupled_) cholesky_.solve(x);
    else
      for (std::size_t b = 0; b < x.size(); ++b) x[b] = solve_block<1>(Index(b), x[b]);
  }

  void memory(auto& archive) {
    archive(springs_);
    find_held();
    analysed_blocks_ = -1;
  }

 private:
  void hold(const Spring& s) {
    const std::size_t blocks = std::size_t(std::max(s.a, s.b)) + 1;
    if (is_held_.size() < blocks) is_held_.resize(blocks, 0);
    is_held_[s.a] = 1;
    if (s.b >= 0) is_held_[s.b] = 1;
  }
  void find_held() {
    is_held_.clear();
    for (const Spring& s : springs_) hold(s);
  }
  Vec3 span(const Spring& s, std::span<const Velocity> x) const {
    const Vec3 end = s.b < 0 ? s.point : Vec3(converted<double>(x[s.b]));
    return converted<double>(x[s.a]) - end;
  }
  static Vec3 rate(const Spring& s, std::span<const Velocity> v) {
    const Vec3 end = s.b < 0 ? Vec3(zero<Vec3>()) : Vec3(converted<double>(v[s.b]));
    return converted<double>(v[s.a]) - end;
  }
  static void push(std::span<Velocity> p, const Spring& s, const Vec3& force) {
    p[s.a] += converted<T>(force);
    if (s.b >= 0) p[s.b] -= converted<T>(force);
  }
  Mat3 stiffness(const Spring& s, std::span<const Velocity> x) const {
    const Vec3 d = span(s, x);
    const double length = norm(d);
    if (length == 0) return s.rest > 0 ? Mat3(zero<Mat3>()) : Mat3(s.stiffness * Mat3::Identity());
    const Vec3 e = d / length;
    const double across = s.stiffness * std::max(0.0, 1 - s.rest / length);
    return across * Mat3::Identity() + (s.stiffness - across) * e * e.transpose();
  }
  Block system(const Spring& s, std::span<const Velocity> x, SystemScale scale) const {
    const Vec3 d = span(s, x);
    const double length = norm(d);
    const Vec3 e = length > 0 ? Vec3(d / length) : Vec3(zero<Vec3>());
    return converted<T>(scale.stiffness * stiffness(s, x) + scale.damping * s.damping * e * e.transpose());
  }

  void factor_coupled(SystemScale scale, std::span<const Velocity> x, const Array<T>& inverse_mass, Index n) {
    if (analysed_blocks_ != n) cholesky_.analyse(n, pairs_);
    analysed_blocks_ = n;
    cholesky_.set_zero();
    for (Index b = 0; b < n; ++b)
      cholesky_.add_diagonal(b, inverse_mass[b] > 0 ? inverse_[b] : Block(Block::Identity()));
    for (const Spring& s : springs_)
      if (s.b >= 0 && inverse_mass[s.a] > 0 && inverse_mass[s.b] > 0)
        cholesky_.add_pair(s.a, s.b, Block(-system(s, x, scale)));
    cholesky_.factor();
  }

  Array<Spring> springs_;
  Array<char> is_held_;  ///< by block: whether a spring ends there
  Array<std::pair<Index, Index>> pairs_;
  Array<Block> inverse_;
  BlockCholesky<3, T> cholesky_;
  const T* inverse_mass_ = nullptr;
  T inverse_scale_ = 1;
  bool is_coupled_ = false;
  Index analysed_blocks_ = -1;  ///< how many blocks the pattern was analysed for; −1 after an edit
};

}  // namespace delassus
