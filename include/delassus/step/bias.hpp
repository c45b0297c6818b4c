/// Bias: the stabilisation turns violations into velocities, and d is made.
#pragma once

#include <delassus/core/ranges.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/step/law_rows.hpp>
#include <delassus/step/moving_surfaces.hpp>

#include <cstddef>

namespace delassus {

/// The bias of a lower row, u⁺ + bias ≥ 0. Of an open one it is φ/h: it may close within the step and no more. Of one
/// that overlaps it is what the stabilisation pushes with. Velocities in m/s, φ in m.
template <class S>
double lower_bias(const S& stabilisation, double phi, double h) {
  return phi < 0 ? stabilisation.penetration(phi, h) : phi / h;
}

namespace inner {

/// 1/kg on the rows of rigid joints; zero of a stabilisation without.
double joint_compliance_of(const auto& stabilisation, double h) {
  if constexpr (requires { stabilisation.joint_compliance(h); }) return stabilisation.joint_compliance(h);
  else return 0;
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
template <class T>
void soften(const RowArrays<T>& pool, std::size_t row, double h, double theta) {
  const SoftRow soft = soft_row(double((*pool.stiffness)[row]), double((*pool.damping)[row]), double((*pool.phi)[row]), h, theta);
  (*pool.compliance)[row] = T(soft.compliance);
  (*pool.bias)[row] = T(soft.bias);
}

/// A row that shall have a speed s: u⁺ − s in place of u⁺, in the soft row above as in a rigid one.
template <class T>
void drive(const RowArrays<T>& pool, std::size_t row, double speed, double h) {
  if (pool.is_soft(row)) soften(pool, row, h, 1.0);
  (*pool.bias)[row] -= T(speed);
}

/// One item's rows from `first` on. u: H v_free, which becomes d; start: H v, where θ < 1. `turns_slip`: friction sees `rotated_slip`. `speed`: see `drive`.
template <class T, class S>
[[gnu::always_inline]] inline void make_bias_of_item(const LawSteps<T>& law, const RowArrays<T>& pool, std::size_t first, T* u, const T* start, const S& stabilisation,
                       double h, double theta, bool turns_slip, double speed) {
  const T before = T((1 - theta) / theta);
  if (turns_slip && law.has_slip) {
    const auto rotated = rotated_slip<T>({start[1], start[2]}, {u[1], u[2]}, theta);
    u[1] += rotated[0], u[2] += rotated[1];
  }
  const T *const all_phi = pool.phi->data() + first, *const stiffness = pool.stiffness->data() + first,
          *const damping = pool.damping->data() + first;
  T *const bias = pool.bias->data() + first, *const compliance = pool.compliance->data() + first;
  for (int k = 0, rows = pool.rows; k < rows; ++k) {
    const RowKind kind = law.kinds[k];
    const double phi = double(all_phi[k]);
    if (kind == RowKind::friction) {  // has no bias
    } else if (inner::is_spring(stiffness[k], damping[k])) {
      soften(pool, first + std::size_t(k), h, law.has_mean_springs ? theta : 1.0);
      if (law.has_mean_springs) u[k] += before * start[k];
    } else if (kind == RowKind::equality) {
      bias[k] = T(stabilisation.equality(phi, theta * h));
      if (before != 0) u[k] += before * start[k];
      compliance[k] = T(joint_compliance_of(stabilisation, h));
    } else {
      const double sign = kind == RowKind::lower ? 1 : -1;
      bias[k] = T(sign * lower_bias(stabilisation, sign * phi, h));
      if constexpr (requires { stabilisation.contact_compliance(h); }) compliance[k] = T(stabilisation.contact_compliance(h));
      // Open rows yield too: one that closes within the step meets the same spring, one that does not has λ = 0.
      if constexpr (requires { stabilisation.relative_compliance(h); })
        (*pool.relative_compliance)[first + std::size_t(k)] = T(stabilisation.relative_compliance(h));
    }
    if (law.speed) drive(pool, first + std::size_t(k), speed, h);
    u[k] += bias[k];
  }
}

/// Of some items of a pool.
template <class T, class S>
void make_bias(const LawPool<T>& of, const RowArrays<T>& pool, Range range, const T* const* v_free, const T* const* v, const MovingSurfaces<T>& moving,
               const S& stabilisation, double h, double theta, bool turns_slip) {
  const LawSteps<T>& law = *of.law;
  const int height = pool.rows, sets = pool.sets;
  const bool sees_surfaces = moving && law.place, sees_start = theta != 1 || sees_surfaces, is_driven = law.speed != nullptr;
  static constexpr T nothing[most_rows] = {};
  T of_start[most_rows];
  for (Index i = range.first; i < range.last; ++i) {
    const std::size_t first = std::size_t(i) * std::size_t(height);
    T* const d = pool.d->data() + first;
    const T *u = nothing, *start = nothing;
    for (int s = 0; s < sets; ++s, u = d) {
      pool.set[s].products->rate(pool.set[s], i, v_free[s], u, d);
      if (!sees_start) continue;
      pool.set[s].products->rate(pool.set[s], i, v[s], start, of_start);
      start = of_start;
    }
    if (sees_surfaces) see_moving_surfaces(moving, law.place(of.pool, i), height, h, theta, of_start, d);
    make_bias_of_item(law, pool, first, d, start, stabilisation, h, theta, turns_slip, is_driven ? law.speed(of.pool, i) : 0.0);
  }
}

}  // namespace inner

/// Makes bias, compliance, relative_compliance, and d = H (v_free + (1−θ)/θ v) + bias. Equalities hold for the mean
/// velocity, as do springs that ask for it and the direction of friction (`inner::rotated_slip`). All other rows hold
/// for v_next. Friction sees how surfaces move besides (`inner::see_moving_surfaces`). Contacts in the middle of the step see all of
/// this by their rows, and `turns_slip` is false. `ranges` says who does which items.
template <class World, class T, class S, class Ranges = inner::OneRange>
void make_bias(const World& world, AllLaws<T> laws, AllRows<T> rows, const MovingSurfaces<T>& moving, const S& stabilisation, double h, double theta,
               bool turns_slip, const Ranges& ranges = {}) {
  const inner::BodyVelocities<World> v(world);
  for (std::size_t p = 0; p < laws.size(); ++p)
    ranges(rows[p].items(), 128, [&](inner::Range range) {
      inner::make_bias(laws[p], rows[p], range, v.free, v.start, moving, stabilisation, h, theta, turns_slip);
    });
}

}  // namespace delassus
