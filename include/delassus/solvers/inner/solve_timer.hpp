/// The time that a solve has, what it costs, and when work is let go for it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <limits>

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
inline constexpr double load_share_of_blocks = 0.07, load_share_otherwise = 0.41;

/// Looks at a clock after each sweep and inside long ones, and lets go what is half done at the deadline, less the time that
/// loading the best measured impulses takes: from then on every operation of the island is over at once, no measure is better
/// than the best, and a solver comes to its end by the way it has. What λ is then does not matter, the best is loaded in the
/// end. Before the first measure after `min_iterations` sweeps nothing is let go.
template <class T>
class SolveTimer {
 public:
  using Now = double (*)(const void* clock);

  /// `share`: what loading the best costs, in sweeps.
  SolveTimer(const void* clock, Now now, double deadline, Array<T>& best, bool may_attempt, double share)
      : clock_(clock), ask_(now), deadline_(deadline), share_(share), best_(best), may_attempt_(may_attempt) {}
  SolveTimer(const SolveTimer&) = delete;
  SolveTimer& operator=(const SolveTimer&) = delete;

  /// Items between two looks at the clock, or products of two blocks of bodies: some 5 µs. A look takes 25 ns.
  static constexpr int stride = 64;

  /// Asked after every sweep.
  bool is_out_of_time() {
    const double now = look();
    if (is_sweep_) {
      (is_measured_ ? measured_ : plain_).add(now - last_);
      kept_ = share_ * pace();
    }
    is_measured_ = false;
    last_ = now;
    is_sweep_ = has_due_sweeps_ = true;
    return is_late_;
  }
  /// Whether another sweep and its measure could end too late: what is not measured then is lost. A fourth is
  /// for what their times vary by.
  bool is_measure_due() const {
    const double both = measured_.count > 0 ? measured_.mean() : 2 * plain_.mean();
    return both > 0 && last_ + 1.25 * both >= end();
  }
  /// Whether what takes as long as so many sweeps would end before the deadline, and a measure after it;
  /// where it is asked again for the same, it took as long as the longest time between. One that is not begun
  /// does not make the solve late: shorter work may still be done.
  bool has_time_for(double sweeps) {
    const double now = look();
    longest_ = is_sweep_ || sweeps != asked_for_ ? 0 : std::max(longest_, now - asked_);
    is_sweep_ = false;
    asked_for_ = sweeps;
    asked_ = now;
    const double needed = std::max(1.25 * longest_ + 2 * pace(), sweeps * pace());
    return !is_late_ && now + needed < end();
  }
  /// The same for what may come to nothing, and what came of it.
  bool may_attempt(double sweeps) { return may_attempt_ && has_time_for(sweeps); }
  void attempted(bool was_of_use) {
    has_attempted_ = true;
    was_of_use_ = was_of_use_ || was_of_use;
  }
  bool has_attempted() const { return has_attempted_; }
  bool was_of_use() const { return was_of_use_; }
  /// From here on λ is the answer, whatever its measure, and all work is done to its end.
  void must_complete() {
    must_complete_ = true;
    may_let_go_ = false;
  }

  /// Whether what is begun now, or half done, is let go.
  bool lets_go() {
    if (is_late_ && may_let_go_) has_let_go_ = true;
    return is_late_ && may_let_go_;
  }
  bool has_let_go() const { return has_let_go_; }
  /// The same after a look.
  bool cuts_off() {
    if (may_let_go_) look();
    return lets_go();
  }
  /// The same after so much work, and a look where that makes a stride with what came before.
  bool cuts_off_after(int work) {
    if (!may_let_go_) return false;
    if (lets_go()) return true;
    since_ += work;
    if (since_ < stride) return false;
    since_ = 0;
    return cuts_off();
  }

  /// What counts of a measure; `save` keeps the island's impulses where they are the best.
  template <class Island>
  Measure judge(const Measure& m, Island& island) {
    is_measured_ = true;
    if (lets_go()) return least_;
    if (m.residual < least_.residual) {
      least_ = m;
      island.save_now(best_);
    }
    may_let_go_ = has_due_sweeps_ && !must_complete_ && least_.residual < infinity;
    return m;
  }
  const Measure& least() const { return least_; }
  const Array<T>& best() const { return best_; }
  bool was_late() const { return is_late_; }

 private:
  struct Times {
    double sum = 0;  ///< s
    int count = 0;
    void add(double time) { sum += time, ++count; }
    double mean() const { return count > 0 ? sum / count : 0; }
  };
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// The time, s; when it is up nobody need look again.
  double look() {
    if (is_late_) return now_;
    now_ = ask_(clock_);
    is_late_ = now_ >= end();
    return now_;
  }
  /// When work has to end, s: before the deadline, by what comes after it.
  double end() const { return deadline_ - kept_; }
  /// Of sweeps, some of them measured.
  double pace() const { return Times{measured_.sum + plain_.sum, measured_.count + plain_.count}.mean(); }

  const void* clock_;
  Now ask_;
  double deadline_, share_, kept_ = 0, now_ = 0;
  int since_ = 0;  ///< work
  bool is_late_ = false, may_let_go_ = false, has_let_go_ = false;
  Array<T>& best_;
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
