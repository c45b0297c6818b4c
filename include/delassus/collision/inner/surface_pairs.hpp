/// Contacts of surfaces of triangles with convex shapes and with each other: collected by triangle, chosen by
/// normal, named from step to step.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/ahead.hpp>
#include <delassus/collision/inner/deep_surfaces.hpp>
#include <delassus/collision/inner/face_pieces.hpp>
#include <delassus/collision/inner/hull_of_patch.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/name_points.hpp>
#include <delassus/collision/inner/patch_doubts.hpp>
#include <delassus/collision/inner/share_area.hpp>
#include <delassus/collision/inner/surface_crossing.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/triangle_patch.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/inner/flat_tree.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace delassus::inner {

/// What outlives a step: for every pair and every direction in which it touched, the points, in the surface's
/// frame.
class SurfacePairs {
 public:
  void begin(bool looks_ahead) {
    next_.clear(), next_impacts_.clear();
    if (looks_ahead) apart_.clear(), asked_.clear(), cores_.clear();
  }
  void end() { memory_.swap(next_), impacts_.swap(next_impacts_); }
  void memory(auto& archive) { archive(memory_, impacts_); }

  /// Appends the contacts of the surface, posed and moving as the collider `job.a`, with the convex collider or
  /// the half-space `job.b`. Call by ascending pairs. Returns how many triangles were looked at. With a filter that knows who
  /// pushed, triangles that are apart have contacts only where they meet.
  template <class Surface, class Filter>
  Index collide(const Surface& surface, std::span<const Collider> colliders, const PairJob& job, double h,
                const CollisionSettings& settings, const Filter& filter, std::vector<ContactPoint>& out) {
    const Collider &a = colliders[job.a], &b = colliders[job.b];
    const bool is_plane = b.shape.kind == ShapeKind::half_space;
    Pair pair(job, a, b, length_scale(is_plane ? a.shape : b.shape), h, settings);
    if constexpr (KnowsWhoPushed<Filter>) pair.reach = std::max(pair.reach, settings.contact_distance + pair.way());
    if constexpr (KnowsWhoPushed<Filter>) is_new_ = !is_plane && a.goes_alone && b.goes_alone && !filter.pushed(job.pair);
    hit_ = {};
    points_.clear();
    pieces_.clear();
    Index queries = 0;
    if (is_plane) {
      queries = collect_on_plane(surface, plane_of(b.shape, pair.b_in_a), pair.reach);
    } else {
      const auto add = [&](Index t, const Patch& patch, const Vec3& n) {
        for (int i = 0; i < patch.count; ++i) {
          if constexpr (KnowsWhoPushed<Filter>) points_.push_back({patch.point[i], n, t});
          else add_within_margin(pair, patch.point[i], n, t);
        }
        const auto corner = [&](int k) -> const Vec3& { return patch.point[k].a; };
        if (patch.corners >= 3) pieces_.add(patch.corners, corner, n, patch.point[deepest(patch)].gap);
      };
      skipped_.clear();
      const bool goes_far = KnowsWhoPushed<Filter> && pair.way() > margin_share * pair.scale;
      queries = doubts_.collect(surface, b.shape, pair.b_in_a, pair.reach, pair.scale, add, [&](const Triangle& triangle, Index t) {
        if (goes_far && triangle.height(pair.b_in_a.to_world(middle(b.shape))) >= 0) skipped_.push_back(t);
      });
      if constexpr (KnowsWhoPushed<Filter>) look_ahead(surface, pair);
      else erase_if(points_, [&](const SurfaceContact& p) { return doubts_.is_false(p.triangle); });
    }
    const std::size_t first = out.size();
    find_last(job.pair);
    emit(pair, first, out);
    if constexpr (KnowsWhoPushed<Filter>) {
      if (hit_.is_found && !is_plane) {
        collect_at_impact(surface, pair, next_);
        emit(pair, first, out);
      }
      if (!is_plane) hold_core(surface, pair, out);
      if (filter.pushed(job.pair) && !has_turned(a, h) && !has_turned(b, h)) finish_impact(pair, first, out);
    }
    sort_names(first, out);
    return queries;
  }
  /// After `end`: contacts of the triangles that were left out and meet by the velocities that the colliders have now.
  template <class Surface>
  void collide_missed(const Surface& surface, std::span<const Collider> colliders, const PairJob& job, double h,
                      const CollisionSettings& settings, std::vector<ContactPoint>& out);

  /// The same for two surfaces; returns how many pairs of triangles were looked at. What is deeper than the
  /// margin and than 2e-2 L is looked for where nothing else overlaps.
  template <class SurfaceA, class SurfaceB>
  Index cross(const SurfaceA& surface_a, const SurfaceB& surface_b, std::span<const Collider> colliders,
              const PairJob& job, double h, const CollisionSettings& settings, std::vector<ContactPoint>& out) {
    const Collider &a = colliders[job.a], &b = colliders[job.b];
    const double scale = pair_scale(a.shape, b.shape);
    const Pair pair(job, a, b, scale, h, settings);
    const TouchRange range{std::max(pair.reach, 2e-2 * scale), 0.5 * scale, scale};
    features_.clear();
    const PosedSurface<SurfaceA> posed_a{surface_a};
    const PosedSurface<SurfaceB> posed_b{surface_b, pair.b_in_a};
    const Index queries = SurfaceCrossing(posed_a, posed_b, range, features_).collect();
    const auto overlaps = [](const FeatureContact& f) { return f.point.gap < 0; };
    if (std::none_of(features_.begin(), features_.end(), overlaps))
      collect_deep(posed_a, posed_b, scale, cuts_, features_);
    is_new_ = false;
    points_.clear();
    pieces_.clear();
    for (const FeatureContact& f : features_) add_within_margin(pair, f.point, f.normal, -1);
    const std::size_t first = out.size();
    find_last(job.pair);
    emit(pair, first, out);
    sort_names(first, out);
    return queries;
  }

 private:
  struct Pair {
    const PairJob& job;
    const Collider &a, &b;
    double scale, h;
    const CollisionSettings& settings;
    Pose b_in_a;
    double reach;

    Pair(const PairJob& j, const Collider& first, const Collider& second, double size, double step,
         const CollisionSettings& s)
        : job(j), a(first), b(second), scale(size), h(step), settings(s), b_in_a(a.pose.to_local(b.pose)),
          reach(s.contact_distance + widest_margin(closing_speed(a, b), size, step, s)) {}
    /// How much nearer two of their points may come in the step, m.
    double way() const { return h * (norm(Vec3(b.velocity - a.velocity)) + turning_speeds(a, b, h)); }
  };

  static bool is_within_margin(const Pair& pair, const PatchPoint& p, const Vec3& n) {
    const Pose& pose = pair.a.pose;
    return p.gap <= pair.settings.contact_distance + margin_along(pair.a, pair.b, pose.rotation * n, pose.to_world(p.a), pair.scale,
                                                                  pair.h, pair.settings);
  }
  void add_within_margin(const Pair& pair, const PatchPoint& p, const Vec3& n, Index triangle) {
    if (is_within_margin(pair, p, n)) points_.push_back({p, n, triangle});
  }

  /// A triangle that was left out: its distance from the shape, or less, and the normal there. World frame, m.
  struct ApartTriangle {
    std::uint64_t pair;
    Index triangle;
    double distance;
    Vec3 normal;
  };
  struct Asked {
    std::uint64_t pair;
    double reach;  ///< m
  };

  static double touch_of(const Pair& pair) { return pair.settings.contact_distance + touch_share * pair.scale; }

  /// Leaves out of `points_` those of triangles that are apart and not met, or met elsewhere than at their nearest points; `hit_`
  /// is the first such impact. What continues a plane that is touched stays. Of a triangle far off a doubt about its nearest point says
  /// nothing of where it is met.
  void look_ahead(const auto& surface, const Pair& pair) {
    touched_.clear();
    const double touch = touch_of(pair);
    for (const SurfaceContact& p : points_)
      if (p.point.gap <= touch && !doubts_.is_false(p.triangle)) touched_.push_back(p.normal);
    asked_.push_back({pair.job.pair, pair.reach});
    ask_skipped(surface, pair, touch);
    const bool are_alone = pair.a.goes_alone && pair.b.goes_alone, is_fast = may_outgrow_margin(pair.a, pair.b, pair.scale, pair.h);
    Index last = -1;
    bool stays = true;
    erase_if(points_, [&](const SurfaceContact& p) {
      const bool is_near = is_within_margin(pair, p.point, p.normal), is_false = doubts_.is_false(p.triangle);
      if (is_false && (is_near || p.point.gap <= touch)) return true;
      if (p.point.gap <= touch || (is_near && (!are_alone || is_among(touched_, p.normal)))) return false;
      if (p.triangle != last) {
        last = p.triangle;
        const Vec3 n = pair.a.pose.rotation * p.normal;
        // The triangle is as far as the nearest of its points, which follow one another.
        double least = p.point.gap;
        bool is_any_near = is_near;
        for (const SurfaceContact* q = &p + 1; q != points_.data() + points_.size() && q->triangle == p.triangle; ++q)
          least = std::min(least, q->point.gap), is_any_near = is_any_near || is_within_margin(pair, q->point, q->normal);
        const ApartTriangle apart{pair.job.pair, p.triangle, least - touch, n};
        const Impact hit = impact_on(surface, pair, apart);
        stays = is_any_near && (hit.is_now || (hit.is_found && !is_fast && dot(hit.a.rotation * hit.normal_in_a, n) > same_normal));
        if (!stays) apart_.push_back(apart);
        if (!stays && hit.is_found && !(hit_.is_found && hit_.time <= hit.time)) hit_ = hit;
      }
      return !stays;
    });
  }
  /// Triangles whose neighbours are nearer may be those that the body meets.
  void ask_skipped(const auto& surface, const Pair& pair, double touch) {
    for (const Index t : skipped_) {
      const SignedPair r = distance_to(surface.triangle(t), pair.b.shape, pair.b_in_a, pair.b_in_a.position);
      if (r.status != PairStatus::near || !(r.distance > touch)) continue;
      const ApartTriangle apart{pair.job.pair, t, r.distance - touch, pair.a.pose.rotation * r.normal};
      apart_.push_back(apart);
      const Impact hit = impact_on(surface, pair, apart);
      if (hit.is_found && !(hit_.is_found && hit_.time <= hit.time)) hit_ = hit;
    }
  }
  static SignedPair distance_to(const Triangle& t, const Shape& s, const Pose& b_in_a, const Vec3& guess) {
    if (s.kind == ShapeKind::sphere) return triangle_and_sphere(t, s.size[0], b_in_a.to_world(middle(s)));
    return GjkEpa::convex(t, s, b_in_a, std::numeric_limits<double>::infinity(), guess);
  }
  static bool is_among(const Array<Vec3>& normals, const Vec3& n) {
    return std::any_of(normals.begin(), normals.end(), [&](const Vec3& other) { return dot(other, n) > 0.9962; });
  }
  /// When the triangle is met.
  static Impact impact_on(const auto& surface, const Pair& pair, const ApartTriangle& apart) {
    if (!may_close(pair.a, pair.b, apart.normal, apart.distance, pair.h)) return {};
    const Triangle t = surface.triangle(apart.triangle);
    const Shape& s = pair.b.shape;
    if (stay_apart(t, pair.a, pair.b, apart.normal, pair.h, touch_of(pair))) return {};
    return time_of_impact(pair.a, pair.b, pair.h, touch_of(pair), transposed_times(pair.a.pose.rotation, apart.normal), [&](const Pose& b_in_a, const Vec3& guess) {
      return distance_to(t, s, b_in_a, guess);
    });
  }
  /// Fills `points_` with those of the place of `hit_`, in planes where `known` has no contacts of the pair.
  void collect_at_impact(const auto& surface, const Pair& pair, const Array<PairMemory>& known) {
    touched_.clear();
    for (const PairMemory& m : known)
      if (m.pair == pair.job.pair) touched_.push_back(m.normal);
    const double speed = dot(hit_.a.rotation * hit_.normal_in_a, pair.a.velocity - pair.b.velocity),
                 margin = pair.settings.contact_distance + limited_margin(std::abs(speed) * (pair.h - hit_.time), pair.scale);
    points_.clear();
    pieces_.clear();
    doubts_.collect(surface, pair.b.shape, hit_.a.to_local(hit_.b), margin, pair.scale, [&](Index t, const Patch& patch, const Vec3& n) {
      for (int i = 0; i < patch.count; ++i)
        if (patch.point[i].gap <= margin && !is_among(touched_, n)) points_.push_back({patch.point[i], n, t, true});
    }, [](const Triangle&, Index) {});
    erase_if(points_, [&](const SurfaceContact& p) { return doubts_.is_false(p.triangle); });
  }
  /// A row through the middle of B where it flies by, see `flies_by`, and has none: the ball about it goes without turning.
  void hold_core(const auto& surface, const Pair& pair, std::vector<ContactPoint>& out) {
    if (!flies_by(pair.b, pair.h)) return;
    for (const std::uint64_t held : cores_)
      if (held == pair.job.pair) return;
    Collider core = pair.b;
    const double radius = core_of_motion(core.shape);
    core.shape = Sphere{radius};
    set_zero(core.angular_velocity);
    const Pose end = pose_after(pair.a, pair.h).to_local(pose_after(core, pair.h));
    Bounds near = bounds_around(core.shape, pair.b_in_a, 0);
    const Bounds there = bounds_around(core.shape, end, 0);
    for (int k = 0; k < 3; ++k) near.low[k] = std::min(near.low[k], there.low[k]), near.high[k] = std::max(near.high[k], there.high[k]);
    Impact first;
    surface.visit([&](const Bounds& box) { return box.meets(near); }, [&](Index t) {
      const Triangle triangle = surface.triangle(t);
      if (is_zero(triangle.normal) || !(triangle.height(pair.b_in_a.position) >= 0)) return;
      const Impact hit = time_of_impact(pair.a, core, pair.h, 1e-3 * radius, zero<Vec3>(), [&](const Pose& b_in_a, const Vec3&) {
        return triangle_and_sphere(triangle, radius, b_in_a.position);
      });
      if ((hit.is_found || hit.is_now) && !((first.is_found || first.is_now) && first.time <= hit.time)) first = hit;
    });
    if (!first.is_found && !first.is_now) return;
    const Vec3 n = first.a.rotation * first.normal_in_a;
    const double flight = dot(n, pair.a.velocity - core.velocity);
    if (!(flight > 0)) return;
    cores_.push_back(pair.job.pair);
    add(pair, core_row(pair.job, pair.a, core, false, first, radius, n, pair.a.key < pair.b.key ? 1 : 0), out);
  }
  /// As CollisionEngine does.
  void finish_impact(const Pair& pair, std::size_t first, std::vector<ContactPoint>& out) {
    const auto less = [](const PairImpact& i, std::uint64_t key) { return i.pair < key; };
    const PairImpact* const end = impacts_.data() + impacts_.size();
    for (const PairImpact* at = inner::lower_bound(impacts_.data(), impacts_.data() + impacts_.size(), pair.job.pair, less);
         at != end && at->pair == pair.job.pair; ++at) {
      const RememberedImpact& impact = at->impact;
      if (!goes_on(impact, pair.a, pair.b)) continue;
      const auto is_same = [&](const ContactPoint& c) { return dot(pair.a.key < pair.b.key ? c.normal : Vec3(-c.normal), impact.normal) > same_normal; };
      if (std::any_of(out.begin() + std::ptrdiff_t(first), out.end(), is_same) && is_there(impact, pair.a, pair.b, first, out, pair.scale)) continue;
      add(pair, row_ahead(pair.job, pair.a, pair.b, impact.arm_a, impact.arm_b, impact.normal, 0, unused(impact.id, first, out)), out);
    }
  }
  static void add(const Pair& pair, const ContactPoint& c, std::vector<ContactPoint>& out) {
    out.push_back(c);
    if (pair.a.key >= pair.b.key) out.back().exchange_bodies();
  }

  /// Corners of the surface with a gap up to `reach` over a plane.
  template <class Surface>
  Index collect_on_plane(const Surface& surface, const Plane& plane, double reach) {
    Index queries = 0;
    const auto meets = [&](const Bounds& box) {
      double lowest = -plane.offset;
      for (int k = 0; k < 3; ++k)
        lowest += plane.normal[k] * (plane.normal[k] > 0 ? box.low[k] : box.high[k]);
      return lowest <= reach;
    };
    surface.visit(meets, [&](Index t) {
      ++queries;
      const Triangle triangle = surface.triangle(t);
      if (dot(triangle.normal, plane.normal) <= -0.9962) {
        double lowest = reach, highest = -reach;
        for (const Vec3& corner : triangle.point) {
          const double gap = dot(plane.normal, corner) - plane.offset;
          lowest = std::min(lowest, gap), highest = std::max(highest, gap);
        }
        if (highest <= reach) pieces_.add(3, [&](int k) -> const Vec3& { return triangle.point[k]; }, -plane.normal, lowest);
      }
      for (int k = 0; k < 3; ++k) {
        const Vec3& corner = triangle.point[k];
        const double gap = dot(plane.normal, corner) - plane.offset;
        if (!(gap <= reach)) continue;
        const Vec3 foot = corner - gap * plane.normal;
        points_.push_back({{corner, foot, gap, vertex_name(true, triangle.corner[k])}, -plane.normal});
      }
    });
    return queries;
  }

  void find_last(std::uint64_t key) {
    const auto less = [](const PairMemory& m, std::uint64_t k) { return m.pair < k; };
    last_ = std::size_t(inner::lower_bound(memory_.data(), memory_.data() + memory_.size(), key, less) - memory_.begin());
    is_claimed_.clear();
    for (std::size_t i = last_; i < memory_.size() && memory_[i].pair == key; ++i)
      is_claimed_.push_back(false);
  }

  /// Turns the points into contacts of the pair, group by group.
  void emit(const Pair& pair, std::size_t first_out, std::vector<ContactPoint>& out) {
    while (!points_.empty()) {
      split_group();
      emit_group(pair, first_out, out);
    }
  }
  static void sort_names(std::size_t first_out, std::vector<ContactPoint>& out) {
    inner::sort(out.data() + first_out, out.data() + out.size(),
              [](const ContactPoint& p, const ContactPoint& q) { return p.feature < q.feature; });
  }

  /// Moves the first point, and all whose normals are within 5° of its own, into `group_`.
  void split_group() {
    const Vec3 n = points_[0].normal;
    group_.clear();
    erase_if(points_, [&](const SurfaceContact& p) {
      if (dot(p.normal, n) < 0.9962) return false;
      group_.push_back(p);
      return true;
    });
  }

  /// What is remembered of this pair in about this direction.
  PairMemory remembered(const Vec3& n) {
    int best = -1;
    double closeness = 0.9;
    for (std::size_t i = 0; i < is_claimed_.size(); ++i) {
      const double c = dot(memory_[last_ + i].normal, n);
      if (!is_claimed_[i] && c > closeness) closeness = c, best = int(i);
    }
    if (best < 0) return {};
    is_claimed_[best] = true;
    return memory_[last_ + std::size_t(best)];
  }

  /// The cap with which B meets a surface whose normal is n, or none.
  static RoundFace round_face_against(const Pair& pair, const Vec3& n) {
    const Shape& s = pair.b.shape;
    if (s.kind != ShapeKind::cylinder && s.kind != ShapeKind::cone) return {};
    const Face face = face_towards(s, Vec3(-transposed_times(pair.b_in_a.rotation, n)));
    return round_face(s, posed(face, pair.b_in_a), pair.b_in_a.position);
  }

  /// The area is that of the pieces, where they are known, and not of the hull.
  void find_area(const Vec3& n, double reach) {
    double least = group_[0].point.gap;
    for (const SurfaceContact& p : group_) least = std::min(least, p.point.gap);
    const ContactArea area = pieces_.area(n, least + reach);
    if (area.size > 0) patch_.area = area;
  }

  void emit_group(const Pair& pair, std::size_t first_out, std::vector<ContactPoint>& out) {
    const Vec3 n = group_[0].normal;
    const RoundFace round = round_face_against(pair, n);
    hull_.choose(group_, n, pair.scale, round, patch_, source_);
    if (!(round.radius > 0)) find_area(n, 1e-3 * pair.scale);
    PairMemory now;
    now.pair = pair.job.pair;
    now.normal = n;
    const bool is_ahead = group_[0].is_ahead;
    const std::size_t first = out.size();
    const auto add_point = [&](int i, std::uint32_t id) {
      const Vec3& of_point = group_[source_[i]].normal;
      if (is_ahead) return add(pair, ahead(pair, patch_.point[i], of_point, id), out);
      add(pair, contact_of(pair.job, pair.a.pose, patch_.point[i], pair.a.pose.rotation * of_point, pair.settings.contact_distance, id), out);
    };
    name_points(patch_, remembered(n), is_ahead ? hit_.a.to_local(hit_.b) : pair.b_in_a, n, pair.scale, pair.settings.max_points, first_out,
                out, now, add_point);
    if (is_ahead || will_meet(n)) remember_impact(pair, is_ahead ? hit_.a : pair.a.pose, is_ahead ? hit_.b : pair.b.pose, now.area, first, out);
    if (!is_ahead) share_area(now.area, pair.a.pose, now.count, out);
    next_.push_back(now);
  }
  /// The row of a point of the place of impact.
  ContactPoint ahead(const Pair& pair, const PatchPoint& p, const Vec3& n, std::uint32_t id) const {
    return impact_row(pair.job, pair.a, pair.b, hit_, p, hit_.a.rotation * n, pair.settings.contact_distance, id);
  }
  /// Whether the plane of the normal was apart and is kept because it will be met.
  bool will_meet(const Vec3& n) const {
    return is_new_ && !is_among(touched_, n);
  }
  /// The two meet at these poses, of faces in the middle of their area.
  void remember_impact(const Pair& pair, const Pose& at_a, const Pose& at_b, const ContactArea& area, std::size_t first, const std::vector<ContactPoint>& out) {
    if (first == out.size()) return;
    Vec3 middle = zero<Vec3>(), half = zero<Vec3>();
    for (std::size_t i = first; i < out.size(); ++i) middle += out[i].point() / double(out.size() - first), half += 0.5 * out[i].travel / double(out.size() - first);
    const double sign = pair.a.key < pair.b.key ? 1 : -1;
    Vec3 arm_a = middle - sign * half - pair.a.pose.position, arm_b = middle + sign * half - pair.b.pose.position;
    if (out.size() - first >= 3 && area.size > 0) arm_a = at_a.rotation * area.middle, arm_b = at_a.position + arm_a - at_b.position;
    next_impacts_.push_back({pair.job.pair, {sign * out[first].normal, arm_a, arm_b, out[first].feature, true}});
  }

  Array<SurfaceContact> points_, group_;
  std::vector<FeatureContact> features_;
  Array<Cut> cuts_;
  Patch patch_;
  PatchDoubts doubts_;
  FixedArray<Index, Patch::capacity> source_{};
  HullOfPatch hull_;
  FacePieces pieces_;
  Array<PairMemory> memory_, next_;
  Impact hit_;  ///< the first of the pair that is not at the nearest points
  bool is_new_ = false;  ///< the pair did not push in the last step, and goes as is known
  Array<Vec3> touched_;  ///< normals of what the pair touches, in the frame of A
  Array<ApartTriangle> apart_;
  Array<Asked> asked_;
  Array<Index> skipped_;  ///< triangles whose neighbours are nearer
  Array<std::uint64_t> cores_;  ///< pairs whose middle of B is held
  Array<PairImpact> impacts_, next_impacts_;
  std::size_t last_ = 0;
  Array<char> is_claimed_;
};

template <class Surface>
void SurfacePairs::collide_missed(const Surface& surface, std::span<const Collider> colliders, const PairJob& job, double h,
                                  const CollisionSettings& settings, std::vector<ContactPoint>& out) {
  const Collider &a = colliders[job.a], &b = colliders[job.b];
  if (b.shape.kind == ShapeKind::half_space) return;
  Pair pair(job, a, b, length_scale(b.shape), h, settings);
  pair.reach = std::max(pair.reach, settings.contact_distance + pair.way());
  hit_ = {};
  const auto ask = [&](const ApartTriangle& apart) {
    const Impact hit = impact_on(surface, pair, apart);
    if (hit.is_found && !(hit_.is_found && hit_.time <= hit.time)) hit_ = hit;
  };
  for (const ApartTriangle& apart : apart_)
    if (apart.pair == job.pair) ask(apart);
  double reach = -1;
  for (Asked& asked : asked_)
    if (asked.pair == job.pair) reach = asked.reach, asked.reach = std::max(reach, pair.reach);
  if (reach < 0) asked_.push_back({job.pair, pair.reach});
  if (pair.reach > reach) {
    const double touch = touch_of(pair);
    doubts_.collect(surface, b.shape, pair.b_in_a, pair.reach, pair.scale, [&](Index t, const Patch& patch, const Vec3& n) {
      const double gap = patch.point[deepest(patch)].gap;
      if (!(gap > std::max(reach, touch))) return;
      apart_.push_back({job.pair, t, gap - touch, a.pose.rotation * n});
      ask(apart_[apart_.size() - 1]);
    }, [&](const Triangle& triangle, Index t) {
      if (!(triangle.height(pair.b_in_a.to_world(middle(b.shape))) >= 0)) return;
      const SignedPair r = distance_to(triangle, b.shape, pair.b_in_a, pair.b_in_a.position);
      if (r.status != PairStatus::near || !(r.distance > std::max(reach, touch))) return;
      apart_.push_back({job.pair, t, r.distance - touch, a.pose.rotation * r.normal});
      ask(apart_[apart_.size() - 1]);
    });
  }
  hold_core(surface, pair, out);
  if (!hit_.is_found) return;
  collect_at_impact(surface, pair, memory_);
  const std::size_t first = out.size();
  next_.clear(), next_impacts_.clear(), is_claimed_.clear();
  emit(pair, first, out);
  sort_names(first, out);
  for (const PairMemory& m : next_) memory_.push_back(m);
  for (const PairImpact& i : next_impacts_) impacts_.push_back(i);
  inner::sort(memory_, [](const PairMemory& x, const PairMemory& y) { return x.pair < y.pair; });
  inner::sort(impacts_, [](const PairImpact& x, const PairImpact& y) { return x.pair < y.pair; });
}

}  // namespace delassus::inner
