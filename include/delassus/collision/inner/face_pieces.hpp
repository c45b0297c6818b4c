/// The pieces of a surface's triangles on which something lies, and the area of those in one plane.
#pragma once

#include <delassus/collision/contact_area.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

namespace delassus::inner {

/// Convex pieces, each with the normal of its triangle. A ring of them has a hole, which the hull of its corners has not.
class FacePieces {
 public:
  void clear() {
    pieces_.clear();
    corners_.clear();
  }
  /// Adds the piece with the corners `corner(0)` … `corner(count − 1)` in order, `gap` being the least there, m.
  template <class At>
  void add(int count, const At& corner, const Vec3& normal, double gap) {
    pieces_.push_back({Index(corners_.size()), Index(count), normal, gap});
    for (int k = 0; k < count; ++k) corners_.push_back(corner(k));
  }

  /// Of the pieces with normals within 5° of n and gaps up to `most`, seen along n.
  ContactArea area(const Vec3& n, double most) const {
    if (pieces_.empty()) return {};
    AreaSum sizes(n, corners_[0]);
    each_side_of(n, most, [&](double sign, const Vec3& p, const Vec3& q) { sizes.add_size(p, q, sign); });
    if (!(sizes.size() > 0)) return {};
    const Vec3 middle = sizes.middle();
    AreaSum distances(n, middle);
    each_side_of(n, most, [&](double sign, const Vec3& p, const Vec3& q) { distances.add_distance(p, q, sign); });
    return {sizes.size(), middle, distances.distance() / sizes.size()};
  }

 private:
  struct Piece {
    Index first, count;
    Vec3 normal;
    double gap;
  };

  /// f(±1, p, q), + where the piece runs counter-clockwise about n.
  template <class F>
  void each_side_of(const Vec3& n, double most, const F& f) const {
    for (const Piece& piece : pieces_) {
      if (!(dot(piece.normal, n) >= 0.9962 && piece.gap <= most)) continue;
      const Vec3* const corner = corners_.data() + piece.first;
      double turn = 0;
      for (Index k = 2; k < piece.count; ++k) turn += dot(n, cross(corner[k - 1] - corner[0], corner[k] - corner[0]));
      for (Index k = 0; k < piece.count; ++k) f(turn < 0 ? -1.0 : 1.0, corner[k], corner[k + 1 < piece.count ? k + 1 : 0]);
    }
  }

  Array<Piece> pieces_;
  Array<Vec3> corners_;
};

}  // namespace delassus::inner
