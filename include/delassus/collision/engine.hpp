/// Collision detection: boxes, pairs, certified distances, patches, and points that keep their names.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/gjk_epa.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/collision/inner/ahead.hpp>
#include <delassus/collision/inner/fallback_normal.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/one_point.hpp>
#include <delassus/collision/inner/pair_slots.hpp>
#include <delassus/collision/inner/resting_pair.hpp>
#include <delassus/collision/inner/share_area.hpp>
#include <delassus/collision/inner/snap_normal.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/manifold.hpp>
#include <delassus/collision/pair_memory.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <span>
#include <type_traits>
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
  /// is cleared first. h is the step, s. With a filter that knows who pushed, pairs that are apart and did not push have
  /// contacts only where they meet by the velocities of the colliders, from however far.
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, const CollisionSettings& settings,
                         std::vector<ContactPoint>& out, const Filter& filter = {}) {
    out.clear();
    report_ = {};
    find_pairs(colliders, h, settings, filter);
    slots_.assign(jobs_);
    for (const Job& job : jobs_) collide(colliders, job, h, settings, slots_[job.slot], filter, out);
    report_.points = Index(out.size());
    return report_;
  }
  /// Contacts of the pairs that have none since `detect` and meet by the velocities that the colliders have now; `out` is
  /// cleared first. The colliders are those of `detect`, at the same poses.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, const CollisionSettings& settings, std::vector<ContactPoint>& out,
                     const Filter& filter);

  Kernel& kernel() { return kernel_; }
  /// What outlives a step: with it restored, the next step is the same to the bit.
  void memory(auto& archive) { archive(slots_); }

 private:
  using RestingPair = inner::RestingPair;
  struct Core {
    std::uint64_t pair;
    bool is_a;  ///< whose middle is held
  };
  using Job = inner::ListedPair;

  template <class Filter>
  void find_pairs(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                  const Filter& filter) {
    boxes_.resize(colliders.size());
    summary_.resize(colliders.size());
    half_spaces_.clear();
    jobs_.clear();
    knows_who_is_apart_ = inner::KnowsWhoPushed<Filter>;
    if constexpr (inner::KnowsWhoPushed<Filter>) apart_.clear(), cores_.clear(), waiting_.clear(), flies_by_.resize(colliders.size());
    for (Index i = 0; i < Index(colliders.size()); ++i) {
      DELASSUS_EXPECT(
          !colliders[i].shape.is_kept(),
          "a body has a mesh or a compound for its shape; put the WithMeshes{...} or WithCompounds{...} that "
          "keeps it around this loop's collision backend");
      summary_[i] = inner::summary_of(colliders[i]);
      if (is_half_space(colliders[i])) half_spaces_.push_back(i);
      boxes_[i] = box_of<Filter>(colliders[i], summary_[i], h, settings);
      if constexpr (inner::KnowsWhoPushed<Filter>) {
        summary_[i].way = inner::longest_way(summary_[i], h, settings);
        flies_by_[i] = inner::flies_by(colliders[i], summary_[i].speed, h);
      }
    }
    if constexpr (TaggedBroadPhase<Broad>) {
      tags_.clear();
      for (const Collider& c : colliders) tags_.push_back({.key = c.key, .is_movable = c.is_movable});
    }
    find_candidates();
    for (const CandidatePair& p : pairs_) add_job(colliders, p.i, p.j, filter);
    const std::size_t of_bodies = jobs_.size();
    for (const Index plane : half_spaces_) {
      const inner::PlaneReach reach(colliders[plane], h, settings);
      for (Index i = 0; i < Index(colliders.size()); ++i)
        if (!boxes_[i].is_empty() && reach.may_touch(boxes_[i])) add_job(colliders, plane, i, filter);
    }
    inner::sort_and_merge(jobs_, of_bodies, merged_);
    add_jobs_of_impacts(colliders, filter);
    if constexpr (inner::KnowsWhoPushed<Filter>) apart_.reserve(jobs_.capacity()), waiting_.reserve(jobs_.capacity());
    report_.pairs = Index(jobs_.size());
  }

  template <class Filter>
  static Aabb box_of(const Collider& c, const inner::Summary& of, double h, const CollisionSettings& settings) {
    if constexpr (inner::KnowsWhoPushed<Filter>) return inner::box_of_way(c, of, h, settings);
    else return inner::alarm_box(c, of, h, settings);
  }

  void find_candidates() {
    pairs_.clear();
    if constexpr (TaggedBroadPhase<Broad>) {
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
    jobs_.push_back(Job{{pair, a, b}});
  }

  /// Fast bodies that met in the last step may be far from each other now: what is left of their impact is due.
  template <class Filter>
  void add_jobs_of_impacts(inner::Slice<const Collider> colliders, const Filter& filter) {
    const std::size_t known = jobs_.size();
    const auto place_of = [&](std::uint32_t key) {
      return Index(std::find_if(colliders.begin(), colliders.end(), [&](const Collider& c) { return c.key == key; }) - colliders.begin());
    };
    slots_.each([&](const RestingPair& m) {
      if (m.is_plain || !m.impact.is_there) return;
      if constexpr (inner::KnowsWhoPushed<Filter>)
        if (!filter.pushed(m.pair)) return;
      if (job_of(m.pair, known)) return;
      const Index a = place_of(std::uint32_t(m.pair >> 32)), b = place_of(std::uint32_t(m.pair));
      const bool are_there = a < Index(colliders.size()) && b < Index(colliders.size());
      if (are_there && !(boxes_[a].is_empty() && !is_half_space(colliders[a])) && !(boxes_[b].is_empty() && !is_half_space(colliders[b])))
        add_job(colliders, a, b, filter);
    });
    if (jobs_.size() > known) inner::sort_and_merge(jobs_, known, merged_);
  }
  /// Among the first `count` jobs; null where there is none.
  Job* job_of(std::uint64_t pair, std::size_t count) {
    Job *const end = jobs_.data() + count, *const at = inner::lower_bound(jobs_.data(), end, pair, [](const Job& job, std::uint64_t key) { return job.pair < key; });
    return at != end && at->pair == pair ? at : nullptr;
  }

  /// One pair, in the frame of A until its points are written: those of the last step where it rests, else in
  /// full.
  template <class Filter>
  void collide(inner::Slice<const Collider> colliders, const Job& job, double h,
               const CollisionSettings& settings, RestingPair& pair, const Filter& filter, std::vector<ContactPoint>& out);

  /// The same of a pair that touches in one point and has nothing to remember but that; false where it is to be asked in full.
  template <class Filter>
  bool collide_in_one_point(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a, double scale, double reach, double h,
                            const CollisionSettings& settings, RestingPair& now, const Filter& filter, std::vector<ContactPoint>& out);

  /// Distance, patch, choice of points, names.
  template <class Filter>
  void collide_in_full(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a, double scale,
                       double reach, double h, const CollisionSettings& settings, std::uint64_t shapes,
                       RestingPair& now, const Filter& filter, std::vector<ContactPoint>& out) {
    constexpr bool looks_ahead = inner::KnowsWhoPushed<Filter>;
    bool will_meet = false;
    PairMemory last;
    last.copy(now);
    now.reset(job.pair);
    now.owner = last.owner;
    if constexpr (!looks_ahead)
      if (last.impact.is_there) now.impact = last.impact;
    ++report_.queries;

    const double farthest = looks_ahead ? farthest_meeting(job, reach, settings) : reach;
    SignedPair r = measure(a, b, b_in_a, farthest, scale, last, now);
    now.normal = a.pose.rotation * r.normal;
    if (r.status == PairStatus::far) return;
    const double margin =
        settings.contact_distance +
        inner::margin_along(a, b, now.normal, a.pose.to_world(r.point_a), scale, h, settings);
    if constexpr (looks_ahead) {
      // What pushed, or may be pushed, keeps its contacts within the margin.
      const bool is_near = r.distance <= margin, is_new = a.goes_alone && b.goes_alone && !filter.pushed(job.pair);
      will_meet = is_new && r.distance > settings.contact_distance;
      if (r.distance - settings.contact_distance > inner::touch_share * scale) {
        if (!is_near || is_new) {
          const inner::Apart apart{job, r.distance - settings.contact_distance - inner::meeting_share * scale, now.normal};
          if (look_ahead(a, b, apart, scale, is_near, h, settings, last, now, out)) return;
        }
      }
      if (farthest > reach && (is_half_space(a) || is_half_space(b))) r = measure(a, b, b_in_a, reach, scale, last, now);
    }
    if (r.distance > margin) return;
    if (!is_half_space(a) && !is_half_space(b))
      contact_patch(a.shape, b.shape, b_in_a, r, margin, scale, patch_);
    inner::name_points(patch_, last, b_in_a, transposed_times(a.pose.rotation, now.normal), scale,
                       settings.max_points, out.size(), out, now, [&](int i, std::uint32_t id) {
                         out.push_back(inner::contact_of(job, a.pose, patch_.point[i], now.normal,
                                                         settings.contact_distance, id));
                       });
    if (will_meet) now.impact = impact_of(a, b, now, out);
    inner::share_area(now.area, a.pose, now.count, out);
    sort_last(now.count, out);
    if constexpr (looks_ahead) hold_cores(a, b, job, h, out);  // their names are the last
    now.keep(shapes, b_in_a, r.normal, margin);
  }

  /// How far apart two bodies can be that meet within the step, m.
  double farthest_meeting(const Job& job, double reach, const CollisionSettings& settings) const {
    return std::max(reach, settings.contact_distance + summary_[job.a].way + summary_[job.b].way);
  }
  /// A pair that is apart: contacts of the place where it meets, or none. False where it meets with the normal that it has
  /// now: then its contacts are those of now.
  bool look_ahead(const Collider& a, const Collider& b, const inner::Apart& apart, double scale, bool is_near, double h,
                  const CollisionSettings& settings, const PairMemory& last, RestingPair& now, std::vector<ContactPoint>& out);
  /// Contacts of the patch that the two will have when they meet; false when they have none.
  bool meet(const Collider& a, const Collider& b, const Job& job, const inner::Impact& hit, double scale, double h,
            const CollisionSettings& settings, const PairMemory& last, RestingPair& now, std::vector<ContactPoint>& out);
  /// Rows through the middles of bodies that fly by, where the pair has none.
  void hold_cores(const Collider& a, const Collider& b, const Job& job, double h, std::vector<ContactPoint>& out) {
    for (const bool is_a : {true, false}) {
      if (!flies_by_[is_a ? job.a : job.b]) continue;
      const Core core{job.pair, is_a};
      if (std::any_of(cores_.begin(), cores_.end(), [&](const Core& c) { return c.pair == core.pair && c.is_a == is_a; })) continue;
      if (inner::hold_core(job, a, b, is_a, h, out)) cores_.push_back(core);
    }
  }
  /// The impact that a pair's last contacts foresee.
  static RememberedImpact impact_of(const Collider& a, const Collider& b, const RestingPair& pair, const std::vector<ContactPoint>& out) {
    const Vec3 n = pair.normal;
    Vec3 middle = zero<Vec3>(), half = zero<Vec3>();
    const ContactPoint* const first = out.data() + out.size() - pair.count;
    for (int k = 0; k < pair.count; ++k) middle += first[k].point() / double(pair.count), half += 0.5 * first[k].travel / double(pair.count);
    return {n, middle - half - a.pose.position, middle + half - b.pose.position, first->feature, pair.count > 0};
  }
  /// Of an impact that goes on at other places, or with another normal, the old row stops what it has left of the approach.
  void finish_impact(const Collider& a, const Collider& b, const Job& job, const RememberedImpact& impact, const RestingPair& now,
                     std::size_t first, std::vector<ContactPoint>& out) {
    const bool is_same = now.count > 0 && dot(now.normal, impact.normal) > inner::same_normal;
    if (is_same && inner::is_there(impact, a, b, first, out, std::min(summary_[job.a].scale, summary_[job.b].scale))) return;
    out.push_back(inner::row_ahead(job, a, b, impact.arm_a, impact.arm_b, impact.normal, 0, inner::unused(impact.id, first, out)));
    sort_last(int(out.size() - first), out);
  }
  /// Looks for pairs of the colliders that go farther than `detect` took into account.
  template <class Filter>
  void find_outgrown(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings, const Filter& filter);
  bool find_who_outgrew(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings);
  /// A pair without contacts is to be asked: at once where it may come near, else when its velocities are others.
  void ask(inner::Slice<const Collider> colliders, const Job& job, Job* listed, double h, const CollisionSettings& settings);
  /// A detection without such a filter, as in the middle of a step, may have had other pairs.
  void keep_jobs_of_apart();
  RestingPair& memory_of(std::uint64_t pair) { return slots_[job_of(pair, jobs_.size())->slot]; }

  /// Two bodies meet when they come nearer than that, m.
  static double meeting_distance(double scale, const CollisionSettings& settings) { return settings.contact_distance + inner::meeting_share * scale; }
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
  Array<Job> jobs_, merged_;  ///< of this step, by pair
  inner::PairSlots slots_;
  Array<inner::Apart> apart_;
  bool knows_who_is_apart_ = false;  ///< the last detection had a filter that knows who pushed
  Array<Job> waiting_;  ///< asked, and not to come near by the velocities that they had then
  Array<char> flies_by_;        ///< colliders, see inner::flies_by
  Array<Core> cores_;           ///< held in this step
  Array<char> is_grown_;        ///< colliders that go farther than detection took into account
  FixedArray<PatchPoint, PairMemory::capacity> repeated_;
};

template <class Kernel, class Broad>
template <class Filter>
void CollisionEngine<Kernel, Broad>::collide(inner::Slice<const Collider> colliders, const Job& job, double h,
                                             const CollisionSettings& settings, RestingPair& pair, const Filter& filter,
                                             std::vector<ContactPoint>& out) {
  const Collider &a = colliders[job.a], &b = colliders[job.b];
  const inner::Summary &of_a = summary_[job.a], &of_b = summary_[job.b];
  const double scale = std::min(of_a.scale, of_b.scale);
  const double reach =
      settings.contact_distance + inner::widest_margin(of_a.speed + of_b.speed, scale, h, settings);
  constexpr bool is_native = std::is_same_v<Kernel, GjkEpa>;
  const bool is_round = is_native && pair.is_plain && inner::is_round_pair(a.shape, b.shape);
  if (is_round && inner::are_balls_far(a, b, inner::KnowsWhoPushed<Filter> ? farthest_meeting(job, reach, settings) : reach, pair)) {
    ++report_.queries;
    return;
  }
  const Pose b_in_a = a.pose.to_local(b.pose);
  if constexpr (is_native)
    if (is_round && collide_in_one_point(a, b, job, b_in_a, scale, reach, h, settings, pair, filter, out)) return;
  const std::uint64_t shapes = (of_a.shape * 3 + of_b.shape) * 11 + std::uint64_t(settings.max_points);
  RememberedImpact impact;
  if (pair.impact.is_there) impact = pair.impact;
  const std::size_t first = out.size();
  if constexpr (inner::KnowsWhoPushed<Filter>) pair.impact.is_there = false;
  Vec3 n;
  if (!pair.repeat(shapes, b_in_a, reach, scale, repeated_, n)) {
    collide_in_full(a, b, job, b_in_a, scale, reach, h, settings, shapes, pair, filter, out);
    pair.see_if_plain();
  } else {
    pair.normal = a.pose.rotation * n;
    for (int k = 0; k < pair.count; ++k)
      out.push_back(inner::contact_of(job, a.pose, repeated_[k], pair.normal, settings.contact_distance,
                                      repeated_[k].name));
    inner::share_area(pair.area, a.pose, pair.count, out);
  }
  if constexpr (inner::KnowsWhoPushed<Filter>)
    if (impact.is_there && filter.pushed(job.pair) && !inner::has_turned(a, h) && !inner::has_turned(b, h))
      finish_impact(a, b, job, impact, pair, first, out);
}

template <class Kernel, class Broad>
template <class Filter>
bool CollisionEngine<Kernel, Broad>::collide_in_one_point(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a, double scale,
                                                          double reach, double h, const CollisionSettings& settings, RestingPair& now,
                                                          const Filter& filter, std::vector<ContactPoint>& out) {
  constexpr bool looks_ahead = inner::KnowsWhoPushed<Filter>;
  const double farthest = looks_ahead ? farthest_meeting(job, reach, settings) : reach;
  SignedPair r;
  if (!inner::one_point(a.shape, b.shape, b_in_a, farthest, scale, r)) return false;
  const Vec3 n = a.pose.rotation * r.normal;
  bool touches = false;
  if (r.status != PairStatus::far) {
    const double margin = settings.contact_distance + inner::margin_along(a, b, n, a.pose.to_world(r.point_a), scale, h, settings);
    touches = !(r.distance > margin);
    if constexpr (looks_ahead) {
      const bool is_new = a.goes_alone && b.goes_alone && !filter.pushed(job.pair);
      if (r.distance - settings.contact_distance > inner::touch_share * scale && (!touches || is_new)) {
        const inner::Apart apart{job, r.distance - settings.contact_distance - inner::meeting_share * scale, n};
        if (inner::may_close(a, b, n, apart.distance, h) && inner::may_come_near(a, b, h, meeting_distance(scale, settings))) return false;
        apart_.push_back(apart);
        touches = false;
      } else if (touches && ((is_new && r.distance > settings.contact_distance) || flies_by_[job.a] || flies_by_[job.b])) {
        return false;
      }
    }
  }
  ++report_.queries;
  now.normal = n;
  if (is_half_space(a) || is_half_space(b)) now.owner = is_half_space(a) ? inner::NormalOwner::a : inner::NormalOwner::b;
  else if (r.status != PairStatus::far) now.owner = inner::NormalOwner::kernel;
  now.count = touches;
  if (!touches) return true;
  const PatchPoint p{r.point_a, r.point_b, r.distance, Patch::witness};
  now.point[0] = {Patch::witness, Patch::witness, p.a, b_in_a.to_local(p.b)};
  out.push_back(inner::contact_of(job, a.pose, p, n, settings.contact_distance, Patch::witness));
  return true;
}

}  // namespace delassus

#include <delassus/collision/inner/engine_ahead.hpp>
