/// What a kernel must do over all convex pairs, and how far from the truth it was.
#pragma once

#include "collision/samples.hpp"

#include <delassus/collision/certified_pair.hpp>

#include <cstdlib>
#include <vector>

namespace samples {

/// One shape of every kind that has a volume, of about `size` m.
struct Zoo {
  explicit Zoo(double size = 1)
      : hull(ball_hull(20, 7, 0.5 * size)),
        all{Sphere{0.4 * size},
            Box{size, 0.6 * size, 0.8 * size},
            Capsule{0.25 * size, 0.8 * size},
            Cylinder{0.35 * size, 0.8 * size},
            hull,
            Cone{0.4 * size, 0.9 * size},
            Ellipsoid{0.5 * size, 0.3 * size, 0.4 * size}} {}
  Zoo(const Zoo&) = delete;
  ConvexHull hull;
  std::vector<Shape> all;
};

template <class F>
void for_each_pair(const std::vector<Shape>& shapes, const F& f) {
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t j = i; j < shapes.size(); ++j) f(shapes[i], shapes[j]);
}

inline double scale_of(const Sample& s) { return std::min(length_scale(s.a), length_scale(s.b)); }

/// How many poses of each pair and class: `few`, or what the environment variable DELASSUS_POSES says.
inline int poses(int few) {
  const char* asked = std::getenv("DELASSUS_POSES");
  return asked ? std::max(1, std::atoi(asked)) : few;
}

/// Of `poses` poses so many were missed (an overlap called a gap), rejected by the certificate, or longer
/// than need be by more than 1e-4 L. Errors relative to the smaller size L.
struct Figures {
  int poses = 0, missed = 0, rejected = 0, deeper = 0;
  double depth_error = 0;  ///< | distance − truth |
  double excess = 0;       ///< h(n) − min h: how much longer this way out is than the shortest

  void add(const Sample& s, const CertifiedPair& answer, double truth) {
    const double L = scale_of(s), distance = answer.pair.distance, proven = -s.reach(answer.pair.normal);
    ++poses;
    rejected += answer.is_rejected;
    missed += truth < -1e-6 * L && distance >= 0;
    deeper += truth - proven > 1e-4 * L;
    // NaN counts as infinite: no comparison with it may pass.
    const auto larger = [](double worst, double x) { return x <= worst ? worst : x; };
    depth_error = larger(depth_error, std::abs(distance - truth) / L);
    excess = larger(excess, (truth - proven) / L);
  }
};

/// The signed distance that is known: by construction when apart or touching, else by search. The search can
/// only be beaten, never be too low, and the kernel's own normal may beat it.
inline double truth(const Sample& s, Depth depth, double apart, const Vec3& kernel_normal,
                    std::mt19937& random) {
  return depth >= Depth::touch ? apart : -std::min(true_depth(s, random), s.reach(kernel_normal));
}

template <class Kernel>
Figures accept(const std::vector<Shape>& shapes, Depth depth, int count, unsigned seed) {
  std::mt19937 random(seed);
  Kernel kernel;
  Figures figures;
  for_each_pair(shapes, [&](const Shape& a, const Shape& b) {
    for (int k = 0; k < count; ++k) {
      double apart = 0;
      const Sample s = any_pose(a, b, depth, k % 2 == 1, random, apart);
      const CertifiedPair r =
          certified_pair(kernel, a, b, s.b_in_a, 10 * scale_of(s), scale_of(s), Vec3::Zero());
      figures.add(s, r, truth(s, depth, apart, r.pair.normal, random));
    }
  });
  return figures;
}

}  // namespace samples
