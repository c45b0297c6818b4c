/// A surface given by its heights over a rectangular grid.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>
#include <delassus/geometry/triangle.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace delassus {

/// `columns` × `rows` heights, m, a row along x after the other along y; the grid's middle is at the origin
/// and its points are `dx` and `dy` apart, m. Each cell is two triangles, parted from its first corner to the
/// opposite one; the solid is below.
class HeightField {
 public:
  HeightField() = default;  ///< no point, until `memory` reads one
  /// Refuses less than 2 × 2 points, a wrong number of heights, and spacings that are not > 0. Refuses heights that
  /// are not finite, or so steep that a triangle is flatter than 1e-6 of its longest edge.
  HeightField(Index columns, Index rows, double dx, double dy, std::span<const double> heights)
      : columns_(columns), rows_(rows), dx_(dx), dy_(dy), heights_(heights.begin(), heights.end()) {
    DELASSUS_EXPECT(columns >= 2 && rows >= 2, "a height field of " + std::to_string(columns) + " x " +
                                                   std::to_string(rows) +
                                                   " points has no cell; give at least 2 x 2");
    DELASSUS_EXPECT(
        std::isfinite(dx) && dx > 0 && std::isfinite(dy) && dy > 0,
        "height field: spacing (" + inner::text(dx) + ", " + inner::text(dy) + ") m must be finite and > 0");
    DELASSUS_EXPECT(heights.size() == std::size_t(columns) * std::size_t(rows),
                    "height field: got " + std::to_string(heights.size()) + " heights for " +
                        std::to_string(columns) + " x " + std::to_string(rows) + " points");
    for (std::size_t i = 0; i < heights.size(); ++i)
      DELASSUS_EXPECT(std::isfinite(heights[i]),
                      "height field: height #" + std::to_string(i) + " is not finite");
    for (Index t = 0; t < triangle_count(); ++t)
      DELASSUS_EXPECT(squared_norm(normal(t)) > 0.5, "height field: triangle #" + std::to_string(t) +
                                                            " is flatter than 1e-6 of its longest edge");
    tree_.build(cell_count(), [&](Index c) { return cell_bounds(c); });
  }

  Index triangle_count() const { return 2 * cell_count(); }  ///< two for each cell
  inner::Bounds bounds() const { return tree_.bounds(); }  ///< of all points, m
  /// Column along x, row along y; m.
  Vec3 point(Index column, Index row) const {
    return {(column - 0.5 * (columns_ - 1)) * dx_, (row - 0.5 * (rows_ - 1)) * dy_,
            heights_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)]};
  }

  /// Triangles 2c and 2c + 1 lie in cell c; cells are counted along x, then along y.
  Triangle triangle(Index t) const {
    Triangle out{.point = points_of(t), .normal = normal(t)};
    const auto grid = corners(t);
    for (int k = 0; k < 3; ++k) out.corner[k] = grid[k][1] * columns_ + grid[k][0];
    inner::find_leans(*this, t, out);
    return out;
  }

  // --- what another surface asks, as of a TriangleMesh; vertex row * columns + column
  // -----------------------

  static constexpr Index triangles_per_item = 2;  ///< an item of `tree` is a cell
  const inner::FlatTree& tree() const { return tree_; }  ///< of the boxes of the cells
  Vec3 vertex(Index v) const { return point(v % columns_, v / columns_); }  ///< by its number, m
  /// The corners of triangle t, counter-clockwise seen from above, m.
  std::array<Vec3, 3> points_of(Index t) const {
    const auto [a, b, c] = corners(t);
    return {point(a[0], a[1]), point(b[0], b[1]), point(c[0], c[1])};
  }
  /// Of triangle t, unit, upward.
  Vec3 normal(Index t) const {
    const auto [a, b, c] = points_of(t);
    return inner::triangle_normal(a, b, c);
  }
  /// Whether corner k is counted with triangle t: of those around a vertex one owns it.
  bool owns_corner(Index t, int k) const {
    const auto [i, j] = corners(t)[k];
    const Index before = (j - 1) * (columns_ - 1);
    if (j > 0) return t == (i > 0 ? 2 * (before + i - 1) : 2 * before + 1);
    return t == (i > 0 ? 2 * (i - 1) : 0);
  }
  /// Whether edge k is counted with triangle t: of the two beside it the one of lower number owns it.
  bool owns_edge(Index t, int k) const {
    const Index other = neighbour(t, k);
    return other < 0 || t < other;
  }
  /// f(u) for every vertex u that an edge joins to vertex v.
  template <class F>
  void each_around(Index v, const F& f) const {
    constexpr Index step[6][2]{{1, 0}, {0, 1}, {1, 1}, {-1, 0}, {0, -1}, {-1, -1}};
    for (const auto& [di, dj] : step) {
      const Index i = v % columns_ + di, j = v / columns_ + dj;
      if (i >= 0 && j >= 0 && i < columns_ && j < rows_) f(j * columns_ + i);
    }
  }

  /// The triangle across edge k, −1 at the border.
  Index neighbour(Index t, int k) const {
    const auto [i, j] = cell(t / 2);
    const auto triangle_in = [&](Index column, Index row, int which) {
      if (column < 0 || row < 0 || column >= columns_ - 1 || row >= rows_ - 1) return Index(-1);
      return 2 * (row * (columns_ - 1) + column) + which;
    };
    if (t % 2 == 0) return k == 0 ? triangle_in(i, j - 1, 1) : k == 1 ? triangle_in(i + 1, j, 1) : t + 1;
    return k == 0 ? t - 1 : k == 1 ? triangle_in(i, j + 1, 0) : triangle_in(i - 1, j, 0);
  }

  /// Calls visit(t) for the triangles in every leaf of the tree whose box passes `meets(bounds)`.
  template <class Meets, class Visit>
  void visit(const Meets& meets, const Visit& visit) const {
    tree_.visit(meets, [&](Index cell) {
      visit(2 * cell);
      visit(2 * cell + 1);
    });
  }

  void memory(auto& archive) { archive(columns_, rows_, dx_, dy_, heights_, tree_); }

 private:
  using GridPoint = std::array<Index, 2>;

  Index cell_count() const { return (columns_ - 1) * (rows_ - 1); }
  GridPoint cell(Index c) const { return {c % (columns_ - 1), c / (columns_ - 1)}; }

  /// The lower triangle of a cell (even) runs along x first, the upper one (odd) along the diagonal.
  std::array<GridPoint, 3> corners(Index t) const {
    const auto [i, j] = cell(t / 2);
    if (t % 2 == 0) return {GridPoint{i, j}, {i + 1, j}, {i + 1, j + 1}};
    return {GridPoint{i, j}, {i + 1, j + 1}, {i, j + 1}};
  }

  inner::Bounds cell_bounds(Index c) const {
    const auto [i, j] = cell(c);
    inner::Bounds b;
    for (const Index di : {0, 1})
      for (const Index dj : {0, 1}) b.add(point(i + di, j + dj));
    return b;
  }

  Index columns_ = 1, rows_ = 1;
  double dx_ = 1, dy_ = 1;
  std::vector<double> heights_;
  inner::FlatTree tree_;
};

}  // namespace delassus
