/// The contacts of an island's colours, copied into groups of which each lane holds one.
#pragma once

#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/crew.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/lanes.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/free_velocity.hpp>
#include <delassus/solvers/inner/colouring.hpp>
#include <delassus/solvers/law_table.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace delassus::inner {

/// Contacts by Coulomb whose W has blocks. Each piece of a colour becomes groups of `lane_count`
/// contacts that follow each other. As many blocks as the first of a group has, all have: those of the others
/// are followed by zeros. What passes read lies in the order in which they ask for it, by group and lane:
///
///   sweeps   d, W_ii⁻¹, μ, w, then 9 numbers of each block; where the λ lies that it meets
///   squares  W_ii and |W_ii|, for projections and measures
///
/// What a slip asks for lies by contact. λ stays where it is. What rows of other pools do is added to d
/// before a pass. A lane behind the last contact of a piece has that once more with w = 0, and writes
/// nothing.
class ContactLanes {
 public:
  static constexpr int sweep_lanes = 14, square_lanes = 10;
  /// S, W_nt/W_nn, W_tn/W_nn, 1/W_nn, α, μ, w of `Coulomb`, up to a whole number of packets.
  static constexpr int slip_numbers = (12 + lane_count - 1) / lane_count * lane_count, alpha_place = 9;

  /// Its first contact, its first group, and how many contacts it has; of these, who meets rows of other
  /// pools.
  struct Piece {
    Index first, group, items, outside, outside_end;
  };

  /// What a group holds.
  struct Group {
    const double *sweep, *block, *square;
    const Index *column, *own;  ///< where in λ three numbers are: of those it meets, and its own
    Index blocks;

    [[gnu::always_inline]] Lanes friction() const { return load_lanes(sweep + 12 * lane_count); }
    [[gnu::always_inline]] Lanes weight() const { return load_lanes(sweep + 13 * lane_count); }
  };

  static bool takes(const PoolView<double>& pool) {
    return pool.table->is_coulomb && pool.is_matrix() && own_blocks(pool);
  }

  /// Room for the spans of `pool`, the items of which lie one after the other; `table` has their loops.
  void lay_out(const PoolView<double>& pool, const LawTable<double>& table, const Span<double>* first,
               const Span<double>* last) {
    pool_ = pool;
    pool_.table = &table;
    within_ = own_blocks(pool_);
    items_ = first->items;
    pieces_.clear(), piece_at_.clear(), first_block_.clear(), outside_.clear();
    first_block_.push_back(0);
    for (const Span<double>* span = first; span != last; ++span)
      for (Index at = 0; at < span->count; at += items_of_piece)
        add_piece(span->items + at, std::min(span->count - at, items_of_piece));
    const std::size_t groups = first_block_.size() - 1, blocks = std::size_t(first_block_.back()),
                      width = std::size_t(lane_count);
    sweeps_.resize_for_overwrite((groups * sweep_lanes + blocks * 9) * width);
    squares_.resize_for_overwrite(groups * square_lanes * width);
    slips_.resize_for_overwrite(groups * slip_numbers * width);
    columns_.resize_for_overwrite(blocks * width);
    own_.resize_for_overwrite(groups * width);
  }
  /// Copies the numbers, as they are now.
  void fill(Crew* crew) {
    const auto one = [this](Index k) {
      const Piece& piece = pieces_[std::size_t(k)];
      const Index width = lane_count;
      for (Index at = 0; at < piece.items; at += width)
        for (Index l = 0; l < width; ++l)
          fill(std::size_t(piece.group + at / width), std::size_t(l),
               items_[piece.first + std::min(at + l, piece.items - 1)], at + l < piece.items);
    };
    const Index count = Index(pieces_.size());
    if (crew)
      crew->run(count, one);
    else
      for (Index k = 0; k < count; ++k) one(k);
  }
  /// To d of a piece's contacts comes what rows of other pools do now.
  [[gnu::always_inline]] void hear_others(const Piece& piece) {
    if (piece.outside != piece.outside_end) add_others(piece);
  }
  /// The roots of the last slips go back to the law's memory.
  void give_back() const {
    for (const Piece& piece : pieces_)
      for (Index k = 0; k < piece.items; ++k)
        memory(items_[piece.first + k]).alpha = slip(piece.group, k)[alpha_place];
  }

  const PoolView<double>& pool() const { return pool_; }
  /// The piece whose items begin there; null: none does.
  const Piece* piece_at(const Index* items) const {
    const std::uintptr_t at = (std::uintptr_t(items) - std::uintptr_t(items_)) / sizeof(Index);
    if (at >= piece_at_.size() || piece_at_[at] < 0) return nullptr;
    return &pieces_[std::size_t(piece_at_[at])];
  }
  [[gnu::always_inline]] Group group(Index g) const {
    const std::size_t width = std::size_t(lane_count), k = std::size_t(g),
                      before = std::size_t(first_block_[k]);
    const double* const sweep = sweeps_.data() + (k * sweep_lanes + before * 9) * width;
    return {sweep,
            sweep + sweep_lanes * width,
            squares_.data() + k * square_lanes * width,
            columns_.data() + before * width,
            own_.data() + k * width,
            first_block_[k + 1] - first_block_[k]};
  }
  /// Where in λ the k-th of a piece has its numbers.
  [[gnu::always_inline]] Index own(const Piece& piece, Index k) const {
    return own_[std::size_t(piece.group) * std::size_t(lane_count) + std::size_t(k)];
  }
  /// Of the k-th contact from the group on.
  [[gnu::always_inline]] double* slip(Index group, Index k) {
    return slips_.data() + (std::size_t(group) * std::size_t(lane_count) + std::size_t(k)) * slip_numbers;
  }
  [[gnu::always_inline]] const double* slip(Index group, Index k) const {
    return const_cast<ContactLanes*>(this)->slip(group, k);
  }

 private:
  Coulomb::Memory<double>& memory(Index i) const {
    return static_cast<Coulomb::Memory<double>*>(pool_.memory)[i];
  }
  Index blocks_of(Index i) const { return within_->start[i + 1] - within_->start[i]; }

  bool meets_others(Index i) const {
    for (const BlockRowsView<double>*W = pool_.blocks, *end = W + pool_.block_rows; W != end; ++W)
      if (W != within_ && W->start[i] != W->start[i + 1]) return true;
    return false;
  }
  void add_others(const Piece& piece) {
    for (Index e = piece.outside; e < piece.outside_end; ++e) {
      const Index k = outside_[std::size_t(e)], i = items_[piece.first + k];
      double u[3];
      for (int j = 0; j < 3; ++j) u[j] = pool_.d[3 * std::ptrdiff_t(i) + j];
      for (const BlockRowsView<double>*W = pool_.blocks, *end = W + pool_.block_rows; W != end; ++W)
        if (W != within_)
          add_wide_row<3>(u, W->start[i], W->start[i + 1], W->block, W->column, W->lambda, W->columns);
      const std::size_t g = std::size_t(piece.group + k / lane_count);
      double* const d = sweep_of(g) + k % lane_count;
      for (int j = 0; j < 3; ++j) d[j * lane_count] = u[j];
    }
  }
  [[gnu::always_inline]] double* sweep_of(std::size_t g) {
    return sweeps_.data() + (g * sweep_lanes + std::size_t(first_block_[g]) * 9) * std::size_t(lane_count);
  }

  void add_piece(const Index* items, Index count) {
    piece_at_.resize(std::size_t(items - items_), -1);
    piece_at_.push_back(Index(pieces_.size()));
    const Index outside = Index(outside_.size());
    for (Index k = 0; k < count; ++k)
      if (meets_others(items[k])) outside_.push_back(k);
    pieces_.push_back(
        {Index(items - items_), Index(first_block_.size()) - 1, count, outside, Index(outside_.size())});
    for (Index at = 0; at < count; at += lane_count) {
      Index most = 0;
      for (Index k = at; k < std::min(at + lane_count, count); ++k)
        most = std::max(most, blocks_of(items[k]));
      first_block_.push_back(first_block_.back() + most);
    }
  }

  /// Contact i in lane l of group g.
  void fill(std::size_t g, std::size_t l, Index i, bool is_first_time) {
    constexpr std::size_t width = std::size_t(lane_count);
    const std::size_t before = std::size_t(first_block_[g]), most = std::size_t(first_block_[g + 1]) - before;
    const auto put = [l](double* to, const double* from, int count) {
      for (int j = 0; j < count; ++j) to[std::size_t(j) * width + l] = from[j];
    };
    const double* const W = pool_.own_block(i);
    const Coulomb::Memory<double>& known = memory(i);
    const double mu_and_w[2] = {pool_.table->friction(pool_, i),
                                is_first_time ? (W[0] + W[4] + W[8]) * (1.0 / 3) : 0};
    double* const sweep = sweep_of(g);
    put(sweep, pool_.d + 3 * std::ptrdiff_t(i), 3);
    put(sweep + 3 * width, known.inverse.data(), 9);
    put(sweep + 12 * width, mu_and_w, 2);
    const std::size_t first = std::size_t(within_->start[i]), count = std::size_t(blocks_of(i));
    for (std::size_t e = 0; e < most; ++e) {
      static constexpr double nothing[9] = {};
      put(sweep + (sweep_lanes + 9 * e) * width, e < count ? within_->block + 9 * (first + e) : nothing, 9);
      columns_[(before + e) * width + l] = 3 * (e < count ? within_->column[first + e] : i);
    }
    own_[g * width + l] = 3 * i;
    const double size = norm(load_square<3>(W));
    double* const square = squares_.data() + g * square_lanes * width;
    put(square, W, 9), put(square + 9 * width, &size, 1);
    double* const slip = slips_.data() + (g * width + l) * slip_numbers;
    for (int k = 0; k < 4; ++k) slip[k] = known.schur[k];
    for (int k = 0; k < 2; ++k)
      slip[4 + k] = known.to_normal[k], slip[6 + k] = known.from_normal[k], slip[10 + k] = mu_and_w[k];
    slip[8] = known.over_normal, slip[alpha_place] = known.alpha;
    for (int k = 12; k < slip_numbers; ++k) slip[k] = 0;
  }

  PoolView<double> pool_;
  const BlockRowsView<double>* within_ = nullptr;  ///< W between its contacts
  const Index* items_ = nullptr;
  Array<Index> piece_at_;  ///< by place among the items
  Array<Piece> pieces_;
  Array<Index> outside_;        ///< by piece: places in it
  Array<Index> first_block_;    ///< by group
  Array<Index> columns_, own_;  ///< by block and lane, by group and lane
  Array<double> sweeps_, squares_, slips_;
};

}  // namespace delassus::inner
