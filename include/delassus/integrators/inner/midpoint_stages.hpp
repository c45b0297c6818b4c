/// What the midpoint rule changes in a step: rows of the mid-configuration, joints whose velocity fades, and how what they hold turns.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/integrators/inner/held_turns.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/rows/theta.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/step/bias.hpp>
#include <delassus/step/correct.hpp>
#include <delassus/step/law_rows.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/step/middle_contacts.hpp>
#include <delassus/step/moving_surfaces.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

/// Whether item i holds a kinematic body that moves: its v is the mean of the step to come.
template <class T, class World>
bool is_led(const RowArrays<T>& pool, Index i, const World& world) {
  bool is_led = false;
  world.each([&](const auto& set, auto s) {
    const Array<Index>&offset = *pool.set[s].offset, &block = *pool.set[s].block;
    for (Index e = offset[i]; e < offset[i + 1]; ++e) is_led = is_led || (!set.moves(block[e]) && !is_zero(set.velocity()[block[e]]));
  });
  return is_led;
}

/// Velocities at the start of the step: v, and of a body that is led, whose v is the mean of a step, the mean of this step's and the
/// last one's.
template <class Set>
class LedMotion {
  using Velocity = typename Set::Velocity;
  using T = typename Set::Scalar;

 public:
  /// Null where nobody of the set is led, and NaN where the last step is not known.
  const T* begin(const Set& set) {
    bool is_any = false;
    for (const Index b : set.active()) is_any = is_any || is_led(set, b);
    if (!is_any) return nullptr;
    const auto& v = set.velocity();
    start_.resize(v.size());
    for (std::size_t b = 0; b < v.size(); ++b) assign(start_[b], v[b]);
    for (const Index b : set.active()) {
      if (!is_led(set, b)) continue;
      if (b < Index(last_.size())) start_[b] = T(0.5) * (v[b] + last_[b]);
      else set_all(start_[b], std::numeric_limits<T>::quiet_NaN());
    }
    return reinterpret_cast<const T*>(start_.data());
  }
  /// The step is over.
  void end(const Set& set) {
    bool is_any = false;
    for (const Index b : set.active()) is_any = is_any || is_led(set, b);
    last_.resize(is_any ? set.velocity().size() : 0);
    for (std::size_t b = 0; b < last_.size(); ++b) {
      if (set.is_alive(Index(b)) && is_led(set, Index(b))) assign(last_[b], set.velocity()[b]);
      else set_all(last_[b], std::numeric_limits<T>::quiet_NaN());
    }
  }
  void memory(auto& archive) { archive(last_); }

 private:
  static bool is_led(const Set& set, Index b) { return !set.moves(b) && !is_zero(set.velocity()[b]); }

  Array<Velocity> last_, start_;  ///< NaN in `last_`: not led then
};

/// Which share of u, H v at the start, fades: a tenth, less where the rows of the middle have s, H v too, that is smaller: min(1, s²/u²) of
/// it. Rows that depend on each other in the middle, and not at the start, could follow the rest of u by enormous impulses alone.
template <class T>
T joint_velocity_damping(int rows, const T* u, const T* s) {
  T at_start = T(0), in_middle = T(0);
  for (int k = 0; k < rows; ++k) at_start += u[k] * u[k], in_middle += s[k] * s[k];
  return in_middle < at_start ? T(0.1) * in_middle / at_start : T(0.1);
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
template <class T>
void linearize_at_midpoint(bool sees_contacts, AllLaws<T> laws, AllRows<T> rows, AllRows<T> at_start, bool again, auto&& linearize_there) {
  const auto swap_start = [&](std::size_t p) { rows[p].phi->swap(*at_start[p].phi), rows[p].lambda->swap(*at_start[p].lambda); };
  for (std::size_t p = 0; p < rows.size(); ++p)
    if (again) swap_start(p);
    else rows[p].swap(at_start[p]);
  linearize_there();
  for (std::size_t p = 0; p < rows.size(); ++p)
    if (laws[p].law->is_contact && !sees_contacts) rows[p].swap(at_start[p]);
    else swap_start(p);
}

/// Of each pool, what fades of the velocity across its rows.
template <class T>
using FadesOf = OwningArray<Array<T>>;

/// H v_next = −H v keeps what goes across the joints, and turns it round every step. So v counts there without a tenth
/// of what it has across the joints at the start (`inner::joint_velocity_damping`), which is of order h² and for which only the rows of
/// the start will do: d ← d − `fade`. Where that gives energy it is withheld, see `reject_damping`.
template <class T>
void fade_joints(const T* const* v, const T* const* v_at_start, AllLaws<T> laws, AllRows<T> rows, AllRows<T> at_start, double theta, FadesOf<T>& fade) {
  fade.resize(rows.size());
  for (std::size_t p = 0; p < rows.size(); ++p) {
    const RowArrays<T>& pool = rows[p];
    fade[p].assign_zeros(pool.phi->size());
    if (laws[p].law->is_contact) continue;
    const RowKind* const kinds = laws[p].law->kinds;
    T u[most_rows], start[most_rows];
    for (Index i = 0; i < pool.items(); ++i) {
      inner::rate(pool, i, v, u);
      inner::rate(at_start[p], i, v_at_start, start);
      for (int k = 0; k < pool.rows; ++k)
        if (!std::isfinite(start[k])) std::fill(start, start + pool.rows, T(0));  // who leads it has just begun to move
      const T share = inner::joint_velocity_damping(pool.rows, start, u);
      for (int k = 0; k < pool.rows; ++k) {
        const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
        if (kinds[k] != RowKind::equality || pool.is_soft(row)) continue;
        fade[p][row] = T((1 - theta) / theta) * (share * start[k]);
        (*pool.d)[row] -= fade[p][row];
      }
    }
  }
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
                   Rows& rows, AllRows<typename Rows::Scalar> all, const Rows& at_start, double h, double theta) {
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
        const Vec3 at = place.friction_point();
        const SurfaceMotion a = moving.world->surface(item.record->a, at), b = moving.world->surface(item.record->b, at);
        const SurfaceMotion of_a = inner::with_running(a, at), of_b = inner::with_running(b, at);
        is_carried = moving.turn && a.is_rigid && b.is_rigid && inner::turn_alike(of_a, of_b);
        if (is_carried) away = inner::turned_away(of_a, of_b, place, away, h, theta);
        for (int k = 1; k < along; ++k) s[k] += T(dot(place.axis(k), Vec3(b.running - a.running)));
      }
      for (int k = 0; k < along; ++k) before += s[k] * s[k];
      const T share = inner::is_led(all[p], i, world) ? T(0) : turned < before ? turned / before : T(1);
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
template <class T>
bool reject_damping(const Island<T>& island, FadesOf<T>& fade) {
  double work = 0, effort = 0;
  const auto each_row = [&](auto&& f) {
    for (const Span<T>& span : island)
      for (const Index i : span)
        for (int k = 0; k < span.pool->rows; ++k) f(*span.pool, std::size_t(i) * std::size_t(span.pool->rows) + std::size_t(k));
  };
  each_row([&](const PoolView<T>& pool, std::size_t row) { work += 0.5 * double(pool.lambda[row] * fade[std::size_t(pool.pool)][row]); });
  if (!(work > 0)) return false;
  T u[most_rows];
  for (const Span<T>& span : island)
    for (const Index i : span) {
      island.velocity(span, i, u);
      const T *lambda = island.impulse(span, i), *d = island.free_of_impulses(span, i);
      for (int k = 0; k < span.pool->rows; ++k) effort += 0.5 * double(lambda[k] * (u[k] - d[k]));
    }
  if (!(work > 0.01 * effort)) return false;
  each_row([&](const PoolView<T>& pool, std::size_t row) {
    T& fades = fade[std::size_t(pool.pool)][row];
    pool.d[row] += fades;
    fades = T(0);
  });
  return true;
}

namespace inner {

template <class P>
struct MidpointState {
  typename P::Rows at_start;       ///< the rows of the start, where the step has others
  ArraysOf<typename P::Rows> arrays;  ///< of them
  FadesOf<typename P::World::Scalar> fade;
  typename P::World::template PerSet<HeldTurns> turns;  ///< of bodies that are held
  typename P::World::template PerSet<LedMotion> led;
  [[no_unique_address]] std::conditional_t<has_middle_contacts<P>, MiddleContacts, Absent> contacts;
  void memory(auto& archive) { std::apply([&](auto&... of_set) { (archive(of_set), ...); }, led); }
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
    using World = std::remove_cvref_t<decltype(world)>;
    using T = typename World::Scalar;
    const BodyVelocities<World> v(world);
    const T* at_start[World::set_count + 1];
    world.each([&](const auto& set, auto s) {
      const T* const led = std::get<s>(own(step).led).begin(set);
      at_start[s] = led ? led : v.start[s];
    });
    fade_joints(v.start, at_start, step.pools.all(), step.arrays.all(), own(step).arrays.all(), share, own(step).fade);
    if constexpr (sees_contacts<decltype(step)>) {
      const auto moving = moving_surfaces(world, step.view, step.h);
      turn_contacts(world, moving, step.laws(), step.rows, step.arrays.all(), own(step).at_start, step.h, share);
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
    if (reject_damping(island, own(step).fade)) Base::solve_island(step, island);
  }
  static void advance(auto& step) {
    constexpr bool are_displaced = requires { step.template state<role::Stabilisation>().displacement; };
    if constexpr (sees_contacts<decltype(step)> && are_displaced)
      move_gaps(std::as_const(step).world(), step.laws(), step.rows, step.h);
    std::as_const(step).world().each([&](const auto& set, auto s) { std::get<s>(own(step).led).end(set); });
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
    own(step).arrays.attach(own(step).at_start);
    linearize_at_midpoint(sees_contacts<decltype(step)>, step.pools.all(), step.arrays.all(), own(step).arrays.all(), again, [&] {
      const Shifted moved(world, step.h / 2, again);
      if constexpr (sees_contacts<decltype(step)>) own(step).contacts.see(step);
      delassus::linearize(step.view, step.pools.all(), step.arrays.all());
    });
    if (are_slender) {
      const Shifted moved(world, step.h / 2, again);
      act_at_own_points(step);
    }
    each_turning_set(step, [&](auto&, auto& held, auto s) {
      each_middle_pool(step, [&](const auto& pool) { turn_back(pool, s, held.bodies); });
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

  /// f(rows) of the pools whose rows are of the middle: all, or those that are no contacts.
  static void each_middle_pool(auto& step, auto&& f) {
    const auto laws = step.pools.all();
    const auto rows = step.arrays.all();
    for (std::size_t p = 0; p < rows.size(); ++p)
      if (sees_contacts<decltype(step)> || !laws[p].law->is_contact) f(rows[p]);
  }
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
      each_middle_pool(step, [&](const auto& pool) {
        for (const Index b : *pool.set[s].block)
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
      each_pool(step.laws(), [&]<class Law>(auto p, const Pool<Law>& pool) {
        if constexpr (JoinsPoints<Law> && (sees_contacts<decltype(step)> || !ContactLaw<Law>))
          inner::act_at_own_points(set, pool, step.view, inner::part<s>(step.rows.template pool<p>().sets), held.bodies);
      });
    });
  }
  /// Hᵀ λ of what holds them.
  static void sum_moments(auto& step) {
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      for (auto& x : held.moment) set_zero(x);
      each_middle_pool(step, [&](const auto& pool) {
        const SetArrays<T>& blocks = pool.set[s];
        blocks.products->add_impulse(blocks, pool.items(), pool.lambda->data(), reinterpret_cast<T*>(held.moment.data()));
      });
    });
  }
};

}  // namespace inner
}  // namespace delassus
