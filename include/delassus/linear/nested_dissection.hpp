/// An order of elimination by nested dissection: both halves of a graph first, the nodes between them last.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace delassus {

/// Neighbours of the nodes of an undirected graph, compressed: those of node i are neighbour[start[i]] …
/// [start[i+1] − 1].
template <class Index>
struct BasicNodeGraph {
  Array<Index> start, neighbour;

  BasicNodeGraph() = default;
  /// From the pairs (i, j), i ≠ j, each once.
  BasicNodeGraph(Index nodes, std::span<const std::pair<Index, Index>> pairs) : start(nodes + 1, 0) {
    for (auto [i, j] : pairs) ++start[i + 1], ++start[j + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    Array<Index> next(start.begin(), start.end() - 1);
    neighbour.resize(start.back());
    for (auto [i, j] : pairs) {
      neighbour[next[i]++] = j;
      neighbour[next[j]++] = i;
    }
  }
  Index nodes() const { return Index(start.size()) - 1; }
  std::span<const Index> of(Index i) const {
    return std::span<const Index>(neighbour).subspan(start[i], start[i + 1] - start[i]);
  }
};

using NodeGraph = BasicNodeGraph<Index>;

/// A. George, "Nested dissection of a regular finite element mesh". A part is cut at the median of x, y or z,
/// whichever needs the fewest nodes between the halves. Without positions x is the distance, in edges, from a
/// node a far out, y and z are those from a and from its opposite b less that from a node c far from both: of
/// a square net with corners a, b and c, whose distance from a has diagonals for level lines, they are its
/// sides. Parts of at most `leaf` nodes are not cut.
template <class Index>
struct BasicNestedDissection {
  Index leaf = 12;

  /// order[k]: the node eliminated at place k. `positions` is empty or has one point a node, m.
  Array<Index> order(const NodeGraph& graph, std::span<const Vec3> positions = {}) const {
    Work work{graph, positions, Array<Index>(graph.nodes()), Array<Index>(graph.nodes(), 0)};
    std::iota(work.order.begin(), work.order.end(), 0);
    cut(work, 0, graph.nodes());
    return work.order;
  }

 private:
  struct Work {
    const NodeGraph& graph;
    std::span<const Vec3> positions;
    Array<Index> order, mark;  ///< mark: which half a node is in, as a number never used before
    Array<std::pair<double, Index>> key = {};
    Array<Index> best = {}, trial = {};
    std::array<Array<double>, 3> far = {};  ///< by node: edges from a, b and c
    Index last_mark = 0;
  };

  /// Orders the nodes order[first … last − 1] in place.
  void cut(Work& w, Index first, Index last) const {
    const Index n = last - first;
    if (n <= leaf) return;
    if (w.positions.empty()) find_far_nodes(w, first, last);
    Index best_between = n, best_left = 0;
    for (int axis = 0; axis < 3; ++axis) {
      set_keys(w, first, last, axis);
      const auto [left, between] = split(w, n);
      if (between >= best_between) continue;
      if (w.positions.empty() && axis > 0 && std::min(left, n - left - between) < n / 5) continue;
      best_between = between;
      best_left = left;
      w.best.swap(w.trial);
    }
    if (best_between == n) return;
    std::copy_n(w.best.begin(), n, w.order.begin() + first);
    cut(w, first, first + best_left);
    cut(w, first + best_left, last - best_between);
  }

  static void set_keys(Work& w, Index first, Index last, int axis) {
    w.key.clear();
    for (Index k = first; k < last; ++k) {
      const Index i = w.order[k];
      w.key.emplace_back(!w.positions.empty() ? w.positions[i][axis]
                         : axis == 0          ? w.far[0][i]
                                              : w.far[axis - 1][i] - w.far[2][i],
                         i);
    }
    inner::sort(w.key);
  }

  /// a is far from any node, b the farthest from a, c the farthest from both.
  static void find_far_nodes(Work& w, Index first, Index last) {
    Index node = distances(w, first, last, w.order[first]);
    for (int which = 0; which < 3; ++which) {
      const Index farthest = distances(w, first, last, node);
      w.far[which].resize(w.order.size());
      for (const auto& [distance, i] : w.key) w.far[which][i] = distance;
      node = farthest;
      const auto from_both = [&](Index i) { return std::min(w.far[0][i], w.far[1][i]); };
      for (Index k = first; which == 1 && k < last; ++k)
        if (k == first || from_both(w.order[k]) > from_both(node)) node = w.order[k];
    }
  }

  /// Keys = number of edges from a node inside the part (beyond all for nodes it cannot reach); returns the
  /// last reached.
  static Index distances(Work& w, Index first, Index last, Index from) {
    const Index inside = ++w.last_mark, seen = ++w.last_mark;
    for (Index k = first; k < last; ++k) w.mark[w.order[k]] = inside;
    w.key.assign(1, {0., from});
    w.mark[from] = seen;
    for (std::size_t k = 0; k < w.key.size(); ++k)
      for (const Index i : w.graph.of(w.key[k].second))
        if (w.mark[i] == inside) {
          w.mark[i] = seen;
          w.key.emplace_back(w.key[k].first + 1, i);
        }
    const Index end = w.key.back().second;
    for (Index k = first; k < last; ++k)
      if (w.mark[w.order[k]] == inside) w.key.emplace_back(double(last), w.order[k]);
    return end;
  }

  /// trial ← left, right, between; returns how many are left and between. Of the two rims along the median
  /// the thinner one is what lies between.
  static std::pair<Index, Index> split(Work& w, Index n) {
    const Index left = ++w.last_mark, right = ++w.last_mark;
    // Equal keys stay together, so that a plane of nodes is not torn.
    Index middle = n / 2;
    const double at = w.key[middle].first;
    const auto same = [&](Index k) { return w.key[k].first == at; };
    Index down = middle, up = middle;
    while (down > 0 && same(down - 1)) --down;
    while (up < n && same(up)) ++up;
    middle = (down > 0 && middle - down <= up - middle) || up == n ? down : up;
    if (middle == 0) middle = n / 2;
    for (Index k = 0; k < n; ++k) w.mark[w.key[k].second] = k < middle ? left : right;
    const auto touches = [&](Index i, Index side) {
      return std::any_of(w.graph.of(i).begin(), w.graph.of(i).end(),
                         [&](Index j) { return w.mark[j] == side; });
    };
    Index rim_left = 0, rim_right = 0;
    for (Index k = 0; k < n; ++k)
      if (k < middle)
        rim_left += touches(w.key[k].second, right);
      else
        rim_right += touches(w.key[k].second, left);
    const bool takes_left = rim_left < rim_right || (rim_left == rim_right && middle > n - middle);
    const auto is_between = [&](Index k) {
      return (k < middle) == takes_left && touches(w.key[k].second, takes_left ? right : left);
    };
    w.trial.clear();
    for (Index k = 0; k < middle; ++k)
      if (!is_between(k)) w.trial.push_back(w.key[k].second);
    const Index lefts = Index(w.trial.size());
    for (Index k = middle; k < n; ++k)
      if (!is_between(k)) w.trial.push_back(w.key[k].second);
    for (Index k = 0; k < n; ++k)
      if (is_between(k)) w.trial.push_back(w.key[k].second);
    return {lefts, takes_left ? rim_left : rim_right};
  }
};

using NestedDissection = BasicNestedDissection<Index>;

}  // namespace delassus
