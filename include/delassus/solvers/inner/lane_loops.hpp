/// The loops of Coulomb's law over contacts in lanes: what stands in the `LawTable` of a pool whose colours
/// are packed.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/index.hpp>
#include <delassus/solvers/inner/contact_lanes.hpp>
#include <delassus/solvers/inner/lane_passes.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// The table of a packed pool. Spans that are no pieces of it, and copies of the pool, are as before.
struct LaneTable : LawTable<double> {
  ContactLanes* lanes = nullptr;
  const LawTable<double>* alone = nullptr;
};

struct LaneLoops {
  using Piece = ContactLanes::Piece;

  static LaneTable table_of(const LawTable<double>& alone, ContactLanes& lanes) {
    LaneTable out{alone, &lanes, &alone};
    out.sweep = sweep, out.project_once = project_once, out.measure = measure, out.extrapolate = extrapolate;
    if (alone.descend) out.descend = descend;
    return out;
  }

 private:
  static void sweep(const Span<double>& span, Sweep<double>& sums) {
    const Index left = visit(
        span, [&sums](ContactLanes& lanes, const Piece& piece, Index) { sweep_piece(lanes, piece, sums); });
    if (left > 0) alone(span).sweep(rest(span, left), sums);
  }
  static void project_once(const Span<double>& span, Sweep<double>& sums) {
    const Index left = visit(
        span, [&sums](ContactLanes& lanes, const Piece& piece, Index) { project_piece(lanes, piece, sums); });
    if (left > 0) alone(span).project_once(rest(span, left), sums);
  }
  static void descend(const Span<double>& span, Sweep<double>& sums) {
    const Index left = visit(
        span, [&sums](ContactLanes& lanes, const Piece& piece, Index) { descend_piece(lanes, piece, sums); });
    if (left > 0) alone(span).descend(rest(span, left), sums);
  }
  static void measure(const Span<double>& span, MeasureSums& sums) {
    const Index left = visit(
        span, [&sums](ContactLanes& lanes, const Piece& piece, Index) { measure_piece(lanes, piece, sums); });
    if (left > 0) alone(span).measure(rest(span, left), sums);
  }
  static void extrapolate(const Span<double>& span, double* before, double beta) {
    const Index left = visit(span, [before, beta](ContactLanes& lanes, const Piece& piece, Index done) {
      extrapolate_piece(lanes, piece, before + 3 * std::ptrdiff_t(done), beta);
    });
    if (left > 0)
      alone(span).extrapolate(rest(span, left), before + 3 * std::ptrdiff_t(span.count - left), beta);
  }

  static const LaneTable& table_of(const Span<double>& span) {
    return static_cast<const LaneTable&>(*span.pool->table);
  }
  static const LawTable<double>& alone(const Span<double>& span) { return *table_of(span).alone; }
  static Span<double> rest(const Span<double>& span, Index left) {
    return {span.pool, span.end() - left, left};
  }
  /// f(lanes, piece, contacts before it) for each piece of the span. Returns how many contacts are left.
  template <class F>
  static Index visit(const Span<double>& span, const F& f) {
    ContactLanes& lanes = *table_of(span).lanes;
    Index done = 0;
    while (done < span.count && span.pool == &lanes.pool()) {
      const Piece* const piece = lanes.piece_at(span.items + done);
      if (!piece || piece->items > span.count - done) break;
      f(lanes, *piece, done);
      done += piece->items;
    }
    return span.count - done;
  }

  static void sweep_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums);
  static void project_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums);
  static void descend_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums);
  /// λ ← next(group, λ, u), contact by contact.
  template <class Next>
  static void step_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums, const Next& next_of);
  static void measure_piece(ContactLanes& lanes, const Piece& piece, MeasureSums& sums);
  static void extrapolate_piece(ContactLanes& lanes, const Piece& piece, double* before, double beta);
};

inline void LaneLoops::sweep_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums) {
  LaneSweep pass(lanes, piece, sums);
  if (sums.relaxation == 1)
    pass.run<false>();
  else
    pass.run<true>();
  if (sums.x) sums.x += 3 * std::ptrdiff_t(piece.items);
}
template <class Next>
void LaneLoops::step_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums, const Next& next_of) {
  double* const lambda = lanes.pool().lambda;
  SweepLanes all;
  lanes.hear_others(piece);
  for (Index k = 0, g = piece.group; k < piece.items; k += lane_count, ++g) {
    const ContactLanes::Group c = lanes.group(g);
    const LaneVector here = gather(lambda, c.own), u = plus_product(free_velocity(c, lambda), c.square, here);
    const LaneVector next = next_of(c, here, u);
    scatter(next, lambda, c.own, piece.items - k);
    all.add(sums, c.weight(), minus(next, here), next, PlacesInPiece(k, piece.items).at);
  }
  all.finish(sums);
  if (sums.x) sums.x += 3 * std::ptrdiff_t(piece.items);
}
inline void LaneLoops::project_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums) {
  step_piece(lanes, piece, sums, [](const ContactLanes::Group& c, const LaneVector& here, const LaneVector& u) {
    const Lanes s = load_lanes(c.square + 9 * lane_count);
    const LaneVector map = natural_map_of(here, u, c.friction(), s);
    return LaneVector{{here[0] - map[0] / s, here[1] - map[1] / s, here[2] - map[2] / s}};
  });
}
inline void LaneLoops::descend_piece(ContactLanes& lanes, const Piece& piece, Sweep<double>& sums) {
  const Lanes share = all_lanes(sums.relaxation);
  step_piece(lanes, piece, sums, [&share](const ContactLanes::Group& c, const LaneVector& here, const LaneVector& u) {
    const LaneVector change = minus(projection_step_of(c.square, here, u, c.friction()), here);
    return LaneVector{{here[0] + share * change[0], here[1] + share * change[1], here[2] + share * change[2]}};
  });
}
inline void LaneLoops::extrapolate_piece(ContactLanes& lanes, const Piece& piece, double* before,
                                         double beta) {
  double* const lambda = lanes.pool().lambda;
  for (Index k = 0, g = piece.group; k < piece.items; k += lane_count, ++g) {
    const ContactLanes::Group c = lanes.group(g);
    const PlacesInPiece places(k, piece.items);
    const LaneVector here = gather(lambda, c.own), change = minus(here, gather(before, places.at)),
                     add = times(all_lanes(beta), change);
    const LaneVector far{{here[0] + add[0], here[1] + add[1], here[2] + add[2]}};
    const Lanes mu = c.friction(), zero{};
    const LaneMask is_still = (change[0] == zero) & (change[1] == zero) & (change[2] == zero);
    const bool are_in = !any_lane(~(is_in_cone(far, mu) | is_still));
    scatter(here, before, places.at, piece.items - k);
    scatter(choose(is_still, here, are_in ? far : project_lanes_on_cone(far, mu)), lambda, c.own,
            piece.items - k);
  }
}
inline void LaneLoops::measure_piece(ContactLanes& lanes, const Piece& piece, MeasureSums& sums) {
  const double* const lambda = lanes.pool().lambda;
  Lanes residual{}, siconos{}, d_square{}, u_square{}, lambda_square{}, closing{},
      worst = all_lanes(sums.worst), reach = all_lanes(sums.reach);
  const Lanes zero{}, one = all_lanes(1);
  lanes.hear_others(piece);
  for (Index k = 0, g = piece.group; k < piece.items; k += lane_count, ++g) {
    const ContactLanes::Group c = lanes.group(g);
    const LaneVector here = gather(lambda, c.own), u = plus_product(free_velocity(c, lambda), c.square, here);
    const LaneVector d = gather(lanes.pool().d, c.own);
    const Lanes mu = c.friction(), w = c.weight(), is_there = first_lanes(piece.items - k) ? one : zero;
    const Lanes below = u[0] < zero ? u[0] : zero, down = below * below;
    const LaneVector map = natural_map_of(here, u, mu, w), map_of_one = natural_map_of(here, u, mu, one);
    const Lanes own = dot(map, map), square = own < down ? down : own, loads = dot(here, here);
    residual += is_there * square, siconos += is_there * dot(map_of_one, map_of_one),
        closing += is_there * down;
    d_square += is_there * dot(d, d), u_square += is_there * dot(u, u), lambda_square += is_there * loads;
    worst = larger_lanes(is_there * square, worst);
    reach = larger_lanes(w * w * loads * larger_lanes(mu * mu, one), reach);
  }
  for (int l = 0; l < lane_count; ++l) {
    sums.residual += residual[l], sums.siconos += siconos[l], sums.closing += closing[l];
    sums.d += d_square[l], sums.u += u_square[l], sums.lambda += lambda_square[l];
    sums.worst = std::max(sums.worst, worst[l]), sums.reach = std::max(sums.reach, reach[l]);
  }
}

/// Takes the spans of one pool into lanes, where there is one that can be.
class PackedContacts {
 public:
  /// Pre: an island's colours.
  void take(Array<Span<double>>& spans) {
    Span<double>* first = spans.begin();
    while (first != spans.end() && !ContactLanes::takes(*first->pool)) ++first;
    is_used_ = first != spans.end();
    if (!is_used_) return;
    Span<double>* last = first;
    while (last != spans.end() && last->pool == first->pool) ++last;
    table_ = LaneLoops::table_of(*first->pool->table, lanes_);
    lanes_.lay_out(*first->pool, table_, first, last);
    for (; first != last; ++first) first->pool = &lanes_.pool();
  }
  /// The numbers of the problem as they are now.
  void fill(Crew* crew) {
    if (is_used_) lanes_.fill(crew);
  }
  /// What the law remembers of its contacts.
  void give_back() const {
    if (is_used_) lanes_.give_back();
  }

 private:
  ContactLanes lanes_;
  LaneTable table_{};
  bool is_used_ = false;
};

/// Rows of another scalar are swept one by one.
struct NothingPacked {
  static void take(auto&) {}
  static void fill(Crew*) {}
  static void give_back() {}
};

}  // namespace delassus::inner
