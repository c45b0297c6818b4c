/// Where friction of a patch acts: nearer to the middle than the corners that carry the load.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/step/contact_memory.hpp>
#include <delassus/step/contact_result.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {

/// A patch is touched by its corners P_i, which carry λ_i, and brakes a spin with the moment μ Σ λ_i D, D being the mean
/// distance of its area from its middle m. So friction acts at
///
///   c + f (P_i − c),   c = Σ λ_i P_i / Σ λ_i,   f = D Σ λ_i / Σ λ_i |P_i − m|,
///
/// with the λ_i of the last step, or the areas where nothing pushed, and no farther from c than the farthest corner. (f is
/// above 1 where the inner corners of several parts carry more than their share.) What one corner carries alone acts there. Contacts of a
/// pair with areas and normals within 5° are one patch, as those of the parts of a compound. Two contacts are none. A patch
/// that hardly rubs is left as it is, so that what rests is solved as points are.
template <class Scalar>
class BasicFrictionPlaces {
 public:
  using Memory = BasicContactMemory<Scalar>;

  /// Fills `friction_arm` of the results, which belong to the points, both by pair and then by feature.
  void find(inner::Slice<const ContactPoint> points, inner::Slice<ContactResult> results, const Memory& memory) {
    make_room(points.size());
    for (std::size_t first = 0, last; first < points.size(); first = last) {
      double least = points[first].gap;
      for (last = first; last < points.size() && points[last].pair == points[first].pair; ++last)
        least = std::min(least, points[last].gap);
      rest_.clear();
      for (std::size_t i = first; i < last; ++i)
        if (is_touched(points[i], least)) rest_.push_back(Index(i));
      if (rest_.size() < 3) continue;
      const inner::Slice<const typename Memory::Entry> remembered = memory.of_pair(points[first].pair);
      while (!rest_.empty()) {
        split_patch(points);
        if (patch_.size() < 3) continue;
        if (weigh(points, remembered)) place(points, results);
      }
    }
  }

 private:
  /// For a pair that has all contacts: as seldom as there are more of them than ever.
  void make_room(std::size_t contacts) {
    if (weight_.capacity() >= contacts) return;
    rest_.reserve(2 * contacts);
    patch_.reserve(2 * contacts);
    weight_.reserve(2 * contacts);
  }

  /// What hangs above the deepest point of the pair bears nothing.
  static bool is_touched(const ContactPoint& p, double least) {
    return p.area > 0 && p.gap - least <= 5e-3 * std::sqrt(p.area);
  }

  /// Moves the first of `rest_`, and all whose normals are near its own, into `patch_`.
  void split_patch(inner::Slice<const ContactPoint> points) {
    const Vec3& n = points[rest_[0]].normal;
    patch_.clear();
    std::size_t left = 0;
    for (const Index i : rest_)
      if (dot(points[i].normal, n) >= 0.9962) patch_.push_back(i);
      else rest_[left++] = i;
    rest_.resize(left);
  }

  /// The shares of the load. False of a patch that pushed and whose friction, as a whole, was less than 1e-3 of the load: it
  /// sticks, wherever friction acts. (That of its corners may press against each other.)
  bool weigh(inner::Slice<const ContactPoint> points, inner::Slice<const typename Memory::Entry> remembered) {
    Scalar sum = 0, moment = 0, reach = 0;
    Vec3 friction = zero<Vec3>(), loaded = zero<Vec3>();
    const Vec3 n = points[patch_[0]].normal, from = points[patch_[0]].point();
    weight_.clear();
    auto at = remembered.begin();
    for (const Index i : patch_) {
      while (at != remembered.end() && at->feature < points[i].feature) ++at;
      const bool is_known = at != remembered.end() && at->feature == points[i].feature;
      const Scalar load = is_known ? std::max(Scalar(0), dot(at->impulse, points[i].normal)) : Scalar(0);
      const Vec3 arm = points[i].point() - from;
      if (is_known) friction += at->impulse - load * n, moment += dot(n, cross(arm, at->impulse));
      loaded += load * arm;
      reach = std::max(reach, norm(arm));
      weight_.push_back(load);
      sum += load;
    }
    if (sum > 0) {
      moment -= dot(n, cross(loaded / sum, friction));
      if (norm(friction) <= Scalar(1e-3) * sum && std::abs(moment) <= Scalar(1e-3) * sum * reach) return false;
    }
    if (!(sum > 0)) {
      for (std::size_t k = 0; k < patch_.size(); ++k) weight_[k] = points[patch_[k]].area, sum += weight_[k];
    }
    for (Scalar& w : weight_) w /= sum;
    return true;
  }

  void place(inner::Slice<const ContactPoint> points, inner::Slice<ContactResult> results) const {
    const Vec3& n = points[patch_[0]].normal;
    const auto across = [&](const Vec3& x) { return Vec3(x - dot(n, x) * n); };
    double area = 0, of_area = 0, of_corners = 0;
    Vec3 middle = zero<Vec3>(), loaded = zero<Vec3>();
    for (std::size_t k = 0; k < patch_.size(); ++k) {
      const ContactPoint& p = points[patch_[k]];
      area += p.area;
      middle += p.area * p.middle;
      loaded += weight_[k] * p.point();
    }
    middle /= area;
    for (std::size_t k = 0; k < patch_.size(); ++k) {
      const ContactPoint& p = points[patch_[k]];
      of_area += p.area / area * norm(across(p.middle - middle));
      of_corners += weight_[k] * norm(across(p.point() - middle));
    }
    if (!(of_corners > 0)) return;
    const double f = of_area / of_corners;
    double farthest = 0;
    for (const Index i : patch_) farthest = std::max(farthest, norm(across(points[i].point() - loaded)));
    for (const Index i : patch_) {
      const Vec3 from = across(points[i].point() - loaded);
      const double way = norm(from), factor = f * way <= farthest ? f : farthest / way;
      results[i].record.friction_arm = (factor - 1) * from;
    }
  }

  Array<Index> rest_, patch_;
  Array<Scalar> weight_;
};

}  // namespace delassus
