/// Of a patch with many corners the few that carry it, the same few as long as they do.
#pragma once

#include <delassus/collision/pair_memory.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>

namespace delassus::inner {

/// Chosen points of a patch, by index; one more than stay while they are chosen.
struct Choice {
  FixedArray<std::int8_t, PairMemory::capacity + 1> index{};
  int count = 0;

  void add(int i) { index[count++] = std::int8_t(i); }
  bool has(int i) const {
    for (int k = 0; k < count; ++k)
      if (index[k] == i) return true;
    return false;
  }
};

/// Twice the area spanned by the chosen points, seen along n: the sum over their hull, which few points make
/// cheap.
inline double spread(const Patch& patch, const Choice& c, const Vec3& n) {
  double area2 = 0;
  for (int i = 0; i < c.count; ++i)
    for (int j = 0; j < c.count; ++j) {
      const Vec3 &p = patch.point[c.index[i]].a, &q = patch.point[c.index[j]].a;
      bool is_hull_edge = i != j;
      for (int k = 0; k < c.count && is_hull_edge; ++k)
        is_hull_edge = k == i || k == j || dot(cross(q - p, patch.point[c.index[k]].a - p), n) >= 0;
      if (is_hull_edge) area2 += dot(cross(p, q), n);
    }
  return area2;
}

/// Adds the points farthest from all chosen ones until there are `limit`. Of a rim those equally far, on both sides of its lowest
/// point, come together, or none where there is no room: on one side alone they turn it. Squares of distances are rounded by some 1e-15.
inline void fill(const Patch& patch, int limit, bool is_of_rim, Choice& c) {
  while (c.count < limit) {
    Choice best;
    double best_distance = -1;
    for (int i = 0; i < patch.count; ++i) {
      if (c.has(i)) continue;
      double distance = std::numeric_limits<double>::infinity();
      for (int k = 0; k < c.count; ++k)
        distance = std::min(distance, squared_norm(patch.point[i].a - patch.point[c.index[k]].a));
      const bool is_equal = is_of_rim && std::abs(distance - best_distance) <= 1e-9 * best_distance;
      if (!is_equal && !(distance > best_distance)) continue;
      if (!is_equal) best_distance = distance, best.count = 0;
      if (best.count <= PairMemory::capacity) best.add(i);
    }
    if (best.count == 0 || (best.count > 1 && c.count + best.count > limit)) return;
    for (int k = 0; k < best.count; ++k) c.add(best.index[k]);
  }
}

/// The deepest point, the one farthest from it, and those farthest to either side of the line between them. Two of a rim that
/// are equally far come instead.
inline Choice choose_anew(const Patch& patch, const Vec3& n, int limit, bool is_of_rim) {
  Choice c;
  c.add(deepest(patch));
  fill(patch, 2, is_of_rim, c);
  const Vec3 &p = patch.point[c.index[0]].a, &q = patch.point[c.index[c.count - 1]].a;
  const Vec3 across = cross(n, q - p);
  for (const double side : {1.0, -1.0}) {
    int best = -1;
    double reach = 0;
    for (int i = 0; i < patch.count && c.count < limit; ++i) {
      const double r = side * dot(across, patch.point[i].a - p);
      if (!c.has(i) && r > reach) reach = r, best = i;
    }
    if (best >= 0) c.add(best);
  }
  fill(patch, limit, is_of_rim, c);
  return c;
}

/// Drops the chosen point that is nearest to another, the first of two.
inline void drop_crowded(const Patch& patch, Choice& c) {
  int crowded = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < c.count; ++i)
    for (int j = 0; j < c.count; ++j) {
      const double apart = squared_norm(patch.point[c.index[i]].a - patch.point[c.index[j]].a);
      if (i != j && apart < least) least = apart, crowded = i;
    }
  c.index[crowded] = c.index[--c.count];
}

inline void drop_highest(const Patch& patch, Choice& c) {
  int highest = 0;
  for (int k = 1; k < c.count; ++k)
    if (patch.point[c.index[k]].gap > patch.point[c.index[highest]].gap) highest = k;
  c.index[highest] = c.index[--c.count];
}

/// At most `limit` points. Last step's stay; when they miss the deepest by more than 5e-5 of the scale, it
/// takes the place of the highest, so that the two on which a round cap tips remain on either side of it.
/// The lowest point of a rim does so however little they miss: a body that rolls is held where it touches.
/// Where there is room for all eight corners of an octagon they stay, to the same 5e-5.
/// When they span less than 0.55 of what a new choice would (three corners of an octagon in a row and one
/// across span 0.6), all are chosen anew. A choice that changes every step makes a stack walk.
inline Choice reduce(const Patch& patch, const Continuation& continues, const Vec3& n, double scale,
                     int limit) {
  Choice kept;
  if (patch.count <= limit) {
    for (int i = 0; i < patch.count; ++i) kept.add(i);
    return kept;
  }
  const int lowest = deepest(patch);
  const bool is_of_rim = is_lowest_of_rim(patch.point[lowest].name),
             is_besides = is_of_rim && limit == PairMemory::capacity;
  if (is_besides) kept.add(lowest);
  for (int i = 0; i < patch.count && kept.count < limit + is_besides; ++i)
    if (continues.of[i] >= 0 && !kept.has(i)) kept.add(i);
  if (is_besides) {
    fill(patch, limit + 1, is_of_rim, kept);
    drop_crowded(patch, kept);
  }
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kept.count; ++k) least = std::min(least, patch.point[kept.index[k]].gap);
  const Choice anew = choose_anew(patch, n, limit, is_of_rim);
  const bool rolls_here = is_of_rim && !is_besides;
  if (rolls_here ? !kept.has(lowest) : !(least <= patch.point[lowest].gap + 5e-5 * scale)) {
    if (kept.count == limit) drop_highest(patch, kept);
    kept.add(lowest);
  }
  fill(patch, limit, is_of_rim, kept);
  return spread(patch, kept, n) >= 0.55 * spread(patch, anew, n) ? kept : anew;
}

}  // namespace delassus::inner
