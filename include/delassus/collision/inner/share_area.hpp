/// What the contacts of a patch stand for: each an equal share of its area.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/contact_area.hpp>

#include <cstddef>
#include <vector>

namespace delassus::inner {

/// Shares the area, in the frame of A, among the last `count` contacts. The middles of the shares are about that of the
/// area as the contacts are about theirs, at its mean distance.
inline void share_area(const ContactArea& area, const Pose& a, int count, std::vector<ContactPoint>& out) {
  if (count < 3 || !(area.size > 0)) return;
  ContactPoint* const first = out.data() + out.size() - std::size_t(count);
  Vec3 centre = zero<Vec3>();
  for (int k = 0; k < count; ++k) centre += first[k].point() / count;
  double distance = 0;
  for (int k = 0; k < count; ++k) distance += norm(first[k].point() - centre) / count;
  const Vec3 middle = a.to_world(area.middle);
  for (int k = 0; k < count; ++k) {
    first[k].area = area.size / count;
    first[k].middle = middle + area.mean_distance / distance * (first[k].point() - centre);
  }
}

}  // namespace delassus::inner
