/// What the contacts of a patch stand for: each an equal share of its area.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/contact_area.hpp>
#include <delassus/core/slice.hpp>

#include <cstddef>
#include <vector>

namespace delassus::inner {

/// Shares the area among contacts of one patch. The middles of the shares are about that of the area as the contacts are about
/// theirs, at its mean distance.
inline void share_area(const ContactArea& area, Slice<ContactPoint> contacts) {
  const double count = double(contacts.size());
  Vec3 centre = zero<Vec3>();
  for (const ContactPoint& p : contacts) centre += p.point() / count;
  double distance = 0;
  for (const ContactPoint& p : contacts) distance += norm(p.point() - centre) / count;
  for (ContactPoint& p : contacts) {
    p.area = area.size / count;
    p.middle = area.middle + area.mean_distance / distance * (p.point() - centre);
  }
}
/// The area, in the frame of A, among the last `count` contacts, where these are a patch.
inline void share_area(const ContactArea& area, const Pose& a, int count, std::vector<ContactPoint>& out) {
  if (count < 3 || !(area.size > 0)) return;
  share_area({area.size, a.to_world(area.middle), area.mean_distance}, {out.data() + out.size() - std::size_t(count), std::size_t(count)});
}

}  // namespace delassus::inner
