/// One island as a solver meets it: sweeps, measures and impulses, whatever its laws, bodies and W are made of.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/inner/length_of_island.hpp>
#include <delassus/solvers/inner/solve_timer.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

namespace delassus {

/// Who hears of a solve. `sweep` gets the number of sweeps and the measure; `force`, after it and where `wants_forces` says
/// so, the impulse of each item.
template <class T>
struct SolveObserver {
  void* who = nullptr;
  bool every_sweep = false;  ///< each sweep is measured
  void (*sweep)(void* who, int sweeps, const Measure&) = nullptr;
  bool (*wants_forces)(void* who) = nullptr;
  void (*force)(void* who, int sweeps, const PoolView<T>&, Index i, double h) = nullptr;
};

/// How the constraints of an island are visited.
struct SweepRule {
  double relaxation = 1;
  bool tells_change = false;  ///< sets the last change: its roots are an eighth of a sweep
  bool projects = false;      ///< one projection a visit in the place of the exact answer
  bool descends = false;      ///< one in the metric of the own block, of laws that have it: `refine::projection_step`

  /// What a law does on such a visit.
  [[gnu::always_inline]] auto loop_of(const auto& law) const { return projects ? law.project_once : descends && law.descend ? law.descend : law.sweep; }
};

template <class T>
class Island;

namespace inner {

class Crew;

/// Passes over an island otherwise than span by span; the first argument is the struct itself.
template <class T>
struct Passes {
  void (*sweep)(Passes*, const Island<T>&, const SweepRule&, const T* x, Sweep<T>&);
  void (*measure)(Passes*, const Island<T>&, MeasureSums&);
  void (*extrapolate)(Passes*, const Island<T>&, T* before, T beta);
};

}  // namespace inner

/// Spans of the pools that have items in an island, in the order of a sweep. A solver sees nothing else of a problem.
/// Impulses that are set aside are an `Array` with the numbers of all items in that order.
template <class T_>
class Island {
 public:
  using T = T_;

  /// `spans` stay where they are as long as the island is used.
  Island(const Span<T>* spans, int count, Index island, double h) : spans_(spans), count_(count), island_(island), h_(h) {
    take(spans, count);
    length_ = inner::length_of_island(begin(), end());
  }

  const Span<T>* begin() const { return spans_; }
  const Span<T>* end() const { return spans_ + count_; }
  /// Its number among the islands of the problem.
  Index island() const { return island_; }
  double h() const { return h_; }
  int row_count() const { return rows_; }
  /// See `Measure`, m; of a part that of the whole.
  double length() const { return length_; }

  /// The island with other spans, or another W in them, as a part of this one's solve: who is asked for the time is the whole,
  /// and nobody hears of its sweeps.
  Island part(const Span<T>* spans, int count) const {
    Island out = *this;
    out.take(spans, count);
    out.is_part_ = true;
    out.observer_ = {};
    out.passes_ = nullptr;
    return out;
  }

  /// Visits every constraint once, in order, and leaves each with an impulse that meets its law while the
  /// others stand still. Returns Σ w_i |Δλ_i|², w_i = tr(W_ii)/rows.
  ///
  /// With `projects` it makes one step of the projection λ_i ← P_K(λ_i − ũ_i/s), s = |W_ii| ≥ λ_max(W_ii), for every constraint
  /// in order. That is less than an exact answer, and a contraction where exact answers go round in circles.
  double sweep(const SweepRule& rule = {}) { return sweep(rule, nullptr, nullptr); }
  /// The same from y = λ to z. `curvature` becomes Σ w_i (y_i − z_i)·(z_i − x_i).
  double sweep(const SweepRule& rule, const T* x, double* curvature) {
    Sweep<T> sums{.relaxation = T(rule.relaxation), .tells_change = rule.tells_change, .length = length_};
    if (passes_) passes_->sweep(passes_, *this, rule, x, sums);
    else
      for (Pass pass(*this); pass.next();) {
        if (x) sums.x = x + pass.row();
        rule.loop_of(*pass.span->pool->table)(*pass.span, sums);
      }
    if (rule.tells_change) {
      last_change_ = h_ * double(sums.displacement);
      worst_change_ = h_ * double(sums.most);
    }
    if (curvature) *curvature = -double(sums.along);
    return double(sums.energy);
  }

  Measure measure() {
    MeasureSums sums{.length = length_};
    if (passes_) passes_->measure(passes_, *this, sums);
    else
      for (Pass pass(*this); pass.next();) pass.span->pool->table->measure(*pass.span, sums);
    Measure m = sums.has_vanished() && moves() ? Measure::of_nothing() : sums.finish(double(std::numeric_limits<T>::epsilon()));
    m.last_change = last_change_;
    m.worst_change = worst_change_;
    m.sinking = h_ * std::sqrt(sums.closing);
    if (limits()) m = timer_->judge(m, *this);
    return m;
  }

  /// λ ← λ + β (λ − before), each brought back into its law's cone; `before` takes the λ that was.
  void extrapolate(Array<T>& before, double beta) {
    if (passes_) passes_->extrapolate(passes_, *this, before.data(), T(beta));
    else
      for (Pass pass(*this); pass.next();) pass.span->pool->table->extrapolate(*pass.span, before.data() + pass.row(), T(beta));
  }

  /// From here on passes visit these spans instead: the same items in the same order. They stay where they are as long as the
  /// island is used.
  void pass_over(const Span<T>* spans, int count) { take(spans, count); }
  /// From here on passes visit these spans instead, by functions of their own. Both stay where they are as long as the island is
  /// used. Pre: no timer.
  void pass_by(const Span<T>* spans, int count, inner::Passes<T>& passes) {
    take(spans, count);
    passes_ = &passes;
  }
  bool has_own_passes() const { return passes_; }
  /// Threads that share such passes; null: none.
  void set_crew(inner::Crew* crew) { crew_ = crew; }
  inner::Crew* crew() const { return crew_; }

  double last_change() const { return last_change_; }
  double worst_change() const { return worst_change_; }

  // --- the time -------------------------------------------------------------------------------------------------------

  void set_timer(inner::SolveTimer<T>* timer) { timer_ = timer; }
  inner::SolveTimer<T>* timer() const { return timer_; }
  /// A solver asks after each sweep.
  bool is_out_of_time() const { return timer_ && timer_->is_out_of_time(); }
  /// And after one that need not be measured: no later one could be.
  bool is_measure_due() const { return limits() && timer_->is_measure_due(); }
  /// Before what takes as long as so many sweeps.
  bool has_time_for(double sweeps) const { return !timer_ || timer_->has_time_for(sweeps); }
  /// The same for what may come to nothing, and then what came of it.
  bool may_attempt(double sweeps) const { return !timer_ || timer_->may_attempt(sweeps); }
  void attempted(bool was_of_use) const {
    if (timer_) timer_->attempted(was_of_use);
  }
  /// After so many products of blocks of what is no sweep: what was found so far is of no use then.
  bool is_cut_off(int work) const { return limits() && timer_->cuts_off_after(work); }
  /// Before what leaves no measured best.
  void must_complete() const {
    if (limits()) timer_->must_complete();
  }

  /// What setting all impulses costs, in sweeps.
  double cost_of_load() const {
    for (const Span<T>& span : *this)
      if (!span.pool->is_matrix()) return inner::load_share_otherwise;
    return inner::load_share_of_blocks;
  }

  // --- who listens ----------------------------------------------------------------------------------------------------

  void set_observer(const SolveObserver<T>& observer) { observer_ = observer; }
  bool observes_sweeps() const { return observer_.every_sweep; }
  bool is_heard() const { return observer_.sweep; }
  /// Whether `notify` reads λ.
  bool tells_forces() const { return observer_.wants_forces && observer_.wants_forces(observer_.who); }
  void notify(int sweeps, const Measure& m) {
    if (!observer_.sweep || (limits() && timer_->lets_go())) return;
    observer_.sweep(observer_.who, sweeps, m);
    if (!tells_forces()) return;
    for (const Span<T>& span : *this)
      for (const Index i : span) observer_.force(observer_.who, sweeps, *span.pool, i, h_);
  }

  // --- impulses -------------------------------------------------------------------------------------------------------

  void save(Array<T>& to) const {
    if (!(limits() && timer_->lets_go())) save_now(to);
  }
  void save_now(Array<T>& to) const {
    to.resize(std::size_t(rows_));
    T* at = to.data();
    for (const Span<T>& span : *this) {
      const std::size_t R = std::size_t(span.pool->rows);
      if (span.is_gapless()) {
        std::memcpy(at, impulse(span, *span.begin()), R * std::size_t(span.count) * sizeof(T));
        at += R * std::size_t(span.count);
      } else {
        for (const Index i : span)
          for (const T *lambda = impulse(span, i), *const end = lambda + R; lambda != end; ++lambda) *at++ = *lambda;
      }
    }
  }
  /// λ ← what was saved, and W is told of the difference.
  void load(const Array<T>& from) {
    if (!(limits() && timer_->lets_go())) load_now(from);
  }
  void load_now(const Array<T>& from) {
    const T* at = from.data();
    for (const Span<T>& span : *this)
      for (const Index i : span) {
        assign(span, i, at);
        at += span.pool->rows;
      }
  }
  /// λ ← 0.
  void clear() {
    T nothing[most_rows] = {};
    for (const Span<T>& span : *this)
      for (const Index i : span) assign(span, i, nothing);
  }

  /// The numbers √w_k λ_k of all rows, in order; `to` has as many.
  void gather(Array<double>& to) const {
    std::size_t at = 0;
    for (const Span<T>& span : *this)
      for (const Index i : span) {
        double root[most_rows];
        span.pool->roots_of_weights(i, root);
        const T* lambda = impulse(span, i);
        for (int k = 0; k < span.pool->rows; ++k) to[at++] = root[k] * double(lambda[k]);
      }
  }
  /// The way back, each λ_i brought into its law's cone.
  void scatter(const Array<double>& from) {
    std::size_t at = 0;
    T next[most_rows];
    for (const Span<T>& span : *this)
      for (const Index i : span) {
        double root[most_rows];
        span.pool->roots_of_weights(i, root);
        for (int k = 0; k < span.pool->rows; ++k, ++at) next[k] = root[k] > 0 ? T(from[at] / root[k]) : T(0);
        clamp(span, i, next);
        assign(span, i, next);
      }
  }

  /// λ_i, `rows` numbers.
  static const T* impulse(const Span<T>& span, Index i) { return span.pool->lambda + std::ptrdiff_t(span.pool->rows) * i; }
  static const T* free_of_impulses(const Span<T>& span, Index i) { return span.pool->d + std::ptrdiff_t(span.pool->rows) * i; }
  /// Σ w_k x_k² of the rows of one item.
  static double energy(const Span<T>& span, Index i, const T* x) {
    const PoolView<T>& pool = *span.pool;
    double sum = 0;
    if (!inner::are_mixed(pool.rows, pool.turns)) {
      for (int k = 0; k < pool.rows; ++k) sum += double(x[k]) * double(x[k]);
      return pool.weight(i) * sum;
    }
    double w[most_rows];
    pool.weights(i, w);
    for (int k = 0; k < pool.rows; ++k) sum += w[k] * double(x[k]) * double(x[k]);
    return sum;
  }
  /// Σ w_k λ_k² of all rows, J.
  double energy() const {
    double sum = 0;
    for (const Span<T>& span : *this)
      for (const Index i : span) sum += energy(span, i, impulse(span, i));
    return sum;
  }
  /// The same of what was saved.
  double energy(const Array<T>& saved) const {
    double sum = 0;
    const T* at = saved.data();
    for (const Span<T>& span : *this)
      for (const Index i : span) sum += energy(span, i, at), at += span.pool->rows;
    return sum;
  }
  /// |u|² of one item, (m/s)².
  double square_of_velocity(const Span<T>& span, const T* u) const {
    double sum = 0;
    for (int k = 0; k < span.pool->rows; ++k) {
      const double x = (span.pool->turn(k) ? length_ : 1) * double(u[k]);
      sum += x * x;
    }
    return sum;
  }
  /// λ_i ← next, and W is told.
  static void assign(const Span<T>& span, Index i, const T* next) {
    const PoolView<T>& pool = *span.pool;
    T* lambda = pool.lambda + std::ptrdiff_t(pool.rows) * i;
    if (pool.is_matrix()) {
      for (int k = 0; k < pool.rows; ++k) lambda[k] = next[k];
    } else {
      T change[most_rows];
      for (int k = 0; k < pool.rows; ++k) change[k] = next[k] - lambda[k], lambda[k] = next[k];
      pool.table->changed(pool, i, change);
    }
  }
  /// u_i = (d + W λ)_i.
  static void velocity(const Span<T>& span, Index i, T* u) { span.pool->table->velocity(*span.pool, i, u); }
  /// Brings an impulse into the law's cone.
  static void clamp(const Span<T>& span, Index i, T* lambda) {
    if (span.pool->table->clamp) span.pool->table->clamp(*span.pool, i, lambda);
  }
  static const RowKind* kinds(const Span<T>& span) { return span.pool->table->kinds; }

 protected:
  void take(const Span<T>* spans, int count) {
    spans_ = spans;
    count_ = count;
    rows_ = 0;
    for (const Span<T>& span : *this) rows_ += span.pool->rows * int(span.count);
  }
  double length_ = 1;

 private:
  /// One pass over all items: a span a pool, or pieces of it between which the clock is looked at.
  struct Pass {
    Island& island;
    const Span<T>* span = nullptr;

    explicit Pass(Island& of) : island(of) {}
    /// The first row of `span` in impulses that are set aside.
    Index row() const { return row_; }
    bool next() {
      if (span) row_ += span->count * span->pool->rows;
      if (island.limits()) return next_piece();
      span = place_ < island.count_ ? island.spans_ + place_++ : nullptr;
      return span;
    }

   private:
    bool next_piece() {
      for (; place_ < island.count_; ++place_, done_ = 0) {
        const Span<T>& whole = island.spans_[place_];
        if (done_ < whole.count && !(done_ == 0 ? island.timer_->lets_go() : island.timer_->cuts_off())) {
          piece_ = {whole.pool, whole.items + done_, std::min(whole.count - done_, Index(inner::SolveTimer<T>::stride))};
          done_ += piece_.count;
          span = &piece_;
          return true;
        }
        row_ += (whole.count - done_) * whole.pool->rows;
      }
      return false;
    }

    int place_ = 0;
    Index done_ = 0, row_ = 0;
    Span<T> piece_;
  };

  /// Whether some velocity is not zero, whatever its square is.
  bool moves() const {
    T u[most_rows];
    for (const Span<T>& span : *this)
      for (const Index i : span) {
        velocity(span, i, u);
        for (int k = 0; k < span.pool->rows; ++k)
          if (u[k] != 0 || free_of_impulses(span, i)[k] != 0) return true;
      }
    return false;
  }
  /// Whether work ends at a deadline.
  bool limits() const { return timer_ && !is_part_; }

  const Span<T>* spans_;
  int count_, rows_ = 0;
  Index island_;
  double h_;
  inner::SolveTimer<T>* timer_ = nullptr;
  inner::Passes<T>* passes_ = nullptr;
  inner::Crew* crew_ = nullptr;
  bool is_part_ = false;
  SolveObserver<T> observer_{};
  double last_change_ = std::numeric_limits<double>::infinity(), worst_change_ = last_change_;
};

}  // namespace delassus
