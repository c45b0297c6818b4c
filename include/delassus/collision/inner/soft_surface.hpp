/// The outer surface of a deformable body: the triangles stay, the vertices are its nodes.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/geometry/inner/triangle_surface.hpp>
#include <delassus/geometry/outer_face.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace delassus::inner {

/// Made once a body, followed step by step: positions, normals and boxes, in the world. A triangle without
/// area has no normal and speaks for nothing. The sides of a sheet are apart but for their nodes: each node is
/// a vertex of either.
class SoftSurface : public TriangleSurface {
 public:
  template <class Mesh>
  SoftSurface(Index set, Index body, std::uint32_t number, const Mesh& mesh, std::span<const Index> blocks)
      : set_(set), body_(body), number_(number) {
    const Index nodes = Index(mesh.points.size());
    Array<Index> vertex(2 * nodes, -1);  // of the front, of the back
    for (const OuterFace& face : outer_faces(mesh)) {
      std::array<Index, 3> corners{};
      std::array<Vec3, 3> places;
      const auto& element = mesh.cells()[face.element];
      for (int k = 0; k < 3; ++k) {
        const Index node = face.triangle[k];
        Index& here = vertex[face.is_back ? nodes + node : node];
        if (here < 0) {
          here = Index(block_.size());
          front_.push_back(face.is_back ? vertex[node] : here);
          block_.push_back(blocks[node]);
          rest_.push_back(mesh.points[node]);
        }
        corners[k] = here;
        const int corner = int(std::find(element.begin(), element.end(), node) - element.begin());
        places[k] = place_of_corner(mesh, corner);
      }
      corners_.push_back(corners);
      places_.push_back(places);
      is_sheet_ = is_sheet_ || face.is_back;
      sums_to_one_.push_back(has_no_first_share<Mesh>(places) ? 1 : 0);
      element_.push_back(face.element);
      base_.push_back(blocks[element[0]]);
    }
    topology_ = SurfaceTopology(corners_, Index(block_.size()));
    vertices_ = rest_;
    velocities_.assign(block_.size(), zero<Vec3>());
    moves_.assign(block_.size(), 0);
    normals_.resize(corners_.size());
    outward_ = vertices_;
    find_normals();
    tree_.build(triangle_count(), [&](Index t) { return bounds_of(t); });
  }

  bool is_of(Index set, Index body, std::uint32_t number) const {
    return set_ == set && body_ == body && number_ == number;
  }
  Index set() const { return set_; }
  std::span<const Index> blocks() const { return block_; }

  /// Takes over where the nodes are now and how fast, and fits the tree, in time proportional to the
  /// triangles.
  template <class Set>
  void follow(const Set& nodes) {
    radius_ = nodes.shape(block_[0]).size[0];
    Vec3 mean = zero<Vec3>();
    is_sound_ = true;
    is_movable_ = false;
    for (std::size_t v = 0; v < block_.size(); ++v) {
      vertices_[v] = nodes.pose(block_[v]).position;
      velocities_[v] = nodes.velocity()[block_[v]].template cast<double>();
      moves_[v] = nodes.moves(block_[v]) ? 1 : 0;
      mean += velocities_[v] / double(block_.size());
      is_sound_ = is_sound_ && is_finite(vertices_[v]) && is_finite(velocities_[v]);
      is_movable_ = is_movable_ || moves_[v];
    }
    top_speed_ = inner_speed_ = 0;
    for (const Vec3& v : velocities_) {
      top_speed_ = std::max(top_speed_, norm(v));
      inner_speed_ = std::max(inner_speed_, norm(v - mean));
    }
    find_normals();
    refit();
  }

  /// It has two sides and nothing between them.
  bool is_sheet() const { return is_sheet_; }
  bool is_sound() const { return is_sound_; }
  bool is_movable() const { return is_movable_; }
  double radius() const { return radius_; }            ///< its thickness on the outer side, m
  double top_speed() const { return top_speed_; }      ///< of any node, m/s
  double inner_speed() const { return inner_speed_; }  ///< of any node against the mean of all, m/s
  double scale() const {  ///< largest half edge of the box around it, m
    const Vec3 size = bounds().high - bounds().low;
    return 0.5 * size[largest_entry(size)];
  }

  /// The vertex of the front that has the same node.
  Index front(Index v) const { return front_[v]; }
  /// The sum of the normals around a vertex.
  const Vec3& outward_at(Index v) const { return outward_[v]; }

  // --- a point on a triangle, by the shares of its corners -------------------------------------------------

  /// Shares w ≥ 0, Σ w = 1, of the point of triangle t next to x; a corner within 1e-6 is that corner.
  Vec3 shares(Index t, const Vec3& x) const {
    const auto [a, b, c] = points_of(t);
    const Vec3 area = cross(b - a, c - a);
    const double size2 = squared_norm(area);
    Vec3 w(-squared_norm(x - a), -squared_norm(x - b), -squared_norm(x - c));
    if (size2 > 0) {
      w = Vec3(dot(area, cross(c - b, x - b)), dot(area, cross(a - c, x - c)),
               dot(area, cross(b - a, x - a))) /
          size2;
      for (int k = 0; k < 3; ++k) w[k] = w[k] > 1e-6 ? w[k] : 0.0;
      w /= w[0] + w[1] + w[2];
      if (!(std::max({w[0], w[1], w[2]}) > 1 - 1e-6)) return w;
    }
    int nearest = 0;
    for (int k = 1; k < 3; ++k)
      if (w[k] > w[nearest]) nearest = k;
    return unit_axis(nearest);
  }
  Vec3 rest_point(Index t, const Vec3& w) const { return mix(rest_, t, w); }
  Vec3 velocity(Index t, const Vec3& w) const { return mix(velocities_, t, w); }
  bool moves(Index t, const Vec3& w) const {
    for (int k = 0; k < 3; ++k)
      if (w[k] > 0 && moves_[corners_[t][k]]) return true;
    return false;
  }
  Index block(Index t, int k) const { return block_[corners_[t][k]]; }

  /// A node, or a point of the element behind the triangle.
  Anchor anchor(Index t, const Vec3& w) const {
    for (int k = 0; k < 3; ++k)
      if (w[k] == 1) return {.set = set_, .block = block(t, k), .has_frame = false};
    Anchor out{.set = set_, .block = base_[t], .has_frame = false, .element = element_[t]};
    const auto& at = places_[t];
    for (int k = 0; k < 3; ++k) out.local += w[k] * at[k];
    // To the bit in the face, so that corners beside it have no share: where the corners that count agree,
    // and of tetrahedra also where the share of corner 0 is 1 less the others.
    const int some = w[0] > 0 ? 0 : 1;
    for (int i = 0; i < 3; ++i)
      if (at[some][i] == at[2][i] || w[2] == 0)
        if (at[some][i] == at[1][i] || w[1] == 0) out.local[i] = at[some][i];
    if (sums_to_one_[t]) out.local[2] = 1 - out.local[0] - out.local[1];
    return out;
  }

 private:
  /// Whether the face lies across from corner 0 of a tetrahedron.
  template <class Mesh>
  static bool has_no_first_share(const std::array<Vec3, 3>& places) {
    if constexpr (requires { Mesh::has_shares; })
      return std::all_of(places.begin(), places.end(), [](const Vec3& p) { return p[0] + p[1] + p[2] == 1; });
    return false;
  }
  void find_normals() {
    for (Vec3& o : outward_) set_zero(o);
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      const auto [a, b, c] = points_of(Index(t));
      normals_[t] = triangle_normal(a, b, c);
      for (const Index v : corners_[t]) outward_[v] += normals_[t];
    }
  }
  Vec3 mix(const std::vector<Vec3>& of, Index t, const Vec3& w) const {
    const auto& [a, b, c] = corners_[t];
    return w[0] * of[a] + w[1] * of[b] + w[2] * of[c];
  }

  Index set_, body_;
  std::uint32_t number_;                       ///< of the body
  Array<Index> block_;                   ///< of each vertex
  Array<Index> front_;                   ///< of each vertex
  std::vector<std::array<Vec3, 3>> places_;    ///< where they are in the element behind
  Array<char> sums_to_one_;              ///< across from corner 0 of a tetrahedron
  Array<Index> element_, base_;          ///< that element, and the block of its corner 0
  std::vector<Vec3> rest_, velocities_, outward_;
  Array<char> moves_;
  double radius_ = 0, top_speed_ = 0, inner_speed_ = 0;
  bool is_sheet_ = false, is_sound_ = true, is_movable_ = true;
};

}  // namespace delassus::inner
