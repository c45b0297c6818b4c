/// The part of the engine that looks ahead, by several workers: who goes farther than detection took into
/// account.
#pragma once

#include <delassus/collision/engine.hpp>
#include <delassus/collision/inner/engine_in_parts.hpp>
#include <delassus/collision/inner/pairs_in_parts.hpp>
#include <delassus/core/ranges.hpp>

#include <algorithm>
#include <atomic>

namespace delassus {

template <class Kernel, class Broad>
template <class Filter>
requires(inner::has_execution<Filter>()) void CollisionEngine<Kernel, Broad>::find_outgrown(
    inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
    const Filter& filter) {
  constexpr Index least_boxes = 256, least_pairs = 512;
  const auto& with = inner::parts_of(filter);
  const inner::SharedSearch by{with.execution,
                               with.scratch.template get<inner::DetectionInParts<Kernel>>().search};
  const inner::SharedRanges ranges{by.execution};
  const Index count = Index(colliders.size());
  const std::size_t known = jobs_.size();
  merged_ = waiting_;
  inner::sort(merged_);
  waiting_.clear();
  inner::JobFinder asked_before(jobs_, known);
  for (const Job& job : merged_) ask(colliders, job, asked_before.find(job.pair), h, settings);

  is_grown_.resize(colliders.size());
  std::atomic<bool> is_any{false};
  ranges(count, least_boxes, [&](inner::Range range) {
    bool is_one = false;
    for (Index i = range.first; i < range.last; ++i)
      is_one = (is_grown_[i] = outgrows(i, colliders[i], h, settings)) || is_one;
    if (is_one) is_any.store(true, std::memory_order_relaxed);
  });
  if (is_any) {
    // Who is to be asked: its place among the jobs in the place of a slot, and whether the two come near.
    auto& asked = by.room.asked;
    asked.clear();
    const auto see = [&](Index i, Index j, inner::JobFinder& finder, Array<Job>& list) {
      const Collider &x = colliders[i], &y = colliders[j];
      const std::uint64_t pair = pair_key(x.key, y.key);
      const Index at = finder.find(pair);
      const Job* const listed = at < 0 ? nullptr : &jobs_[std::size_t(at)];
      if (listed ? listed->is_asked
                 : inner::is_listed(merged_, Job{{pair, i, j}}))
        return;
      if (!may_meet(x, y) || !filter.lets(pair)) return;
      const Job job = x.key < y.key ? Job{{pair, i, j}, at} : Job{{pair, j, i}, at};
      list.push_back(job);
      list.back().is_asked = comes_near(colliders, job, h, settings);
    };
    if constexpr (requires { broad_.find(boxes_, tags_, pairs_, by); })
      pairs_.clear(), broad_.find(boxes_, tags_, pairs_, by);
    else
      find_candidates();
    by.room.jobs.fill(asked, Index(pairs_.size()), least_pairs, by.execution,
                      [&](inner::Range range, Array<Job>& list) {
                        inner::JobFinder finder(jobs_, known);
                        for (Index k = range.first; k < range.last; ++k) {
                          const CandidatePair& p = pairs_[std::size_t(k)];
                          if (is_grown_[p.i] || is_grown_[p.j]) see(p.i, p.j, finder, list);
                        }
                      });
    list_at_planes(colliders, h, settings, by, asked,
                   [&](Index plane, const inner::PlaneReach& reach, Index i, Array<Job>& list) {
                     inner::JobFinder finder(jobs_, known);
                     if (is_grown_[i] && reach.may_touch(boxes_[i])) see(i, plane, finder, list);
                   });
    for (const Job& one : asked) {
      const Job job{{one.pair, one.a, one.b}};
      if (one.slot >= 0) jobs_[std::size_t(one.slot)].is_asked = true;
      if (!one.is_asked) {
        waiting_.push_back(job);
        continue;
      }
      if (one.slot < 0) jobs_.push_back(Job{job, -1, true});
      worker_.apart_pairs.push_back({job, 0, zero<Vec3>()});
    }
  }
  if (jobs_.size() == known) return;
  inner::sort_and_merge(jobs_, known, merged_);
  slots_.assign(jobs_);
}

}  // namespace delassus
