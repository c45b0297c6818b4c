/// The narrow phase of libccd: the depth of overlapping pairs by Minkowski portal refinement.
#pragma once

#include <delassus/collision/gjk_epa.hpp>
#include <delassus/collision/signed_pair.hpp>
#include <delassus/core/cmath.hpp>

#include <ccd/ccd.h>

#include <algorithm>
#include <limits>

namespace delassus {
namespace inner {

/// A posed shape as libccd's callbacks see it: scaled to unit size, with a budget of support calls.
struct CcdBody {
  const Shape& shape;
  const Pose& pose;
  double scale;
  int& budget;
};

inline void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) noexcept {
  const CcdBody& body = *static_cast<const CcdBody*>(object);
  Vec3 x = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (body.budget-- > 0) {
    const Vec3 d = body.pose.rotation.transpose() * Vec3(direction->v[0], direction->v[1], direction->v[2]);
    x = body.scale * body.pose.to_world(support(body.shape, Vec3(d.normalized())));
  }
  ccdVec3Set(point, x[0], x[1], x[2]);
}

inline void ccd_center(const void* object, ccd_vec3_t* point) noexcept {
  const CcdBody& body = *static_cast<const CcdBody*>(object);
  const Vec3 x = body.scale * body.pose.to_world(middle(body.shape));
  ccdVec3Set(point, x[0], x[1], x[2]);
}

}  // namespace inner

/// libccd decides whether two bodies overlap, and how deeply: `ccdMPRPenetration`, which allocates nothing.
/// It has no distance for bodies apart, so GJK gives that. Its tolerances are absolute: bodies are scaled to
/// unit size. Two of its loops have no bound of their own: beyond `max_supports` the support points are NaN,
/// which ends them, and the answer is a failed one. Its EPA, `ccdGJKPenetration`, is never asked: it is wrong
/// in two thirds of shallow contacts.
struct CcdKernel {
  int max_iterations = 100;
  double tolerance = 1e-7;  ///< of the portal, relative to the smaller body
  int max_supports = 1000;  ///< of one pair

  SignedPair pair(const Shape& a, const Shape& b, const Pose& b_in_a, double margin,
                  PairCache& cache) const noexcept {
    const double scale = std::ldexp(1.0, -std::ilogb(std::min(length_scale(a), length_scale(b))));
    const Pose a_in_a;
    int budget = max_supports;
    const inner::CcdBody body_a{a, a_in_a, scale, budget}, body_b{b, b_in_a, scale, budget};
    ccd_t settings;
    CCD_INIT(&settings);
    settings.support1 = settings.support2 = inner::ccd_support;
    settings.center1 = settings.center2 = inner::ccd_center;
    settings.max_iterations = static_cast<unsigned long>(max_iterations);
    settings.mpr_tolerance = tolerance;
    ccd_real_t depth = 0;
    ccd_vec3_t direction{}, position{};
    const bool is_overlap =
        ccdMPRPenetration(&body_a, &body_b, &settings, &depth, &direction, &position) == 0;
    if (budget < 0) return {};
    if (!is_overlap) return GjkEpa{}.pair(a, b, b_in_a, margin, cache);
    const Vec3 normal(direction.v[0], direction.v[1], direction.v[2]);
    const Vec3 middle = Vec3(position.v[0], position.v[1], position.v[2]) / scale;
    return {.status = PairStatus::near,
            .distance = -depth / scale,
            .normal = normal,
            .point_a = middle + 0.5 * depth / scale * normal,
            .point_b = middle - 0.5 * depth / scale * normal};
  }
};
}  // namespace delassus
