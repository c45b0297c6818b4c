#include "scenes.hpp"

#include "catch.hpp"

#include <delassus/collision/native.hpp>
#include <delassus/collision/native_engine.hpp>

#include <limits>
#include <stdexcept>
#include <vector>

namespace broken_kernels_tests {

using namespace delassus;
using namespace scenes;

namespace {

enum class Fault {
  none,
  throws,
  throws_a_number,
  nan_normal,
  nan_distance,
  nan_witness,
  infinite,
  zero_normal,
  forged,
  none_answered
};

/// Answers wrongly every second time, in the way it is told, and spoils what it was lent besides.
struct BrokenKernel {
  Fault fault = Fault::none;
  int calls = 0;

  SignedPair pair(const Shape& a, const Shape& b, const Pose& b_in_a, double margin, PairCache& cache) {
    SignedPair r = GjkEpa{}.pair(a, b, b_in_a, margin, cache);
    if (fault == Fault::none || calls++ % 2) return r;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    cache.guess = Vec3::Constant(nan);
    if (fault == Fault::throws) throw std::runtime_error("a broken kernel");
    if (fault == Fault::throws_a_number) throw 7;
    if (fault == Fault::nan_normal) r.normal[1] = nan;
    if (fault == Fault::nan_distance) r.distance = nan;
    if (fault == Fault::nan_witness) r.point_b[0] = nan;
    if (fault == Fault::infinite) r.distance = -std::numeric_limits<double>::infinity();
    if (fault == Fault::zero_normal) r.normal.setZero();
    if (fault == Fault::forged) r.distance -= 0.1;
    if (fault == Fault::none_answered) return {};
    return r;
  }
};
static_assert(NarrowKernel<BrokenKernel>);
using Broken = NativeDetection<BrokenKernel, BoxTree>;

/// Boxes and hulls that fall in a heap and come to rest.
std::vector<Vec3> pile(Fault fault, Index& rejects) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Broken{}};
  loop.get<Broken>().engine->kernel().fault = fault;
  auto& set = rigid_bodies(loop);
  const ConvexHull cube = cube_of_points(0.7);
  set.add_fixed(Box{20, 20, 1}, {0, 0, -0.5});
  std::vector<RigidBodies::Handle> bodies;
  for (int i = 0; i < 8; ++i)
    bodies.push_back(set.add({.position = {0.35 * (i % 3), 0.25 * (i % 2), 0.6 + 1.02 * i},
                              .mass = 1.0,
                              .shape = i % 3 == 0   ? Shape(cube)
                                       : i % 3 == 1 ? Shape(Box{1, 1, 0.5})
                                                    : Shape(Cylinder{0.4, 0.6})}));
  rejects = 0;
  for (int n = 0; n < 90; ++n) rejects += loop.step(1.0 / 60).rejects;
  std::vector<Vec3> where;
  for (const auto body : bodies) where.push_back(set.position(body));
  return where;
}

}  // namespace

// A refused answer is asked of GjkEpa again, with the same guess, and the others are its own: the whole
// motion is the native one to the bit.
TEST_CASE("a kernel that throws, or answers with what is no number, changes no bit of a scene") {
  Index rejects = 0;
  const std::vector<Vec3> truth = pile(Fault::none, rejects);
  REQUIRE(rejects == 0);
  for (const Vec3& x : truth) REQUIRE(is_finite(x));
  for (const Fault fault :
       {Fault::throws, Fault::throws_a_number, Fault::nan_normal, Fault::nan_distance, Fault::nan_witness,
        Fault::infinite, Fault::zero_normal, Fault::forged, Fault::none_answered}) {
    const std::vector<Vec3> seen = pile(fault, rejects);
    CAPTURE(int(fault), rejects);
    CHECK(rejects > 50);
    for (std::size_t i = 0; i < truth.size(); ++i) CHECK(seen[i] == truth[i]);
  }
}

}  // namespace broken_kernels_tests
