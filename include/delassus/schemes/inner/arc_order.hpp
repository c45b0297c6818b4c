/// The order of an arc in contact, measured from three sizes of a step.
#pragma once

#include <delassus/schemes/inner/arc_difference.hpp>
#include <delassus/schemes/inner/end_state.hpp>

#include <type_traits>

namespace delassus::inner {

/// Spin, joints and contacts have orders of their own, which no integrator's name says. On an arc, where the
/// same pairs push, stick and slip all along, the order p is measured now and then: the first half of a step
/// is made of two quarters too, and the differences are
///
///   e(h)/e(h/2) = 2^(p+1),   of the whole from its halves, and of the half from its quarters.
///
/// Where the leading term of an error passes through zero that ratio says nothing: a known order is given up
/// when the next step denies it too. Until it is known, where something begins, ends or changes, and in contacts of first order, the difference
/// counts with all that is held, and p is 1: a contact that lets go, or slips, turns what it held into
/// motion.
template <class World>
class ArcOrder {
  /// The least e(h)/e(h/2): of p = 1 it is 4 and of p = 2 it is 8; here p is half less. Once known to be 2, it is until the ratio
  /// says 1.
  static constexpr double of_first = 2.83, of_second = 5.66, of_second_still = 4;
  static constexpr int steps_between = 16;

 public:
  /// After the whole of a step.
  bool is_due() const { return left_ <= 0 && difference_.is_known(); }
  /// Of each part of a step, before Advance.
  void look(auto& step) { difference_.look(step); }
  /// Two quarters have been made.
  void take_quarters(const World& world) { quarters_.take(world); }
  /// The first half has.
  template <class Lengths>
  void take_half(auto& step, const Lengths& lengths, double tau) {
    half_ = difference_.take(step, quarters_) ? difference_.error(step.world(), lengths, tau).sum : 0;
  }
  /// The second half has, on an arc. The error of the step, `plain` while p is not known; `measures`: the
  /// first half was taken.
  template <class Lengths>
  EndError error(auto& step, const EndState<World>& whole, const Lengths& lengths, double tau, bool measures,
                 const EndError& plain) {
    if (p_ == 0 && !measures) return plain;
    const bool is_taken = difference_.take(step, whole);
    const EndError error = is_taken ? difference_.error(step.world(), lengths, tau) : plain;
    if (!is_taken) {
      p_ = 0;
    } else if (measures) {
      const int p = error.sum > (p_ == 2 ? of_second_still : of_second) * half_                               ? 2
                    : error.sum > of_first * half_ && !any_contact_pushes(step) ? 1
                                                                                : 0;
      is_in_doubt_ = p < p_ && !is_in_doubt_;
      if (!is_in_doubt_) p_ = p;
    }
    if (measures) left_ = is_in_doubt_ ? 0 : steps_between;
    return p_ > 0 ? error : plain;
  }
  int order() const { return p_; }  ///< 0: not known
  /// A step was accepted in which something pushes; `is_arc`: the same all along.
  void accept(bool is_arc) {
    if (is_arc)
      --left_;
    else
      p_ = 0, left_ = 1, is_in_doubt_ = false;
  }
  /// A trial of a step was rejected: what is not known is measured by the next.
  void reject() {
    if (p_ == 0) left_ = 0;
  }
  void memory(auto& archive) { archive(p_, left_, is_in_doubt_); }

 private:
  static bool any_contact_pushes(auto& step) {
    if constexpr (std::remove_cvref_t<decltype(step)>::Laws::has_contacts)
      for (const auto& result : step.contact_cache.results)
        if (!is_zero(result.impulse)) return true;
    return false;
  }

  ArcDifference<World> difference_;
  EndState<World> quarters_;
  double half_ = 0;
  int p_ = 0, left_ = 1;      ///< the order, and in how many steps it is measured
  bool is_in_doubt_ = false;  ///< the last measurement denied it
};

}  // namespace delassus::inner
