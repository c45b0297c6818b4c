/// Which triangles of a surface share edges and corners, and which of them speaks for each.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace delassus::inner {

/// An edge that no two triangles can share as they do: crowded by a third, or run through twice in one
/// direction.
struct SharedEdge {
  Index low = 0, high = 0;                    ///< its vertices
  Index first = -1, second = -1, third = -1;  ///< triangles; −1: it is not crowded
};

/// Fixed by the triangles alone, however their vertices move. A corner and an edge are owned by the first
/// triangle that has them, so that each is treated once [CurtisEtAl2008]. Edges with a fault have no
/// neighbours, as if the surface ended there.
class SurfaceTopology {
 public:
  SurfaceTopology() = default;
  SurfaceTopology(std::span<const std::array<Index, 3>> triangles, Index vertices) {
    find_edges(triangles);
    find_rings(vertices);
    own_corners(triangles, vertices);
  }

  /// The triangle across edge k, −1 at the border.
  Index neighbour(Index t, int k) const { return neighbours_[t][k]; }
  bool is_closed() const {
    const auto has_border = [](const std::array<Index, 3>& n) { return n[0] < 0 || n[1] < 0 || n[2] < 0; };
    return std::none_of(neighbours_.begin(), neighbours_.end(), has_border);
  }
  bool owns_corner(Index t, int k) const { return owned_[t] >> k & 1; }
  bool owns_edge(Index t, int k) const { return owned_[t] >> (3 + k) & 1; }

  /// f(w) for every vertex w that shares an edge with v.
  template <class F>
  void each_around(Index v, const F& f) const {
    for (Index i = ring_start_[v]; i < ring_start_[v + 1]; ++i) f(ring_[i]);
  }
  /// The edges with a fault.
  std::span<const SharedEdge> faults() const { return faults_; }

  void memory(auto& archive) { archive(neighbours_, owned_, ring_start_, ring_, faults_); }

 private:
  struct Edge {
    Index low, high, triangle;
    int k;
    bool is_forward;
    bool is_with(const Edge& o) const { return low == o.low && high == o.high; }
  };

  /// Sorts all edges by their two vertices: those of one pair of triangles come to stand side by side.
  void find_edges(std::span<const std::array<Index, 3>> triangles) {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (Index t = 0; t < Index(triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        const Index u = triangles[t][k], v = triangles[t][(k + 1) % 3];
        edges.push_back({std::min(u, v), std::max(u, v), t, k, u < v});
      }
    inner::sort(edges, [](const Edge& x, const Edge& y) {
      return std::array{x.low, x.high, x.triangle} < std::array{y.low, y.high, y.triangle};
    });
    neighbours_.assign(triangles.size(), {-1, -1, -1});
    owned_.assign(triangles.size(), 0);
    for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
      for (next = i + 1; next < edges.size() && edges[i].is_with(edges[next]);) ++next;
      const Edge &x = edges[i], &y = edges[next - 1];
      owned_[x.triangle] |= std::uint8_t(8u << x.k);
      ends_.push_back({x.low, x.high});
      if (next == i + 1) continue;
      if (next == i + 2 && x.is_forward != y.is_forward) {
        neighbours_[x.triangle][x.k] = y.triangle;
        neighbours_[y.triangle][y.k] = x.triangle;
      } else {
        faults_.push_back(
            {x.low, x.high, x.triangle, edges[i + 1].triangle, next > i + 2 ? edges[i + 2].triangle : -1});
      }
    }
  }

  void find_rings(Index vertices) {
    ring_start_.assign(std::size_t(vertices) + 1, 0);
    for (const auto& [u, v] : ends_) ++ring_start_[u + 1], ++ring_start_[v + 1];
    for (Index v = 0; v < vertices; ++v) ring_start_[v + 1] += ring_start_[v];
    ring_.resize(2 * ends_.size());
    std::vector<Index> place(ring_start_.begin(), ring_start_.end());
    for (const auto& [u, v] : ends_) ring_[place[u]++] = v, ring_[place[v]++] = u;
    ends_.clear();
    ends_.shrink_to_fit();
  }

  void own_corners(std::span<const std::array<Index, 3>> triangles, Index vertices) {
    std::vector<char> is_owned(std::size_t(vertices), 0);
    for (Index t = 0; t < Index(triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        char& taken = is_owned[triangles[t][k]];
        if (!taken) owned_[t] |= std::uint8_t(1u << k);
        taken = 1;
      }
  }

  std::vector<std::array<Index, 3>> neighbours_;
  std::vector<std::uint8_t> owned_;         ///< bits: corners 0, 1, 2, then edges 0, 1, 2
  std::vector<Index> ring_start_, ring_;    ///< vertices around each vertex
  std::vector<std::array<Index, 2>> ends_;  ///< of the edges, while it is made
  std::vector<SharedEdge> faults_;
};

}  // namespace delassus::inner
