/// The Delassus operator of soft bodies whose A is not factored anew in each step.
#pragma once

#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/inner/rotated_inverse.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace delassus {

/// What a compliance with a factor of its own did in the last step.
struct ComplianceReport {
  int factorizations = 0;
  int iterations = 0;    ///< of conjugate gradients, the most that one solve took
  int passes = 0;        ///< solves of the rows after the first one
  double violation = 0;  ///< what the rows of the whole A are off, as a displacement of the step, m or rad
};

/// A set of bodies that assembles A without its factor.
template <class S>
concept AssembledSet = NodeCompliantSet<S> && requires(S set, const S fixed, SystemScale scale, Index b) {
  { set.assemble(scale) } -> std::same_as<void>;          // A where the bodies are
  { set.assemble_at_rest(scale) } -> std::same_as<void>;  // A where they are at rest
  { fixed.node_of(b) } -> std::same_as<Index>;            // the number of a block in its body
  fixed.each_system([](Index, auto, const auto&, const auto&) {});
};

namespace inner {

/// When to stop, and when a factor is old.
struct RotatedLimits {
  double violation, tolerance, contraction;
  int max_iterations, max_passes;
};

/// Factors are of the A of some step, and are made anew.
struct FactorOfAStep {
  static constexpr bool is_at_rest = false;
};

/// W̃ = H R F⁻¹ Rᵀ Hᵀ of `RotatedInverse`. What W̃ misses goes into d: with d₀ what the free motion gives and
/// Δv = A⁻¹ Hᵀ λ by conjugate gradients,
///
///   d = d₀ + H Δv − W̃ λ,
///
/// so that after the next solve the rows are off by (W − W̃) Δλ alone, Δλ being what it changed. `Origin` says
/// of which A the factors are; one that `is_at_rest` completes each new one by complete(k, inverse, body).
template <class S, class Rows, class Origin>
class RotatedOperator;

template <class S, class T, int... w, int... R, class Origin>
class RotatedOperator<S, RowSystem<T, Widths<w...>, R...>, Origin>
    : public AssembledCompliance::Operator<RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;
  using Base = AssembledCompliance::Operator<Rows>;

  /// A set as seen through the factors of the operator. `guess`: which of its last answers a solve begins
  /// with.
  template <class Set, int s>
  struct Through {
    using Scalar = T;
    using Velocity = typename Set::Velocity;
    static constexpr int width = Set::width;
    Set& set;
    RotatedOperator& own;
    int guess;

    Index blocks() const { return set.blocks(); }
    bool moves(Index b) const { return set.moves(b); }
    bool is_coupled() const { return set.is_coupled(); }
    Index body_of(Index b) const { return set.body_of(b); }
    void factor(SystemScale scale) { own.template factor<s>(set, scale); }
    void solve(std::span<Velocity> x) const { own.template solve<s>(set, x, guess); }
    void node_compliance(std::span<const Index> blocks, std::span<T> C) const {
      own.template node_compliance<s>(set, blocks, C);
    }
    template <int C>
    auto solve_block(Index b, const Mat<Set::width, C, T>& x) const {
      return set.template solve_block<C>(b, x);
    }
  };

  /// Set s with the inverse that acts here.
  template <int s, class Set>
  requires AssembledSet<Set> Through<Set, s> inverse(Set& set, int guess) { return {set, *this, guess}; }

  /// Before the free motion.
  void begin(const auto& policy) {
    limits_ = policy.limits();
    if constexpr (Origin::is_at_rest) origin_.begin(policy);
    report_ = {};
    last_miss_ = 0;
  }
  const ComplianceReport& report() const { return report_; }

  template <class World>
  void build(const World& world, Rows& rows) {
    Base::build(ThroughAll<World>{world, *this}, rows);
    each_pool(rows, [&](auto p, const auto& pool) {
      missed<p>().assign(pool.items(), Vec<Rows::template rows_of<p>, T>::Zero());
    });
  }

  /// What went into d of pool p so far.
  template <int p>
  auto& missed() {
    return std::get<p>(missed_);
  }
  /// The rows were off by `miss` (m) and d knows it now: whether they must be solved again.
  bool goes_on(double miss) {
    report_.violation = miss;
    is_old_ =
        is_old_ || (last_miss_ > 0 && miss > limits_.violation && miss > limits_.contraction * last_miss_);
    last_miss_ = miss;
    if (!(miss > limits_.violation) || report_.passes >= limits_.max_passes) return false;
    ++report_.passes;
    return true;
  }
  bool is_settled() const { return report_.violation <= limits_.violation; }

  /// Where a pass did not bring the rows near enough, A is factored as it is now and W̃ made anew; true then.
  template <class World>
  bool renew(const World& world, Rows& rows) {
    if (Origin::is_at_rest || !is_old_ || is_new_) return false;
    world.each([&](const auto& set, auto s) {
      if constexpr (AssembledSet<std::remove_cvref_t<decltype(set)>>)
        if (set.is_coupled())
          set.each_system([&](Index k, auto, const auto& body, const auto& x) {
            factor_now(std::get<s>(bodies_)[k], body, x);
          });
    });
    is_new_ = true;
    is_old_ = false;
    Base::build(ThroughAll<World>{world, *this}, rows);
    return true;
  }

 private:
  struct Body {
    RotatedInverse<S, T> inverse;
    std::uint32_t number = 0;  ///< of the body that it is of
  };

  template <int s, class Set>
  void factor(Set& set, SystemScale scale) {
    set.assemble(scale);
    if (scale.stiffness == 0) return;
    auto& own = std::get<s>(bodies_);
    bool is_any_new = false;
    set.each_system([&](Index k, std::uint32_t number, const auto& body, const auto&) {
      if (std::size_t(k) >= own.size()) own.resize(std::size_t(k) + 1);
      if (own[k].number != number) {
        own[k].inverse.analyse(body);
        own[k].number = number;
      }
      is_any_new = is_any_new || own[k].inverse.is_of_another(body);
    });
    is_new_ = false;
    if constexpr (Origin::is_at_rest)
      if (is_any_new) {
        set.assemble_at_rest(scale);
        set.each_system([&](Index k, auto, const auto& body, const auto&) {
          if (own[k].inverse.is_of_another(body)) factor_at_rest(own[k], body, k);
        });
        set.assemble(scale);
      }
    set.each_system([&](Index k, auto, const auto& body, const auto& x) {
      if (!Origin::is_at_rest && (is_old_ || own[k].inverse.is_of_another(body)))
        factor_now(own[k], body, x);
      else
        own[k].inverse.turn(body, places_of(body, x));
    });
    is_old_ = false;
  }

  template <class World>
  struct ThroughAll {
    const World& world;
    RotatedOperator& own;
    void each(auto&& f) const {
      world.each([&](const auto& set, auto s) {
        using Set = std::remove_cvref_t<decltype(set)>;
        if constexpr (AssembledSet<Set>)
          f(Through<const Set, decltype(s)::value>{set, own, 1}, s);
        else
          f(set, s);
      });
    }
  };

  std::span<const Vec<3, T>> places_of(const auto& body, const auto& x) {
    places_.clear();
    for (const Index b : body.blocks()) places_.push_back(x[b]);
    return places_;
  }
  void factor_now(Body& own, const auto& body, const auto& x) {
    own.inverse.factor(body, places_of(body, x));
    ++report_.factorizations;
    is_new_ = true;
  }
  void factor_at_rest(Body& own, const auto& body, Index k) {
    places_.clear();
    for (const Vec3& x : body.mesh().points) places_.push_back(x.template cast<T>());
    own.inverse.factor(body, places_);
    ++report_.factorizations;
    origin_.complete(k, own.inverse, body);
  }

  template <int s, class Set>
  void solve(const Set& set, std::span<Vec<3, T>> x, int guess) {
    set.each_system([&](Index k, auto, const auto& body, const auto& at) {
      auto& inverse = std::get<s>(bodies_)[k].inverse;
      part_.clear();
      for (std::size_t i = 0; i < body.blocks().size(); ++i)
        part_.push_back(body.held()[i] ? Vec<3, T>::Zero().eval() : x[body.blocks()[i]]);
      load_ = part_;
      int n = inverse.solve(body, part_, limits_.tolerance, most_iterations, guess);
      if (n < 0 && !Origin::is_at_rest) {
        factor_now(std::get<s>(bodies_)[k], body, at);
        part_ = load_;
        n = inverse.solve(body, part_, limits_.tolerance, most_iterations, guess);
      }
      const int iterations = n < 0 ? most_iterations : n;
      report_.iterations = std::max(report_.iterations, iterations);
      is_old_ = is_old_ || iterations > limits_.max_iterations;
      for (std::size_t i = 0; i < body.blocks().size(); ++i) x[body.blocks()[i]] = part_[i];
    });
  }

  template <int s, class Set>
  void node_compliance(const Set& set, std::span<const Index> blocks, std::span<T> C) {
    nodes_.clear();
    for (const Index b : blocks) nodes_.push_back(set.node_of(b));
    std::get<s>(bodies_)[set.body_of(blocks.front())].inverse.compliance(nodes_, C, Origin::is_at_rest);
  }

  static constexpr int most_iterations = 60;
  RotatedLimits limits_{};
  [[no_unique_address]] Origin origin_;
  ComplianceReport report_;
  double last_miss_ = 0;
  bool is_old_ = false, is_new_ = false;
  std::array<std::vector<Body>, sizeof...(w)> bodies_;
  std::tuple<Array<Vec<R, T>>...> missed_;
  Array<Vec<3, T>> places_, part_, load_;
  Array<Index> nodes_;
};

}  // namespace inner
}  // namespace delassus
