/// The narrow phase of FCL: signed distances of convex pairs, for the engine to certify.
#pragma once

#include <delassus/collision/gjk.hpp>
#include <delassus/collision/signed_pair.hpp>
#include <delassus/core/cmath.hpp>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

static_assert(
    EIGEN_MAX_ALIGN_BYTES == 16,
    "delassus: libfcl is built with 16-byte alignment; compile without AVX (no -march=native) or define "
    "EIGEN_MAX_ALIGN_BYTES=16 before any header");

// The two entry points are instantiated in libfcl: declaring them costs nothing, their headers cost a second.
namespace fcl {
template <typename S>
std::size_t collide(const CollisionGeometry<S>*, const Transform3<S>&, const CollisionGeometry<S>*,
                    const Transform3<S>&, const CollisionRequest<S>&, CollisionResult<S>&);
template <typename S>
S distance(const CollisionGeometry<S>*, const Transform3<S>&, const CollisionGeometry<S>*,
           const Transform3<S>&, const DistanceRequest<S>&, DistanceResult<S>&);
extern template std::size_t collide<double>(const CollisionGeometry<double>*, const Transform3<double>&,
                                            const CollisionGeometry<double>*, const Transform3<double>&,
                                            const CollisionRequest<double>&, CollisionResult<double>&);
extern template double distance<double>(const CollisionGeometry<double>*, const Transform3<double>&,
                                        const CollisionGeometry<double>*, const Transform3<double>&,
                                        const DistanceRequest<double>&, DistanceResult<double>&);
}  // namespace fcl

namespace delassus {
namespace inner {

/// FCL's copies of hulls, each scaled by a power of two. A hull is recognised by its vertices, never by its
/// address. Copies of the cache share what is there: nobody changes it.
class FclHulls {
 public:
  const fcl::Convexd& at(const ConvexHull& hull, double scale) {
    for (const Entry& e : entries_)
      if (e.scale == scale && e.source.size() == hull.vertices().size() &&
          std::equal(e.source.begin(), e.source.end(), hull.vertices().begin()))
        return *e.convex;
    return *entries_.emplace_back(make(hull, scale)).convex;
  }

 private:
  struct Entry {
    double scale;
    std::vector<Vec3> source;
    std::shared_ptr<const fcl::Convexd> convex;
  };

  static Entry make(const ConvexHull& hull, double scale) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    auto faces = std::make_shared<std::vector<int>>();
    for (const Vec3& v : hull.vertices()) vertices->push_back(scale * v);
    for (Index f = 0; f < hull.face_count(); ++f) {
      faces->push_back(int(hull.face(f).size()));
      faces->insert(faces->end(), hull.face(f).begin(), hull.face(f).end());
    }
    return {scale,
            {hull.vertices().begin(), hull.vertices().end()},
            std::make_shared<const fcl::Convexd>(vertices, int(hull.face_count()), faces)};
  }

  std::vector<Entry> entries_;
};

}  // namespace inner

/// What each call is right for, and no other:
///   box–box, sphere–box, sphere–capsule, sphere–cylinder, sphere–sphere   their own formulas in `collide`
///   capsule–capsule                                                       its formula in `distance`
///   other overlapping pairs                                               `collide`, which is libccd's MPR
///   pairs apart                                                           `distance`, unsigned, to 1e-9
/// Debian's libfcl asserts: `distance` ends the process on some bodies that touch, and its signed form on
/// some that overlap. So the latter is never asked, and the former only when a few steps of our GJK have
/// proven a gap of 1e-8 of the size. Queries run in the frame of A, scaled by a power of two to unit size,
/// since FCL's tolerances are absolute. What FCL throws is a failed answer.
class FclKernel {
 public:
  SignedPair pair(const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
                  PairCache& cache) noexcept {
    try {
      const double scale = std::ldexp(1.0, -std::ilogb(std::min(length_scale(a), length_scale(b))));
      // FCL's frame of A is ours, moved to the middle of A.
      const Vec3 middle_a = scale * fcl_middle(a);
      fcl::Transform3d pose = fcl::Transform3d::Identity();
      pose.linear() = b_in_a.rotation;
      pose.translation() = scale * b_in_a.to_world(fcl_middle(b)) - middle_a;
      SignedPair r;
      with_geometry(a, scale, [&](const Geometry& ga) {
        with_geometry(b, scale, [&](const Geometry& gb) {
          const bool has_signed_distance = a.kind == ShapeKind::capsule && b.kind == ShapeKind::capsule;
          if (has_signed_distance ||
              (!overlap(ga, gb, pose, r) && is_clear(a, b, b_in_a, cache.guess, 1e-8 / scale)))
            apart(ga, gb, pose, r);
        });
      });
      r.distance /= scale;
      r.point_a = (r.point_a + middle_a) / scale;
      r.point_b = (r.point_b + middle_a) / scale;
      if (r.status == PairStatus::near && r.distance > margin) r.status = PairStatus::far;
      return r;
    } catch (...) {
      return {};
    }
  }

 private:
  using Geometry = fcl::CollisionGeometryd;

  /// Where FCL has the origin of a shape: a cone's is half way up, ours at the centre of mass.
  static Vec3 fcl_middle(const Shape& s) {
    return s.kind == ShapeKind::cone ? Vec3(0.5 * s.size[1] * unit_axis(2)) : Vec3::Zero();
  }

  template <class F>
  void with_geometry(const Shape& s, double scale, const F& f) {
    switch (s.kind) {
      case ShapeKind::sphere:
        return f(fcl::Sphered(scale * s.size[0]));
      case ShapeKind::box:
        return f(fcl::Boxd(2 * scale * s.size[0], 2 * scale * s.size[1], 2 * scale * s.size[2]));
      case ShapeKind::capsule:
        return f(fcl::Capsuled(scale * s.size[0], 2 * scale * s.size[1]));
      case ShapeKind::cylinder:
        return f(fcl::Cylinderd(scale * s.size[0], 2 * scale * s.size[1]));
      case ShapeKind::cone:
        return f(fcl::Coned(scale * s.size[0], 2 * scale * s.size[1]));
      case ShapeKind::ellipsoid:
        return f(fcl::Ellipsoidd(scale * s.size[0], scale * s.size[1], scale * s.size[2]));
      case ShapeKind::convex_hull:
        return f(hulls_.at(*s.hull, scale));
      default:
        return;
    }
  }

  static bool is_clear(const Shape& a, const Shape& b, const Pose& b_in_a, const Vec3& guess, double gap) {
    const inner::Difference difference{a, b, b_in_a};
    const double wanted = gap + difference.radius();
    const Vec3 direction = guess.squaredNorm() > 0 ? guess : Vec3(b_in_a.position + Vec3::UnitZ() * gap);
    return inner::gjk(difference, direction, wanted).separation > wanted;
  }

  /// False when FCL sees no overlap. The normal is that of the deepest of at most four contacts.
  bool overlap(const Geometry& a, const Geometry& b, const fcl::Transform3d& pose, SignedPair& r) {
    contacts_.clear();
    const fcl::CollisionRequestd request(4, true, 1, false, true, fcl::GST_LIBCCD, 1e-7);
    if (fcl::collide<double>(&a, fcl::Transform3d::Identity(), &b, pose, request, contacts_) == 0)
      return false;
    std::size_t deepest = 0;
    for (std::size_t i = 1; i < contacts_.numContacts(); ++i)
      if (contacts_.getContact(i).penetration_depth > contacts_.getContact(deepest).penetration_depth)
        deepest = i;
    const fcl::Contactd& c = contacts_.getContact(deepest);
    const double sign = c.o1 == &a ? 1 : -1;
    r = {.status = PairStatus::near, .distance = -c.penetration_depth, .normal = sign * c.normal};
    r.point_a = c.pos + 0.5 * c.penetration_depth * r.normal;
    r.point_b = c.pos - 0.5 * c.penetration_depth * r.normal;
    return true;
  }

  void apart(const Geometry& a, const Geometry& b, const fcl::Transform3d& pose, SignedPair& r) {
    fcl::DistanceRequestd request(true, false);
    request.distance_tolerance = 1e-9;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::DistanceResultd nearest;
    const double distance =
        fcl::distance<double>(&a, fcl::Transform3d::Identity(), &b, pose, request, nearest);
    if (distance == 0) return;
    r = {.status = PairStatus::near,
         .distance = distance,
         .normal = (nearest.nearest_points[1] - nearest.nearest_points[0]) / distance,
         .point_a = nearest.nearest_points[0],
         .point_b = nearest.nearest_points[1]};
  }

  inner::FclHulls hulls_;
  fcl::CollisionResultd contacts_;
};
}  // namespace delassus
