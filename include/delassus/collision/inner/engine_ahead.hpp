/// The part of the collision engine that looks ahead: pairs that are apart and meet within the step.
#pragma once

#include <delassus/collision/engine.hpp>

namespace delassus {

template <class Kernel, class Broad>
void CollisionEngine<Kernel, Broad>::keep_jobs_of_apart() {
  for (const Job& job : waiting_) worker_.apart_pairs.push_back({job, 0, zero<Vec3>()});
  waiting_.clear();
  const std::size_t known = jobs_.size();
  for (const inner::Apart& p : worker_.apart_pairs) {
    Job* const listed = job_of(p.job.pair, known);
    if (listed)
      listed->is_asked = true;
    else
      jobs_.push_back(Job{p.job, -1, true});
  }
  if (jobs_.size() > known) {
    inner::sort_and_merge(jobs_, known, merged_);
    slots_.assign(jobs_);
  }
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

template <class Kernel, class Broad>
void CollisionEngine<Kernel, Broad>::ask(inner::Slice<const Collider> colliders, const Job& job, Index listed,
                                         double h, const CollisionSettings& settings) {
  if (listed >= 0) jobs_[std::size_t(listed)].is_asked = true;
  if (!comes_near(colliders, job, h, settings)) {
    waiting_.push_back(job);
    return;
  }
  if (listed < 0) jobs_.push_back(Job{job, -1, true});
  worker_.apart_pairs.push_back({job, 0, zero<Vec3>()});
}

template <class Kernel, class Broad>
template <class Filter>
void CollisionEngine<Kernel, Broad>::find_outgrown(inner::Slice<const Collider> colliders, double h,
                                                   const CollisionSettings& settings, const Filter& filter) {
  const std::size_t known = jobs_.size();
  // Of an earlier call in this step; `merged_` has them by pair, for who is asked again below.
  merged_ = waiting_;
  inner::sort(merged_);
  waiting_.clear();
  inner::JobFinder finder(jobs_, known);
  for (const Job& job : merged_) ask(colliders, job, finder.find(job.pair), h, settings);
  is_grown_.resize(colliders.size());
  bool is_any = false;
  for (Index i = 0; i < Index(colliders.size()); ++i)
    is_any = (is_grown_[i] = outgrows(i, colliders[i], h, settings)) || is_any;
  if (is_any) {
    const auto see = [&](Index i, Index j) {
      const Collider &x = colliders[i], &y = colliders[j];
      const std::uint64_t pair = pair_key(x.key, y.key);
      const Index listed = finder.find(pair);
      if (listed >= 0 ? jobs_[std::size_t(listed)].is_asked : inner::is_listed(merged_, Job{{pair, i, j}}))
        return;
      if (!may_meet(x, y) || !filter.lets(pair)) return;
      ask(colliders, x.key < y.key ? Job{{pair, i, j}} : Job{{pair, j, i}}, listed, h, settings);
    };
    find_candidates();
    for (const CandidatePair& p : pairs_)
      if (is_grown_[p.i] || is_grown_[p.j]) see(p.i, p.j);
    for (const Index plane : half_spaces_) {
      const inner::PlaneReach reach(colliders[plane], h, settings);
      for (Index i = 0; i < Index(colliders.size()); ++i)
        if (is_grown_[i] && reach.may_touch(boxes_[i])) see(i, plane);
    }
  }
  if (jobs_.size() == known) return;
  inner::sort_and_merge(jobs_, known, merged_);
  slots_.assign(jobs_);
}

template <class Kernel, class Broad>
inner::Impact CollisionEngine<Kernel, Broad>::impact_of(const inner::Apart& p, const Collider& a, const Collider& b, double h) const {
  if (!inner::may_close(a, b, p.normal, p.distance, h)) return {};
  const double scale = std::min(summary_[p.job.a].scale, summary_[p.job.b].scale), near = worker_.meeting_distance(scale);
  if (!inner::may_come_near(a, b, h, near) || inner::stay_apart(a, b, p.normal, h, near)) return {};
  return inner::time_of_impact(a, b, h, scale, near, transposed_times(a.pose.rotation, p.normal));
}

template <class Kernel, class Broad>
template <class Filter>
void CollisionEngine<Kernel, Broad>::let_go_who_misses(std::span<const Collider> colliders, double h, const Filter& filter) {
  if constexpr (inner::KnowsWhoMisses<Filter>)
    for (inner::Apart& p : worker_.apart_pairs) {
      if (!p.is_foreseen) continue;
      const auto meets = [&](const Collider& a, const Collider& b) {
        const inner::Impact hit = impact_of(p, a, b, h);
        return hit.is_found || hit.is_now;
      };
      if (!filter.misses(p.job.pair, colliders[p.job.a], colliders[p.job.b], meets)) continue;
      p.is_foreseen = false;
      memory_of(p.job.pair).reset(p.job.pair);
    }
}

template <class Kernel, class Broad>
template <class Filter>
void CollisionEngine<Kernel, Broad>::detect_missed(std::span<const Collider> colliders, double h,
                                                   const CollisionSettings& settings,
                                                   std::vector<ContactPoint>& out, const Filter& filter) {
  out.clear();
  if (!knows_who_is_apart_) keep_jobs_of_apart();
  bool any_flies_by = false;
  flies_by_.resize(colliders.size());
  for (std::size_t i = 0; i < colliders.size(); ++i)
    any_flies_by =
        (flies_by_[i] = inner::flies_by(colliders[i], inner::top_speed(colliders[i]), h)) || any_flies_by;
  find_outgrown(colliders, h, settings, filter);
  worker_.scene = {colliders, summary_.data(), flies_by_.data(), h, settings};
  let_go_who_misses(colliders, h, filter);
  erase_if(worker_.apart_pairs, [&](const inner::Apart& p) {
    if (p.is_foreseen) return false;
    const Collider &a = colliders[p.job.a], &b = colliders[p.job.b];
    const double scale = std::min(summary_[p.job.a].scale, summary_[p.job.b].scale);
    const inner::Impact hit = impact_of(p, a, b, h);
    if (!hit.is_found) return false;
    RestingPair& now = memory_of(p.job.pair);
    if (a.is_movable && b.is_movable) {
      // Nearest points, where they are those that meet, have one place for both.
      const std::size_t known = out.size();
      worker_.scene.leaves_out = false;
      worker_.collide(Job{p.job}, now, filter, out);
      worker_.scene.leaves_out = true;
      if (out.size() > known && dot(hit.a.rotation * hit.normal_in_a, now.normal) > inner::same_normal)
        return true;
      while (out.size() > known) out.pop_back();
    }
    PairMemory last;
    last.copy(now);
    now.count = 0;
    const bool is_met = worker_.meet(a, b, Job{p.job}, hit, scale, last, now, out);
    now.see_if_plain();
    return is_met;
  });
  for (std::size_t k = 0; any_flies_by && k < jobs_.size(); ++k)
    if (slots_[jobs_[k].slot].count > 0)
      worker_.hold_cores(colliders[jobs_[k].a], colliders[jobs_[k].b], jobs_[k], out);
}

}  // namespace delassus
