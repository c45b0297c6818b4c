/// Contacts of listed pairs, one after the other.
#pragma once

#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/collision/gjk_epa.hpp>
#include <delassus/collision/half_space.hpp>
#include <delassus/collision/inner/ahead.hpp>
#include <delassus/collision/inner/fallback_normal.hpp>
#include <delassus/collision/inner/keep_side.hpp>
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
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/slice.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// What pairs of one detection share.
struct PairScene {
  Slice<const Collider> colliders;
  const Summary* summary = nullptr;  ///< by collider
  const char* flies_by = nullptr;    ///< the same, see `inner::flies_by`
  double h = 0;                      ///< step, s
  CollisionSettings settings;
  bool leaves_out = true;  ///< pairs that do not meet, where the filter knows who pushed
};

/// Whose middle a row holds.
struct HeldCore {
  std::uint64_t pair;
  bool is_a;
};

/// Whether a filter, or one that it goes around, brings threads for the pairs: see `InParts`.
template <class Filter>
constexpr bool has_execution() {
  if constexpr (requires(const Filter& f) { f.execution; })
    return true;
  else if constexpr (requires(const Filter& f) { f.filter; })
    return has_execution<std::remove_cvref_t<decltype(std::declval<const Filter&>().filter)>>();
  else
    return false;
}

/// What one thread needs to turn pairs into contacts, and what it finds besides.
template <class Kernel>
class PairWorker {
 public:
  using Job = ListedPair;

  Kernel kernel{};
  PairScene scene;
  CollisionReport report;    ///< queries and rejects
  Array<Apart> apart_pairs;  ///< without contacts, which may meet yet, or with those of an impact to come
  Array<HeldCore> cores;     ///< held in this step

  /// Takes part of the work of another.
  void begin(const PairWorker& other) {
    kernel = other.kernel;
    scene = other.scene;
    report = {};
    apart_pairs.clear();
    apart_pairs.reserve(other.apart_pairs.capacity());
    cores.clear();
  }
  /// Adds what a part found, in the order of the pairs.
  void join(const PairWorker& part) {
    report.queries += part.report.queries;
    report.rejects += part.report.rejects;
    for (const Apart& pair : part.apart_pairs) apart_pairs.push_back(pair);
    for (const HeldCore& core : part.cores) cores.push_back(core);
  }

  /// One pair, in the frame of A until its points are written: those of the last step where it rests, else in
  /// full.
  template <class Filter>
  void collide(const Job& job, RestingPair& pair, const Filter& filter, std::vector<ContactPoint>& out);

  /// Contacts of the patch that the two will have when they meet; false when they have none.
  bool meet(const Collider& a, const Collider& b, const Job& job, const Impact& hit, double scale,
            const PairMemory& last, RestingPair& now, std::vector<ContactPoint>& out);
  /// Rows through the middles of bodies that fly by, where the pair has none.
  void hold_cores(const Collider& a, const Collider& b, const Job& job, std::vector<ContactPoint>& out) {
    for (const bool is_a : {true, false}) {
      if (!scene.flies_by[is_a ? job.a : job.b]) continue;
      const HeldCore core{job.pair, is_a};
      bool is_known = false;
      for (const HeldCore& known : cores)
        is_known = is_known || (known.pair == core.pair && known.is_a == core.is_a);
      if (is_known) continue;
      if (hold_core(job, a, b, is_a, scene.h, out)) cores.push_back(core);
    }
  }
  /// Two bodies meet when they come nearer than that, m.
  double meeting_distance(double scale) const {
    return scene.settings.contact_distance + meeting_share * scale;
  }

 private:
  /// The same of a pair that touches in one point and has nothing to remember but that; false where it is to
  /// be asked in full.
  template <class Filter>
  bool collide_in_one_point(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a,
                            double scale, double reach, RestingPair& now, const Filter& filter,
                            std::vector<ContactPoint>& out);

  /// Distance, patch, choice of points, names.
  template <class Filter>
  void collide_in_full(const Collider& a, const Collider& b, const Job& job, const Pose& b_in_a, double scale,
                       double reach, std::uint64_t shapes, RestingPair& now, const Filter& filter,
                       std::vector<ContactPoint>& out) {
    const bool looks_ahead = may_leave_out<Filter>();
    bool will_meet = false;
    PairMemory last;
    last.copy(now);
    now.reset(job.pair);
    now.owner = last.owner;
    if (!looks_ahead && last.impact.is_there) now.impact = last.impact;
    ++report.queries;

    const double farthest = looks_ahead ? farthest_meeting(job, reach) : reach;
    SignedPair r = measure(a, b, b_in_a, farthest, scale, last, now);
    now.normal = a.pose.rotation * r.normal;
    if (r.status == PairStatus::far) return;
    const double margin =
        scene.settings.contact_distance +
        margin_along(a, b, now.normal, a.pose.to_world(r.point_a), scale, scene.h, scene.settings);
    if (looks_ahead) {
      // What pushed, or may be pushed, keeps its contacts within the margin.
      const bool is_near = r.distance <= margin,
                 is_new = a.goes_alone && b.goes_alone && !has_pushed(filter, job.pair);
      will_meet = is_new && r.distance > scene.settings.contact_distance;
      if (r.distance - scene.settings.contact_distance > touch_share * scale) {
        if (!is_near || is_new) {
          const Apart apart{job, r.distance - scene.settings.contact_distance - meeting_share * scale,
                            now.normal};
          if (look_ahead(a, b, apart, scale, is_near, last, now, out)) return;
        }
      }
      if (farthest > reach && (is_half_space(a) || is_half_space(b)))
        r = measure(a, b, b_in_a, reach, scale, last, now);
    }
    if (r.distance > margin) return;
    // Up to the reach of the pair, as of a half-space: of two that turn, the far end closes faster than the nearest points.
    if (!is_half_space(a) && !is_half_space(b))
      contact_patch(a.shape, b.shape, b_in_a, r, reach, scale, patch_);
    name_points(patch_, last, b_in_a, transposed_times(a.pose.rotation, now.normal), scale,
                scene.settings.max_points, out.size(), out, now, [&](int i, std::uint32_t id) {
                  out.push_back(contact_of(job, a.pose, patch_.point[i], now.normal,
                                           scene.settings.contact_distance, id));
                });
    if (will_meet) now.impact = impact_of(a, b, a.pose, b.pose, now, out);
    share_area(now.area, a.pose, now.count, out);
    sort_last(now.count, out);
    if (looks_ahead) hold_cores(a, b, job, out);  // their names are the last
    now.keep(shapes, b_in_a, r.normal, reach);
  }

  /// Whether pairs that do not meet are left out.
  template <class Filter>
  [[gnu::always_inline]] bool may_leave_out() const {
    return KnowsWhoPushed<Filter> && scene.leaves_out;
  }
  template <class Filter>
  [[gnu::always_inline]] static bool has_pushed(const Filter& filter, std::uint64_t pair) {
    if constexpr (KnowsWhoPushed<Filter>)
      return filter.pushed(pair);
    else
      return false;
  }
  /// How far apart two bodies can be that meet within the step, m.
  double farthest_meeting(const Job& job, double reach) const {
    return std::max(reach,
                    scene.settings.contact_distance + scene.summary[job.a].way + scene.summary[job.b].way);
  }
  /// A pair that is apart: contacts of the place where it meets, or none. False where it meets with the
  /// normal that it has now: then its contacts are those of now.
  bool look_ahead(const Collider& a, const Collider& b, const Apart& apart, double scale, bool is_near,
                  const PairMemory& last, RestingPair& now, std::vector<ContactPoint>& out);
  /// The impact that a pair's last contacts foresee, where the two meet at these poses: of faces in the middle of their area.
  static RememberedImpact impact_of(const Collider& a, const Collider& b, const Pose& at_a, const Pose& at_b, const RestingPair& pair,
                                    const std::vector<ContactPoint>& out) {
    const Vec3 n = pair.normal;
    if (pair.count >= 3 && pair.area.size > 0) {
      const Vec3 arm_a = at_a.rotation * pair.area.middle;
      return {n, arm_a, at_a.position + arm_a - at_b.position, (out.data() + out.size() - pair.count)->feature, true};
    }
    Vec3 middle = zero<Vec3>(), half = zero<Vec3>();
    const ContactPoint* const first = out.data() + out.size() - pair.count;
    for (int k = 0; k < pair.count; ++k)
      middle += first[k].point() / double(pair.count), half += 0.5 * first[k].travel / double(pair.count);
    return {n, middle - half - a.pose.position, middle + half - b.pose.position, first->feature,
            pair.count > 0};
  }
  /// Of an impact that goes on at other places, or with another normal, the old row stops what it has left of
  /// the approach.
  void finish_impact(const Collider& a, const Collider& b, const Job& job, const RememberedImpact& impact,
                     const RestingPair& now, std::size_t first, std::vector<ContactPoint>& out) {
    if (!goes_on(impact, a, b)) return;
    const bool is_same = now.count > 0 && dot(now.normal, impact.normal) > same_normal;
    if (is_same &&
        is_there(impact, a, b, first, out, std::min(scene.summary[job.a].scale, scene.summary[job.b].scale)))
      return;
    out.push_back(
        row_ahead(job, a, b, impact.arm_a, impact.arm_b, impact.normal, 0, unused(impact.id, first, out)));
    sort_last(int(out.size() - first), out);
  }
  static bool is_half_space(const Collider& c) { return c.shape.kind == ShapeKind::half_space; }

  /// The certified signed distance. Of a half-space the patch comes with it.
  SignedPair measure(const Collider& a, const Collider& b, const Pose& b_in_a, double reach, double scale,
                     const PairMemory& last, PairMemory& now) {
    if (is_half_space(a) || is_half_space(b)) {
      now.owner = is_half_space(a) ? NormalOwner::a : NormalOwner::b;
      return half_space_patch(a.shape, b.shape, b_in_a, reach, scale, patch_);
    }
    const Vec3 guess = transposed_times(a.pose.rotation, last.normal);
    // Centres in one point: the normal of B moved by 1e-4 of the size, far above what round shapes resolve.
    // Along it B is then put back, and the depth is within 4e-4 of the size of the least.
    const bool is_moved = is_zero(b_in_a.position) && is_zero(last.normal);
    Vec3 shift = zero<Vec3>();
    if (is_moved) shift = transposed_times(a.pose.rotation, 1e-4 * scale * fallback_normal(a.key, b.key));
    const Pose pose{.position = b_in_a.position + shift, .rotation = b_in_a.rotation};
    const auto [answer, is_rejected] = certified_pair(kernel, a.shape, b.shape, pose, reach, scale, guess);
    report.rejects += is_rejected ? 1 : 0;
    SignedPair r = answer;
    if (is_moved) r.distance -= dot(r.normal, shift), r.point_b -= r.normal * dot(r.normal, shift);
    if (r.status == PairStatus::near && !is_round_pair(a.shape, b.shape)) keep_side(a.shape, b.shape, b_in_a, guess, r);
    if (r.status == PairStatus::near)
      now.owner = snap_normal_to_face(a.shape, b.shape, b_in_a, scale, last.owner, r);
    return r;
  }

  /// The last points by feature; they are few.
  static void sort_last(int count, std::vector<ContactPoint>& out) {
    ContactPoint* const first = out.data() + out.size() - count;
    for (int i = 1; i < count; ++i)
      for (int k = i; k > 0 && first[k].feature < first[k - 1].feature; --k)
        std::swap(first[k], first[k - 1]);
  }

  Patch patch_;
  FixedArray<PatchPoint, PairMemory::capacity> repeated_;
};

/// Contacts of all listed pairs by the threads that the filter brings; the worker is left as if it had made
/// them all.
template <class Kernel, class Filter>
void collide_in_parts(PairWorker<Kernel>& worker, Array<ListedPair>& jobs, PairSlots& slots,
                      const Filter& filter, std::vector<ContactPoint>& out);

template <class Kernel>
template <class Filter>
void PairWorker<Kernel>::collide(const Job& job, RestingPair& pair, const Filter& filter,
                                 std::vector<ContactPoint>& out) {
  const Collider &a = scene.colliders[job.a], &b = scene.colliders[job.b];
  const Summary &of_a = scene.summary[job.a], &of_b = scene.summary[job.b];
  const double scale = std::min(of_a.scale, of_b.scale);
  const double reach = scene.settings.contact_distance +
                       widest_margin(closing_speed(a, b, of_a.radius, of_b.radius), scale, scene.h, scene.settings);
  constexpr bool is_native = std::is_same_v<Kernel, GjkEpa>;
  const bool looks_ahead = may_leave_out<Filter>();
  const bool is_round = is_native && pair.is_plain && is_round_pair(a.shape, b.shape);
  if (is_round && are_balls_far(a, b, looks_ahead ? farthest_meeting(job, reach) : reach, pair)) {
    ++report.queries;
    return;
  }
  const Pose b_in_a = a.pose.to_local(b.pose);
  if constexpr (is_native)
    if (is_round && collide_in_one_point(a, b, job, b_in_a, scale, reach, pair, filter, out)) return;
  const std::uint64_t shapes = (of_a.shape * 3 + of_b.shape) * 11 + std::uint64_t(scene.settings.max_points);
  RememberedImpact impact;
  if (pair.impact.is_there) impact = pair.impact;
  const std::size_t first = out.size();
  if (looks_ahead) pair.impact.is_there = false;
  Vec3 n;
  if (!pair.repeat(shapes, b_in_a, reach, scale, repeated_, n)) {
    collide_in_full(a, b, job, b_in_a, scale, reach, shapes, pair, filter, out);
    pair.see_if_plain();
  } else {
    pair.normal = a.pose.rotation * n;
    for (int k = 0; k < pair.count; ++k)
      out.push_back(contact_of(job, a.pose, repeated_[k], pair.normal, scene.settings.contact_distance,
                               repeated_[k].name));
    share_area(pair.area, a.pose, pair.count, out);
  }
  if constexpr (KnowsWhoPushed<Filter>)
    if (looks_ahead && impact.is_there && filter.pushed(job.pair) && !has_turned(a, scene.h) &&
        !has_turned(b, scene.h))
      finish_impact(a, b, job, impact, pair, first, out);
}

template <class Kernel>
template <class Filter>
bool PairWorker<Kernel>::collide_in_one_point(const Collider& a, const Collider& b, const Job& job,
                                              const Pose& b_in_a, double scale, double reach,
                                              RestingPair& now, const Filter& filter,
                                              std::vector<ContactPoint>& out) {
  const bool looks_ahead = may_leave_out<Filter>();
  const double farthest = looks_ahead ? farthest_meeting(job, reach) : reach;
  SignedPair r;
  if (!one_point(a.shape, b.shape, b_in_a, farthest, scale, r)) return false;
  const Vec3 n = a.pose.rotation * r.normal;
  bool touches = false;
  if (r.status != PairStatus::far) {
    const double margin = scene.settings.contact_distance +
                          margin_along(a, b, n, a.pose.to_world(r.point_a), scale, scene.h, scene.settings);
    touches = !(r.distance > margin);
    if (looks_ahead) {
      const bool is_new = a.goes_alone && b.goes_alone && !has_pushed(filter, job.pair);
      if (r.distance - scene.settings.contact_distance > touch_share * scale && (!touches || is_new)) {
        const Apart apart{job, r.distance - scene.settings.contact_distance - meeting_share * scale, n};
        if (may_close(a, b, n, apart.distance, scene.h) &&
            may_come_near(a, b, scene.h, meeting_distance(scale)))
          return false;
        apart_pairs.push_back(apart);
        touches = false;
      } else if (touches && ((is_new && r.distance > scene.settings.contact_distance) ||
                             scene.flies_by[job.a] || scene.flies_by[job.b])) {
        return false;
      }
    }
  }
  ++report.queries;
  now.normal = n;
  if (is_half_space(a) || is_half_space(b))
    now.owner = is_half_space(a) ? NormalOwner::a : NormalOwner::b;
  else if (r.status != PairStatus::far)
    now.owner = NormalOwner::kernel;
  now.count = touches;
  if (!touches) return true;
  const PatchPoint p{r.point_a, r.point_b, r.distance, Patch::witness};
  now.point[0] = {Patch::witness, Patch::witness, p.a, b_in_a.to_local(p.b)};
  out.push_back(contact_of(job, a.pose, p, n, scene.settings.contact_distance, Patch::witness));
  return true;
}

template <class Kernel>
bool PairWorker<Kernel>::look_ahead(const Collider& a, const Collider& b, const Apart& apart, double scale,
                                    bool is_near, const PairMemory& last, RestingPair& now,
                                    std::vector<ContactPoint>& out) {
  const double target = meeting_distance(scale);
  if (may_close(a, b, apart.normal, apart.distance, scene.h) && may_come_near(a, b, scene.h, target) &&
      !stay_apart(a, b, apart.normal, scene.h, target)) {
    const Impact hit = time_of_impact(a, b, scene.h, scale, target, transposed_times(a.pose.rotation, apart.normal));
    if (hit.is_now) return false;
    if (hit.is_found) {
      const bool is_same = dot(hit.a.rotation * hit.normal_in_a, apart.normal) > same_normal;
      if (is_near && is_same && !may_outgrow_margin(a, b, scale, scene.h)) return false;
      if (meet(a, b, Job{apart.job}, hit, scale, last, now, out)) {
        apart_pairs.push_back({apart.job, apart.distance, apart.normal, true});
        return true;
      }
    }
  }
  apart_pairs.push_back(apart);
  return true;
}

template <class Kernel>
bool PairWorker<Kernel>::meet(const Collider& a, const Collider& b, const Job& job, const Impact& hit,
                              double scale, const PairMemory& last, RestingPair& now,
                              std::vector<ContactPoint>& out) {
  const Pose b_in_a = hit.a.to_local(hit.b);
  const double speed = dot(hit.a.rotation * hit.normal_in_a, a.velocity - b.velocity),
               margin = scene.settings.contact_distance +
                        limited_margin(std::abs(speed) * (scene.h - hit.time), scale);
  const SignedPair r = distance_of(a.shape, b.shape, b_in_a, margin, scale, hit.normal_in_a, patch_);
  if (r.status != PairStatus::near) return false;
  if (!is_half_space(a) && !is_half_space(b))
    contact_patch(a.shape, b.shape, b_in_a, r, margin, scale, patch_);
  now.owner = NormalOwner::kernel;
  now.normal = hit.a.rotation * r.normal;
  const std::size_t first = out.size();
  name_points(patch_, last, b_in_a, r.normal, scale, scene.settings.max_points, first, out, now,
              [&](int i, std::uint32_t id) {
                out.push_back(impact_row(job, a, b, hit, patch_.point[i], now.normal,
                                         scene.settings.contact_distance, id));
              });
  if (now.count == 0) return false;
  now.impact = impact_of(a, b, hit.a, hit.b, now, out);
  hold_cores(a, b, job, out);
  sort_last(int(out.size() - first), out);
  return true;
}

/// Contacts of a listed pair; the list keeps what is known of it.
template <class Kernel, class Filter>
void collide_listed(PairWorker<Kernel>& worker, ListedPair& job, RestingPair& pair, const Filter& filter,
                    std::vector<ContactPoint>& out) {
  const std::size_t apart = worker.apart_pairs.size();
  worker.collide(job, pair, filter, out);
  job.is_asked = pair.count > 0 || worker.apart_pairs.size() > apart;
}

}  // namespace delassus::inner
