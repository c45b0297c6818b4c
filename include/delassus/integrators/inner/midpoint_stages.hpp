/// What the midpoint rule changes in a step: rows of the mid-configuration, joints whose velocity fades, and how what they hold turns.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/integrators/inner/held_turns.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/bias.hpp>
#include <delassus/step/correct.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/middle_contacts.hpp>
#include <delassus/step/moving_surfaces.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

/// Whether item i holds a kinematic body that moves: its v is the mean of the step to come.
template <int R, class T, int... w, class World>
bool is_led(const PoolRows<R, T, w...>& pool, Index i, const World& world) {
  bool is_led = false;
  world.each([&](const auto& set, auto s) {
    const auto& blocks = inner::part<s>(pool.sets);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
      is_led = is_led || (!set.moves(blocks.block[e]) && !is_zero(set.velocity()[blocks.block[e]]));
  });
  return is_led;
}

/// H v of item i where a step starts; zero where it holds such a body.
template <int R, class T, int... w, class World>
Vec<R, T> rate_at_start(const PoolRows<R, T, w...>& pool, Index i, const World& world) {
  if (is_led(pool, i, world)) return zero<Vec<R, T>>();
  return rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
}

/// A tenth of u, H v at the start, less where the rows of the middle have s, H v too, that is smaller: min(1, s²/u²) of it.
/// Rows that depend on each other in the middle, and not at the start, could follow the rest of u by enormous impulses alone.
template <class V>
V joint_velocity_damping(const V& u, const V& s) {
  using T = typename V::Scalar;
  const T at_start = squared_norm(u), in_middle = squared_norm(s);
  return (in_middle < at_start ? T(0.1) * in_middle / at_start : T(0.1)) * u;
}

/// The bodies at q ⊕ h v while it lives, and back where they were after it: also when a law throws. `by_next`: v_next has v.
template <class World>
class Shifted {
 public:
  Shifted(World& world, double h, bool by_next) : world_(world) {
    world.each([&](auto& set, auto) {
      if (by_next) std::swap(set.velocity(), set.v_next);
      set.shift(h);
      if (by_next) std::swap(set.velocity(), set.v_next);
    });
  }
  Shifted(const Shifted&) = delete;
  ~Shifted() {
    world_.each([](auto& set, auto) { set.restore(); });
  }

 private:
  World& world_;
};

}  // namespace inner

/// H where `linearize_there` has put the bodies into the middle of the step, φ and λ where it starts. `rows` has the rows of the start
/// and leaves them in `at_start`; or, `again`, those of the look before and the λ of its solve. Contacts that are not seen in the
/// middle keep the rows of the start: a point that stays while its body moves would turn the body.
template <bool contacts, class Laws, class Rows>
void linearize_at_midpoint(const Laws& laws, Rows& rows, Rows& at_start, bool again, auto&& linearize_there) {
  const auto swap_start = [](auto& pool, auto& start) { std::swap(pool.phi, start.phi), std::swap(pool.lambda, start.lambda); };
  if (again) each_pool(rows, [&](auto p, auto& pool) { swap_start(pool, at_start.template pool<p>()); });
  else std::swap(rows, at_start);
  linearize_there();
  each_pool(rows, [&](auto p, auto& pool) {
    auto& start = at_start.template pool<p>();
    if constexpr (!contacts && ContactLaw<std::remove_cvref_t<decltype(laws.template pool<p>().law)>>) std::swap(pool, start);
    else swap_start(pool, start);
  });
}

/// H v_next = −H v keeps what goes across the joints, and turns it round every step. So v counts there without a tenth
/// of what it has across the joints at the start (`inner::joint_velocity_damping`), which is of order h² and for which only the rows of
/// the start will do: d ← d − `fade`. Where that gives energy it is withheld, see `reject_damping`.
template <class World, class Laws, class Rows>
void fade_joints(const World& world, const Laws& laws, Rows& rows, const Rows& at_start, double theta, Impulses<Rows>& fade) {
  using T = typename Rows::Scalar;
  fade.resize_like(rows);
  each_pool(rows, [&](auto p, auto& pool) {
    using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    for (Index i = 0; i < pool.items(); ++i) {
      auto& own = inner::part<p>(fade.pools)[i];
      set_zero(own);
      if constexpr (ContactLaw<Law>) continue;
      const auto u = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
      const auto fades = inner::joint_velocity_damping(inner::rate_at_start(at_start.template pool<p>(), i, world), u);
      for (int k = 0; k < Law::rows; ++k) {
        if (kinds[k] != RowKind::equality || inner::is_spring(pool.stiffness[i][k], pool.damping[i][k])) continue;
        own[k] = T((1 - theta) / theta) * fades[k];
        pool.d[i][k] -= own[k];
      }
    }
  });
}

/// Contacts in the middle of the step. H v_next + H v ≥ 0 would throw back what hits, and turn round what slides to a stop; H v_next ≥ 0
/// is of first order. The rows of the start, S, say which part of H v comes of the turn of the rows, (H − S) v, and which was there
/// before, S v: of order h² where the contact lasts, and no smaller than an impact or a slip. So with f of a joint's tenth
///
///   H v_next + (H − S) v + (1 − f) min(1, |(H − S) v|²/|S v|²) S v ≥ 0,
///
/// which does no work but that of the tenth where a contact rolls on. What slips has the direction of the mean (`rotated_slip`). What
/// turns with a kinematic body has the circle's way (`turned_away`): −(H − S) v takes H v_next to the start, of which that is told.
template <class Laws, class Rows, class World>
void turn_contacts(const World& world, const MovingSurfaces<typename Rows::Scalar>& moving, const Laws& laws,
                   Rows& rows, const Rows& at_start, double h, double theta) {
  using T = typename Rows::Scalar;
  const auto v = [](const auto& set) -> const auto& { return set.velocity(); };
  each_contact_pool(laws, [&]<class Law>(auto p, const Pool<Law>& contacts) {
    auto& pool = rows.template pool<p>();
    constexpr int along = inner::rows_along<Law::rows>;
    for (Index i = 0; i < pool.items(); ++i) {
      const auto u = inner::rate(pool, i, world, v);
      auto s = inner::rate(at_start.template pool<p>(), i, world, v);
      T turn[along], turned = 0, before = 0;
      Vec3 away = zero<Vec3>();
      bool is_carried = false;
      const auto& item = contacts.item(i);
      const ContactPlace place{item.record, &item.point, &item.frame};
      for (int k = 0; k < along; ++k) turn[k] = u[k] - s[k], turned += turn[k] * turn[k];
      if (along > 1 && moving) {
        const SurfaceMotion a = moving.world->surface(item.record->a, item.point);
        const SurfaceMotion b = moving.world->surface(item.record->b, item.point);
        is_carried = moving.turn && a.is_rigid && b.is_rigid && inner::turn_alike(a, b);
        if (is_carried) away = inner::turned_away(a, b, place, away, h, theta);
        for (int k = 1; k < along; ++k) s[k] += T(dot(place.axis(k), Vec3(b.running - a.running)));
      }
      for (int k = 0; k < along; ++k) before += s[k] * s[k];
      const T share = inner::is_led(pool, i, world) ? T(0) : turned < before ? turned / before : T(1);
      for (int k = 0; k < along; ++k) {
        if (inner::is_spring(pool.stiffness[i][k], pool.damping[i][k])) continue;
        if (k > 0 && is_carried) pool.d[i][k] += T(dot(place.axis(k), away)) - turn[k];
        else pool.d[i][k] += turn[k] + T(0.9) * share * s[k];
      }
      if constexpr (inner::has_slip(row_kinds<Law>())) {
        const auto rotated = inner::rotated_slip<T>({s[1], s[2]}, {pool.d[i][1], pool.d[i][2]}, theta);
        for (int k = 0; k < 2; ++k) pool.d[i][k + 1] += (1 - share) * rotated[k];
      }
    }
  });
}

/// φ of contacts in the middle of the step becomes that of its end, φ + h H (v + v_next)/2.
template <class World, class Laws, class Rows>
void move_gaps(const World& world, const Laws& laws, Rows& rows, double h) {
  using T = typename Rows::Scalar;
  each_contact_pool(laws, [&](auto p, const auto&) {
    auto& pool = rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i)
      pool.phi[i][0] += T(h / 2) * (inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); })[0] +
                                    inner::next_rate(pool, i, world)[0]);
  });
}

/// Joints of the midpoint rule hold H (v + v_next) = f, f what fades across them, and so do the work
/// E = ½ Σ λ·f. A fade is there to take energy. Where bodies turn at ω and α on arms of r, f = h² α ω r/10 and
/// W λ = h (ω² + α) r, so that E of either sign,
///
///   E/(½ λ·W λ) = h α ω/(ω² + α)/10 ≤ h √α/20,
///
/// is below a hundredth while h √α < 0.2. It is above where rows of the middle depend on each other: where they
/// see across a chain drawn straight the other way round than those of the start, f makes grow what it should
/// take. There f is put back into d, and the joints do no work. True: the island has to be solved again.
template <class Rows, class Operator>
bool reject_damping(Rows& rows, const Operator& W, const Islands<typename Rows::Scalar>& islands, Index island,
                   Impulses<Rows>& fade) {
  double work = 0, effort = 0;
  inner::each_item<Rows::pool_count>(islands, island, [&](auto p, Index i) {
    work += 0.5 * double(rows.template pool<p>().lambda[i].dot(inner::part<p>(fade.pools)[i]));
  });
  if (!(work > 0)) return false;
  inner::each_item<Rows::pool_count>(islands, island, [&](auto p, Index i) {
    const auto& pool = rows.template pool<p>();
    effort += 0.5 * double(dot(pool.lambda[i], W.template residual<p>(rows, i) - pool.d[i]));
  });
  if (!(work > 0.01 * effort)) return false;
  inner::each_item<Rows::pool_count>(islands, island, [&](auto p, Index i) {
    rows.template pool<p>().d[i] += inner::part<p>(fade.pools)[i];
    inner::part<p>(fade.pools)[i].setZero();
  });
  return true;
}

namespace inner {

template <class P>
struct MidpointState {
  typename P::Rows at_start;       ///< the rows of the start, where the step has others
  Impulses<typename P::Rows> fade;  ///< what fades of the velocity across the joints
  typename P::World::template PerSet<HeldTurns> turns;  ///< of bodies that are held
  [[no_unique_address]] std::conditional_t<has_middle_contacts<P>, MiddleContacts, Absent> contacts;
};

template <class Base>
struct MidpointStages : Base {
  static void linearize(auto& step) {
    using Scheme = std::remove_cvref_t<decltype(step.scheme())>;
    if constexpr (sees_contacts<decltype(step)> && requires { typename Scheme::template stages<Base>; })
      DELASSUS_EXPECT(step.integrator().looks == 1, "ImplicitMidpoint: looks must be 1 beside PredictiveScheme, which "
                                                    "predicts for one solve");
    Base::linearize(step);
    look(step, false);
  }
  static void free_motion(auto& step) {
    Base::free_motion(step);
    each_held(step, [&](auto& set, auto& held, Index b) { add_gyration(set, b, held.bodies[b]); });
  }
  static void make_bias(auto& step) {
    Base::make_bias(step);
    constexpr double share = theta<std::remove_cvref_t<decltype(step.integrator())>>();
    const auto& world = std::as_const(step).world();
    fade_joints(world, step.laws(), step.rows, own(step).at_start, share, own(step).fade);
    if constexpr (sees_contacts<decltype(step)>) {
      const auto moving = moving_surfaces(world, step.view, step.h);
      turn_contacts(world, moving, step.laws(), step.rows, own(step).at_start, step.h, share);
    }
  }
  /// With contacts as often as the integrator looks.
  static void solve_islands(auto& step, auto& observer) {
    if constexpr (sees_contacts<decltype(step)>) {
      NoObserver nobody;
      for (int left = step.integrator().looks; left > 1 && !step.contact_cache.results.empty(); --left) {
        Base::solve_islands(step, nobody);
        look_again(step);
      }
    }
    Base::solve_islands(step, observer);
  }
  static void solve_island(auto& step, auto& island) {
    Base::solve_island(step, island);
    if (reject_damping(step.rows, step.W, step.islands, island.island(), own(step).fade)) Base::solve_island(step, island);
  }
  static void advance(auto& step) {
    constexpr bool are_displaced = requires { step.template state<role::Stabilisation>().displacement; };
    if constexpr (sees_contacts<decltype(step)> && are_displaced)
      move_gaps(std::as_const(step).world(), step.laws(), step.rows, step.h);
    sum_moments(step);
    each_held(step, [&](auto& set, auto& held, Index b) { end_turn(set, b, held.bodies[b], angular_part(held.moment[b])); });
    Base::advance(step);
  }

 private:
  template <class Step>
  static constexpr bool sees_contacts = has_middle_contacts<typename std::remove_reference_t<Step>::Policies>;

  /// Rows of the middle; `again`: by the mean of v and v_next, which v_next has.
  static void look(auto& step, bool again) {
    const bool are_slender = begin_turns(step, again);
    auto& world = step.world();
    linearize_at_midpoint<sees_contacts<decltype(step)>>(step.laws(), step.rows, own(step).at_start, again, [&] {
      const Shifted moved(world, step.h / 2, again);
      if constexpr (sees_contacts<decltype(step)>) own(step).contacts.see(step);
      delassus::linearize(std::as_const(world), step.laws(), step.rows);
    });
    if (are_slender) {
      const Shifted moved(world, step.h / 2, again);
      act_at_own_points(step);
    }
    each_turning_set(step, [&](auto&, auto& held, auto s) {
      each_middle_pool(step, [&](auto, auto& pool) { turn_back(inner::part<s>(pool.sets), held.bodies); });
    });
  }
  /// After a solve: what the mean velocity of the step is makes another middle, and all that follows of it.
  static void look_again(auto& step) {
    using Stages = typename std::remove_reference_t<decltype(step)>::Stages;
    delassus::correct(step.world(), step.arrays.all(), step.W, step.scratch, step.islands, step.reports, step.is_nonfinite);
    step.world().each([&](auto& set, auto) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      for (const Index b : set.active()) {
        auto& v = set.v_next[b];
        if (is_finite(v)) v = T(0.5) * (v + set.velocity()[b]);
        else v = set.velocity()[b];
      }
    });
    each_held(step, [&](auto& set, auto& held, Index b) {
      for (int k = 0; k < 3; ++k) set.v_free[b][k + 3] -= held.bodies[b].gyration[k];
    });
    look(step, true);
    each_held(step, [&](auto& set, auto& held, Index b) { add_gyration(set, b, held.bodies[b]); });
    Stages::make_bias(step);
    Stages::build(step);
  }

  static void each_middle_pool(auto& step, auto&& f) { each_pool_of_middle<sees_contacts<decltype(step)>>(step.laws(), step.rows, f); }
  static auto& own(auto& step) { return step.template state<role::Integrator>(); }

  static void each_turning_set(auto& step, auto&& f) {
    step.world().each([&](auto& set, auto s) {
      if constexpr (TurnsRigidly<std::remove_cvref_t<decltype(set)>>) f(set, std::get<s>(own(step).turns), s);
    });
  }
  static void each_held(auto& step, auto&& f) {
    each_turning_set(step, [&](auto& set, auto& held, auto) {
      for (const Index b : set.active())
        if (held.bodies[b].is_held) f(set, held, b);
    });
  }
  /// Of bodies that are held; true where one is slender.
  static bool begin_turns(auto& step, bool again) {
    bool are_slender = false;
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      held.bodies.resize(set.blocks());
      held.moment.resize(set.blocks());
      set.state().given_turn.resize(set.blocks());
      for (auto& body : held.bodies) body.is_held = false;
      for (auto& turn : set.state().given_turn) turn.is_given = false;
      each_middle_pool(step, [&](auto, auto& pool) {
        for (const Index b : inner::part<s>(pool.sets).block)
          if (auto& body = held.bodies[b]; !body.is_held && set.moves(b)) {
            begin_turn(set, b, body, T(step.h));
            if (again) turn_by_mean(set, b, body, Vec<3, T>(angular_part(set.v_next[b])), T(step.h));
            are_slender = are_slender || (body.is_held && body.is_slender);
          }
      });
    });
    return are_slender;
  }
  static void act_at_own_points(auto& step) {
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      each_middle_pool(step, [&](auto p, auto& rows) {
        const auto& pool = step.laws().template pool<p>();
        if constexpr (JoinsPoints<std::remove_cvref_t<decltype(pool.law)>>)
          inner::act_at_own_points(set, pool, step.view, inner::part<s>(rows.sets), held.bodies);
      });
    });
  }
  /// Hᵀ λ of what holds them.
  static void sum_moments(auto& step) {
    const auto all = step.arrays.all();
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      for (auto& x : held.moment) set_zero(x);
      each_middle_pool(step, [&](auto p, auto& pool) {
        const SetArrays<T>& blocks = all[p].set[s];
        blocks.products->add_impulse(blocks, pool.items(), all[p].lambda->data(), reinterpret_cast<T*>(held.moment.data()));
      });
    });
  }
};

}  // namespace inner
}  // namespace delassus
