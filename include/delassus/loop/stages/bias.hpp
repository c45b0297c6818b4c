/// Bias: the stabilisation turns violations into velocities, and d is made.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/stabilisation/stabilisation.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

namespace delassus {

/// What one row needs to know to get its bias. Velocities in m/s, φ in m, all in the sense of a `lower` row.
struct RowState {
  double phi = 0;
  double start_velocity = 0;  ///< H v at the start of the step
  double free_velocity = 0;   ///< H v_free
  double restitution = 0;
};
struct RowBias {
  double bias = 0;
  double plain = 0;  ///< the bias without restitution
};

/// Lower row u⁺ + bias ≥ 0. Open: φ/h. Closing within the step with u⁻ < 0: the stronger of e u⁻ and the push-out
/// speed, never their sum. Taking u⁻ at the start of the step makes e = 1 keep ½ v² + g x − ½ h g v, the energy that
/// symplectic Euler itself keeps, exactly.
template <class S>
RowBias lower_bias(const S& stabilisation, const RowState& row, double h) {
  RowBias out;
  const bool is_closed = row.phi < 0;
  out.plain = is_closed ? stabilisation.penetration(row.phi, h) : row.phi / h;
  out.bias = out.plain;
  const bool closes = row.phi + h * row.free_velocity < 0 && row.start_velocity < 0;
  if (row.restitution > 0 && closes) out.bias = std::min(is_closed ? out.plain : 0.0, row.restitution * row.start_velocity);
  return out;
}

namespace inner {

/// H x of item i of a pool.
template <int R, class T, int... w, class World, class Member>
Vec<R, T> rate(const PoolRows<R, T, w...>& pool, Index i, const World& world, const Member& member) {
  Vec<R, T> u = Vec<R, T>::Zero();
  world.each([&](const auto& set, auto s) {
    const auto& blocks = std::get<s>(pool.sets);
    const auto& v = member(set);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) u.noalias() += blocks.H[e] * v[blocks.block[e]];
  });
  return u;
}

/// The same of arrays x, one for each set.
template <int R, class T, int... w, class... Arrays>
Vec<R, T> rate(const PoolRows<R, T, w...>& pool, Index i, const std::tuple<Arrays...>& x) {
  Vec<R, T> u = Vec<R, T>::Zero();
  for_each_index<int(sizeof...(Arrays))>([&](auto s) {
    const auto& blocks = std::get<s>(pool.sets);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
      u.noalias() += blocks.H[e] * std::get<s>(x)[blocks.block[e]];
  });
  return u;
}

/// H v of item i where a step starts; zero where it holds a body that is led, whose v is the mean of the step to come.
template <int R, class T, int... w, class World>
Vec<R, T> rate_at_start(const PoolRows<R, T, w...>& pool, Index i, const World& world) {
  bool is_led = false;
  world.each([&](const auto& set, auto s) {
    const auto& blocks = std::get<s>(pool.sets);
    for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
      is_led = is_led || (!set.moves(blocks.block[e]) && !is_zero(set.velocity()[blocks.block[e]]));
  });
  if (is_led) return Vec<R, T>::Zero();
  return rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
}

/// A tenth of u, H v at the start, less where the rows of the middle have s, H v too, that is smaller: min(1, s²/u²) of it.
/// Rows that depend on each other in the middle, and not at the start, could follow the rest of u by enormous impulses alone.
template <class V>
V fading(const V& u, const V& s) {
  using T = typename V::Scalar;
  const T at_start = u.squaredNorm(), in_middle = s.squaredNorm();
  return (in_middle < at_start ? T(0.1) * in_middle / at_start : T(0.1)) * u;
}

/// Rows of friction beside a contact's normal: rows 1 and 2.
template <std::size_t rows>
constexpr bool has_slip(const std::array<RowKind, rows>& kinds) {
  if constexpr (rows >= 3)
    return kinds[0] == RowKind::lower && kinds[1] == RowKind::friction && kinds[2] == RowKind::friction;
  else
    return false;
}

/// What turns the direction of u⁺ into that of its mean with u, the slip at the start: (1−θ) of u across `free`, the
/// slip without friction. It is of order h, as the turn of the slip is. Slips that may end within the step keep the
/// direction of u⁺, which alone can be held at rest.
template <class T>
Vec<2, T> turned_slip(const Vec<2, T>& u, const Vec<2, T>& free, double theta) {
  const T size = free.squaredNorm();
  if (!(u.squaredNorm() > (free - u).squaredNorm()) || !(size > 0)) return Vec<2, T>::Zero();
  return T(1 - theta) * (u - u.dot(free) / size * free);
}

template <std::size_t rows>
constexpr bool are_equalities(const std::array<RowKind, rows>& kinds) {
  for (const RowKind kind : kinds)
    if (kind != RowKind::equality) return false;
  return true;
}

template <class Law, class Item>
double restitution_of(const Law& law, const Item& item) {
  if constexpr (requires { law.restitution(item); }) return law.restitution(item);
  else return 0;
}

struct SoftRow {
  double compliance, bias;
};

/// The soft row λ = −h (k (φ + θ h ū) + c ū), ū = θ u⁺ + (1−θ) u⁻, solved for u⁺ + (1−θ)/θ u⁻:
///
///   R = 1/(θ (θ h² k + h c)),  bias = k φ/(θ (θ h k + c)).
inline SoftRow soft_row(double stiffness, double damping, double phi, double h, double theta) {
  return {.compliance = 1 / (theta * (theta * h * h * stiffness + h * damping)),
          .bias = stiffness * phi / (theta * (theta * h * stiffness + damping))};
}
template <class Pool>
void soften(Pool& pool, Index i, int k, double h, double theta = 1) {
  using T = typename Pool::Scalar;
  const SoftRow row =
      soft_row(double(pool.stiffness[i][k]), double(pool.damping[i][k]), double(pool.phi[i][k]), h, theta);
  pool.compliance[i][k] = T(row.compliance);
  pool.bias[i][k] = T(row.bias);
}

/// A law whose springs see the mean velocity of the step.
template <class Law>
inline constexpr bool has_mean_springs = requires(const Law& contact) {
  requires std::remove_cvref_t<decltype(contact.law)>::takes_mean;
};

/// Rows that shall have a speed s: u⁺ − s in place of u⁺, in the soft row above as in a rigid one.
template <class Pool>
void drive(Pool& pool, Index i, double speed, double h) {
  for (int k = 0; k < Pool::rows; ++k) {
    if (pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0) soften(pool, i, k, h);
    pool.bias[i][k] -= typename Pool::Scalar(speed);
  }
}

}  // namespace inner

/// bias, compliance, softness, and d = H (v_free + (1−θ)/θ v) + bias; equalities hold for the mean velocity,
/// as do springs that ask for it and the direction of friction (`inner::turned_slip`), all other rows for
/// v_next. `bounce` takes what restitution added to the bias, where some law restitutes; `at_start` has the rows
/// of the start of the step, where H is not those, and `fade` takes what fades.
///
/// H v_next = −H v keeps what goes across the joints, and turns it round every step. So v counts there
/// without a tenth of what it has across the joints at the start (`inner::fading`), which is of order h² and
/// for which only the rows of the start will do. Where that gives energy it is withheld, see `withhold_fade`.
template <class World, class Laws, class Rows, class S, class Bounce, class AtStart, class Fade>
void make_bias(const World& world, const Laws& laws, Rows& rows, const S& stabilisation, double h,
               double theta, Bounce& bounce, const AtStart& at_start, Fade& fade) {
  using T = typename Rows::Scalar;
  for_each_index<Laws::pool_count>([&](auto p) {
    const auto& constraints = laws.template pool<p>();
    auto& pool = rows.template pool<p>();
    using Law = std::remove_cvref_t<decltype(constraints.law)>;
    constexpr auto kinds = row_kinds<Law>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto free = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.v_free; });
      Vec<Law::rows, T> start = Vec<Law::rows, T>::Zero();
      if (theta != 1 || !inner::are_equalities(kinds))
        start = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
      Vec<Law::rows, T> fades = Vec<Law::rows, T>::Zero();
      if constexpr (requires { at_start.pools; })
        if constexpr (!ContactLaw<Law>)
          fades = inner::fading(inner::rate_at_start(at_start.template pool<p>(), i, world), start);
      if constexpr (requires { fade.pools; }) std::get<p>(fade.pools)[i].setZero();
      const double restitution = inner::restitution_of(constraints.law, constraints.item(i));
      pool.d[i] = free;
      if constexpr (inner::has_slip(kinds))
        if (theta != 1)
          pool.d[i].template segment<2>(1) +=
              inner::turned_slip<T>(start.template segment<2>(1), free.template segment<2>(1), theta);
      for (int k = 0; k < Law::rows; ++k) {
        if (kinds[k] == RowKind::friction) continue;
        if (pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0) {
          if constexpr (inner::has_mean_springs<Law>) {
            inner::soften(pool, i, k, h, theta);
            pool.d[i][k] += T((1 - theta) / theta) * start[k];
          } else {
            inner::soften(pool, i, k, h);
          }
        } else if (kinds[k] == RowKind::equality) {
          pool.bias[i][k] = T(stabilisation.equality(double(pool.phi[i][k]), theta * h));
          pool.d[i][k] += T((1 - theta) / theta) * (start[k] - fades[k]);
          if constexpr (requires { fade.pools; })
            std::get<p>(fade.pools)[i][k] = T((1 - theta) / theta) * fades[k];
          if constexpr (requires { stabilisation.joint_compliance(h); })
            pool.compliance[i][k] = T(stabilisation.joint_compliance(h));
        } else {
          const double sign = kinds[k] == RowKind::lower ? 1 : -1;
          const RowBias row = lower_bias(stabilisation,
                                         {.phi = sign * double(pool.phi[i][k]),
                                          .start_velocity = sign * double(start[k]),
                                          .free_velocity = sign * double(free[k]),
                                          .restitution = restitution},
                                         h);
          pool.bias[i][k] = T(sign * row.bias);
          if constexpr (requires { stabilisation.contact_compliance(h); })
            pool.compliance[i][k] = T(stabilisation.contact_compliance(h));
          // Open rows yield too: one that closes within the step meets the same spring, one that does not has λ = 0.
          if constexpr (requires { stabilisation.softness(h); }) pool.softness[i][k] = T(stabilisation.softness(h));
          if constexpr (requires { bounce.pools; })
            std::get<p>(bounce.pools)[i][k] = T(sign * (row.bias - row.plain));
        }
      }
      if constexpr (requires { constraints.law.speed(constraints.item(i)); })
        inner::drive(pool, i, constraints.law.speed(constraints.item(i)), h);
      pool.d[i] += pool.bias[i];
    }
  });
}

}  // namespace delassus
