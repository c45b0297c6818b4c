/// The stages of `LocatedImpacts`: flights, impacts, and what is left of a step.
#pragma once

#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/inner/loop_stages.hpp>
#include <delassus/loop/stages/bias.hpp>
#include <delassus/loop/stages/impact_bias.hpp>
#include <delassus/loop/stages/linearize.hpp>
#include <delassus/loop/stages/pass_on_impacts.hpp>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace delassus {

namespace inner {

/// Shorter flights, as shares of a step, go as a step with contacts does: with gaps closed over the whole
/// step. What they are off by is of second order in their length.
template <class Integrator>
constexpr double shortest_flight() {
  if constexpr (requires { Integrator::shortest_flight; })
    return Integrator::shortest_flight;
  else
    return 1e-6;
}

/// Advance of a step with contacts under an integrator that leaves q to its whole step.
struct KickAndDrift {
  void advance(auto& set, double h) const { set.advance(h); }
};

/// f(gap, rate), m and m/s, of each contact in the book, at the poses and velocities of now.
template <class Laws, class F>
void each_rate_of_contact(const auto& world, Laws& laws, auto& collision, auto& work, const F& f) {
  if (work.contacts.points.empty()) return;
  work.contacts.record();
  place_ends(collision, work.contacts.results);
  route_contacts(laws, work.contacts, work.materials);
  delassus::linearize(world, laws, work.rows);
  for_each_index<Laws::pool_count>([&](auto p) {
    const auto& pool = std::as_const(work.rows).template pool<p>();
    if constexpr (ContactLaw<std::remove_cvref_t<decltype(laws.template pool<p>().law)>>)
      for (Index i = 0; i < pool.items(); ++i) {
        const auto u = rate(
            pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
        f(double(pool.phi[i][0]), double(u[0]));
      }
  });
}

}  // namespace inner

template <class... Policies>
double AnimationLoop<Policies...>::begin_flights(double tolerance) {
  if constexpr (locates_impacts) {
    auto& flights = work_.parts;
    flights.h = h_, flights.start = start_, flights.steps = steps_;
    flights.begin(world(), laws(), work_.contacts, report_);
    detect();
    report_.contacts = 0;
    flights.see(work_.contacts);
    flights.look_ahead();
    flights.note_touching(work_.contacts, tolerance);
    if constexpr (requires { Parts::Integrator::shortest_flight; }) {
      delassus::linearize(std::as_const(*this).world(), laws(), work_.rows);
      flights.are_joints_closed = worst_equality(laws(), work_.rows) <= 1e-9;  // 10⁻⁴ m/s in the shortest
    }
    return flights.landing(work_.contacts).gap;
  }
  return 0;
}

template <class... Policies>
bool AnimationLoop<Policies...>::may_locate() const {
  if constexpr (locates_impacts) return work_.parts.are_joints_closed;
  return false;
}

template <class... Policies>
bool AnimationLoop<Policies...>::closes(double reach) {
  bool is_closing = false;
  if constexpr (locates_impacts) {
    auto& flights = work_.parts;
    std::erase_if(work_.contacts.points,
                  [&](const ContactPoint& p) { return !(p.gap <= reach) || flights.stays(p.pair); });
    inner::each_rate_of_contact(std::as_const(*this).world(), laws(), part<role::Collision>(), work_,
                                [&](double, double rate) { is_closing = is_closing || rate < 0; });
    if (is_closing) flights.forget_impulses(laws());
  }
  return is_closing;
}

template <class... Policies>
double AnimationLoop<Policies...>::soonest_touch(double reach) {
  double soonest = std::numeric_limits<double>::infinity();
  if constexpr (locates_impacts) {
    auto& flights = work_.parts;
    work_.contacts.points = flights.ahead();
    std::erase_if(work_.contacts.points,
                  [&](const ContactPoint& p) { return p.gap <= reach || flights.stays_ahead(p.pair); });
    inner::each_rate_of_contact(std::as_const(*this).world(), laws(), part<role::Collision>(), work_,
                                [&](double gap, double rate) {
                                  if (rate < 0) soonest = std::min(soonest, -gap / rate);
                                });
  }
  return soonest;
}

template <class... Policies>
void AnimationLoop<Policies...>::set_part(double h, bool is_last) {
  work_.parts.go_back(world(), laws(), report_);
  last_h_ = h_ = h;
  work_.parts.stay_on_the_way(world(), !is_last);
}

template <class... Policies>
void AnimationLoop<Policies...>::see() {
  if constexpr (locates_impacts) {
    const StepReport flown = report_;
    detect();
    const CollisionReport seen{.pairs = report_.pairs, .queries = report_.queries};
    report_ = flown;  // what overlaps here is no end of a step
    report_.pairs = seen.pairs, report_.queries = seen.queries;
    work_.parts.see(work_.contacts);
  }
}

template <class... Policies>
auto AnimationLoop<Policies...>::fly(double h, bool is_last) {
  if constexpr (locates_impacts) {
    set_part(h, is_last);
    work_.contacts.points.clear();
    work_.contacts.record();
    route_contacts(laws(), work_.contacts, work_.materials);
    if constexpr (solves_whole_step) {
      if (h < inner::shortest_flight<typename Parts::Integrator>() * work_.parts.h) {
        inner::linearize_to_build(*this);
        solve();
        correct();
        advance_by(inner::KickAndDrift{});
      } else {
        solve_whole_step();
        work_.contacts.remember();
        advance();
      }
    } else {
      inner::linearize_to_build(*this);
      inner::solve_to_advance(*this);
    }
    see();
    return work_.parts.landing(work_.contacts);
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::meet(double reach) {
  if constexpr (locates_impacts) {
    auto& flights = work_.parts;
    auto& contacts = work_.contacts;
    h_ = flights.h;
    flights.add_impulses(laws());
    std::erase_if(contacts.points, [&](const ContactPoint& p) { return !(p.gap <= reach); });
    flights.note_touching(contacts, reach);
    contacts.record();
    inner::place_ends(part<role::Collision>(), contacts.results);
    if (route_contacts(laws(), contacts, work_.materials) > 0)
      report_.status = worse(report_.status, Status::unclaimed_contact);
    delassus::linearize(std::as_const(*this).world(), laws(), work_.rows);
    if constexpr (Work::passes_impacts_on)
      pass_on_impacts(world(), laws(), work_.rows, work_.impacts, contacts.results.size(), h_);
    world().each([&](auto& set, auto s) {
      inner::inverse_of<s>(work_.W, set, 0).factor(SystemScale{.mass = 1});
      set.v_free = set.velocity();
    });
    find_islands();
    if constexpr (Work::restitutes) work_.bounce.resize_like(work_.rows);
    if constexpr (Work::at_midpoint) {
      work_.fade.resize_like(work_.rows);
      for_each_index<Laws::pool_count>([&](auto p) {
        for (auto& x : std::get<p>(work_.fade.pools)) x.setZero();
      });
    }
    make_impact_bias(std::as_const(*this).world(), laws(), work_.rows, work_.islands, work_.bounce);
    build();
    solve();
    correct();
    world().each([&](auto& set, auto) {
      for (const Index b : set.active())
        if (set.moves(b) && is_finite(set.v_next[b])) set.velocity()[b] = set.v_next[b];
    });
    flights.add_impulses(laws());
    flights.add_contacts(contacts);
    see();  // with what is ahead of the new velocities in the whole of a step
    flights.go_on(world(), laws(), report_);
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::step_with_contacts(double h) {
  if constexpr (locates_impacts) {
    set_part(h, true);
    work_.contacts = work_.parts.contacts_before();
    detect();
    inner::linearize_to_build(*this);
    solve();
    correct();
    if constexpr (solves_whole_step)
      advance_by(inner::KickAndDrift{});
    else
      advance();
    work_.parts.add_contacts(work_.contacts);
  }
}

template <class... Policies>
void AnimationLoop<Policies...>::end_flights() {
  if constexpr (locates_impacts) {
    auto& flights = work_.parts;
    flights.add_impulses(laws());
    flights.give_impulses(laws(), work_.contacts);
    report_.contacts = Index(work_.contacts.results.size());
    forget_rows();
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws().template pool<p>();
      if constexpr (ContactLaw<std::remove_cvref_t<decltype(pool.law)>>) pool.items.clear();
    });
    h_ = std::exchange(flights.h, 0);
    start_ = flights.start;
    steps_ = flights.steps + 1;
    report_.time = time();
  }
}

}  // namespace delassus
