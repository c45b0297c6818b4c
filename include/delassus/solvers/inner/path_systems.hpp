/// The matrix of smoothed rows: in the velocities of the bodies, or in the impulses where there are none.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/block_lu.hpp>
#include <delassus/math/pivoted_lu.hpp>
#include <delassus/solvers/inner/newton_system.hpp>
#include <delassus/solvers/inner/path_item.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// With y the change of the bodies' velocities that δλ = P D δ/w makes, −∂r/∂x δ = ρ is
///
///   δ = (1 + E) F (ρ − P H y),   (1 + G S H) y = G S P⁻¹ ρ,   S = P E F P/w,   F = (B + P C P E/w)⁻¹:
///
/// one sparse factorization with six unknowns a body, however many contacts they have. Rank of W does not
/// matter.
template <class Rows>
class PathBodies {
  using System = NewtonSystem<PathItem, Rows>;

 public:
  static constexpr double largest_ratio = 1e10;  ///< of E, whose rounding the passes of `solve` take back

  bool gather(auto& problem) {
    return system_.gather(problem);
  }
  void each(auto&& f) {
    system_.each([&](auto p, auto& c, auto&) { f(p, c); });
  }

  bool factor() {
    bool is_regular = true;
    each([&](auto, auto& c) {
      auto bent = c.B;
      for (int k = 0; k < c.shape.size(); ++k)
        for (int l = 0; l < c.shape.size(); ++l)
          bent(k, l) += c.shape[k] * c.compliance[k] * c.scale[k] * c.E(k, l);
      PivotedLu<std::remove_cvref_t<decltype(c)>::rows, double> lu;
      is_regular = is_regular && lu.factor(bent);
      if (!is_regular) return;
      c.folded.setIdentity();
      lu.solve(c.folded);
      c.slope = c.scale.asDiagonal() * (c.E * c.folded) * c.shape.asDiagonal();
    });
    return is_regular && system_.factor();
  }
  /// Whether det(−∂r/∂x) < 0: between it and the matrix that is factored lie positive ones.
  bool is_negative() const { return system_.is_negative(); }
  /// Leaves δ in `lambda`, ρ being `side`. With g = (1 + E)⁻¹ δ what a pass has left of ρ is
  /// ρ − B g − P (W + C) P E g/w, which goes in again: where contacts carry, E is large, and so is the
  /// rounding of the matrix.
  void solve() {
    system_.each([](auto, auto& c, auto&) {
      c.error.setZero();
      c.lambda = c.side;
    });
    for (int pass = 0;; ++pass) {
      push([](const auto& c) { return (c.scale.asDiagonal() * (c.E * (c.folded * c.lambda))).eval(); });
      system_.solve(y_);
      system_.each([&](auto, auto& c, auto& sides) {
        for (Index s = c.first; s < c.last; ++s) c.lambda -= c.shape.cwiseProduct(sides[s].H * at(sides[s]));
        c.error.noalias() += c.folded * c.lambda;
      });
      if (pass == passes - 1) break;
      push([](const auto& c) { return c.scale.cwiseProduct(c.E * c.error).eval(); });
      system_.each([&](auto, auto& c, auto& sides) {
        Vec<std::remove_cvref_t<decltype(c)>::rows> velocity =
            c.compliance.cwiseProduct(c.scale.cwiseProduct(c.E * c.error));
        for (Index s = c.first; s < c.last; ++s) velocity.noalias() += sides[s].H * at(sides[s]);
        c.lambda = c.side - c.B * c.error - c.shape.cwiseProduct(velocity);
      });
    }
    system_.each([](auto, auto& c, auto&) { c.lambda = c.error + c.E * c.error; });
  }
  /// Leaves W δλ in `velocity`, δλ being `error`.
  void answer() {
    push([](const auto& c) { return c.error; });
    system_.each([&](auto, auto& c, auto& sides) {
      c.velocity = c.compliance.cwiseProduct(c.error);
      for (Index s = c.first; s < c.last; ++s) c.velocity.noalias() += sides[s].H * at(sides[s]);
    });
  }

 private:
  static constexpr int passes = 3;

  auto& at(const auto& side) {
    return y_[std::size_t(side.block)];
  }
  /// y ← Σ G f(c).
  void push(const auto& f) {
    y_.assign(system_.blocks(), Velocity::Zero());
    system_.each([&](auto, auto& c, auto& sides) {
      const auto impulse = f(c);
      for (Index s = c.first; s < c.last; ++s) at(sides[s]).noalias() += sides[s].G * impulse;
    });
  }

  using Velocity = typename System::Velocities::value_type;
  System system_;
  typename System::Velocities y_;
};

/// One pool of rows with an assembled W. With δλ = P D δ/w,
///
///   (W + w P⁻¹ B E⁻¹ P⁻¹) δλ = P⁻¹ ρ,   δ = (1 + E⁻¹) w P⁻¹ δλ:
///
/// what is added to W grows where a contact opens, and where it carries it keeps W's null space from being
/// one.
template <class Rows>
class PathImpulses {
  static constexpr int R = Rows::template rows_of<0>;
  static constexpr double least = 1e-14;  ///< of w, added to W: above the rounding of its null space

 public:
  static constexpr double largest_ratio = 1e12;  ///< of E: its inverse stands beside W

  bool gather(auto& problem) {
    items_.resize(std::size_t(problem.row_count() / R));
    own_.clear();
    entries_.clear();
    pairs_.clear();
    const auto& W = problem.compliance().template blocks<0, 0>();
    bool is_sound = true;
    problem.each([&](auto, Index i) {
      is_sound = is_sound && i == Index(own_.size()) && problem.book().template friction<0>(i) > 0;
      if (!is_sound) return;
      items_[std::size_t(i)].item = i;
      own_.push_back(problem.compliance().template diagonal<0>(i));
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
        entries_.push_back({i, W.column[e], W.block[e]});
        pairs_.emplace_back(i, W.column[e]);
      }
    });
    if (is_sound && items_.size() + 1 == W.start.size()) matrix_.analyse(Index(items_.size()), pairs_);
    return is_sound && items_.size() + 1 == W.start.size();
  }
  void each(auto&& f) {
    for (auto& c : items_) f(std::integral_constant<int, 0>{}, c);
  }

  bool factor() {
    matrix_.set_identity();
    for (auto& c : items_) {
      Block own = own_[std::size_t(c.item)];
      const Mat<R, R> bent = c.B * c.inverse;
      for (int k = 0; k < R; ++k) {
        for (int l = 0; l < R; ++l) own(k, l) += bent(k, l) / (c.shape[k] * c.scale[l]);
        own(k, k) += least * c.weight;
      }
      matrix_.at(c.item, c.item) = c.slope = own;
    }
    for (const Entry& e : entries_) matrix_.at(e.row, e.column) = e.block;
    return matrix_.factor();
  }
  bool is_negative() const { return matrix_.is_negative(); }
  void solve() {
    for (auto& c : items_) {
      c.side = c.side.cwiseQuotient(c.shape).eval();
      c.error.setZero();
    }
    for (int pass = 0; pass < 3;
         ++pass) {  // pivots inside blocks alone leave a residual, which goes in again
      y_.resize(items_.size());
      for (const auto& c : items_) y_[std::size_t(c.item)] = c.side - c.slope * c.error;
      for (const Entry& e : entries_) y_[std::size_t(e.row)] -= e.block * items_[std::size_t(e.column)].error;
      matrix_.solve(y_);
      for (auto& c : items_) c.error += y_[std::size_t(c.item)];
    }
    for (auto& c : items_) {
      const Vec<R> change = c.error.cwiseQuotient(c.scale);
      c.lambda = change + c.inverse * change;
    }
  }
  void answer() {
    for (auto& c : items_) c.velocity = own_[std::size_t(c.item)] * c.error;
    for (const Entry& e : entries_)
      items_[std::size_t(e.row)].velocity += e.block * items_[std::size_t(e.column)].error;
  }

 private:
  using Block = Mat<R, R>;
  struct Entry {
    Index row, column;
    Block block;
  };

  Array<PathItem<R>> items_;
  Array<Block> own_;      ///< W_ii
  Array<Entry> entries_;  ///< W_ij, i ≠ j
  Array<std::pair<Index, Index>> pairs_;
  BlockLu<R, double> matrix_;
  Array<Vec<R>> y_;
};

template <class Rows>
using PathSystem = std::conditional_t<(Rows::set_count > 0), PathBodies<Rows>, PathImpulses<Rows>>;

}  // namespace delassus::inner
