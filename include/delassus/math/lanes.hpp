/// Several numbers at a time: as many doubles as one instruction takes, and small matrices of them.
#pragma once

#include <delassus/math/packet.hpp>
#include <delassus/math/packet_root.hpp>
#include <delassus/math/singular_values.hpp>

#include <cstddef>
#include <cstring>
#include <utility>

namespace delassus {

/// One double or a few, by the vector unit that is compiled for; + − * / and comparisons act on each.
using Lanes = Packet<double>;
inline constexpr int lane_count = packet_size<double>;

/// x in every lane.
[[gnu::always_inline]] inline Lanes all_lanes(double x) { return x - Lanes{}; }
inline Lanes load_lanes(const double* from) { return load_packet(from); }
inline void store_lanes(double* to, const Lanes& x) { store_packet(to, x); }
inline Lanes larger_lanes(const Lanes& x, const Lanes& y) { return x > y ? x : y; }

/// By columns.
struct LaneVector {
  Lanes e[3];
  Lanes& operator[](int k) { return e[k]; }
  const Lanes& operator[](int k) const { return e[k]; }
};
struct LaneMatrix {
  LaneVector column[3];
  Lanes& operator()(int i, int k) { return column[k][i]; }
  const Lanes& operator()(int i, int k) const { return column[k][i]; }
};

inline Lanes dot(const LaneVector& a, const LaneVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
inline LaneVector times(const Lanes& s, const LaneVector& a) { return {{s * a[0], s * a[1], s * a[2]}}; }
/// A Bᵀ.
inline LaneMatrix times_transposed(const LaneMatrix& A, const LaneMatrix& B) {
  LaneMatrix C;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) C(i, k) = A(i, 0) * B(k, 0) + A(i, 1) * B(k, 1) + A(i, 2) * B(k, 2);
  return C;
}

namespace inner {

/// The element i of what `exchange_lanes` makes of a (the first half) and b, counted through a and then b.
constexpr int exchanged_lane(bool is_first, int step, int i) {
  const bool is_upper = i & step;
  if (is_first) return is_upper ? lane_count + i - step : i;
  return is_upper ? lane_count + i : i + step;
}
/// The upper halves of a's groups of 2 `step` lanes for the lower ones of b's.
template <int step, class P, std::size_t... i>
inline void exchange_lanes(P& a, P& b, std::index_sequence<i...>) {
  const P first = __builtin_shufflevector(a, b, exchanged_lane(true, step, i)...);
  b = __builtin_shufflevector(a, b, exchanged_lane(false, step, i)...);
  a = first;
}
/// Row k of `rows` becomes what was column k: blocks of 1, 2, 4 … lanes change places across the diagonal.
template <int step = 1, class P>
[[gnu::always_inline]] inline void transpose_lanes(P* rows) {
  if constexpr (step < lane_count) {
#pragma GCC unroll 8  // the rows stay in registers
    for (int k = 0; k < lane_count; ++k)
      if (!(k & step)) exchange_lanes<step>(rows[k], rows[k + step], std::make_index_sequence<lane_count>());
    transpose_lanes<2 * step>(rows);
  }
}

}  // namespace inner

/// `SingularValues` of one matrix a lane.
struct LaneSingularValues {
  LaneMatrix U, V;
  LaneVector sigma;
};

namespace inner {

/// Jacobi's turn of the columns p and q of B and V where they are not orthogonal; false where all are.
inline bool turn_columns(LaneMatrix& B, LaneMatrix& V, int p, int q) {
  LaneVector &x = B.column[p], &y = B.column[q];
  const Lanes a = dot(x, x), b = dot(y, y), g = dot(x, y), zero = all_lanes(0), one = all_lanes(1);
  const auto turns = size_of(g) > larger_lanes(4e-16 * root_of(a * b), all_lanes(1e-300));
  const Lanes zeta = turns ? (b - a) / (2 * g) : zero;
  const Lanes t = turns ? (zeta < zero ? -one : one) / (size_of(zeta) + root_of(1 + zeta * zeta)) : zero;
  const Lanes c = 1 / root_of(1 + t * t), s = c * t;
  for (LaneMatrix* A : {&B, &V})
    for (int i = 0; i < 3; ++i) {
      const Lanes u = (*A)(i, p), v = (*A)(i, q);
      (*A)(i, p) = c * u - s * v;
      (*A)(i, q) = s * u + c * v;
    }
  return any_is_positive(size_of(t));
}

/// Exchanges columns p and q, one of them turned round, where q is the longer one.
inline void order_columns(LaneMatrix& B, LaneMatrix& V, int p, int q) {
  const auto swaps = dot(B.column[p], B.column[p]) < dot(B.column[q], B.column[q]);
  for (LaneMatrix* A : {&B, &V})
    for (int i = 0; i < 3; ++i) {
      const Lanes u = (*A)(i, p), v = (*A)(i, q);
      (*A)(i, p) = swaps ? v : u;
      (*A)(i, q) = swaps ? -u : v;
    }
}

/// The matrices of lanes whose U is not found from two columns, one by one.
inline void redo_flat_lanes(const LaneMatrix& F, const Lanes& is_flat, LaneSingularValues& f) {
  double flat[lane_count], at[9 * lane_count], U[9 * lane_count], V[9 * lane_count], sigma[3 * lane_count];
  store_lanes(flat, is_flat);
  std::memcpy(at, &F, sizeof at);
  std::memcpy(U, &f.U, sizeof U), std::memcpy(V, &f.V, sizeof V), std::memcpy(sigma, &f.sigma, sizeof sigma);
  for (int l = 0; l < lane_count; ++l) {
    if (!(flat[l] > 0)) continue;
    Mat3 one;
    for (int k = 0; k < 9; ++k) one.data()[k] = at[k * lane_count + l];
    const SingularValues s = singular_values(one);
    for (int k = 0; k < 9; ++k) U[k * lane_count + l] = s.U.data()[k], V[k * lane_count + l] = s.V.data()[k];
    for (int k = 0; k < 3; ++k) sigma[k * lane_count + l] = s.sigma[k];
  }
  std::memcpy(&f.U, U, sizeof U), std::memcpy(&f.V, V, sizeof V), std::memcpy(&f.sigma, sigma, sizeof sigma);
}

}  // namespace inner

/// `singular_values` of every lane, by the same turns. Where that fails (flat, overflow) it is asked itself.
inline LaneSingularValues singular_values(const LaneMatrix& F) {
  LaneMatrix B = F, V{};
  for (int k = 0; k < 3; ++k) V(k, k) = all_lanes(1);
  bool is_turning = true;
  for (int sweep = 0; sweep < 12 && is_turning; ++sweep) {
    is_turning = false;
    for (const auto& [p, q] : inner::pairs_of_three)
      is_turning = inner::turn_columns(B, V, p, q) || is_turning;
  }
  for (const auto& [p, q] : inner::pairs_of_three) inner::order_columns(B, V, p, q);
  const Lanes longest = root_of(dot(B.column[0], B.column[0])), one = all_lanes(1), zero = all_lanes(0);
  LaneSingularValues f;
  f.V = V;
  LaneVector& u0 = f.U.column[0];
  LaneVector& u1 = f.U.column[1];
  u0 = times(1 / longest, B.column[0]);
  const Lanes along = dot(u0, B.column[1]);
  for (int i = 0; i < 3; ++i) u1[i] = B(i, 1) - along * u0[i];
  const Lanes length = root_of(dot(u1, u1));
  u1 = times(1 / length, u1);
  f.U.column[2] = cross(u0, u1);
  for (int k = 0; k < 3; ++k) f.sigma[k] = dot(f.U.column[k], B.column[k]);
  const Lanes is_sound = length > 1e-14 * longest ? one : zero;
  const Lanes is_flat = one - is_sound;
  if (any_is_positive(is_flat)) inner::redo_flat_lanes(F, is_flat, f);
  return f;
}

}  // namespace delassus
