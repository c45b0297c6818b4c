/// Collision detection: boxes, pairs, certified distances, patches, and points that keep their names.
#pragma once

#include <delassus/collision/broad_phase.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/collision/inner/ahead.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/pair_slots.hpp>
#include <delassus/collision/inner/pair_worker.hpp>
#include <delassus/collision/inner/resting_pair.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
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
  static_assert(
      NarrowKernel<Kernel>,
      "delassus: a narrow kernel needs pair(a, b, b_in_a, margin, cache), which returns a SignedPair");
  static_assert(BroadPhase<Broad>,
                "delassus: a broad phase needs find(boxes, pairs); see collision/broad_phase.hpp");

 public:
  /// Contacts within the margin of the pairs that the filter lets, sorted by pair and then by feature; `out`
  /// is cleared first. h is the step, s. With a filter that knows who pushed, pairs that are apart and did
  /// not push have contacts only where they meet by the velocities of the colliders, from however far.
  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, const CollisionSettings& settings,
                         std::vector<ContactPoint>& out, const Filter& filter = {}) {
    worker_.report = {};
    if constexpr (inner::has_execution<Filter>())
      find_pairs_in_parts(colliders, h, settings, filter);
    else
      out.clear(), find_pairs(colliders, h, settings, filter);
    slots_.assign(jobs_);
    worker_.scene = {colliders, summary_.data(), flies_by_.data(), h, settings};
    if constexpr (inner::has_execution<Filter>())
      inner::collide_in_parts(worker_, jobs_, slots_, filter, out);
    else
      for (Job& job : jobs_) inner::collide_listed(worker_, job, slots_[job.slot], filter, out);
    worker_.report.points = Index(out.size());
    return worker_.report;
  }
  /// Contacts of the pairs that have none since `detect` and meet by the velocities that the colliders have
  /// now; `out` is cleared first. The colliders are those of `detect`, at the same poses.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, const CollisionSettings& settings,
                     std::vector<ContactPoint>& out, const Filter& filter);

  Kernel& kernel() { return worker_.kernel; }
  /// What outlives a step: with it restored, the next step is the same to the bit.
  void memory(auto& archive) { archive(slots_); }

 private:
  using RestingPair = inner::RestingPair;
  using Job = inner::ListedPair;

  template <class Filter>
  void find_pairs(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                  const Filter& filter) {
    begin_search<Filter>(colliders.size());
    for (Index i = 0; i < Index(colliders.size()); ++i) {
      look_at<Filter>(i, colliders[i], h, settings);
      if (is_half_space(colliders[i])) half_spaces_.push_back(i);
    }
    if constexpr (TaggedBroadPhase<Broad>) {
      tags_.clear();
      for (const Collider& c : colliders) tags_.push_back({.key = c.key, .is_movable = c.is_movable});
    }
    find_candidates();
    for (const CandidatePair& p : pairs_) add_job(colliders, p.i, p.j, filter, jobs_);
    const std::size_t of_bodies = jobs_.size();
    for (const Index plane : half_spaces_) {
      const inner::PlaneReach reach(colliders[plane], h, settings);
      for (Index i = 0; i < Index(colliders.size()); ++i)
        if (!boxes_[i].is_empty() && reach.may_touch(boxes_[i])) add_job(colliders, plane, i, filter, jobs_);
    }
    inner::sort_and_merge(jobs_, of_bodies, merged_);
    const std::size_t known = jobs_.size();
    slots_.each([&](const RestingPair& m) {
      if (has_impact(m)) add_job_of_impact(m, known, colliders, filter);
    });
    end_search<Filter>(known);
  }
  /// The same by the workers that the filter brings.
  template <class Filter>
  void find_pairs_in_parts(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                           const Filter& filter);

  /// f(plane, reach, i, list) of every half-space and collider, by several workers: what it appends to the lists follows
  /// in `to`.
  template <class By, class F>
  void list_at_planes(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings, const By& by,
                      Array<Job>& to, const F& f);

  /// Room for so many colliders, and no pair yet.
  template <class Filter>
  void begin_search(std::size_t colliders) {
    boxes_.resize(colliders);
    summary_.resize(colliders);
    half_spaces_.clear();
    jobs_.clear();
    knows_who_is_apart_ = inner::KnowsWhoPushed<Filter>;
    if constexpr (inner::KnowsWhoPushed<Filter>)
      worker_.apart_pairs.clear(), worker_.cores.clear(), waiting_.clear(), flies_by_.resize(colliders);
  }
  /// What pairs ask of collider i.
  template <class Filter>
  [[gnu::always_inline]] void look_at(Index i, const Collider& c, double h, const CollisionSettings& settings) {
    DELASSUS_EXPECT(
        !c.shape.is_kept(),
        "a body has a mesh or a compound for its shape; put the WithMeshes{...} or WithCompounds{...} that "
        "keeps it around this loop's collision backend");
    summary_[i] = inner::summary_of(c);
    boxes_[i] = box_of<Filter>(c, summary_[i], h, settings);
    if constexpr (inner::KnowsWhoPushed<Filter>) {
      summary_[i].way = inner::longest_way(summary_[i], h, settings);
      flies_by_[i] = inner::flies_by(c, summary_[i].speed, h);
    }
  }
  /// After those of the first `known` jobs there are jobs of impacts.
  template <class Filter>
  void end_search(std::size_t known) {
    if (jobs_.size() > known) inner::sort_and_merge(jobs_, known, merged_);
    if constexpr (inner::KnowsWhoPushed<Filter>)
      worker_.apart_pairs.reserve(jobs_.capacity()), waiting_.reserve(jobs_.capacity());
    worker_.report.pairs = Index(jobs_.size());
  }

  template <class Filter>
  static Aabb box_of(const Collider& c, const inner::Summary& of, double h,
                     const CollisionSettings& settings) {
    if constexpr (inner::KnowsWhoPushed<Filter>)
      return inner::box_of_way(c, of, h, settings);
    else
      return inner::alarm_box(c, of, h, settings);
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
  static void add_job(inner::Slice<const Collider> colliders, Index a, Index b, const Filter& filter,
                      Array<Job>& to) {
    const Collider &x = colliders[a], &y = colliders[b];
    const std::uint64_t pair = pair_key(x.key, y.key);
    if (!may_meet(x, y) || !filter.lets(pair)) return;
    if (x.key > y.key) std::swap(a, b);
    to.push_back(Job{{pair, a, b}});
  }

  static bool has_impact(const RestingPair& m) { return !m.is_plain && m.impact.is_there; }
  /// Fast bodies that met in the last step may be far from each other now: what is left of their impact is
  /// due. `known`: how many jobs there are without such.
  template <class Filter>
  void add_job_of_impact(const RestingPair& m, std::size_t known, inner::Slice<const Collider> colliders,
                         const Filter& filter) {
    if constexpr (inner::KnowsWhoPushed<Filter>)
      if (!filter.pushed(m.pair)) return;
    if (job_of(m.pair, known)) return;
    const auto place_of = [&](std::uint32_t key) {
      Index i = 0;
      while (i < Index(colliders.size()) && colliders[i].key != key) ++i;
      return i;
    };
    const Index a = place_of(std::uint32_t(m.pair >> 32)), b = place_of(std::uint32_t(m.pair));
    const bool are_there = a < Index(colliders.size()) && b < Index(colliders.size());
    if (are_there && !(boxes_[a].is_empty() && !is_half_space(colliders[a])) &&
        !(boxes_[b].is_empty() && !is_half_space(colliders[b])))
      add_job(colliders, a, b, filter, jobs_);
  }
  /// Among the first `count` jobs; null where there is none.
  Job* job_of(std::uint64_t pair, std::size_t count) {
    Job *const end = jobs_.data() + count, *const at = inner::lower_bound(
                                               jobs_.data(), end, pair, [](const Job&job, std::uint64_t key) {
                                                 return job.pair < key;
                                               });
    return at != end && at->pair == pair ? at : nullptr;
  }

  /// Where two that are apart meet by these velocities.
  inner::Impact impact_of(const inner::Apart& p, const Collider& a, const Collider& b, double h) const;
  /// Forgets the impacts that the filter says will not be.
  template <class Filter>
  void let_go_who_misses(std::span<const Collider> colliders, double h, const Filter& filter);

  /// Looks for pairs of the colliders that go farther than `detect` took into account.
  template <class Filter>
  void find_outgrown(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                     const Filter& filter);
  /// The same by the workers that the filter brings.
  template <class Filter>
    requires(inner::has_execution<Filter>())
  void find_outgrown(inner::Slice<const Collider> colliders, double h, const CollisionSettings& settings,
                     const Filter& filter);
  /// Whether collider i goes farther; then its box is made larger.
  bool outgrows(Index i, const Collider& c, double h, const CollisionSettings& settings);
  bool comes_near(inner::Slice<const Collider> colliders, const Job& job, double h,
                  const CollisionSettings& settings) const;
  /// A pair without contacts is to be asked: at once where it may come near, else when its velocities are
  /// others.
  void ask(inner::Slice<const Collider> colliders, const Job& job, Index listed, double h,
           const CollisionSettings& settings);
  /// A detection without such a filter, as in the middle of a step, may have had other pairs.
  void keep_jobs_of_apart();
  RestingPair& memory_of(std::uint64_t pair) { return slots_[job_of(pair, jobs_.size())->slot]; }

  static bool is_half_space(const Collider& c) { return c.shape.kind == ShapeKind::half_space; }

  inner::PairWorker<Kernel> worker_;
  Broad broad_;
  Array<Aabb> boxes_;
  Array<inner::Summary> summary_;
  Array<BoxTag> tags_;
  Array<Index> half_spaces_;
  typename inner::PairsOf<Broad>::type pairs_;
  Array<Job> jobs_, merged_;  ///< of this step, by pair
  inner::PairSlots slots_;
  bool knows_who_is_apart_ = false;  ///< the last detection had a filter that knows who pushed
  Array<Job> waiting_;               ///< asked, and not to come near by the velocities that they had then
  Array<char> flies_by_;             ///< colliders, see inner::flies_by
  Array<char> is_grown_;             ///< colliders that go farther than detection took into account
};

}  // namespace delassus

#include <delassus/collision/inner/engine_ahead.hpp>
