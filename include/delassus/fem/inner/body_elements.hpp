/// The elements of one deformable body: where they are, and what one of them, or one a lane, makes there.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/elements_made.hpp>
#include <delassus/fem/inner/pairs_of_nodes.hpp>
#include <delassus/math/lanes.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace delassus::inner {

/// Elements E of a material M on a mesh; node k of it is block `blocks_[k]` of the set. Evaluated in double,
/// whatever T is.
template <class E, class M, class T>
class BodyElements {
 public:
  using Mesh = typename E::Mesh;
  using Velocity = Vec<3, T>;

  BodyElements() = default;
  BodyElements(Mesh mesh, const M& material, Array<Index> blocks)
      : mesh_(std::move(mesh)), material_(material), blocks_(std::move(blocks)) {}

  std::span<const Index> blocks() const { return blocks_; }
  const Mesh& mesh() const { return mesh_; }
  const M& material() const { return material_; }
  /// The block of corner `corner` of element e.
  Index block_of(Index e, int corner) const { return blocks_[mesh_.cells()[e][corner]]; }

  /// The element a point of the world is in, and its place there, by which E weighs the corners; −1 where it
  /// is outside of all of them by more than 1e-6 of one.
  Index locate(const Vec3& point, std::span<const Velocity> x, Vec3& local) const {
    Index found = -1;
    double best = -1e-6;
    for (Index e = 0; e < Index(elements_.size()); ++e) {
      Vec3 at = Vec3::Zero();
      const double inside = E::locate(corners(e, x), point, at);
      if (!(inside > best)) continue;
      best = inside;
      local = at;
      found = e;
    }
    return found;
  }

 protected:
  void make_elements() {
    elements_.clear();
    const Lame lame(material_.young, material_.poisson);
    for (Index e = 0; e < Index(mesh_.cells().size()); ++e) elements_.emplace_back(mesh_, e, lame);
    order_corners();
  }

  /// How many elements are taken lane_count at a time.
  Index batched() const { return LaneElement<E, M> ? Index(elements_.size()) / lane_count * lane_count : 0; }
  /// The element that is taken as number k. Those that meshes name one after the other share nodes, and lanes
  /// that add to one number wait for each other: of each lane_count² elements, a batch takes every
  /// lane_count-th.
  Index element_at(Index k) const {
    constexpr Index group = lane_count * lane_count;
    if (!LaneElement<E, M> || k >= Index(elements_.size()) / group * group) return k;
    const Index in_group = k % group;
    return k - in_group + in_group % lane_count * lane_count + in_group / lane_count;
  }
  /// The corners of each element by ascending node, and what its lane is made of.
  void order_corners() {
    const std::size_t n = elements_.size();
    order_.resize(n), nodes_.resize(n);
    lane_numbers_.clear();
    if constexpr (LaneElement<E, M>) lane_numbers_.resize(std::size_t(batched()) * E::lane_numbers);
    for (std::size_t k = 0; k < n; ++k) {
      const Index e = element_at(Index(k));
      const auto& t = mesh_.cells()[e];
      for (int a = 0; a < E::nodes; ++a) order_[k][a] = a;
      inner::sort(order_[k], [&](int a, int b) { return t[a] < t[b]; });
      for (int a = 0; a < E::nodes; ++a) nodes_[k][a] = t[order_[k][a]];
      if constexpr (LaneElement<E, M>)
        if (Index(k) < batched())
          elements_[e].enter_lane(
              order_[k], &lane_numbers_[k / lane_count * lane_count * E::lane_numbers + k % lane_count]);
    }
  }

  typename E::Corners corners(Index e, std::span<const Velocity> x) const {
    typename E::Corners at;
    for (int a = 0; a < E::nodes; ++a) at[a] = x[block_of(e, a)].template cast<double>();
    return at;
  }

  /// The elements that are taken as numbers e … e + lane_count − 1 at once.
  [[gnu::always_inline]] auto lanes_at(Index e, std::span<const Velocity> x) const {
    double places[E::nodes * 3 * lane_count];
    for (int l = 0; l < lane_count; ++l)
      for (int a = 0; a < E::nodes; ++a) {
        const Velocity& at = x[blocks_[nodes_[e + l][a]]];
        for (int k = 0; k < 3; ++k) places[(3 * a + k) * lane_count + l] = double(at[k]);
      }
    return E::lanes_at(material_, &lane_numbers_[std::size_t(e) * E::lane_numbers], places);
  }
  void make_element(Index e, std::span<const Velocity> x, bool with_stiffness, ElementMade<E>& made) const {
    const auto state = elements_[e].at(material_, corners(e, x));
    for (int a = 0; a < E::nodes; ++a) made.force[a] = state.force[a];
    if (!with_stiffness) return;
    const auto K = state.stiffness();
    const auto& order = order_[e];
    for (int k = 0; k < int(pairs_of_nodes<E::nodes>.size()); ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      made.K[k] = K.block(order[i], order[j]);
    }
  }
  void make_lanes(Index e, std::span<const Velocity> x, bool with_stiffness, LanesMade<E>& made) const {
    const auto state = lanes_at(e, x);
    for (int a = 0; a < E::nodes; ++a) made.force[a] = state.force[a];
    if (!with_stiffness) return;
    const auto K = state.stiffness();
#pragma GCC unroll 6
    for (int k = 0; k < int(pairs_of_nodes<E::nodes>.size()); ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      made.K[k] = K.block(i, j);
    }
  }

  Mesh mesh_;
  M material_{};
  Array<Index> blocks_;
  ArrayOrVector<E> elements_;
  Array<std::array<int, E::nodes>> order_;    ///< `element_at(k)`'s corners by ascending node
  Array<std::array<Index, E::nodes>> nodes_;  ///< these nodes
  Array<double> lane_numbers_;                ///< of whole lanes of elements
};

}  // namespace delassus::inner
