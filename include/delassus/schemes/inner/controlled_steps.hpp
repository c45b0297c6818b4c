/// The inner steps of `ErrorControlled`: each is tried, and accepted or repeated.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/schemes/error_report.hpp>
#include <delassus/schemes/inner/arc_order.hpp>
#include <delassus/schemes/inner/close_joints.hpp>
#include <delassus/schemes/inner/end_state.hpp>
#include <delassus/schemes/inner/impulses_of_parts.hpp>
#include <delassus/schemes/inner/order_of.hpp>
#include <delassus/schemes/inner/pushing_rows.hpp>
#include <delassus/schemes/inner/step_copy.hpp>
#include <delassus/schemes/inner/step_size_control.hpp>
#include <delassus/step/law_rows.hpp>
#include <delassus/step/moves_at_once.hpp>
#include <delassus/step/plain_step.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

template <class P>
class ControlledSteps {
  using World = typename P::World;
  using Laws = typename P::Laws;
  static constexpr int order = order_of<typename P::Integrator>();
  static constexpr bool has_arcs = order > 1 && Laws::pool_count > 0 && !MovesAtOnce<typename P::Integrator>;

 public:
  const ErrorReport& report() const { return report_; }

  void run(auto& step, const auto& asked) {
    const double H = step.h, start = step.start, begin = step.time(), end = begin + H;
    const long steps = step.steps;
    lengths_.take(step.world(), asked.length);
    check(step, asked);
    keep_loads(step.world());
    impulses_.clear();
    report_ = {};
    report_.least_step = std::numeric_limits<double>::infinity();
    last_h_ = step.last_h;
    t_ = begin;
    is_kept_ = false;
    if (!control_.has_begun()) control_.begin(std::min({1e-3, asked.max_step, H}));
    for (double left = H; left > 0;) {
      const double now = control_.propose(asked.max_step, asked.min_step, reach(left, asked.output_step));
      if (!attempt_or_leave(step, asked, now, now == left)) continue;
      left = now == left ? 0 : end - (t_ + now);
      t_ = left > 0 ? t_ + now : end;
      notify_all(step);
    }
    impulses_.give_to(step);
    step.h = H;
    step.start = start;
    step.steps = steps + 1;
    step.summary.time = step.time();
  }

  /// What outlives a step of the host; a repeated inner step keeps its hands off it.
  void memory(auto& archive) {
    if (is_trying_) return;
    archive(control_, before_);
    if constexpr (has_arcs) archive(arc_);
  }

 private:
  /// The same as `attempt`; where that throws, the bodies are where the inner step began.
  bool attempt_or_leave(auto& step, const auto& asked, double now, bool is_last) {
    struct Trying {
      bool& is_so;
      ~Trying() { is_so = false; }
    } trying{is_trying_};
    is_trying_ = true;
    try {
      return attempt(step, asked, now, is_last);
    } catch (...) {
      if (std::exchange(is_kept_, false)) copy_.bring_back(step);
      throw;
    }
  }
  /// One inner step of `now` s from t; false where it is to be repeated.
  bool attempt(auto& step, const auto& asked, double now, bool is_last) {
    if (!std::exchange(is_kept_, true)) copy_.keep(step);
    move(step, now, last_h_, is_last);
    close_joints(step, of_whole_.take(step, lengths_, now));
    const bool is_whole_lost = step.summary.quarantined > 0;
    end_of_whole_.take(step.world());
    copy_.bring_back(step);
    const bool measures = make_quarters(step, now);

    step.summary.quarantined = 0;
    trial_ = impulses_;
    move(step, now / 2, last_h_, false);
    close_joints(step, of_first_.take(step, lengths_, now / 2));
    trial_.add(step);
    if constexpr (has_arcs)
      if (measures) arc_.take_half(step, lengths_, asked.horizon);
    move(step, now / 2, now / 2, is_last);
    close_joints(step, of_second_.take(step, lengths_, now / 2));
    trial_.add(step);

    const PushChange change = change_of(before_, {&of_first_, &of_second_, &of_whole_}, 2);
    const bool pushes = !(of_first_.are_none() && of_second_.are_none() && of_whole_.are_none());
    const bool is_smooth = !pushes && all_move_by_block(step.world());
    const bool is_arc = pushes && !change.is_any && !change.is_shift && all_move_by_block(step.world());
    int known = !is_smooth ? 0 : any_spring(step) ? 1 : order;
    EndError error = end_of_whole_.error(step.world(), lengths_, change.is_impact ? now : asked.horizon);
    if constexpr (has_arcs)
      if (is_arc) error = arc_.error(step, end_of_whole_, lengths_, asked.horizon, measures, error), known = arc_.order();
    const int p = std::max(known, 1);
    double estimate = is_smooth ? error.sum / (std::ldexp(1.0, p) - 1) : error.sum;
    if (change.is_any) estimate = std::max(estimate, change.gap);
    if (is_whole_lost || step.summary.quarantined > 0 || !std::isfinite(estimate)) estimate = std::numeric_limits<double>::infinity();
    const double allowed = asked.per_second && !change.is_impact ? asked.accuracy * now : asked.accuracy;
    const double k = change.is_any ? 1 : asked.per_second || (pushes && known == 0) ? p : p + 1;
    const double E = estimate / allowed;
    const bool is_at_floor = now <= asked.min_step * 1.0001;
    if (!(E <= 1) && !is_at_floor) {
      control_.reject(t_, now, E, k, change.is_any);
      if constexpr (has_arcs)
        if (is_arc) arc_.reject();
      ++report_.rejections;
      ++report_.by_effect[std::size_t(effect_of(step, error, change, pushes))].rejections;
      copy_.bring_back(step);
      return false;
    }
    if (is_smooth && estimate > 0 && std::isfinite(estimate)) {
      end_of_whole_.extrapolate(step.world(), 1 / (std::ldexp(1.0, p) - 1));
      close_joints_.run(step);
    }
    is_kept_ = false;
    note(step, error, estimate, now, E <= 1 ? 0 : 1, change, pushes);
    control_.accept(t_ + now, now, E, k, change.is_any);
    if constexpr (has_arcs)
      if (pushes) arc_.accept(is_arc);
    std::swap(impulses_, trial_);
    std::swap(before_, of_second_);
    last_h_ = now / 2;
    return true;
  }

  /// Where the order of an arc is to be measured: the first half in two.
  bool make_quarters(auto& step, double now) {
    if constexpr (has_arcs) {
      if (!arc_.is_due()) return false;
      move(step, now / 4, last_h_, false);
      move(step, now / 4, now / 4, false);
      arc_.take_quarters(step.world());
      copy_.bring_back(step);
      ++report_.measurements;
    }
    return has_arcs;
  }
  /// Where nothing pushes. The rows have served: what they were solved for is noted in `pushing`.
  void close_joints(auto& step, const PushingRows& pushing) {
    if (order > 1 && pushing.are_none()) close_joints_.run(step);
  }
  /// A step of h after one of `last` s, of which no listener hears.
  void move(auto& step, double h, double last, bool is_last) {
    using Data = std::remove_reference_t<decltype(step)>;
    using Stages = StagesOf<Data>;
    step.start = step.time();
    step.steps = 0;
    step.h = h;
    step.last_h = last;
    step.world().each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) set.loads() = std::get<s>(loads_);
      if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(!is_last);
    });
    lead(step, h);
    Stages::detect(step);
    if constexpr (Data::moves_freely) {
      move_freely(step);
    } else {
      if constexpr (MovesAtOnce<typename Data::Policies::Integrator>) {
        step.integrator().move(step);
      } else {
        do {
          Stages::linearize(step);
          Stages::free_motion(step);
          Stages::find_islands(step);
          Stages::make_bias(step);
          Stages::build(step);
          Stages::solve(step);
          Stages::correct(step);
        } while (Stages::find_missed(step));
        if constexpr (has_arcs) arc_.look(step);
      }
      Stages::advance(step);
    }
  }

  /// Who leads bodies says where they are at the end of these h s: then they arrive there.
  static void lead(auto& step, double h) {
    step.policies.each([&](auto& policy) {
      if constexpr (requires { policy.lead(step.world(), h, h); }) {
        policy.lead(step.world(), step.start, h);
        step.world().each([&](auto& set, auto) {
          set.begin_step(h);
          if constexpr (requires { set.targets(); }) set.targets().stay_on_the_way(false);
        });
      }
    });
  }

  static void notify_all(auto& step) {
    notify<stage::Detect>(step), notify<stage::Linearize>(step), notify<stage::FreeMotion>(step), notify<stage::Islands>(step),
        notify<stage::Bias>(step), notify<stage::Build>(step), notify<stage::Solve>(step), notify<stage::Correct>(step),
        notify<stage::Advance>(step);
  }

  void note(auto& step, const EndError& error, double estimate, double now, int is_too_large, const PushChange& change, bool pushes) {
    ++report_.steps;
    report_.at_floor += is_too_large;
    report_.least_step = std::min(report_.least_step, now);
    report_.last_step = now;
    const ErrorEffect effect = effect_of(step, error, change, pushes);
    EffectSteps& own = report_.by_effect[std::size_t(effect)];
    own.least_step = own.steps++ == 0 ? now : std::min(own.least_step, now);
    if (!(estimate >= report_.error)) return;
    report_.error = estimate;
    report_.set = error.set;
    report_.block = error.block;
    report_.effect = effect;
  }
  static ErrorEffect effect_of(auto& step, const EndError& error, const PushChange& change, bool pushes) {
    if (change.is_impact) return ErrorEffect::impact;
    if (pushes) return ErrorEffect::contact;
    return is_held(step, error) ? ErrorEffect::joint : ErrorEffect::motion;
  }
  /// Whether a constraint holds the body.
  static bool is_held(auto& step, const EndError& error) {
    bool is_found = false;
    step.each_joint([&](const Anchor& a, const Anchor& b) {
      for (const Anchor* end : {&a, &b})
        is_found = is_found || (!end->is_world() && Index(end->set) == error.set && end->block == error.block);
    });
    return is_found;
  }

  void keep_loads(World& world) {
    world.each([&](auto& set, auto s) {
      if constexpr (requires { set.loads(); }) std::get<s>(loads_) = set.loads();
    });
  }

  /// s to the next multiple of `output` after t, or to the end where that is the same but for rounding.
  double reach(double left, double output) const {
    if (!(output > 0)) return left;
    const double next = (std::floor(t_ / output * (1 + 1e-12) + 1e-9) + 1) * output;
    return next - t_ < left - 1e-9 * output ? next - t_ : left;
  }

  void check(auto& step, const auto& asked) const {
    if constexpr (order < 2)
      DELASSUS_EXPECT(asked.accuracy >= 1e-3,
                      "ErrorControlled: accuracy = " + text(asked.accuracy) +
                          " is too fine for an integrator of first order; take ImplicitMidpoint, or NewtonMidpoint where nothing pushes");
    // Each step rounds a float by 6e-8 of itself: hundreds of them by more than a finer accuracy.
    if constexpr (std::is_same_v<typename World::Scalar, float>)
      DELASSUS_EXPECT(asked.accuracy >= 1e-4, "ErrorControlled: accuracy = " + text(asked.accuracy) + " is too fine for bodies in float; take 1e-4 or more, or bodies in double");
    if constexpr (Laws::has_contacts)
      if constexpr (requires { step.solver().tolerance; }) {
        // What a solve leaves of the velocity, tolerance g h, moves a body by tolerance g h² in a step: a tenth of the error at most.
        const double way = asked.accuracy * lengths_.least() / (20 * greatest_gravity(step.world())), tolerance = double(step.solver().tolerance);
        const double most = way / asked.max_step / asked.max_step;
        DELASSUS_EXPECT(tolerance <= most, "ErrorControlled: the solver's tolerance = " + text(tolerance) + " is too loose for accuracy = " +
                                               text(asked.accuracy) + " in steps of up to " + text(asked.max_step) + " s; take " +
                                               (most >= 1e-15 ? text(most) + " or less, or " : std::string()) + "max_step = " +
                                               text(std::sqrt(way / tolerance)) + " s or less");
      }
  }
  /// Springs of joints are taken at the end of a step, and are of first order whatever the integrator's is.
  static bool any_spring(auto& step) {
    bool any = false;
    if constexpr (Laws::pool_count > 0 && !MovesAtOnce<typename P::Integrator>) {
      const AllRows<typename World::Scalar> pools = step.arrays.all();
      for (std::size_t p = 0; p < pools.size(); ++p)
        for (std::size_t row = 0; row < pools[p].phi->size() && !any; ++row) any = !step.pools.all()[p].law->has_mean_springs && pools[p].is_soft(row);
    }
    return any;
  }
  /// Springs and elements couple bodies beyond the order of the integrator: there the halves are taken.
  static bool all_move_by_block(const World& world) {
    bool all = true;
    world.each([&](const auto& set, auto) { all = all && moves_by_block(set); });
    return all;
  }
  static double greatest_gravity(const World& world) {
    double most = 0;
    world.each([&](const auto& set, auto) { most = std::max(most, norm(Vec3(set.gravity))); });
    return most;
  }

  StepCopy copy_;
  BodyLengths<World> lengths_;
  EndState<World> end_of_whole_;
  PushingRows before_, of_whole_, of_first_, of_second_;
  ImpulsesOfParts<Laws> impulses_, trial_;
  CloseJoints<P> close_joints_;
  [[no_unique_address]] std::conditional_t<has_arcs, ArcOrder<World>, Absent> arc_;
  typename World::template PerSet<VelocitiesOf> loads_;
  StepSizeControl control_;
  ErrorReport report_;
  double t_ = 0, last_h_ = 0;  ///< s: the start of the inner step, and the size of the one before
  bool is_trying_ = false, is_kept_ = false;  ///< `copy_` has the start of this inner step
};

}  // namespace delassus::inner
