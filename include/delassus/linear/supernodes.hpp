/// The columns of a sparse Cholesky factor that share their rows, found from the graph and an order of
/// elimination.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/nested_dissection.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace delassus {

/// A supernode is a run of columns first … first + width − 1 of L with the rows `rows` (ascending, its own
/// columns included). Children stand before their parents. Columns and rows are places in the order of
/// elimination.
struct Supernode {
  Index first = 0, width = 0, parent = -1, first_descendant = 0;
  Array<Index> rows;
  Array<Index> children;

  Index below() const { return Index(rows.size()) - width; }
};

/// J. W. H. Liu, "The role of elimination trees in sparse factorization": the tree, its postorder, the rows
/// of each column, then supernodes, merged with their parents where that adds few zeros.
template <class Index>
class BasicSupernodalPattern {
 public:
  /// `order[k]`: the node eliminated at place k; the postorder may permute it further.
  void analyse(const NodeGraph& graph, Array<Index> order) {
    node_ = std::move(order);
    number_places();
    find_tree(graph);
    postorder();
    find_tree(graph);
    find_rows(graph);
    find_supernodes();
    merge();
    connect();
  }

  Index nodes() const { return Index(node_.size()); }
  Index place(Index node) const { return place_[node]; }
  Index node(Index place) const { return node_[place]; }
  Index supernode_of(Index place) const { return owner_[place]; }
  const std::vector<Supernode>& supernodes() const { return supernodes_; }

 private:
  void number_places() {
    place_.resize(node_.size());
    for (Index k = 0; k < nodes(); ++k) place_[node_[k]] = k;
  }

  /// parent_[k]: the first row below the diagonal in column k of L.
  void find_tree(const NodeGraph& graph) {
    parent_.assign(nodes(), -1);
    Array<Index> ancestor(nodes(), -1);
    for (Index k = 0; k < nodes(); ++k)
      for (const Index neighbour : graph.of(node_[k]))
        for (Index i = place_[neighbour]; i >= 0 && i < k;) {
          const Index next = ancestor[i];
          ancestor[i] = k;
          if (next < 0) parent_[i] = k;
          i = next;
        }
  }

  /// Renumbers so that every subtree is a run of places.
  void postorder() {
    Array<Index> size(nodes(), 1), start(nodes(), -1), order(nodes());
    for (Index k = 0; k < nodes(); ++k)
      if (parent_[k] >= 0) size[parent_[k]] += size[k];
    // From the roots down: a subtree of `size` places, its root last, the children packed from the end.
    Array<Index> end(nodes());
    Index top = nodes();
    for (Index k = nodes(); k-- > 0;) {
      Index& limit = parent_[k] >= 0 ? end[parent_[k]] : top;
      order[limit - 1] = node_[k];
      end[k] = limit - 1;
      limit -= size[k];
    }
    node_ = std::move(order);
    number_places();
  }

  void find_rows(const NodeGraph& graph) {
    rows_.assign(nodes(), {});
    child_count_.assign(nodes(), 0);
    std::vector<Array<Index>> children(nodes());
    Array<Index> mark(nodes(), -1);
    for (Index k = 0; k < nodes(); ++k) {
      Array<Index>& rows = rows_[k];
      const auto take = [&](Index i) {
        if (i <= k || mark[i] == k) return;
        mark[i] = k;
        rows.push_back(i);
      };
      for (const Index neighbour : graph.of(node_[k])) take(place_[neighbour]);
      for (const Index c : children[k])
        for (const Index i : rows_[c]) take(i);
      inner::sort(rows);
      if (parent_[k] < 0) continue;
      children[parent_[k]].push_back(k);
      ++child_count_[parent_[k]];
    }
  }

  /// Column k + 1 joins column k when it is its only parent and has the same rows.
  void find_supernodes() {
    supernodes_.clear();
    for (Index k = 0, next = 0; k < nodes(); k = next) {
      next = k + 1;
      while (next < nodes() && parent_[next - 1] == next && child_count_[next] == 1 &&
             rows_[next].size() + 1 == rows_[next - 1].size())
        ++next;
      Supernode s;
      s.first = k;
      s.width = next - k;
      for (Index i = k; i < next; ++i) s.rows.push_back(i);
      s.rows.append(rows_[next - 1].begin(), rows_[next - 1].end());
      supernodes_.push_back(std::move(s));
    }
    rows_.clear();
  }

  /// A supernode joins the next one when that is its parent and the zeros stored for it are few: up to 60 %
  /// of four columns, 30 % of sixteen, 5 % of more.
  void merge() {
    for (bool is_changing = true; is_changing;) {
      is_changing = false;
      std::size_t kept = 0;
      for (std::size_t k = 1; k < supernodes_.size(); ++k) {
        Supernode &a = supernodes_[kept], &b = supernodes_[k];
        if (pays(a, b)) {
          a.rows.resize(a.width);
          a.rows.append(b.rows.begin(), b.rows.end());
          a.width += b.width;
          is_changing = true;
        } else if (++kept != k) {
          supernodes_[kept] = std::move(b);
        }
      }
      if (!supernodes_.empty()) supernodes_.resize(kept + 1);
    }
  }

  bool pays(const Supernode& a, const Supernode& b) const {
    if (a.below() == 0 || a.rows[a.width] >= b.first + b.width) return false;  // b is not the parent
    const double width = a.width + b.width, height = a.width + double(b.rows.size());
    const double zeros = a.width * (height - double(a.rows.size())),
                 all = width * height - 0.5 * width * width;
    return zeros < (width <= 4 ? 0.6 : width <= 16 ? 0.3 : 0.05) * all;
  }

  void connect() {
    owner_.resize(nodes());
    for (Index s = 0; s < Index(supernodes_.size()); ++s) {
      Supernode& x = supernodes_[s];
      std::fill_n(owner_.begin() + x.first, x.width, s);
      x.first_descendant = x.first;
    }
    for (Index s = 0; s < Index(supernodes_.size()); ++s) {
      Supernode& x = supernodes_[s];
      if (!x.children.empty()) x.first_descendant = supernodes_[x.children[0]].first_descendant;
      if (x.below() == 0) continue;
      x.parent = owner_[x.rows[x.width]];
      supernodes_[x.parent].children.push_back(s);
    }
  }

  Array<Index> node_, place_, parent_, owner_, child_count_;
  std::vector<Array<Index>> rows_;
  std::vector<Supernode> supernodes_;
};

using SupernodalPattern = BasicSupernodalPattern<Index>;

/// A's own entries below the diagonal, by columns of P A Pᵀ with rows ascending; rows and columns are places.
template <class Index>
struct BasicLowerEntries {
  Array<Index> start, row;

  void analyse(const NodeGraph& graph, const SupernodalPattern& pattern) {
    start.assign(1, 0);
    row.clear();
    for (Index j = 0; j < pattern.nodes(); ++j) {
      for (const Index i : graph.of(pattern.node(j)))
        if (pattern.place(i) > j) row.push_back(pattern.place(i));
      inner::sort(row.data() + start.back(), row.data() + row.size());
      start.push_back(Index(row.size()));
    }
  }
  /// The entry of a row in a column; it exists.
  Index find(Index at, Index column) const {
    const auto first = row.begin() + start[column], last = row.begin() + start[column + 1];
    return Index(inner::lower_bound(first, last, at) - row.begin());
  }
};

using LowerEntries = BasicLowerEntries<Index>;

}  // namespace delassus
