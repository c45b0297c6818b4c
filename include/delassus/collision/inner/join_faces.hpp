/// Of parts of a body that lie side by side on another: the one face that they are together.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/contact_area.hpp>
#include <delassus/collision/inner/flat_hull.hpp>
#include <delassus/collision/inner/share_area.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace delassus::inner {

/// Where faces of parts adjoin in one plane, the gap is linear over all of them: the corners of their common hull hold the
/// bodies apart as all corners do, and no load can gather where the parts meet, inside. The area of all is shared among them.
/// Feet that stand apart keep their own corners. Its arrays keep their capacity.
class JoinedFaces {
 public:
  void clear() { parts_.clear(); }
  /// That the contact behind those that were named is of these two colliders, 0 of a body without parts.
  void name(std::uint32_t part_a, std::uint32_t part_b) { parts_.push_back(std::uint64_t(part_a) << 32 | part_b); }

  /// Drops what lies inside. All contacts have been named.
  void join(std::vector<ContactPoint>& contacts) {
    order_.clear();
    for (Index i = 0; i < Index(contacts.size()); ++i)
      if (parts_[i] != 0 && contacts[i].area > 0) order_.push_back(i);
    inner::sort(order_, [&](Index i, Index j) {
      const ContactPoint &p = contacts[i], &q = contacts[j];
      return p.pair != q.pair ? p.pair < q.pair : parts_[i] != parts_[j] ? parts_[i] < parts_[j] : p.feature < q.feature;
    });
    const auto is_of_pair = [&](std::size_t k, std::size_t first) { return contacts[order_[k]].pair == contacts[order_[first]].pair; };
    bool is_dropped = false;
    for (std::size_t first = 0, last; first < order_.size(); first = last) {
      for (last = first; last < order_.size() && is_of_pair(last, first); ++last) {}
      if (parts_[order_[first]] != parts_[order_[last - 1]]) is_dropped = join_pair(contacts, first, last) || is_dropped;
    }
    if (is_dropped) std::erase_if(contacts, [](const ContactPoint& p) { return p.a < 0; });
  }

 private:
  struct Face {
    Index first, last;  ///< in `order_`
    bool is_taken;
  };

  /// Whether some of its contacts, order_[first] … order_[last − 1], were marked by a < 0.
  bool join_pair(std::vector<ContactPoint>& contacts, std::size_t first, std::size_t last) {
    faces_.clear();
    for (std::size_t from = first, to; from < last; from = to) {
      for (to = from; to < last && parts_[order_[to]] == parts_[order_[from]]; ++to) {}
      faces_.push_back({Index(from), Index(to), false});
    }
    bool is_dropped = false;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].is_taken) continue;
      const Vec3 n = contacts[order_[faces_[f].first]].normal;
      flat_.project(Index(last), [&](Index k) -> Vec3 { return contacts[order_[k]].point(); }, n);
      collect(contacts, f, n);
      if (together_.size() > 1) is_dropped = keep_hull(contacts) || is_dropped;
    }
    return is_dropped;
  }

  /// Fills `together_` with the face f and all that adjoin it, or each other.
  void collect(const std::vector<ContactPoint>& contacts, std::size_t f, const Vec3& n) {
    together_.clear();
    const auto take = [&](std::size_t i) { faces_[i].is_taken = true, together_.push_back(Index(i)); };
    take(f);
    for (std::size_t k = 0; k < together_.size(); ++k)
      for (std::size_t i = f + 1; i < faces_.size(); ++i)
        if (!faces_[i].is_taken && dot(contacts[order_[faces_[i].first]].normal, n) >= 1 - 1e-8 &&
            adjoin(contacts, faces_[together_[k]], faces_[i]))
          take(i);
  }

  bool adjoin(const std::vector<ContactPoint>& contacts, const Face& f, const Face& g) {
    return has_corner_on(contacts, f, g) || has_corner_on(contacts, g, f);
  }
  bool has_corner_on(const std::vector<ContactPoint>& contacts, const Face& f, const Face& g) {
    list_.clear();
    double area = 0;
    for (Index k = g.first; k < g.last; ++k) list_.push_back(k), area += contacts[order_[k]].area;
    const Array<Index>& corners = flat_.find(list_, 0);
    for (Index k = f.first; k < f.last && corners.size() > 2; ++k)
      if (flat_.outside(k, corners) <= 1e-5 * std::sqrt(area)) return true;
    return false;
  }

  /// Marks what is inside, and shares the area among the others. False, and nothing done, where the gap is not linear.
  bool keep_hull(std::vector<ContactPoint>& contacts) {
    ContactArea all;
    list_.clear();
    for (const Index f : together_)
      for (Index k = faces_[f].first; k < faces_[f].last; ++k) {
        const ContactPoint& p = contacts[order_[k]];
        list_.push_back(k);
        all.size += p.area;
        all.middle += p.area * p.middle;
      }
    all.middle /= all.size;
    const double scale = std::sqrt(all.size);
    const Array<Index>& corners = flat_.find(list_, 1e-6 * scale);
    if (corners.size() < 3 || !is_linear(contacts, corners, 1e-6 * scale)) return false;
    kept_.clear();
    corners_ = corners;
    for (const Index k : corners_) kept_.push_back(contacts[order_[k]]);
    for (const Index f : together_) all.mean_distance += distances(contacts, faces_[f], all.middle) / all.size;
    share_area(all, {kept_.data(), kept_.size()});
    for (const Index f : together_)
      for (Index k = faces_[f].first; k < faces_[f].last; ++k) contacts[order_[k]].a = -1;
    for (std::size_t k = 0; k < kept_.size(); ++k) contacts[order_[corners_[k]]] = kept_[k];
    return true;
  }

  /// ∫ |x − middle| dA over a face, m³: of the polygon of its contacts where they are all of its corners, else by the shares.
  double distances(const std::vector<ContactPoint>& contacts, const Face& face, const Vec3& middle) {
    list_.clear();
    double area = 0, of_shares = 0;
    for (Index k = face.first; k < face.last; ++k) {
      const ContactPoint& p = contacts[order_[k]];
      list_.push_back(k);
      area += p.area;
      of_shares += p.area * norm(p.middle - middle);
    }
    const Array<Index>& corners = flat_.find(list_, 0);
    AreaSum sum(contacts[order_[face.first]].normal, middle);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3 p = contacts[order_[corners[k]]].point(), q = contacts[order_[corners[k + 1 < corners.size() ? k + 1 : 0]]].point();
      sum.add_size(p, q);
      sum.add_distance(p, q);
    }
    return std::abs(sum.size() - area) <= 1e-4 * area ? sum.distance() : of_shares;
  }

  /// Whether the gaps of `list_` are those of a plane through three corners far from each other, to `most` m.
  bool is_linear(const std::vector<ContactPoint>& contacts, const Array<Index>& corners, double most) const {
    const auto at = [&](Index k) -> const ContactPoint& { return contacts[order_[k]]; };
    const Vec3 n = at(corners[0]).normal, from = at(corners[0]).point();
    const auto arm = [&](Index k) { return Vec3(at(k).point() - from - dot(n, at(k).point() - from) * n); };
    Index second = corners[0], third = corners[0];
    double reach = 0, height = 0;
    for (const Index k : corners)
      if (norm(arm(k)) > reach) reach = norm(arm(k)), second = k;
    const Vec3 x = arm(second);
    for (const Index k : corners)
      if (norm(cross(x, arm(k))) > height) height = norm(cross(x, arm(k))), third = k;
    const Vec3 y = arm(third), normal = cross(x, y);
    const double size = squared_norm(normal), gap = at(corners[0]).gap;
    if (!(size > 0)) return false;
    for (const Index k : list_) {
      const double along_x = dot(cross(arm(k), y), normal) / size, along_y = dot(cross(x, arm(k)), normal) / size;
      const double linear = gap + along_x * (at(second).gap - gap) + along_y * (at(third).gap - gap);
      if (!(std::abs(at(k).gap - linear) <= most)) return false;
    }
    return true;
  }

  FlatHull flat_;
  Array<std::uint64_t> parts_;
  Array<Index> order_, list_, together_, corners_;
  Array<Face> faces_;
  std::vector<ContactPoint> kept_;
};

}  // namespace delassus::inner
