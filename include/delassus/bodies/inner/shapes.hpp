/// The shapes of the bodies of a set, with hulls of their own.
#pragma once

#include <delassus/core/archive.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/shape.hpp>

#include <cstddef>
#include <type_traits>

namespace delassus::inner {

/// A hull is copied when its body is added and freed when it is taken out; no hull ever moves.
template <class Hull>
class BasicShapes {
 public:
  /// Gives block b a shape: a new block, or one that was dropped.
  void give(Index b, const Shape& shape) {
    if (std::size_t(b) >= shape_.size()) {
      shape_.resize(b + 1);
      hull_.resize(b + 1, -1);
    }
    shape_[b] = shape;
    if (!shape.hull) return;
    shape_[b].hull = nullptr;
    if (free_.empty()) {
      free_.push_back(Index(hulls_.size()));
      hulls_.emplace_back();
    }
    hull_[b] = free_.back();
    free_.pop_back();
    hulls_[hull_[b]] = shape.hull->centred();
  }

  void drop(Index b) {
    shape_[b] = {};
    if (hull_[b] < 0) return;
    hulls_[hull_[b]] = {};
    free_.push_back(hull_[b]);
    hull_[b] = -1;
  }

  ShapeKind kind(Index b) const { return shape_[b].kind; }
  Shape of(Index b) const {
    Shape shape = shape_[b];
    if (hull_[b] >= 0) shape.hull = &hulls_[hull_[b]];
    return shape;
  }

  void memory(auto& archive) {
    if constexpr (!leaves_shapes<std::remove_cvref_t<decltype(archive)>>) archive(shape_, hulls_, hull_, free_);
  }

 private:
  Array<Shape> shape_;  ///< without their hulls
  OwningArray<Hull> hulls_;
  Array<Index> hull_, free_;
};

using Shapes = BasicShapes<ConvexHull>;

}  // namespace delassus::inner
