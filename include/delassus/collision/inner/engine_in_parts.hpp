/// The part of the collision engine that several workers do: boxes, and the list of pairs.
#pragma once

#include <delassus/collision/engine.hpp>
#include <delassus/collision/inner/pairs_in_parts.hpp>
#include <delassus/core/ranges.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus {

template <class Kernel, class Broad>
template <class Filter>
void CollisionEngine<Kernel, Broad>::find_pairs_in_parts(inner::Slice<const Collider> colliders, double h,
                                                         const CollisionSettings& settings,
                                                         const Filter& filter) {
  constexpr Index least_boxes = 128, least_pairs = 512;
  const auto& with = inner::parts_of(filter);
  const inner::SharedSearch by{with.execution,
                               with.scratch.template get<inner::DetectionInParts<Kernel>>().search};
  const inner::SharedRanges ranges{by.execution};
  const Index count = Index(colliders.size());
  begin_search<Filter>(colliders.size());
  if constexpr (TaggedBroadPhase<Broad>) tags_.resize(colliders.size());
  ranges(count, least_boxes, [&](inner::Range range) {
    for (Index i = range.first; i < range.last; ++i) {
      look_at<Filter>(i, colliders[i], h, settings);
      if constexpr (TaggedBroadPhase<Broad>)
        tags_[i] = {.key = colliders[i].key, .is_movable = colliders[i].is_movable};
    }
  });
  for (Index i = 0; i < count; ++i)
    if (is_half_space(colliders[i])) half_spaces_.push_back(i);

  if constexpr (requires { broad_.find(boxes_, tags_, pairs_, by); })
    pairs_.clear(), broad_.find(boxes_, tags_, pairs_, by);
  else
    find_candidates();
  by.room.jobs.fill(jobs_, Index(pairs_.size()), least_pairs, by.execution,
                    [&](inner::Range range, Array<Job>& list) {
                      for (Index k = range.first; k < range.last; ++k)
                        add_job(colliders, pairs_[std::size_t(k)].i, pairs_[std::size_t(k)].j, filter, list);
                    });
  const std::size_t of_bodies = jobs_.size();
  list_at_planes(colliders, h, settings, by, jobs_,
                 [&](Index plane, const inner::PlaneReach& reach, Index i, Array<Job>& list) {
                   if (!boxes_[i].is_empty() && reach.may_touch(boxes_[i]))
                     add_job(colliders, plane, i, filter, list);
                 });
  inner::sort_and_merge(jobs_, of_bodies, merged_);

  const std::size_t known = jobs_.size();
  by.room.found.clear();
  by.room.places.fill(by.room.found, slots_.count(), least_pairs, by.execution,
                      [&](inner::Range range, Array<Index>& list) {
                        for (Index k = range.first; k < range.last; ++k)
                          if (has_impact(slots_.memory_of(k))) list.push_back(k);
                      });
  for (const Index k : by.room.found) add_job_of_impact(slots_.memory_of(k), known, colliders, filter);
  end_search<Filter>(known);
}

template <class Kernel, class Broad>
template <class By, class F>
void CollisionEngine<Kernel, Broad>::list_at_planes(inner::Slice<const Collider> colliders, double h,
                                                    const CollisionSettings& settings, const By& by,
                                                    Array<Job>& to, const F& f) {
  constexpr Index least = 512, most = Index(1) << 30;
  const Index count = Index(colliders.size()), planes = Index(half_spaces_.size());
  if (count == 0) return;
  const Index at_once = std::max(most / count, Index(1));
  for (Index first = 0; first < planes; first += at_once) {
    const Index last = std::min(planes, first + at_once);
    by.room.jobs.fill(to, (last - first) * count, least, by.execution,
                      [&](inner::Range range, Array<Job>& list) {
                        for (Index k = range.first; k < range.last;) {
                          const Index start = k / count * count, end = std::min(range.last, start + count),
                                      plane = half_spaces_[std::size_t(first + k / count)];
                          const inner::PlaneReach reach(colliders[plane], h, settings);
                          for (; k < end; ++k) f(plane, reach, k - start, list);
                        }
                      });
  }
}

}  // namespace delassus
