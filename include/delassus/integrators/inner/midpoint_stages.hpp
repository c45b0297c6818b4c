/// What the midpoint rule changes in a step: rows of the mid-configuration, joints whose velocity fades, and how what they hold turns.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/integrators/inner/held_turns.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/step/linearize.hpp>
#include <delassus/rows/theta.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {
namespace inner {

/// H v of item i where a step starts; zero where it holds a kinematic body, whose v is the mean of the step to come.
template <int R, class T, int... w, class World>
Vec<R, T> rate_at_start(const PoolRows<R, T, w...>& pool, Index i, const World& world) {
  bool is_led = false;
  world.each([&](const auto& set, auto s) {
    const auto& blocks = inner::part<s>(pool.sets);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
      is_led = is_led || (!set.moves(blocks.block[e]) && !is_zero(set.velocity()[blocks.block[e]]));
  });
  if (is_led) return zero<Vec<R, T>>();
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

/// The bodies at q ⊕ h v while it lives, and back where they were after it: also when a law throws.
template <class World>
class Shifted {
 public:
  Shifted(World& world, double h) : world_(world) {
    world.each([&](auto& set, auto) { set.shift(h); });
  }
  Shifted(const Shifted&) = delete;
  ~Shifted() {
    world_.each([](auto& set, auto) { set.restore(); });
  }

 private:
  World& world_;
};

}  // namespace inner

/// H at the guess q ⊕ h v/2 of the mid-configuration, φ and λ where the step starts. Contacts keep the rows of the start:
/// their points are those of the start, and a point that stays while its body moves would turn the body. `rows` has the
/// rows of the start and leaves those of all others in `at_start`.
template <class World, class Laws, class Rows>
void linearize_at_midpoint(World& world, const Laws& laws, Rows& rows, Rows& at_start, double h) {
  std::swap(rows, at_start);
  {
    const inner::Shifted moved(world, h / 2);
    linearize(std::as_const(world), laws, rows);
  }
  for_each_index<Laws::pool_count>([&](auto p) {
    auto &middle = rows.template pool<p>(), &start = at_start.template pool<p>();
    if constexpr (ContactLaw<std::remove_cvref_t<decltype(laws.template pool<p>().law)>>) {
      std::swap(middle, start);
    } else {
      std::swap(middle.phi, start.phi);
      std::swap(middle.lambda, start.lambda);
    }
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
  typename P::World::template PerSet<HeldTurns> turns;  ///< of bodies with joints
};

template <class Base>
struct MidpointStages : Base {
  static void linearize(auto& step) {
    Base::linearize(step);
    const bool are_slender = begin_turns(step);
    linearize_at_midpoint(step.world(), step.laws(), step.rows, own(step).at_start, step.h);
    if (are_slender) act_at_own_points(step);
    each_turning_set(step, [&](auto&, auto& held, auto s) {
      each_joint_pool(step.laws(), step.rows, [&](auto, auto& pool) { turn_back(inner::part<s>(pool.sets), held.bodies); });
    });
  }
  static void free_motion(auto& step) {
    Base::free_motion(step);
    each_held(step, [&](auto& set, auto& held, Index b) { add_gyration(set, b, held.bodies[b]); });
  }
  static void make_bias(auto& step) {
    Base::make_bias(step);
    using Integrator = std::remove_cvref_t<decltype(step.integrator())>;
    fade_joints(std::as_const(step).world(), step.laws(), step.rows, own(step).at_start, theta<Integrator>(), own(step).fade);
  }
  static void solve_island(auto& step, auto& island) {
    Base::solve_island(step, island);
    if (reject_damping(step.rows, step.W, step.islands, island.island(), own(step).fade)) Base::solve_island(step, island);
  }
  static void advance(auto& step) {
    sum_moments(step);
    each_held(step, [&](auto& set, auto& held, Index b) { end_turn(set, b, held.bodies[b], angular_part(held.moment[b])); });
    Base::advance(step);
  }

 private:
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
  /// Of bodies with joints; true where one is slender.
  static bool begin_turns(auto& step) {
    bool are_slender = false;
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      held.bodies.resize(set.blocks());
      held.moment.resize(set.blocks());
      set.state().given_turn.resize(set.blocks());
      for (auto& body : held.bodies) body.is_held = false;
      for (auto& turn : set.state().given_turn) turn.is_given = false;
      each_joint_pool(step.laws(), step.rows, [&](auto, auto& pool) {
        for (const Index b : inner::part<s>(pool.sets).block)
          if (auto& body = held.bodies[b]; !body.is_held && set.moves(b)) {
            begin_turn(set, b, body, T(step.h));
            are_slender = are_slender || (body.is_held && body.is_slender);
          }
      });
    });
    return are_slender;
  }
  static void act_at_own_points(auto& step) {
    step.world().each([&](auto& set, auto) { set.shift(step.h / 2); });
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      each_joint_pool(step.laws(), step.rows, [&](auto p, auto& rows) {
        const auto& pool = step.laws().template pool<p>();
        if constexpr (JoinsPoints<std::remove_cvref_t<decltype(pool.law)>>)
          inner::act_at_own_points(set, pool, step.view, inner::part<s>(rows.sets), held.bodies);
      });
    });
    step.world().each([&](auto& set, auto) { set.restore(); });
  }
  /// Hᵀ λ of the joints.
  static void sum_moments(auto& step) {
    const auto all = step.arrays.all();
    each_turning_set(step, [&](auto& set, auto& held, auto s) {
      using T = typename std::remove_cvref_t<decltype(set)>::Scalar;
      for (auto& x : held.moment) set_zero(x);
      each_joint_pool(step.laws(), step.rows, [&](auto p, auto& pool) {
        const SetArrays<T>& blocks = all[p].set[s];
        blocks.products->add_impulse(blocks, pool.items(), all[p].lambda->data(), reinterpret_cast<T*>(held.moment.data()));
      });
    });
  }
};

}  // namespace inner
}  // namespace delassus
