/// Newton's method in the velocities of the bodies, as a stage in a chain of sweeps.
#pragma once

#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/inner/proximal_point.hpp>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace delassus::inner {

/// Rows that act on bodies; those of a friction problem from a file have W alone.
template <class Rows>
inline constexpr bool knows_bodies = false;
template <class T, int... w, int... R>
inline constexpr bool knows_bodies<RowSystem<T, Widths<w...>, R...>> = sizeof...(w) > 0;

/// What the proximal point iteration may do in one opening of the stage.
struct NewtonLimits {
  double tolerance;
  int max_iterations = 30, min_iterations = 0;  ///< factorizations
  bool scale_tolerance, all_verified;
};

/// Opens when the sweeps so far have cost what it is likely to: then neither an island that sweeps would have
/// ended soon nor one that they never end takes more than some twice the better of both. Sweeps before
/// Newton's method leave λ where each of its steps changes which rows carry, so that ε begins large, and
/// grows at once where it stalls. Where it fails all the same, it opens again after twice the sweeps that it
/// has cost, and no sooner than after twice the last wait.
template <class Criterion, class Problem, class Pursuit>
class NewtonStage {
 public:
  using Body = BodySpace<typename Problem::RowsType>;

  template <class Chain>
  NewtonStage(const Chain& chain, Problem& problem, Pursuit& pursuit, Body& body)
      : limits_{.tolerance = chain.tolerance,
                .scale_tolerance = chain.scale_tolerance,
                .all_verified = chain.all_verified},
        problem_(problem),
        pursuit_(pursuit),
        body_(body) {}

  /// Asked before each sweep of momentum. The island is gathered when it has been swept for a while, and
  /// where Newton's method cannot act nothing is changed.
  bool opens() {
    if (pursuit_.sweeps() < opening_) return false;
    if (is_gathered_) return true;
    is_gathered_ = true;
    if (body_.gather(problem_)) {
      cost_ = body_.cost_in_sweeps();
      open_after(likely * cost_);
    } else {
      opening_ = never;
    }
    return pursuit_.sweeps() >= opening_;
  }

  /// From the best λ so far; the rows keep the better of what they had and what was found.
  void run() {
    pursuit_.back_to_best();
    pursuit_.name("newton");
    ProximalPoint<Criterion, NewtonLimits, Problem, Body> point(limits_, problem_, body_);
    point.sweeps = pursuit_.sweeps();
    point.epsilon = epsilon_;
    if (!body_.restart(problem_)) return close(point.factorizations);
    const double before = energy();
    body_.keep();
    point.begin();
    bool is_met = false;
    for (int k = 0; k < attempts && !is_met; ++k) {
      is_met = point.run() && point.is_met();
      if (!is_met) point.give_best();
      if (!is_met && !point.restart()) break;
    }
    if (!(energy() <= 100 * before)) pursuit_.back_to_best();
    point.measure = problem_.measure();
    pursuit_.take(point.measure, point.factorizations);
    if (!pursuit_.is_over()) pursuit_.back_to_best();
    epsilon_ = point.epsilon;
    close(point.factorizations);
  }

 private:
  static constexpr int least = 20, never = std::numeric_limits<int>::max();
  static constexpr int attempts = 3;
  static constexpr double likely = 6;  ///< factorizations of an opening, for what surrounds them too

  /// Σ w_i |λ_i|². Where contacts depend on each other λ may run away along what moves nothing; one ten times
  /// larger than the sweeps' is not taken: its rounding alone would give the bodies energy.
  double energy() const {
    double sum = 0;
    problem_.each([&](auto p, Index i) {
      const double root = problem_.template root_of_weight<p>(i);
      sum += root * root * double(problem_.rows().template pool<p>().lambda[i].squaredNorm());
    });
    return sum;
  }
  void close(int factorizations) {
    wait_ *= 2;
    open_after(pursuit_.sweeps() + std::max(double(wait_), 2 * factorizations * cost_));
  }
  void open_after(double sweeps) { opening_ = sweeps < never ? std::max(least, int(sweeps)) : never; }

  NewtonLimits limits_;
  Problem& problem_;
  Pursuit& pursuit_;
  Body& body_;
  double cost_ = 0;  ///< of a factorization, in sweeps
  double epsilon_ = 1e-5;
  int opening_ = least, wait_ = least;
  bool is_gathered_ = false;
};

}  // namespace delassus::inner

namespace delassus {

/// A chain that sweeps and no more.
struct SweepsAlone {
  template <class Rows>
  struct Space {};
  struct Stage {
    static constexpr bool opens() { return false; }
    static void run() {}
  };
  template <class Criterion, class Chain, class Problem, class Pursuit, class Body>
  static Stage stage(const Chain&, Problem&, Pursuit&, Body&) {
    return {};
  }
};

/// A chain that turns to Newton's method in the velocities of the bodies where a problem has any and stops on
/// a measured error.
struct ThenNewton {
  template <class Rows>
  using Space =
      std::conditional_t<inner::knows_bodies<Rows>, inner::BodySpace<Rows>, SweepsAlone::Space<Rows>>;
  template <class Criterion, class Chain, class Problem, class Pursuit, class Body>
  static auto stage(const Chain& chain, Problem& problem, Pursuit& pursuit, Body& body) {
    if constexpr (Criterion::needs_measure && inner::knows_bodies<typename Problem::RowsType>)
      return inner::NewtonStage<Criterion, Problem, Pursuit>(chain, problem, pursuit, body);
    else
      return SweepsAlone::Stage{};
  }
};

}  // namespace delassus
