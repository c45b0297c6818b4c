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

namespace inner {

/// Looks jobs up by their pairs, which are mostly asked in the order of the jobs.
class JobFinder {
 public:
  JobFinder(Array<ListedPair>& jobs, std::size_t count) : first_(jobs.data()), count_(count) {}
  /// −1 where there is none.
  Index find(std::uint64_t pair) {
    if (next_ == unknown || (next_ > 0 && !(first_[next_ - 1].pair < pair)))
      next_ = std::size_t(
          inner::lower_bound(first_, first_ + count_, pair,
                             [](const ListedPair& job, std::uint64_t key) { return job.pair < key; }) -
          first_);
    while (next_ < count_ && first_[next_].pair < pair) ++next_;
    return next_ < count_ && first_[next_].pair == pair ? Index(next_) : Index(-1);
  }

 private:
  static constexpr std::size_t unknown = std::size_t(-1);
  ListedPair* first_;
  std::size_t count_, next_ = unknown;
};

}  // namespace inner

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
  for (const Job& job : merged_) ask(colliders, job, job_of(job.pair, known), h, settings);

  is_grown_.resize(colliders.size());
  std::atomic<bool> is_any{false};
  ranges(count, least_boxes, [&](inner::Range range) {
    bool is_one = false;
    for (Index i = range.first; i < range.last; ++i)
      is_one = (is_grown_[i] = outgrows(i, colliders[i], h, settings)) || is_one;
    if (is_one) is_any.store(true, std::memory_order_relaxed);
  });
  if (is_any) {
    const auto& apart = worker_.apart_pairs;
    ranges(Index(apart.size()), least_pairs, [&](inner::Range range) {
      inner::JobFinder finder(jobs_, known);
      for (Index k = range.first; k < range.last; ++k)
        if (const Index listed = finder.find(apart[std::size_t(k)].job.pair); listed >= 0)
          jobs_[std::size_t(listed)].is_asked = true;
    });
    // Who is to be asked: its place among the jobs in the place of a slot, and whether the two come near.
    auto& asked = by.room.asked;
    asked.clear();
    const auto see = [&](Index i, Index j, inner::JobFinder& finder, Array<Job>& list) {
      const Collider &x = colliders[i], &y = colliders[j];
      const std::uint64_t pair = pair_key(x.key, y.key);
      const Index at = finder.find(pair);
      const Job* const listed = at < 0 ? nullptr : &jobs_[std::size_t(at)];
      if (listed ? listed->is_asked || slots_[listed->slot].count > 0
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

template <class Kernel, class Broad>
bool CollisionEngine<Kernel, Broad>::outgrows(Index i, const Collider& c, double h,
                                              const CollisionSettings& settings) {
  const double speed = inner::top_speed(c);
  if (boxes_[i].is_empty() || !std::isfinite(speed) ||
      speed * h <= 0.5 * inner::margin_share * summary_[i].scale)
    return false;
  inner::Summary now = summary_[i];
  now.speed = std::max(speed, now.speed);
  const Aabb box = inner::box_of_way(c, now, h, settings);
  if (speed * h <= inner::longest_way(summary_[i], h, settings) && boxes_[i].contains(box)) return false;
  summary_[i] = now;
  boxes_[i].extend(box);
  return true;
}

template <class Kernel, class Broad>
bool CollisionEngine<Kernel, Broad>::comes_near(inner::Slice<const Collider> colliders, const Job& job,
                                                double h, const CollisionSettings& settings) const {
  const double scale = std::min(summary_[job.a].scale, summary_[job.b].scale);
  return inner::may_come_near(colliders[job.a], colliders[job.b], h,
                              settings.contact_distance + inner::meeting_share * scale);
}

}  // namespace delassus
