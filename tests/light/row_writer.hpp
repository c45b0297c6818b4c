/// What a law writes its linearisation with: the number of its rows is all that the type knows.
#pragma once

#include "rows.hpp"
#include "world_view.hpp"

namespace light {

/// One end of an item: the blocks that move one material point.
template <int R, class T>
class RowEnd {
 public:
  RowEnd(const WorldView<T>& world, Rows<T>& rows, const Anchor& anchor, const Vec3& point)
      : world_(world), rows_(rows), anchor_(anchor), point_(point), first_(Index(rows.entries.size())) {
    if (anchor.set < 0) return;
    const SetView<T>& s = world.of(anchor);
    count_ = s.table->anchor_blocks(s.set, anchor);
    for (int k = 0; k < count_; ++k) {
      const Index b = s.table->anchor_block(s.set, anchor, k), place = Index(rows.H.size());
      const int width = s.table->width;
      rows.entries.push_back(
          {s.first_block + b, s.first_velocity + width * b, place, int(anchor.set), width});
      rows.H.resize(rows.H.size() + std::size_t(R) * width, T(0));
    }
  }

  /// u_k += direction · v(point).
  void along(int k, const Vec3& direction) { add(k, &direction, 1); }
  /// The first n rows see it along the rows of `axes`, times `sign`: one call for all of them.
  template <int n>
  void along(const Mat<n, 3>& axes, double sign) {
    Vec3 directions[n];
    for (int k = 0; k < n; ++k) directions[k] = {sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2)};
    add(0, directions, n);
  }
  void along_axes(double sign) {
    const Vec3 directions[] = {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}};
    add(0, directions, 3);
  }
  /// u_k += axis · ω.
  void about(int k, const Vec3& axis) {
    for (int b = 0; b < count_; ++b) set().table->about(set().set, anchor_, b, axis, R, H(b) + k);
  }

 private:
  void add(int k, const Vec3* directions, int n) {
    for (int b = 0; b < count_; ++b)
      set().table->along(set().set, anchor_, b, point_, directions, n, R, H(b) + k);
  }
  const SetView<T>& set() const { return world_.of(anchor_); }
  T* H(int b) { return rows_.H.data() + rows_.entries[std::size_t(first_ + b)].place; }

  const WorldView<T>& world_;
  Rows<T>& rows_;
  const Anchor& anchor_;
  Vec3 point_;
  Index first_;
  int count_ = 0;
};

/// Writes H, φ and springs of the item that was opened last.
template <int R, class T>
class RowWriter {
 public:
  RowWriter(const WorldView<T>& world, Rows<T>& rows)
      : world_(world), rows_(rows), first_(rows.count() - R) {}

  RowEnd<R, T> end(const Anchor& anchor, const Vec3& point) { return {world_, rows_, anchor, point}; }
  void phi(int k, double value) { rows_.phi[first_ + k] = T(value); }
  void soft(int k, double stiffness, double damping) {
    rows_.stiffness[first_ + k] = T(stiffness);
    rows_.damping[first_ + k] = T(damping);
  }

 private:
  const WorldView<T>& world_;
  Rows<T>& rows_;
  Index first_;
};

}  // namespace light
