/// Passes over one piece of contacts in lanes.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/lane_masks.hpp>
#include <delassus/math/lanes.hpp>
#include <delassus/solvers/inner/contact_lanes.hpp>
#include <delassus/solvers/inner/coulomb_lanes.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace delassus::inner {

/// Three numbers from each of the places at[0] … at[lane_count − 1] of x.
template <std::size_t... l>
[[gnu::always_inline]] inline LaneVector gather(const double* x, const Index* at, std::index_sequence<l...>) {
#if defined(__AVX__) && !defined(__AVX512F__)
  // Two numbers at a time: half as many change from one half of a register to the other.
  const NumberPair a = load_pair(x + at[0]), b = load_pair(x + at[1]), c = load_pair(x + at[2]),
                   d = load_pair(x + at[3]);
  const Lanes even = __builtin_shufflevector(a, c, 0, 1, 2, 3),
              odd = __builtin_shufflevector(b, d, 0, 1, 2, 3);
  return {{__builtin_shufflevector(even, odd, 0, 4, 2, 6), __builtin_shufflevector(even, odd, 1, 5, 3, 7),
           Lanes{x[at[l] + 2]...}}};
#else
  return {{Lanes{x[at[l]]...}, Lanes{x[at[l] + 1]...}, Lanes{x[at[l] + 2]...}}};
#endif
}
[[gnu::always_inline]] inline LaneVector gather(const double* x, const Index* at) {
  return gather(x, at, std::make_index_sequence<lane_count>());
}
/// The way back, of the first `count` lanes.
template <std::size_t... l>
[[gnu::always_inline]] inline void scatter(const LaneVector& from, double* x, const Index* at, Index count,
                                           std::index_sequence<l...>) {
  if (count >= lane_count) {
    ((x[at[l]] = from[0][l], x[at[l] + 1] = from[1][l], x[at[l] + 2] = from[2][l]), ...);
  } else {
    for (Index k = 0; k < count; ++k)
      for (int j = 0; j < 3; ++j) x[at[k] + j] = from[j][k];
  }
}
[[gnu::always_inline]] inline void scatter(const LaneVector& from, double* x, const Index* at, Index count) {
  scatter(from, x, at, count, std::make_index_sequence<lane_count>());
}

/// The lanes below `count`.
[[gnu::always_inline]] inline LaneMask first_lanes(Index count) {
  Lanes number{};
  for (int l = 1; l < lane_count; ++l) number[l] = l;
  return number < all_lanes(double(count));
}

/// Where the lanes of contacts k … k + lane_count − 1 of a piece have their numbers, in impulses that are set
/// aside. What is behind the last contact has that once more.
struct PlacesInPiece {
  Index at[lane_count];
  [[gnu::always_inline]] PlacesInPiece(Index k, Index items) {
    for (int l = 0; l < lane_count; ++l) at[l] = 3 * std::min(k + l, items - 1);
  }
};

/// Sums of a sweep, by lane.
struct SweepLanes {
  Lanes energy{}, along{}, displacement{}, most{};

  /// A change of λ by `step` to `next`, whose λ before lies at `at` of sums.x.
  [[gnu::always_inline]] void add(const Sweep<double>& sums, const Lanes& w, const LaneVector& step,
                                  const LaneVector& next, const Index* at) {
    const Lanes square = dot(step, step);
    energy += w * square;
    if (sums.x) along += w * dot(step, minus(next, gather(sums.x, at)));
    if (sums.tells_change) {
      const Lanes share = w * root_of(square);
      displacement += share;
      most = larger_lanes(most, share);
    }
  }
  void finish(Sweep<double>& sums) const {
    for (int l = 0; l < lane_count; ++l) {
      sums.energy += energy[l], sums.along += along[l], sums.displacement += displacement[l];
      sums.most = std::max(sums.most, most[l]);
    }
  }
};

/// x + A y, of lanes of 3 × 3 numbers by columns.
[[gnu::always_inline]] inline LaneVector plus_product(const LaneVector& x, const double* A,
                                                      const LaneVector& y) {
  LaneVector out;
  for (int i = 0; i < 3; ++i)
    out[i] = x[i] + (load_lanes(A + i * lane_count) * y[0] + load_lanes(A + (3 + i) * lane_count) * y[1] +
                     load_lanes(A + (6 + i) * lane_count) * y[2]);
  return out;
}
/// d + Σ W_ij λ_j: a sum for each number of a block, so that no addition waits for the one before it.
[[gnu::always_inline]] inline LaneVector free_velocity(const ContactLanes::Group& c, const double* lambda) {
  Lanes sum[9] = {};
  const double* W = c.block;
  const Index* column = c.column;
  for (Index e = c.blocks; e > 0; --e, W += 9 * lane_count, column += lane_count) {
    const LaneVector x = gather(lambda, column);
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k) sum[k] += load_lanes(W + k * lane_count) * x[k / 3];
  }
  LaneVector out;
  for (int i = 0; i < 3; ++i)
    out[i] = load_lanes(c.sweep + i * lane_count) + (sum[i] + sum[i + 3] + sum[i + 6]);
  return out;
}

/// Exact answers to a piece, those that slip when all others are known: together they fill lanes that each
/// group by itself leaves empty.
class LaneSweep {
  using Piece = ContactLanes::Piece;

 public:
  LaneSweep(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums)
      : lanes_(lanes), piece_(piece), sums_(sums) {}

  template <bool relaxes>
  void run() {
    double* const lambda = lanes_.pool().lambda;
    SweepLanes all;
    Index late = 0;
    lanes_.hear_others(piece_);
    for (Index k = 0, g = piece_.group; k < piece_.items; k += lane_count, ++g) {
      const ContactLanes::Group c = lanes_.group(g);
      const LaneVector b = free_velocity(c, lambda), here = gather(lambda, c.own), nothing{};
      const Lanes mu = c.friction();
      const LaneVector stick = minus(nothing, plus_product(nothing, c.sweep + 3 * lane_count, b));
      const LaneMask is_open = b[0] >= all_lanes(-negligible_approach<double>),
                     slips = ~(is_open | is_in_cone(stick, mu));
      LaneVector next = choose(is_open, nothing, stick);
      if constexpr (relaxes) next = relaxed(here, next, mu);
      next = choose(slips, here, next);
      scatter(next, lambda, c.own, piece_.items - k);
      all.add(sums_, c.weight(), minus(next, here), next, PlacesInPiece(k, piece_.items).at);
      if (!any_lane(slips)) continue;
      for (int j = 0; j < 3; ++j) store_lanes(b_ + 3 * k + j * lane_count, b[j]);
      for (int l = 0; l < lane_count; ++l) late_[late] = k + l, late -= Index(slips[l]);
    }
    while (late > 0 && late_[late - 1] >= piece_.items) --late;
    for (int l = 1; late > 0 && l < lane_count; ++l) late_[late + l - 1] = late_[late - 1];
    for (Index k = 0; k < late; k += lane_count) slip<relaxes>(late_ + k, late - k, all);
    all.finish(sums_);
  }

 private:
  /// The first `count` of these contacts of the piece; there are as many as lanes.
  template <bool relaxes>
  [[gnu::always_inline]] void slip(const Index* which, Index count, SweepLanes& all) {
    double* const lambda = lanes_.pool().lambda;
    Lanes numbers[ContactLanes::slip_numbers];
    Index own[lane_count], at[lane_count];
    alignas(packet_bytes) double velocity[3 * lane_count];
    for (int l = 0; l < lane_count; ++l) {
      const Index k = which[l], lane = k % lane_count;
      own[l] = lanes_.own(piece_, k);
      at[l] = 3 * k;
      const double* const from = lanes_.slip(piece_.group, k);
      for (int j = 0; j < ContactLanes::slip_numbers; j += lane_count) numbers[j + l] = load_lanes(from + j);
      for (int j = 0; j < 3; ++j) velocity[j * lane_count + l] = b_[3 * (k - lane) + j * lane_count + lane];
    }
    for (int j = 0; j < ContactLanes::slip_numbers; j += lane_count) transpose_lanes(numbers + j);
    SlipLanes of{{numbers[0], numbers[1], numbers[2], numbers[3]},
                 {numbers[4], numbers[5]},
                 {numbers[6], numbers[7]},
                 numbers[8],
                 numbers[9],
                 numbers[10]};
    const LaneVector here = gather(lambda, own);
    LaneVector next = slip_of(
        {{load_lanes(velocity), load_lanes(velocity + lane_count), load_lanes(velocity + 2 * lane_count)}},
        of);
    if constexpr (relaxes) next = relaxed(here, next, of.friction);
    scatter(next, lambda, own, count);
    for (Index l = 0; l < std::min(count, Index(lane_count)); ++l)
      lanes_.slip(piece_.group, which[l])[ContactLanes::alpha_place] = of.alpha[l];
    const Lanes w = first_lanes(count) ? numbers[11] : Lanes{};
    all.add(sums_, w, minus(next, here), next, at);
  }
  /// λ + ω (next − λ), in the cone.
  [[gnu::always_inline]] LaneVector relaxed(const LaneVector& lambda, const LaneVector& next,
                                            const Lanes& mu) const {
    const Lanes omega = all_lanes(sums_.relaxation);
    return project_lanes_on_cone(
        {{lambda[0] + omega * (next[0] - lambda[0]), lambda[1] + omega * (next[1] - lambda[1]),
          lambda[2] + omega * (next[2] - lambda[2])}},
        mu);
  }

  static constexpr int room = int(items_of_piece) + lane_count;
  ContactLanes& lanes_;
  const Piece& piece_;
  Sweep<double>& sums_;
  Index late_[room + lane_count];             ///< contacts of the piece that slip
  alignas(packet_bytes) double b_[3 * room];  ///< their velocities without them, by group
};

}  // namespace delassus::inner
