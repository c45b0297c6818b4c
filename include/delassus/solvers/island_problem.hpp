/// One island as a solver meets it: visits, sweeps and measurements, nothing else.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/solvers/inner/share_of_measure.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

namespace delassus {

/// An observer that wants nothing. One with `every_sweep = true` has each sweep measured, and is called with its number and measure.
struct NoObserver {
  static constexpr bool every_sweep = false;
  void begin_island(Index) const {}
  void operator()(int, const Measure&) const {}
};

/// `Groups` lists the items of an island; a solver that treats some of them by itself shows the others as a problem.
template <class Book, class Rows, class Operator, class Observer = NoObserver, class Groups = Islands<Rows::pool_count>>
class IslandProblem {
 public:
  using T = typename Rows::Scalar;
  using Observes = Observer;
  using RowsType = Rows;
  using OperatorType = Operator;
  using BookType = Book;
  using GroupsType = Groups;
  static constexpr int pools = Rows::pool_count;

  IslandProblem(Book& book, Rows& rows, Operator& W, const Groups& islands, Index island, double h, Observer& observer)
      : book_(book), rows_(rows), W_(W), islands_(islands), island_(island), h_(h), observer_(observer) {}

  /// The same laws and impulses with another W and other items.
  template <class OtherOperator, class OtherGroups>
  IslandProblem<Book, Rows, OtherOperator, Observer, OtherGroups> with(OtherOperator& W, const OtherGroups& items) const {
    return {book_, rows_, W, items, island_, h_, observer_};
  }
  Operator& compliance() const { return W_; }
  const Groups& groups() const { return islands_; }
  /// Laws that keep something of their own block of W make it anew from `own_block`.
  template <int p, class Own>
  void prepare(Index i, const Own& own_block) {
    if constexpr (requires { book_.template prepare_item<p>(i, own_block, h_); })
      book_.template prepare_item<p>(i, own_block, h_);
  }

  Index island() const { return island_; }
  const Rows& rows() const { return rows_; }
  /// λ_i to write to; W is not told.
  auto& impulse(auto p, Index i) {
    return rows_.template pool<p>().lambda[i];
  }
  const Book& book() const { return book_; }

  int row_count() const {
    int count = 0;
    each_pool([&](auto p, auto items) { count += Rows::template rows_of<p> * int(items.size()); });
    return count;
  }

  /// Visits every constraint once, in order, and leaves each with an impulse that meets its law while the
  /// others stand still. Returns Σ w_i |Δλ_i|², w_i = tr(W_ii)/rows. Sets the last change if asked: its roots
  /// are an eighth of a sweep.
  template <bool tells_change = false>
  double sweep(double relaxation = 1) {
    return double(visit_all<tells_change>(relaxation, [](auto, Index, const auto&, const auto&) {
                    return T(0);
                  }).energy);
  }
  /// The same from y = λ to z. `curvature` becomes Σ w_i (y_i − z_i)·(z_i − x_i).
  template <bool tells_change = false>
  double sweep(double relaxation, const Impulses<Rows>& x, double& curvature) {
    const Moved moved =
        visit_all<tells_change>(relaxation, [&](auto p, Index i, const auto& change, const auto& z) {
          return dot(change, z - std::get<p>(x.pools)[i]);
        });
    curvature = -double(moved.along);
    return double(moved.energy);
  }

  /// One step of the projection λ_i ← P_K(λ_i − ũ_i/s), s = |W_ii| ≥ λ_max(W_ii), for every constraint in order: less than an
  /// exact answer, and a contraction where exact answers go round in circles. Returns and sets what
  /// `sweep` does.
  double project_once(const Impulses<Rows>& x, double& curvature) {
    T energy = 0, sum = 0;
    each([&](auto p, Index i) {
      constexpr int R = Rows::template rows_of<p>;
      auto& lambda = rows_.template pool<p>().lambda[i];
      const Local<R, T> c{W_.template diagonal<p>(i), W_.template residual<p>(rows_, i), lambda};
      const T s = norm(c.W);
      const Vec<R, T> next = lambda - book_.template natural_map<p>(i, c, s) / s;
      const Vec<R, T> change = next - lambda;
      lambda = next;
      W_.template commit<p>(rows_, i, change);
      const T weight = inner::weight_of(c.W);
      energy += weight * squared_norm(change);
      sum -= weight * dot(change, next - std::get<p>(x.pools)[i]);
    });
    curvature = double(sum);
    return double(energy);
  }

  Measure measure() {
    MeasureSums sums;
    each_pool([&](auto p, auto items) {
      MeasureSums here = sums;
      for (const Index i : items) add<p>(i, local<p>(i), here);
      sums = here;
    });
    Measure m = sums.finish(double(std::numeric_limits<T>::epsilon()));
    m.last_change = last_change_;
    m.worst_change = worst_change_;
    return m;
  }

  double last_change() const { return last_change_; }
  double worst_change() const { return worst_change_; }
  /// A solver asks after each sweep; only `WithDeadline` ever says yes.
  static constexpr bool is_out_of_time() { return false; }
  /// And after one that need not be measured: no later one could be.
  static constexpr bool is_measure_due() { return false; }
  /// Before what takes as long as so many sweeps.
  static constexpr bool has_time_for(double) { return true; }
  /// The same for what may come to nothing, and then what came of it.
  static constexpr bool may_attempt(double) { return true; }
  static constexpr void attempted(bool) {}
  /// After so many products of blocks of what is no sweep: what was found so far is of no use then.
  static constexpr bool is_cut_off(int) { return false; }
  /// Before what leaves no measured best.
  static constexpr void must_complete() {}
  /// Whether `notify` reads λ.
  bool tells_forces() const {
    if constexpr (requires { observer_.wants_forces(); }) return observer_.wants_forces();
    return false;
  }
  void notify(int sweeps, const Measure& m) {
    observer_(sweeps, m);
    if (tells_forces())
      if constexpr (requires { observer_.wants_forces(); })
        each([&](auto p, Index i) { observer_.force(sweeps, int(p), i, rows_.template pool<p>().lambda[i], h_); });
  }

  void save(Impulses<Rows>& to) const {
    each([&](auto p, Index i) { std::get<p>(to.pools)[i] = rows_.template pool<p>().lambda[i]; });
  }
  /// λ ← what was saved, and W is told of the difference.
  void load(const Impulses<Rows>& from) {
    each([&](auto p, Index i) { assign<p>(i, std::get<p>(from.pools)[i]); });
  }

  /// λ ← λ + β (λ − before), each brought back into its law's cone; `before` takes the λ that was.
  void extrapolate(Impulses<Rows>& before, double beta) {
    each([&](auto p, Index i) {
      auto& last = std::get<p>(before.pools)[i];
      const auto here = rows_.template pool<p>().lambda[i];
      if (here == last) return;  // an open contact, most of all
      Vec<Rows::template rows_of<p>, T> next = here + T(beta) * (here - last);
      last = here;
      book_.template clamp<p>(i, next);
      assign<p>(i, next);
    });
  }

  /// The numbers √w_i λ_i of all constraints, in order; `to` has as many.
  void gather(Array<double>& to) const {
    std::size_t at = 0;
    each([&](auto p, Index i) {
      const double root = root_of_weight<p>(i);
      for (const T x : rows_.template pool<p>().lambda[i]) to[at++] = root * double(x);
    });
  }
  /// The way back, each λ_i brought into its law's cone.
  void scatter(const Array<double>& from) {
    std::size_t at = 0;
    change([&](auto p, Index i, auto& next) {
      const double root = root_of_weight<p>(i);
      for (T& x : next) x = root > 0 ? T(from[at++] / root) : (++at, T(0));
      book_.template clamp<p>(i, next);
    });
  }

  /// f(p, i) for every constraint, in order.
  void each(auto&& f) const {
    each_pool([&](auto p, auto items) {
      for (const Index i : items) f(p, i);
    });
  }

  template <int p>
  double root_of_weight(Index i) const {
    return std::sqrt(double(trace(W_.template diagonal<p>(i))) / Rows::template rows_of<p>);
  }

  /// λ_i ← what f(p, i, λ_i) makes of it, for every constraint, and W is told.
  void change(auto&& f) {
    each([&](auto p, Index i) {
      auto next = rows_.template pool<p>().lambda[i];
      f(p, i, next);
      assign<p>(i, next);
    });
  }
  /// λ ← 0.
  void clear() {
    change([](auto, Index, auto& next) { set_all(next, T(0)); });
  }

  /// λ_i ← next, and W is told.
  template <int p>
  void assign(Index i, const Vec<Rows::template rows_of<p>, T>& next) {
    auto& lambda = rows_.template pool<p>().lambda[i];
    const Vec<Rows::template rows_of<p>, T> change = next - lambda;
    lambda = next;
    W_.template commit<p>(rows_, i, change);
  }

  /// W_ii, (d + W λ)_i and λ_i.
  template <int p>
  Local<Rows::template rows_of<p>, T> local(Index i) const {
    return {W_.template diagonal<p>(i), W_.template residual<p>(rows_, i), rows_.template pool<p>().lambda[i]};
  }

  /// What constraint i adds to the measure when its velocity and impulse are those of `c`.
  template <int p>
  void add(Index i, const Local<Rows::template rows_of<p>, T>& c, MeasureSums& sums) {
    inner::add_share<p>(book_, i, c, rows_.template pool<p>().d[i], sums);
  }

 private:
  /// f(p, items of the island) for every pool. One without items anywhere costs one look; the only pool has some.
  void each_pool(auto&& f) const {
    for_each_index<pools>([&](auto p) {
      if (pools == 1 || rows_.template pool<p>().items() > 0) f(p, islands_.items(p, island_));
    });
  }

  /// A contact without impulse that goes on opening, of which its normal row tells.
  template <int p>
  bool stays_open(Index i, const Vec<Rows::template rows_of<p>, T>& lambda) const {
    if constexpr (requires {
                    requires Book::template has_cone<p>();
                    W_.template free_normal_velocity<p>(rows_, i);
                  })
      return is_zero(lambda) && W_.template free_normal_velocity<p>(rows_, i) >= T(0);
    else
      return false;
  }

  /// The impulse that meets the law of item i while the others stand still.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, T> answer(Index i, const Vec<Rows::template rows_of<p>, T>& lambda) {
    return book_.template solve_local<p>(i, W_.template diagonal<p>(i), free_velocity<p>(i, lambda));
  }
  /// What the rows of item i would do without λ_i: W's own answer, or u − W λ.
  template <int p>
  [[gnu::always_inline]] Vec<Rows::template rows_of<p>, T> free_velocity(Index i, const Vec<Rows::template rows_of<p>, T>& lambda) const {
    if constexpr (requires { W_.template free_velocity<p>(rows_, i); }) return W_.template free_velocity<p>(rows_, i);
    else return W_.template residual<p>(rows_, i) - W_.template diagonal<p>(i) * lambda;
  }

  /// Sums over the visits of a sweep: Σ w |Δλ|², Σ w Δλ·see, Σ w |Δλ| and the largest w |Δλ|.
  struct Moved {
    T energy = 0, along = 0, displacement = 0, most = 0;
  };

  template <bool tells_change, class See>
  Moved visit_all(double relaxation, const See& see) {
    Moved moved;
    each_pool([&](auto p, auto items) {
      Moved here = moved;
      for (const Index i : items) visit<p, tells_change>(i, T(relaxation), see, here);
      moved = here;
    });
    if constexpr (tells_change) {
      last_change_ = h_ * double(moved.displacement);
      worst_change_ = h_ * double(moved.most);
    }
    return moved;
  }

  // What a visit does is inlined by order, here and in the operators: whether compilers do it by themselves depends
  // on what else a program holds, and one call a visit costs a fifth of a sweep.
  template <int p, bool tells_change, class See>
  [[gnu::always_inline]] void visit(Index i, T relaxation, const See& see, Moved& moved) {
    constexpr int R = Rows::template rows_of<p>;
    auto& lambda = rows_.template pool<p>().lambda[i];
    if (stays_open<p>(i, lambda)) return;
    Vec<R, T> next = answer<p>(i, lambda);
    if (relaxation != T(1)) {
      next = lambda + relaxation * (next - lambda);
      book_.template clamp<p>(i, next);
    }
    const Vec<R, T> change = next - lambda;
    lambda = next;
    W_.template commit<p>(rows_, i, change);
    const T weight = inner::weight_of(W_.template diagonal<p>(i)), square = squared_norm(change);
    moved.energy += weight * square;
    moved.along += weight * see(std::integral_constant<int, p>{}, i, change, next);
    if constexpr (tells_change) {
      const T share = weight * std::sqrt(square);
      moved.displacement += share;
      moved.most = std::max(moved.most, share);
    }
  }

  Book& book_;
  Rows& rows_;
  Operator& W_;
  const Groups& islands_;
  Index island_;
  double h_;
  Observer& observer_;
  double last_change_ = std::numeric_limits<double>::infinity(), worst_change_ = last_change_;
};

}  // namespace delassus
