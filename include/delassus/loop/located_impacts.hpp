/// Impacts at the time at which they happen, between flights of the integrator's own order.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/loop/scheme.hpp>
#include <delassus/loop/stages/flights.hpp>

#include <cmath>

namespace delassus {

/// The bodies fly without their contacts until the first gap closes; where it does is found by a root finder
/// on the gap at the end of flights of other lengths. There the contact's law gives its impulses in no time,
/// H v⁺ = 0 for joints and u⁺ ≥ −e u⁻ for contacts, and the rest of the step is another flight. So a scene
/// whose contacts are impacts is met with the order of its integrator, 2 by `ImplicitMidpoint`,
/// `NewtonMidpoint` and `Rattle` and 4 by `RungeKutta4`, where contacts of a whole step leave the first.
///
/// Contacts that stay (a body that rests or slides, the last of infinitely many bounces) get the rest of the
/// step as it is without this scheme, with an integrator of whole steps as under `SymplecticEuler`. Seen is
/// what overlaps at the end of a flight, and on its way what the speculative margin saw ahead: who was
/// farther off and is through a thin wall by then was not. Takes contacts and joints whose rows are
/// equalities; no activity. The state is copied once a flight, so soft bodies pay much for it. Listeners hear
/// every flight, those too that only look for the impact. `impulse` has the sum of all flights and impacts,
/// `contacts` the impacts, one after the other, and what stays.
struct LocatedImpacts {
  using plays = role::Scheme;
  static constexpr bool takes_whole_steps = true;
  static constexpr bool locates_impacts = true;
  template <class World, class Laws, class Rows>
  using Parts = Flights<World, Laws>;
  double tolerance = 1e-12;  ///< of the gap at an impact, m
  int max_impacts = 16;      ///< in a step; what is left of it after them is a step with contacts

  void check() const {
    DELASSUS_EXPECT(tolerance > 0, "LocatedImpacts: tolerance " + inner::text(tolerance) + " m must be > 0");
    DELASSUS_EXPECT(max_impacts >= 1,
                    "LocatedImpacts: max_impacts " + inner::text(max_impacts) + " must be >= 1");
  }

  void run(auto& loop) const {
    double left = loop.step_size(), near = loop.begin_flights(tolerance);
    if (loop.closes(tolerance)) {
      loop.meet(tolerance);
      near = 0;
    }
    for (int impacts = 0;; ++impacts) {
      const double soonest = loop.soonest_touch(tolerance);
      decltype(loop.fly(left, true)) end;
      double until = left;
      for (double share = 1. / 64; soonest < left && share < 1 && !(end.gap < -tolerance); share *= 2) {
        until = soonest + share * (left - soonest);  // who will be through something thin?
        end = loop.fly(until, false);
      }
      if (!(end.gap < -tolerance)) end = loop.fly(until = left, true);
      if (!(end.gap < -tolerance)) break;
      Found found;
      if (!end.stays && impacts < max_impacts && loop.may_locate())
        found = find(loop, {0, near}, {until, end.gap});
      if (!(found.time > 0)) {
        loop.step_with_contacts(left);
        break;
      }
      loop.meet(found.reach);
      left -= found.time;
      near = 0;
    }
    loop.end_flights();
  }

 private:
  /// The least gap (m) after a flight of `time` (s).
  struct Sample {
    double time = 0, gap = 0;
  };
  struct Found {
    double time = 0, reach = 0;  ///< s after the flight began, where the loop then is; m, of what meets there
  };

  /// Between `open` and `closed`. Bodies that touch at the start must part first: by more than a 64th of the
  /// way to `closed`, or they stay in touch.
  Found find(auto& loop, Sample open, Sample closed) const {
    for (int k = 0; k < 60 && !(open.gap > tolerance); ++k) {
      const double time = 0.5 * closed.time;
      const auto middle = loop.fly(time, false);
      (middle.gap > tolerance ? open : closed) = {time, middle.gap};
      if (k >= 5 && middle.is_old && !(middle.gap > tolerance)) return {};
    }
    if (!(open.gap > tolerance)) return {};
    // Regula falsi; the gap of an end that stays twice is halved [DowellJarratt1971].
    double above = open.gap, below = closed.gap;
    for (int k = 0, last = 0; k < 100; ++k) {
      const double share = std::isfinite(above) ? above / (above - below) : 0.5;
      const double time = open.time + share * (closed.time - open.time);
      if (!(time > open.time && time < closed.time)) break;
      const Sample next{time, loop.fly(time, false).gap};
      if (std::abs(next.gap) <= tolerance) return {time, 2 * tolerance};
      if (next.gap > 0) {
        open = next, above = next.gap;
        if (last > 0) below *= 0.5;
        last = 1;
      } else {
        closed = next, below = next.gap;
        if (last < 0) above *= 0.5;
        last = -1;
      }
    }
    const double gap = std::abs(loop.fly(closed.time, false).gap);  // as near as numbers come
    if (!(gap <= 1e6 * tolerance)) return {};  // a jump: what was seen here is seen no more there
    return {closed.time, gap + tolerance};
  }
};

}  // namespace delassus
