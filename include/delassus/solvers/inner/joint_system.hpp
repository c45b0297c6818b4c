/// The bilateral constraints of an island, those between the same two bodies as one node of their sparse
/// matrix.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/rows/row_view.hpp>
#include <delassus/solvers/inner/direct_system.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// The most rows of one constraint; six, those of a weld, where joints may have rotors, springs or motors
/// beside them.
template <class Rows>
inline constexpr int rows_of_a_node = Rows::lowest == 1 && Rows::widest == 6 ? std::max(6, Rows::highest)
                                                                             : std::max(1, Rows::highest);

/// One bilateral constraint, and which rows of its node are its own.
template <int w>
struct JointPart {
  int pool, rows;  ///< pool: the number that `take` was given
  Index item, node;
  int at[w];                 ///< row k stands there in the node
  Vec<w> compliance, scale;  ///< as in `DirectNode`
  Vec<w> apart;              ///< of a shared row: (u_k − u)/R_k, what it takes beside its share
  Vec<w> step;               ///< δ
};

/// A `DirectSystem` whose nodes are bodies' joints: a hinge, its rotor and its damper act on the same two
/// bodies and make one node, as far as w rows go. A machine's matrix then has as many blocks as joints, and a
/// body as many as it has neighbours.
///
/// Soft rows k of a node with the same H are parallel springs, J δv + R_k δ_k = −u_k. Together they are the
/// row
///
///   J δv + R δ = −u,   1/R = Σ 1/R_k,   u = R Σ u_k/R_k,   and then   δ_k = (R δ + u − u_k)/R_k.
template <int w, int width>
class JointSystem : public DirectSystem<w, width> {
  using Base = DirectSystem<w, width>;

 public:
  using Part = JointPart<w>;
  using typename Base::Node;
  using typename Base::Row;
  using typename Base::Side;

  void begin() {
    Base::begin();
    parts_.clear();
    shared_.clear();
    newest_.clear();
    older_.clear();
  }

  /// Takes item i of a pool as the next bilateral constraint; no other kind came before. False as for `take`.
  template <class T>
  bool take_joint(const RowView<T>& rows, Index i, int pool) {
    if (!this->take(rows, i, true, pool)) return false;
    const Index last = this->bilateral() - 1;
    const Node& node = this->node(last);
    Part& part = parts_.emplace_back();
    part.pool = pool, part.rows = node.rows, part.item = i, part.node = last;
    assign(part.compliance, node.compliance);
    assign(part.scale, node.scale);
    set_all(part.apart, 0.0);
    if (!joins_another(part)) {
      for (int k = 0; k < w; ++k) part.at[k] = k;
      shared_.push_back(0);
      list(last);
    }
    return true;
  }

  inner::Slice<const Part> parts() const { return {parts_.data(), parts_.size()}; }

  /// The right side ← −u, where something answers; velocity(part, u) sets u. Returns √Σ u²/W_kk, the size of
  /// it.
  double load(const auto& velocity) {
    this->clear();
    double square = 0;
    for (Part& part : parts_) {
      Row u;
      velocity(part, u);
      Row& x = this->right_side(part.node);
      const unsigned shared = shared_[part.node];
      for (int k = 0; k < part.rows; ++k) {
        if (!(part.scale[k] > 0)) continue;
        square += u[k] * u[k] / part.scale[k];
        const int at = part.at[k];
        if (shared >> at & 1) {
          x[at] -= u[k] * (this->node(part.node).compliance[at] / part.compliance[k]);
          part.apart[k] = u[k];
        } else {
          x[at] = -u[k];
        }
      }
    }
    for (Part& part : parts_)
      if (const unsigned shared = shared_[part.node])
        for (int k = 0; k < part.rows; ++k)
          if (shared >> part.at[k] & 1)
            part.apart[k] = (part.apart[k] + this->right_side(part.node)[part.at[k]]) / part.compliance[k];
    return std::sqrt(square);
  }

  /// Sets the answers aside as `step` of each part, so that the right side can be loaded anew.
  void keep() {
    for (Part& part : parts_) {
      const Row& x = this->answer(part.node);
      const unsigned shared = shared_[part.node];
      for (int k = 0; k < part.rows; ++k) {
        const int at = part.at[k];
        part.step[k] = x[at];
        if (shared >> at & 1)
          part.step[k] =
              part.step[k] * (this->node(part.node).compliance[at] / part.compliance[k]) - part.apart[k];
      }
    }
  }

 private:
  static constexpr int most_looked_at = 8;  ///< joints of a body that a new one is compared with

  /// Sides of one block are linked, the newest first.
  void list(Index n) {
    const Node& node = this->node(n);
    newest_.resize(this->blocks(), -1);
    older_.resize(std::size_t(node.last), -1);
    for (Index e = node.first; e < node.last; ++e) {
      Index& newest = newest_[this->side(e).block];
      older_[e] = newest;
      newest = e;
    }
  }

  /// Whether the last node has become rows of an earlier one on the same bodies.
  bool joins_another(Part& part) {
    const Node& node = this->node(part.node);
    const Index sides = node.last - node.first;
    if (sides == 0 || sides > 2 || newest_.size() < this->blocks()) return false;
    if (sides == 2 && this->side(node.first).block == this->side(node.first + 1).block) return false;
    // Of two bodies one is often the end of a branch, and has few joints.
    Index e[2] = {newest_[this->side(node.first).block], newest_[this->side(node.last - 1).block]};
    for (int looked_at = 0; looked_at < most_looked_at && e[0] >= 0 && e[1] >= 0; ++looked_at)
      for (Index& at : e) {
        if (at < 0) continue;
        if (const Index with = this->side(at).node;
            acts_alike(this->node(with), node) && append_last(with, part.at, shared_[with])) {
          part.node = with;
          return true;
        }
        at = older_[at];
      }
    return false;
  }

  /// Whether two nodes act on the same blocks.
  bool acts_alike(const Node& one, const Node& other) const {
    if (one.last - one.first != other.last - other.first) return false;
    for (Index e = other.first; e < other.last; ++e)
      if (side_on(one, this->side(e).block) < 0) return false;
    return true;
  }
  Index side_on(const Node& node, Index block) const {
    for (Index e = node.first; e < node.last; ++e)
      if (this->side(e).block == block) return e;
    return -1;
  }

  /// The last node's rows become rows of another that acts alike, at[k] there, and it is no more. A soft row
  /// that is another one again shares it, and has its bit in `shared`: then the compliance is that of both.
  /// False where they are too many.
  bool append_last(Index n, int* at, unsigned& shared) {
    Node& to = this->changed_node(n);
    const Node& from = this->node(this->bilateral() - 1);
    int rows = to.rows;
    unsigned newly = 0;
    for (int k = 0; k < from.rows; ++k) {
      at[k] = from.compliance[k] > 0 ? same_row(to, from, k) : -1;
      if (at[k] >= 0)
        newly |= 1u << at[k];
      else
        at[k] = rows++;
    }
    if (rows > w) return false;
    for (int k = 0; k < from.rows; ++k) {
      const int j = at[k];
      if (j < to.rows) {
        const double own = to.scale[j] - to.compliance[j];
        to.compliance[j] *= from.compliance[k] / (to.compliance[j] + from.compliance[k]);
        to.scale[j] = own + to.compliance[j];
        continue;
      }
      to.compliance[j] = from.compliance[k], to.scale[j] = from.scale[k];
      for (Index e = from.first; e < from.last; ++e) {
        const Side& theirs = this->side(e);
        Side& mine = this->changed_side(side_on(to, theirs.block));
        for (int v = 0; v < width; ++v) mine.H(j, v) = theirs.H(k, v), mine.G(v, j) = theirs.G(v, k);
      }
    }
    shared |= newly;
    to.rows = rows;
    this->drop_last();
    return true;
  }
  /// The soft row of `to` with the same H and G as row k of `from`, or −1.
  int same_row(const Node& to, const Node& from, int k) const {
    for (int j = 0; j < to.rows; ++j) {
      bool is_same = to.compliance[j] > 0;
      for (Index e = from.first; e < from.last && is_same; ++e) {
        const Side &theirs = this->side(e), &mine = this->side(side_on(to, theirs.block));
        for (int v = 0; v < width; ++v)
          is_same = is_same && mine.H(j, v) == theirs.H(k, v) && mine.G(v, j) == theirs.G(v, k);
      }
      if (is_same) return j;
    }
    return -1;
  }

  Array<Part> parts_;
  Array<unsigned> shared_;       ///< bit k: row k of a node is that of several parts
  Array<Index> newest_, older_;  ///< a side of a block, and of a side that before it; −1: none
};

}  // namespace delassus::inner
