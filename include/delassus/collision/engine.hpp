/// Collision detection: boxes, pairs, certified distances, patches, and points that keep their names.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/collision/inner/fallback_normal.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/resting_pair.hpp>
#include <delassus/collision/inner/share_area.hpp>
#include <delassus/collision/inner/snap_normal.hpp>
#include <delassus/collision/manifold.hpp>
#include <delassus/collision/pair_memory.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace delassus {

/// Asks `Kernel` for distances and `Broad` for pairs; everything else of a contact is decided here, the same
/// for all.
template <class Kernel, class Broad>
class CollisionEngine {
  static_assert(NarrowKernel<Kernel>, "delassus: a narrow kernel needs pair(a, b, b_in_a, margin, cache), which returns a SignedPair");
  static_assert(BroadPhase<Broad>, "delassus: a broad phase needs find(boxes, pairs); see collision/broad_phase.hpp");

 public:
  /// Contacts within the margin of the pairs that the filter lets, sorted by pair and then by feature; `out`
  /// is cleared first. h is the step, s.
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, const CollisionSettings& settings,
                         std::vector<ContactPoint>& out, const Filter& filter = {}) {
    out.clear();
    report_ = {};
    find_pairs(colliders, h, settings, filter);
    recall_pairs();
    for (std::size_t k = 0; k < jobs_.size(); ++k) collide(colliders, jobs_[k], h, settings, memory_[k], out);
    report_.points = Index(out.size());
    return report_;
  }


  Kernel& kernel() { return kernel_; }
  /// What outlives a step: with it restored, the next step is the same to the bit.
  void memory(auto& archive) { archive(memory_); }

 private:
  using RestingPair = inner::RestingPair;
  using Job = inner::PairJob;

  template <class Filter>
  void find_pairs(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                  const Filter& filter) {
    boxes_.resize(colliders.size());
    summary_.resize(colliders.size());
    half_spaces_.clear();
    pairs_.clear();
    jobs_.clear();
    for (Index i = 0; i < Index(colliders.size()); ++i) {
      DELASSUS_EXPECT(
          !colliders[i].shape.is_kept(),
          "a body has a mesh or a compound for its shape; put the WithMeshes{...} or WithCompounds{...} that "
          "keeps it around this loop's collision backend");
      summary_[i] = inner::summary_of(colliders[i]);
      if (is_half_space(colliders[i])) half_spaces_.push_back(i);
      boxes_[i] = inner::alarm_box(colliders[i], summary_[i], h, settings);
    }
    find_candidates(colliders);
    for (const CandidatePair& p : pairs_) add_job(colliders, p.i, p.j, filter);
    for (const Index plane : half_spaces_)
      for (Index i = 0; i < Index(colliders.size()); ++i)
        if (!boxes_[i].is_empty() && inner::may_touch(colliders[plane], boxes_[i], h, settings))
          add_job(colliders, plane, i, filter);
    inner::sort(jobs_);
    report_.pairs = Index(jobs_.size());
  }

  void find_candidates(inner::Slice<const Collider> colliders) {
    if constexpr (TaggedBroadPhase<Broad>) {
      tags_.clear();
      for (const Collider& c : colliders) tags_.push_back({.key = c.key, .is_movable = c.is_movable});
      broad_.find(boxes_, tags_, pairs_);
    } else {
      broad_.find(boxes_, pairs_);
    }
  }

  template <class Filter>
  void add_job(inner::Slice<const Collider> colliders, Index a, Index b, const Filter& filter) {
    const Collider &x = colliders[a], &y = colliders[b];
    const std::uint64_t pair = pair_key(x.key, y.key);
    if (!may_meet(x, y) || !filter.lets(pair)) return;
    if (x.key > y.key) std::swap(a, b);
    jobs_.push_back({pair, a, b});
  }

  /// Gives every pair of this step its place in the memory. Mostly the pairs are those of the last one, and
  /// stay.
  void recall_pairs();

  /// One pair, in the frame of A until its points are written: those of the last step where it rests, else in
  /// full.
  void collide(inner::Slice<const Collider> colliders, const Job& job, double h,
               const CollisionSettings& settings, RestingPair& pair, std::vector<ContactPoint>& out);

  /// Distance, patch, choice of points, names.
  void collide_in_full(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a, double scale,
                       double reach, double h, const CollisionSettings& settings, std::uint64_t shapes,
                       RestingPair& now, std::vector<ContactPoint>& out) {
    const RestingPair last = now;
    now = {};
    now.pair = job.pair;
    now.owner = last.owner;
    ++report_.queries;

    SignedPair r = measure(a, b, b_in_a, reach, scale, last, now);
    now.normal = a.pose.rotation * r.normal;
    if (r.status == PairStatus::far) return;
    const double margin =
        settings.contact_distance +
        inner::margin_along(a, b, now.normal, a.pose.to_world(r.point_a), scale, h, settings);
    if (r.distance > margin) return;
    if (!is_half_space(a) && !is_half_space(b))
      contact_patch(a.shape, b.shape, b_in_a, r, margin, scale, patch_);
    inner::name_points(patch_, last, b_in_a, transposed_times(a.pose.rotation, now.normal), scale,
                       settings.max_points, out.size(), out, now, [&](int i, std::uint32_t id) {
                         out.push_back(inner::contact_of(job, a.pose, patch_.point[i], now.normal,
                                                         settings.contact_distance, id));
                       });
    inner::share_area(now.area, a.pose, now.count, out);
    sort_last(now.count, out);
    now.keep(shapes, b_in_a, r.normal, margin);
  }

  static bool is_half_space(const Collider& c) { return c.shape.kind == ShapeKind::half_space; }

  /// The certified signed distance. Of a half-space the patch comes with it.
  SignedPair measure(const Collider& a, const Collider& b, const Pose& b_in_a, double reach, double scale,
                     const PairMemory& last, PairMemory& now) {
    if (is_half_space(a) || is_half_space(b)) {
      now.owner = is_half_space(a) ? inner::NormalOwner::a : inner::NormalOwner::b;
      return half_space_patch(a.shape, b.shape, b_in_a, reach, scale, patch_);
    }
    const Vec3 guess = transposed_times(a.pose.rotation, last.normal);
    // Centres in one point: the normal of B moved by 1e-4 of the size, far above what round shapes resolve. Along it B
    // is then put back, and the depth is within 4e-4 of the size of the least.
    const bool is_moved = is_zero(b_in_a.position) && is_zero(last.normal);
    Vec3 shift = zero<Vec3>();
    if (is_moved) shift = transposed_times(a.pose.rotation, 1e-4 * scale * inner::fallback_normal(a.key, b.key));
    const Pose pose{.position = b_in_a.position + shift, .rotation = b_in_a.rotation};
    const auto [answer, is_rejected] = certified_pair(kernel_, a.shape, b.shape, pose, reach, scale, guess);
    report_.rejects += is_rejected ? 1 : 0;
    SignedPair r = answer;
    if (is_moved) r.distance -= dot(r.normal, shift), r.point_b -= r.normal * dot(r.normal, shift);
    if (r.status == PairStatus::near)
      now.owner = inner::snap_normal_to_face(a.shape, b.shape, b_in_a, scale, last.owner, r);
    return r;
  }

  /// The last points by feature; they are few.
  static void sort_last(int count, std::vector<ContactPoint>& out) {
    ContactPoint* const first = out.data() + out.size() - count;
    for (int i = 1; i < count; ++i)
      for (int k = i; k > 0 && first[k].feature < first[k - 1].feature; --k) std::swap(first[k], first[k - 1]);
  }

  Kernel kernel_;
  Broad broad_;
  CollisionReport report_;
  Patch patch_;
  Array<Aabb> boxes_;
  Array<inner::Summary> summary_;
  Array<BoxTag> tags_;
  Array<Index> half_spaces_;
  std::vector<CandidatePair> pairs_;
  Array<Job> jobs_;
  Array<RestingPair> memory_, next_memory_;
  FixedArray<PatchPoint, PairMemory::capacity> repeated_;
};

template <class Kernel, class Broad>
void CollisionEngine<Kernel, Broad>::recall_pairs() {
  const auto is_of = [](const RestingPair& m, const Job& job) { return m.pair == job.pair; };
  if (std::equal(memory_.begin(), memory_.end(), jobs_.begin(), jobs_.end(), is_of)) return;
  next_memory_.clear();
  std::size_t last = 0;
  for (const Job& job : jobs_) {
    while (last < memory_.size() && memory_[last].pair < job.pair) ++last;
    if (last < memory_.size() && is_of(memory_[last], job))
      next_memory_.push_back(memory_[last]);
    else
      next_memory_.emplace_back().pair = job.pair;
  }
  memory_.swap(next_memory_);
  next_memory_.reserve(memory_.capacity());  // now, and not when the pairs change next in a warm step
}

template <class Kernel, class Broad>
void CollisionEngine<Kernel, Broad>::collide(inner::Slice<const Collider> colliders, const Job& job, double h,
                                             const CollisionSettings& settings, RestingPair& pair,
                                             std::vector<ContactPoint>& out) {
  const Collider &a = colliders[job.a], &b = colliders[job.b];
  const inner::Summary &of_a = summary_[job.a], &of_b = summary_[job.b];
  const Pose b_in_a = a.pose.to_local(b.pose);
  const double scale = std::min(of_a.scale, of_b.scale);
  const double reach =
      settings.contact_distance + inner::widest_margin(of_a.speed + of_b.speed, scale, h, settings);
  const std::uint64_t shapes = (of_a.shape * 3 + of_b.shape) * 11 + std::uint64_t(settings.max_points);
  Vec3 n;
  if (!pair.repeat(shapes, b_in_a, reach, scale, repeated_, n))
    return collide_in_full(a, b, job, b_in_a, scale, reach, h, settings, shapes, pair, out);
  pair.normal = a.pose.rotation * n;
  for (int k = 0; k < pair.count; ++k)
    out.push_back(inner::contact_of(job, a.pose, repeated_[k], pair.normal, settings.contact_distance,
                                    repeated_[k].name));
  inner::share_area(pair.area, a.pose, pair.count, out);
}

}  // namespace delassus
