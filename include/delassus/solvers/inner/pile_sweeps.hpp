/// How momentum sweeps a pile, many bodies that meet many others at one point each.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/solvers/island.hpp>

#include <limits>

namespace delassus::inner {

/// An island as a net of bodies, from W alone: before anything is gathered, and in a fiftieth of a sweep.
struct BodyNet {
  double contacts_a_pair = 0;  ///< items that act on the same two bodies, one after the other
  double factorization = 0;    ///< what one in the velocities of the bodies is likely to cost, in sweeps

  static constexpr double finest = 3e-4;  ///< a tolerance: below it the rules of other islands end more

  [[gnu::always_inline]] bool is_pile(double tolerance) const {
    return tolerance >= finest && factorization > 50 && contacts_a_pair < 1.5;
  }
};

/// Nothing of an island whose W is not square blocks alone, or has no bodies. With k contacts a pair and d
/// neighbours a body, row i of W has 2 k (d − 1) + k − 1 blocks beside its own. A body with two neighbours is
/// of a chain, which does not fill; every further neighbour fills the factor, as the bodies do, and a sweep
/// has k² as many blocks as that of a net with one contact a pair. A third of that is what factors of piles
/// of spheres cost.
template <class T>
BodyNet find_body_net(const Island<T>& island) {
  double items = 0, blocks = 0, pairs = 0;
  for (const Span<T>& span : island) {
    const PoolView<T>& pool = *span.pool;
    if (pool.form != FormOfW::square_blocks || pool.sets == 0) return {};
    Index first = -1, last = -1;
    for (const Index i : span) {
      Index a = -1, b = -1;
      for (const SetBlocksView<T>* set = pool.set; set != pool.set + pool.sets; ++set)
        if (set->has_entries(i))
          a = a < 0 ? set->block[set->offset[i]] : a, b = set->block[set->offset[i + 1] - 1];
      pairs += a != first || b != last;
      first = a, last = b;
      blocks += double(pool.blocks->start[i + 1] - pool.blocks->start[i]);
    }
    items += double(span.count);
  }
  const double k = items / pairs, neighbours = 1 + (blocks / items - k + 1) / (2 * k);
  if (!(neighbours > 2)) return {k, 0};
  return {k, 2 * pairs / neighbours * (neighbours - 2) / (3 * k * k)};
}

/// A pile has loads that many sets of contacts can carry. Exact answers come near them fast, and then its
/// contacts go to and fro between sticking and slipping. So from an error of `late` on a visit is one
/// projection, and momentum ends as soon as a sweep moves half as much again as the least. What it leaves
/// near the tolerance is mostly noise from contact to contact, which eight sweeps of half a projection
/// without momentum take away. Loads that must go far stand still for long: there is more patience.
class PileSweeps {
 public:
  [[gnu::always_inline]] explicit PileSweeps(const SweepRule& rule)
      : given_(rule), rule_(rule), from_(rule.projects ? never : first) {}

  [[gnu::always_inline]] const SweepRule& rule() const { return rule_; }
  [[gnu::always_inline]] bool is_on() const { return is_on_; }

  /// After a sweep that did not end the stage: whether momentum begins anew from here. Most islands are
  /// solved before `first` sweeps, and of those that are no piles it asks nothing any more.
  [[gnu::always_inline]] bool turns(const auto& island, auto& monitor) {
    return monitor.sweeps() >= from_ && is_turning(island, monitor);
  }

  /// `RestartRule::asks` of a pile.
  [[gnu::always_inline]] bool asks(double curvature, double moved) {
    const bool is_asked = curvature > 0 || moved > 1.5 * least_;
    if (is_asked)
      least_ = infinity;
    else if (moved < least_)
      least_ = moved;
    return is_asked;
  }

 private:
  static constexpr int first = 8, never = std::numeric_limits<int>::max(), smoothing = 8, more_patience = 6;
  static constexpr double late = 5e-3, near = 1.5, infinity = std::numeric_limits<double>::infinity();

  [[gnu::noinline]] bool is_turning(const auto& island, auto& monitor) {
    if (!is_on_) {
      is_on_ = find_body_net(island).is_pile(monitor.tolerance());
      if (!is_on_)
        from_ = never;
      else
        allowed_ = near * monitor.tolerance();
    }
    if (left_ > 0) {
      if (--left_ == 0) end_smoothing(monitor);
      return true;
    }
    if (!is_on_ || !monitor.is_measured_now()) return false;
    const double error = monitor.error();
    if (error < allowed_ && monitor.sweeps() >= rested_) {
      rule_ = {.relaxation = 0.5, .descends = true};
      left_ = smoothing;
      before_ = error;
    } else if (error < late && !rule_.descends) {
      rule_ = {.descends = true};
      is_late_ = true;
      monitor.give_patience(more_patience);
    } else {
      return false;
    }
    least_ = infinity;
    return true;
  }
  /// It is tried again after twice as many sweeps, and where it did not help from a smaller error only.
  [[gnu::always_inline]] void end_smoothing(const auto& monitor) {
    rule_ = is_late_ ? SweepRule{.descends = true} : given_;
    rested_ = monitor.sweeps() + 2 * smoothing;
    if (monitor.error() > before_) allowed_ = 0.9 * before_;
  }

  const SweepRule given_;
  SweepRule rule_;
  int from_, left_ = 0, rested_ = 0;
  bool is_on_ = false, is_late_ = false;
  double least_ = infinity, allowed_ = 0, before_ = infinity;
};

}  // namespace delassus::inner
