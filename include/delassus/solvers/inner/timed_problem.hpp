/// An island whose sweeps end when the time does.
#pragma once

#include <delassus/solvers/inner/watch.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace delassus::inner {

/// Whether to begin what may come to nothing before a deadline, from one step to the next: where it did it is
/// passed over in one step, then in two, and so on up to `most`. What never helps costs one step in seventeen
/// then, and what begins to help is found within as many.
class Attempts {
 public:
  /// Asked once a solve.
  bool is_due() {
    if (left_ == 0) return true;
    --left_;
    return false;
  }
  void note(bool was_of_use) {
    wait_ = was_of_use ? 0 : std::clamp(2 * wait_, 1, most);
    left_ = wait_;
  }

 private:
  static constexpr int most = 16;
  int wait_ = 0, left_ = 0;  ///< steps
};

/// What setting all impulses costs, in sweeps: copying them takes up to 0.07, telling W of it up to 0.41 where that is
/// work (of a thousand to three thousand boxes, `AssembledCompliance` and `MatrixFreeCompliance`).
template <class Operator>
inline constexpr double load_share = 0.07;
template <class Operator>
  requires(!requires { requires Operator::commit_is_free; })
inline constexpr double load_share<Operator> = 0.41;

/// Looks at the clock after each sweep and inside long ones, sets the best measured impulses aside, and lets
/// go what is half done at the deadline, less the time that loading those takes: from then on every operation is over at once, no measure is better
/// than the best, and a solver comes to its end by the way it has. What λ is then does not matter, the best
/// is loaded in the end. Before the first measure after `min_iterations` sweeps nothing is let go.
template <class Problem, Clock C, class Best>
class TimedProblem : public Problem {
  using Groups = WatchedGroups<typename Problem::GroupsType, Watch<C>>;
  using Watched = decltype(std::declval<const Problem&>().with(
      std::declval<typename Problem::OperatorType&>(), std::declval<const Groups&>()));

 public:
  TimedProblem(const Problem& problem, const C& clock, double deadline, Best& best, bool may_attempt)
      : Problem(problem),
        watch_(clock, deadline),
        groups_(problem.groups(), watch_),
        watched_(problem.with(problem.compliance(), groups_)),
        best_(best),
        may_attempt_(may_attempt) {}
  TimedProblem(const TimedProblem&) = delete;
  TimedProblem& operator=(const TimedProblem&) = delete;

  /// Asked after every sweep.
  bool is_out_of_time() {
    const double now = watch_.look();
    if (is_sweep_) {
      (is_measured_ ? measured_ : plain_).add(now - last_);
      watch_.keep(load_share<typename Problem::OperatorType> * pace());
    }
    is_measured_ = false;
    last_ = now;
    is_sweep_ = has_due_sweeps_ = true;
    return watch_.is_late();
  }
  /// Whether another sweep and its measure could end too late: what is not measured then is lost. A fourth is
  /// for what their times vary by.
  bool is_measure_due() const {
    const double both = measured_.count > 0 ? measured_.mean() : 2 * plain_.mean();
    return both > 0 && last_ + 1.25 * both >= watch_.end();
  }
  /// Whether what takes as long as so many sweeps would end before the deadline, and a measure after it;
  /// where it is asked again for the same, it took as long as the longest time between. One that is not begun
  /// does not make the solve late: shorter work may still be done.
  bool has_time_for(double sweeps) {
    const double now = watch_.look();
    longest_ = is_sweep_ || sweeps != asked_for_ ? 0 : std::max(longest_, now - asked_);
    is_sweep_ = false;
    asked_for_ = sweeps;
    asked_ = now;
    const double needed = std::max(1.25 * longest_ + 2 * pace(), sweeps * pace());
    return !watch_.is_late() && now + needed < watch_.end();
  }
  /// The same for what may come to nothing, and what came of it.
  bool may_attempt(double sweeps) { return may_attempt_ && has_time_for(sweeps); }
  void attempted(bool was_of_use) {
    has_attempted_ = true;
    was_of_use_ = was_of_use_ || was_of_use;
  }
  bool has_attempted() const { return has_attempted_; }
  bool was_of_use() const { return was_of_use_; }
  /// Asked between the pieces of what is long and no sweep.
  bool is_cut_off(int work) { return watch_.cuts_off_after(work); }
  /// From here on λ is the answer, whatever its measure, and all work is done to its end.
  void must_complete() {
    must_complete_ = true;
    watch_.let_go(false);
  }

  template <bool tells_change = false, class... Curvature>
  double sweep(double relaxation = 1, Curvature&&... curvature) {
    return watched_.template sweep<tells_change>(relaxation, curvature...);
  }
  double project_once(const Best& x, double& curvature) { return watched_.project_once(x, curvature); }
  void extrapolate(Best& before, double beta) { watched_.extrapolate(before, beta); }
  double last_change() const { return watched_.last_change(); }
  double worst_change() const { return watched_.worst_change(); }

  Measure measure() {
    const Measure m = watched_.measure();
    is_measured_ = true;
    if (watch_.lets_go()) return least_;
    if (m.residual < least_.residual) {
      least_ = m;
      Problem::save(best_);
    }
    watch_.let_go(has_due_sweeps_ && !must_complete_ && least_.residual < infinity);
    return m;
  }
  void notify(int sweeps, const Measure& m) {
    if (!watch_.lets_go()) Problem::notify(sweeps, m);
  }
  void save(Best& to) {
    if (!watch_.lets_go()) Problem::save(to);
  }
  void load(const Best& from) {
    if (!watch_.lets_go()) Problem::load(from);
  }

  bool was_late() const { return watch_.is_late(); }
  /// Whether λ is unfit for use.
  bool has_let_go() const { return watch_.has_let_go(); }
  /// λ ← the best measured.
  const Measure& restore_best() {
    Problem::load(best_);
    return least_;
  }
  const Measure& least() const { return least_; }

 private:
  struct Times {
    double sum = 0;  ///< s
    int count = 0;
    void add(double time) { sum += time, ++count; }
    double mean() const { return count > 0 ? sum / count : 0; }
  };
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Of sweeps, some of them measured.
  double pace() const { return Times{measured_.sum + plain_.sum, measured_.count + plain_.count}.mean(); }

  Watch<C> watch_;
  Groups groups_;
  Watched watched_;
  Best& best_;
  bool may_attempt_, has_attempted_ = false, was_of_use_ = false;
  Measure least_{.residual = infinity};
  bool is_sweep_ = false;        ///< there was nothing else since the last look
  bool has_due_sweeps_ = false;  ///< `min_iterations` of them
  bool must_complete_ = false;
  bool is_measured_ = false;                        ///< there was a measure since
  double last_ = 0;                                 ///< s
  double asked_for_ = 0, asked_ = 0, longest_ = 0;  ///< of `has_time_for`: sweeps, s and s
  Times measured_, plain_;                          ///< of sweeps with a measure before them, and without
};

}  // namespace delassus::inner
