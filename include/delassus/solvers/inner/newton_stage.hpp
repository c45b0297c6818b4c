/// Newton's method in the velocities of the bodies, as a stage in a chain of sweeps.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/solvers/inner/body_space.hpp>
#include <delassus/solvers/inner/momentum.hpp>
#include <delassus/solvers/inner/pile_sweeps.hpp>
#include <delassus/solvers/inner/proximal_point.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// What the stage keeps: the island, and λ from before the sweeps. `width` velocities a block of bodies at most.
template <class T, int width>
struct NewtonSpace {
  BodySpace<T, NewtonSystem<T, width>, LawsAsTheyAre<T>> body;
  Array<T> start;
  void reserve(std::size_t rows) { start.reserve(rows); }
};

/// Opens when the sweeps so far have cost what it is likely to, and at their pace will cost as much again:
/// then neither an island that sweeps would have ended soon nor one that they never end takes more than some
/// twice the better of both. It may spend as much as the sweeps have, with a larger ε where it stalls, and as
/// much again whenever that halved the error; where it fails it opens again after twice the sweeps that it
/// has cost, and no sooner than after twice the last wait. From cold the first opening is from λ as it was
/// before the sweeps: they leave it where each step of Newton's method changes which rows carry, and ten
/// boxes cost 29 factorizations in place of two. Warm they have helped, and λ from before them is for the
/// second opening. From the sweeps' λ ε begins large, and grows where it stalls.
template <class T, class ConvergenceMonitor, class Space>
class NewtonStage {
 public:
  NewtonStage(const SolveOptions& chain, Island<T>& problem, ConvergenceMonitor& monitor, Space& space)
      : limits_(chain), problem_(problem), monitor_(monitor), space_(space), opening_(chain.is_measured() ? least : never) {
    limits_.min_iterations = 0;
    monitor.keep_start_in(space.start);
  }

  /// Asked before each sweep of momentum. The island is gathered when it has been swept for a while, a pile,
  /// whose order alone costs dozens of sweeps, later than others. Where Newton's method cannot act nothing is
  /// changed.
  bool opens() { return monitor_.sweeps() >= opening_ && is_due(); }

  /// The rows keep the better of what they had and what was found.
  [[gnu::noinline]] void run() {
    monitor_.back_to_best();
    monitor_.name("newton");
    const double before = limits_.error(monitor_.best());
    ProximalPoint<T, decltype(space_.body)> point(limits_, problem_, space_.body);
    point.sweeps = monitor_.sweeps();
    point.work = around * cost_;
    const double allowed = 100 * std::max(energy(), space_.body.energy_of_stopping(problem_));
    const bool from_start = openings_++ == (monitor_.first_error() > cold ? 0 : 1);
    if (from_start)
      problem_.load(monitor_.start());
    else
      point.epsilon = epsilon_;
    if (space_.body.restart(problem_)) {
      space_.body.keep();
      point.begin();
      const int share = std::max(2 * likely, int(monitor_.sweeps() / cost_));
      double smallest = std::min(limits_.error(point.measure), limits_.error(monitor_.best()));
      limits_.max_iterations = share;
      while (!(point.run() && point.is_met())) {
        point.restore_best();
        if (!point.restart()) break;
        if (point.has_time()) continue;
        const double error = limits_.error(point.measure);
        if (!(error < 0.5 * smallest)) break;
        smallest = error;
        limits_.max_iterations += share;
      }
      if (!(energy() <= allowed)) monitor_.back_to_best();
      point.measure = problem_.measure();
      monitor_.take(point.measure, point.factorizations);
      if (!from_start) epsilon_ = point.epsilon;
    }
    if (!monitor_.is_over()) monitor_.back_to_best();
    problem_.attempted(limits_.error(monitor_.best()) < 0.5 * before);
    wait_ *= 2;
    open_after(monitor_.sweeps() + std::max(double(wait_), 2 * point.factorizations * cost_));
  }

 private:
  /// Most islands are solved before that is asked once.
  [[gnu::noinline]] bool is_due() {
    if (!is_gathered_) {
      if (gathers_after_ < 0) {
        const BodyNet net = find_body_net(problem_);
        gathers_after_ = net.is_pile(limits_.tolerance) ? net.factorization : 0;
      }
      if (monitor_.sweeps() < gathers_after_ || !problem_.may_attempt(gathering)) return false;
    }
    if (!is_gathered_) {
      is_gathered_ = true;
      problem_.attempted(false);  // that far: what is gathered and not begun is of no use either
      if (space_.body.gather(problem_)) {
        cost_ = space_.body.cost_in_sweeps();
        open_after(likely * cost_);
      } else {
        opening_ = never;
      }
    }
    const double work = likely * cost_;
    return monitor_.sweeps() >= opening_ && monitor_.likely_left() >= work &&
           problem_.may_attempt(around * work);
  }

  static constexpr int least = 20, never = std::numeric_limits<int>::max();
  static constexpr int likely = 2;  ///< factorizations, of a warm stack
  static constexpr int gathering =
      20;  ///< sweeps that take as long as gathering an island for the first time
  static constexpr double around = 1.5;  ///< with what ends an opening, where a deadline is near
  static constexpr double cold = 1e-2;   ///< an error after the first sweep

  /// Σ w_i |λ_i|². Where contacts depend on each other λ may run away along what moves nothing; one ten times
  /// larger than the sweeps', and than what stops all bodies at once, is not taken: its rounding alone would
  /// give the bodies energy.
  double energy() const { return problem_.energy(); }
  void open_after(double sweeps) { opening_ = sweeps < never ? std::max(least, int(sweeps)) : never; }

  SolveOptions limits_;  ///< of the proximal point iteration in one opening: factorizations
  Island<T>& problem_;
  ConvergenceMonitor& monitor_;
  Space& space_;
  double cost_ = 0;  ///< of a factorization, in sweeps
  double gathers_after_ = -1;  ///< sweeps; below zero: not known yet
  double epsilon_ = 1e-5;
  int opening_, wait_ = least, openings_ = 0;
  bool is_gathered_ = false;
};

}  // namespace delassus::inner

namespace delassus {

/// A chain that sweeps and no more.
struct SweepsAlone {
  static constexpr const char* solver = "AcceleratedSweeps";  ///< its name in refusals
  static constexpr Needs needs = Needs::sweeps;
  template <class T, int width>
  struct Space {
    void reserve(std::size_t) {}
  };
  template <class Space>
  static inner::NoNewton stage(const auto&, auto&, auto&, Space&) {
    return {};
  }
};

/// A chain that turns to Newton's method in the velocities of the bodies where a problem has any and stops on
/// a measured error.
struct ThenNewton {
  static constexpr const char* solver = "AcceleratedGaussSeidel";  ///< its name in refusals
  static constexpr Needs needs = Needs::tangents;
  template <class T, int width>
  using Space = std::conditional_t<(width > 0), inner::NewtonSpace<T, width>, SweepsAlone::Space<T, width>>;
  template <class Space, class T, class ConvergenceMonitor>
  static auto stage(const SolveOptions& chain, Island<T>& problem, ConvergenceMonitor& monitor, Space& space) {
    if constexpr (requires { space.body; })
      return inner::NewtonStage<T, ConvergenceMonitor, Space>(chain, problem, monitor, space);
    else
      return inner::NoNewton{};
  }
};

}  // namespace delassus
