/// The size of the next step from the errors of the last ones, and the search for an event.
#pragma once

#include <delassus/core/cmath.hpp>

#include <algorithm>

namespace delassus::inner {

/// A PI controller [Gustafsson1991], E the error over what is allowed and k the order of the error in h,
///
///   h₊ = h · clamp(0.9 E^(−0.7/k) E₋^(0.4/k), 0.2, 5).
///
/// It is not above h after a rejection and at most twice after an event. An event in a step [t, t + h] that was rejected is
/// looked for by bisection: until t + h is passed the next step is what is left of it where its error is likely to pass, else half.
class StepSizeControl {
 public:
  /// h of the next trial where `left` s are left to go.
  double propose(double largest, double smallest, double left) {
    double now = std::clamp(next_, smallest, std::max(smallest, largest));
    if (now > left * (1 - 1e-9)) now = left;
    else if (2 * now > left && left / 2 >= smallest) now = left / 2;
    is_cut_ = now < 0.999 * next_;
    return now;
  }
  /// A trial of h from t with the error E (1: as large as allowed), whose order is k. `is_event`: contacts begin or end in it.
  void reject(double t, double h, double E, double k, bool is_event) {
    double factor = E < 1e300 ? std::clamp(0.9 * std::pow(E, -1 / k), 0.1, 0.5) : 0.1;
    if (is_event) factor = 0.5, until_ = t + h, density_ = E / h;
    next_ = h * factor;
    was_rejected_ = true;
  }
  /// The same of one that was accepted and ends at t.
  void accept(double t, double h, double E, double k, bool is_event) {
    E = std::max(E, 1e-10);
    double factor = 0.9 * std::pow(E, -0.7 / k) * std::pow(last_ > 0 ? last_ : 1 / std::pow(E, 0.75), 0.4 / k);
    factor = std::clamp(factor, 0.2, 5.0);
    if (was_rejected_) factor = std::min(factor, 1.0);
    if (is_event) factor = std::min(factor, 2.0), until_ = -1;
    last_ = is_event ? 0 : E;
    was_rejected_ = false;
    if (!is_cut_ || factor < 1) next_ = h * factor;
    if (until_ > t) {
      const double rest = until_ - t;
      next_ = density_ * rest < 0.9 ? rest * (1 + 1e-6) : rest / 2;
    } else {
      until_ = -1;
    }
  }
  double next() const { return next_; }  ///< s
  /// Before the first step.
  void begin(double h) { *this = {}, next_ = h; }
  bool has_begun() const { return next_ > 0; }

 private:
  double next_ = 0;      ///< s
  double last_ = 0;      ///< E of the step before; 0 where there is none, or it had an event
  double until_ = -1;    ///< the end of the interval of an event, s; −1: none is looked for
  double density_ = 0;   ///< E/h of that interval
  bool was_rejected_ = false, is_cut_ = false;
};

}  // namespace delassus::inner
