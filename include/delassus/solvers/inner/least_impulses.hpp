/// Among impulses that make the same motion, the least.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/solvers/inner/anderson.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/solve_options.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace delassus::inner {

/// A constraint whose impulse may be another one: of one that stands still each row is an unknown; a contact that slips has
/// one unknown, the size of its impulse.
template <class T>
struct FreeImpulse {
  const Span<T>* span;
  Index i, first;  ///< the item, and the first of its numbers in impulses that are set aside
  bool slips, is_outside = false, ends = false;
  double over[most_rows] = {}, along[most_rows] = {};  ///< 1/√w of each row, and what one unknown of a contact that slips is in each

  int rows() const { return span->pool->rows; }
  int unknowns() const { return slips ? 1 : rows(); }
  /// What the n-th unknown is in a row, of B or of P.
  double entry(int n, int row, bool is_normal) const {
    if (!slips) return n == row ? over[row] : 0;
    return !is_normal ? along[row] : row == 0 ? over[0] : 0;
  }
};

/// Residuals of conjugate gradients: all of them where the unknowns are few, else the first. They are orthogonal, but for what
/// rounding leaves; a search that is not told of it goes the same ways again and again.
struct PastResiduals {
  static constexpr std::size_t most_numbers = 1 << 16;
  Array<double> unit;  ///< of length 1, one after the other

  void reserve(std::size_t unknowns) { unit.reserve(unknowns < 256 ? unknowns * unknowns : most_numbers); }
  void clear() { unit.clear(); }
  void add(const Array<double>& r, double square) {
    if (unit.size() + r.size() > most_numbers) return;
    const double over = 1 / std::sqrt(square);
    for (const double number : r) unit.push_back(over * number);
  }
  /// What r has of them goes.
  void take_from(Array<double>& r) const {
    for (const double *q = unit.data(), *end = q + unit.size(); q != end; q += r.size()) {
      double along = 0;
      for (std::size_t n = 0; n < r.size(); ++n) along += q[n] * r[n];
      for (std::size_t n = 0; n < r.size(); ++n) r[n] -= along * q[n];
    }
  }
};

/// Room for the search, reserved once.
template <class T>
struct LeastImpulsesSpace {
  Array<T> solved, target;  ///< impulses that are set aside
  Array<FreeImpulse<T>> free;
  Array<double> x, b, r, p, q;  ///< of the unknowns
  PastResiduals past;

  void reserve(Index rows) {
    const std::size_t room = std::size_t(rows);
    for (auto* impulses : {&solved, &target}) impulses->reserve(room);
    for (auto* v : {&x, &b, &r, &p, &q}) v->reserve(room);
    past.reserve(room);
    free.reserve(room);
  }
};

/// The unknowns x are √w λ. B x are impulses: rows of what stands still, and along λ* where a contact slips. P x differs from
/// them where a contact slips: it is along the normal there.
template <class T>
class LeastImpulses {
 public:
  LeastImpulses(Island<T>& problem, LeastImpulsesSpace<T>& work) : problem_(problem), work_(work) {}

  int slipping() const { return slipping_; }
  /// Contacts that are closed.
  int contacts() const { return contacts_; }

  /// λ* is what the problem has, and free are the constraints whose velocity is within the error of the solve.
  void sort(const Measure& measure) {
    problem_.save(work_.solved);
    T u[most_rows];
    double d = 0, moved = 0;
    for (const Span<T>& span : problem_)
      for (const Index i : span) {
        d += problem_.square_of_velocity(span, problem_.free_of_impulses(span, i));
        problem_.velocity(span, i, u);
        moved += problem_.square_of_velocity(span, u);
      }
    const double small = 10 * std::max(measure.residual, measure.floor) * std::sqrt(std::max(d, moved));
    work_.free.clear();
    slipping_ = contacts_ = 0;
    Index row = 0;
    for (const Span<T>& span : problem_)
      for (const Index i : span) {
        problem_.velocity(span, i, u);
        add_if_free(span, i, row, u, small);
        row += span.pool->rows;
      }
  }

  /// Of a solve that ended with `report`: impulses that meet the tolerance, or are hidden by rounding, stay and are what it reports;
  /// so do those of a solve that stalled which are nearly as good. Else λ* is put back: false.
  bool keep(const SolveOptions& limits, SolveReport& report) {
    Measure after = problem_.measure();
    after.last_change = report.measure.last_change, after.worst_change = report.measure.worst_change;  // there was no sweep since
    const int rows = problem_.row_count();
    const bool stays = limits.is_done(after, rows) || (report.status == Status::stalled && after.residual <= 2 * report.measure.residual);
    if (!stays) {
      problem_.load(work_.solved);
      return false;
    }
    report.measure = after;
    if (report.status == Status::converged) report.status = limits.verdict(after, rows);
    return true;
  }

  /// λ = argmin Σ w_i |λ_i|² with W λ unchanged, by conjugate gradients from zero on Bᵀ W B x = Bᵀ W λ*. Where a cone is in
  /// the way λ goes as far as it lets it. False when λ is the least, or nothing more can be done.
  bool shrink(int products) {
    gather();
    multiply(work_.x, false, work_.b, false);
    const bool is_found = find_in_range(products);
    problem_.load(work_.target);
    return is_found && !go(1) && go_as_far_as_the_cones();
  }

  /// The limit of a compliance that vanishes: the least λ_n that leave the normal velocities of closed contacts as they are,
  /// friction following along the slip. That moves what slips, so that the problem must be solved again from here. By
  /// conjugate gradients on G Gᵀ y = b, x = Gᵀ y, G = Pᵀ W B, b = G x*. Returns how far λ went, of its size.
  double share(int products) {
    auto& [solved, target, free, x, b, r, p, q, past] = work_;
    gather();
    b = x;
    multiply(x, false, r, true);
    x.assign_zeros(x.size());
    multiply(r, true, p, false);
    double square = sum_of_products(r, r);
    const double goal = std::max(1e-20, least_square) * square;
    past.clear();
    for (int k = 0; square > goal && k < products; ++k) {
      const double curvature = sum_of_products(p, p);
      if (!(curvature > 0)) break;
      const double alpha = square / curvature;
      past.add(r, square);
      multiply(p, false, q, true);
      for (std::size_t n = 0; n < x.size(); ++n) x[n] += alpha * p[n], r[n] -= alpha * q[n];
      past.take_from(r);
      const double next = sum_of_products(r, r), beta = next / square;
      multiply(r, true, q, false);
      for (std::size_t n = 0; n < x.size(); ++n) p[n] = q[n] + beta * p[n];
      square = next;
    }
    problem_.load(target);
    go(1);
    double way = 0;
    for (std::size_t n = 0; n < x.size(); ++n) way += (x[n] - b[n]) * (x[n] - b[n]);
    const double size = sum_of_products(b, b);
    return size > 0 ? std::sqrt(way / size) : 0;
  }

 private:
  void add_if_free(const Span<T>& span, Index i, Index row, const T* u, double small) {
    const bool is_contact = span.pool->table->friction, stands = std::sqrt(problem_.square_of_velocity(span, u)) <= small;
    const bool is_closed = is_contact && std::abs(double(u[0])) <= small && problem_.impulse(span, i)[0] > 0;
    if ((!stands && !is_closed) || !(span.pool->trace(i) > 0)) return;
    FreeImpulse<T> free{&span, i, row, !stands};
    span.pool->roots_of_weights(i, free.over);
    for (int k = 0; k < free.rows(); ++k) free.over[k] = free.over[k] > 0 ? 1 / free.over[k] : 0;
    work_.free.push_back(free);
    slipping_ += !stands;
    contacts_ += is_closed;
  }

  // --- B and P --------------------------------------------------------------------------------------------------------

  /// One constraint's part of B x or P x.
  static void impulse(const FreeImpulse<T>& free, bool is_normal, const double* x, T* sum) {
    for (int row = 0; row < free.rows(); ++row)
      sum[row] = T(free.slips ? free.entry(0, row, is_normal) * x[0] : free.over[row] * x[row]);
  }
  /// And of Bᵀ u or Pᵀ u.
  static void velocity(const FreeImpulse<T>& free, bool is_normal, const T* u, double* y) {
    if (free.slips) y[0] = 0;
    for (int row = 0; row < free.rows(); ++row)
      if (free.slips)
        y[0] += free.entry(0, row, is_normal) * double(u[row]);
      else
        y[row] = free.over[row] * double(u[row]);
  }

  /// λ* ← λ, x ← the unknowns of it.
  void gather() {
    problem_.save(work_.target);
    std::size_t count = 0;
    for (const FreeImpulse<T>& free : work_.free) count += std::size_t(free.unknowns());
    for (auto* v : {&work_.x, &work_.b, &work_.r, &work_.p, &work_.q}) v->assign(count, 0);
    double* x = work_.x.data();
    for (FreeImpulse<T>& free : work_.free) {
      const T* at = work_.target.data() + free.first;
      double size = 0;  // w |λ*|²
      for (int k = 0; k < free.rows(); ++k) {
        const double number = double(at[k]), weighed = free.over[k] > 0 ? number / free.over[k] : 0;
        if (!free.slips) x[k] = weighed;
        size += weighed * weighed;
      }
      if (free.slips) {
        // A unit of x is a unit of √(Σ w_k λ_k²).
        for (int k = 0; k < free.rows(); ++k) free.along[k] = double(at[k]) / std::sqrt(size);
        x[0] = std::sqrt(size);
      }
      x += free.unknowns();
    }
  }
  /// y = Pᵀ W B x, with P in the place of B and B in the place of P as said. The problem has λ = B x afterwards, and zero
  /// elsewhere.
  void multiply(const Array<double>& x, bool normals_of_x, Array<double>& y, bool normals_of_y) {
    problem_.clear();
    T numbers[most_rows];
    const double* from = x.data();
    for (const FreeImpulse<T>& free : work_.free) {
      impulse(free, normals_of_x, from, numbers);
      problem_.assign(*free.span, free.i, numbers);
      from += free.unknowns();
    }
    double* to = y.data();
    for (const FreeImpulse<T>& free : work_.free) {
      problem_.velocity(*free.span, free.i, numbers);
      const T* d = problem_.free_of_impulses(*free.span, free.i);
      for (int row = 0; row < free.rows(); ++row) numbers[row] -= d[row];
      velocity(free, normals_of_y, numbers, to);
      to += free.unknowns();
    }
  }

  /// The square of a residual that is rounding, which W does not reach: answers to it would be large.
  static constexpr double rounding = 64 * double(std::numeric_limits<T>::epsilon()), least_square = rounding * rounding;

  // --- the search -----------------------------------------------------------------------------------------------------

  /// x in the range of Bᵀ W B with its product b.
  bool find_in_range(int products) {
    auto& [solved, target, free, x, b, r, p, q, past] = work_;
    x.assign_zeros(x.size());
    r = b;
    p = b;
    double square = sum_of_products(r, r);
    const double goal = std::max(1e-26, least_square) * square;
    past.clear();
    for (int k = 0; square > goal; ++k) {
      if (k == products) return false;
      multiply(p, false, q, false);
      const double curvature = sum_of_products(p, q);
      if (!(curvature > 0)) return square <= std::max(1e-20, least_square) * sum_of_products(b, b);
      const double alpha = square / curvature;
      past.add(r, square);
      for (std::size_t n = 0; n < x.size(); ++n) x[n] += alpha * p[n], r[n] -= alpha * q[n];
      past.take_from(r);
      const double next = sum_of_products(r, r), beta = next / square;
      for (std::size_t n = 0; n < x.size(); ++n) p[n] = r[n] + beta * p[n];
      square = next;
    }
    return true;
  }
  /// λ ← λ* + s (B x − λ*), in the cones; whether they let it. `is_outside` has who does not.
  bool go(double s) {
    bool is_inside = true;
    T next[most_rows], inside[most_rows];
    const double* x = work_.x.data();
    for (FreeImpulse<T>& free : work_.free) {
      const T* at = work_.target.data() + free.first;
      impulse(free, false, x, next);
      double size = 0, apart = 0;
      for (int row = 0; row < free.rows(); ++row) {
        next[row] = at[row] + T(s) * (next[row] - at[row]);
        inside[row] = next[row];
      }
      problem_.clamp(*free.span, free.i, inside);
      for (int row = 0; row < free.rows(); ++row) {
        size += double(next[row]) * double(next[row]);
        apart += double(inside[row] - next[row]) * double(inside[row] - next[row]);
      }
      free.is_outside = std::sqrt(apart) > 1e-12 * std::sqrt(size);
      if (free.is_outside) is_inside = false;
      problem_.assign(*free.span, free.i, inside);
      x += free.unknowns();
    }
    return is_inside;
  }
  /// The largest s. Who ends it is held from now on.
  bool go_as_far_as_the_cones() {
    double low = 0, high = 1;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      (go(middle) ? low : high) = middle;
    }
    go(high);
    for (FreeImpulse<T>& free : work_.free) free.ends = free.is_outside;
    go(low);
    std::size_t left = 0;
    for (const FreeImpulse<T>& free : work_.free)
      if (!free.ends) work_.free[left++] = free;
    work_.free.resize(left);
    return true;
  }

  Island<T>& problem_;
  LeastImpulsesSpace<T>& work_;
  int slipping_ = 0, contacts_ = 0;
};

}  // namespace delassus::inner
