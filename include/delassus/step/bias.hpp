/// Bias: the stabilisation turns violations into velocities, and d is made.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>

#include <array>
#include <cstddef>
#include <type_traits>

namespace delassus {

/// The bias of a lower row, u⁺ + bias ≥ 0: φ/h of an open one, which may close within the step and no more; of one that
/// overlaps what the stabilisation pushes with. Velocities in m/s, φ in m.
template <class S>
double lower_bias(const S& stabilisation, double phi, double h) {
  return phi < 0 ? stabilisation.penetration(phi, h) : phi / h;
}

namespace inner {

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
Vec<2, T> rotated_slip(const Vec<2, T>& u, const Vec<2, T>& free, double theta) {
  const T size = squared_norm(free);
  if (!(squared_norm(u) > squared_norm(free - u)) || !(size > 0)) return {T(0), T(0)};
  return T(1 - theta) * (u - dot(u, free) / size * free);
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

/// bias, compliance, relative_compliance, and d = H (v_free + (1−θ)/θ v) + bias; equalities hold for the mean velocity,
/// as do springs that ask for it and the direction of friction (`inner::rotated_slip`), all other rows for v_next.
template <class World, class Laws, class Rows, class S>
void make_bias(const World& world, const Laws& laws, Rows& rows, const S& stabilisation, double h, double theta) {
  using T = typename Rows::Scalar;
  each_pool(laws, [&](auto p, const auto& constraints) {
    auto& pool = rows.template pool<p>();
    using Law = std::remove_cvref_t<decltype(constraints.law)>;
    constexpr auto kinds = row_kinds<Law>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto free = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.v_free; });
      auto start = zero<Vec<Law::rows, T>>();
      if (theta != 1) start = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
      pool.d[i] = free;
      if constexpr (inner::has_slip(kinds))
        if (theta != 1) {
          const auto rotated = inner::rotated_slip<T>({start[1], start[2]}, {free[1], free[2]}, theta);
          pool.d[i][1] += rotated[0], pool.d[i][2] += rotated[1];
        }
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
          pool.d[i][k] += T((1 - theta) / theta) * start[k];
          if constexpr (requires { stabilisation.joint_compliance(h); })
            pool.compliance[i][k] = T(stabilisation.joint_compliance(h));
        } else {
          const double sign = kinds[k] == RowKind::lower ? 1 : -1;
          pool.bias[i][k] = T(sign * lower_bias(stabilisation, sign * double(pool.phi[i][k]), h));
          if constexpr (requires { stabilisation.contact_compliance(h); })
            pool.compliance[i][k] = T(stabilisation.contact_compliance(h));
          // Open rows yield too: one that closes within the step meets the same spring, one that does not has λ = 0.
          if constexpr (requires { stabilisation.relative_compliance(h); }) pool.relative_compliance[i][k] = T(stabilisation.relative_compliance(h));
        }
      }
      if constexpr (refines<Law>(refine::speed))
        inner::drive(pool, i, constraints.law.speed(constraints.item(i)), h);
      pool.d[i] += pool.bias[i];
    }
  });
}

}  // namespace delassus
