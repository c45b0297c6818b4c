#include "adapters/backend.hpp"
#include "catch.hpp"

#include <delassus/adapters/ccd.hpp>

#include <vector>

using namespace delassus;
using namespace samples;
using namespace scenes;

TEST_CASE(
    "whatever libccd says, the contacts are right: no miss, no false depth, in every class and at every "
    "size") {
  check_backend<CcdCollision>();
}

TEST_CASE("under the certificate libccd misses no overlap and errs by no more than its portals do", "[table]") {
  check_kernel<CcdKernel>();
}

TEST_CASE("the share of libccd's refused answers is known") {
  // Measured on 1500 poses: 71 % deep, 71 % at 1e-2 L, 22 % at 1e-4 L, 9 % touching, none apart (GJK is
  // ours).
  CHECK(shares<CcdKernel>(all_pairs(), Depth::deep, 20).share() < 0.8);
  CHECK(shares<CcdKernel>(all_pairs(), Depth::hundredth, 20).share() < 0.8);
  CHECK(shares<CcdKernel>(all_pairs(), Depth::ten_thousandth, 20).share() < 0.35);
  CHECK(shares<CcdKernel>(all_pairs(), Depth::gap_half, 20).share() == 0);
}

TEST_CASE("a box sunk into a floor gets its four contacts from libccd's normal") {
  SceneOf<CcdCollision> scene;
  scene.add(Box{10, 10, 1}, {0, 0, 0}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {0.01, 0.02, 1 - 1e-2});
  scene.detect();
  CHECK(scene.contacts.size() == 4);
  CHECK(scene.report.rejects == 0);
  for (const ContactPoint& c : scene.contacts) CHECK(c.gap == Approx(-1e-2).epsilon(1e-9));
}

TEST_CASE("libccd's loops end when the budget of support calls does") {
  std::mt19937 random(3);
  for (const int budget : {0, 1, 2, 3, 4, 5, 6, 8, 12, 20})
    for (const auto& [a, b] : all_pairs()) {
      double apart = 0;
      const Sample s = any_pose(a, b, Depth::deep, false, random, apart);
      PairCache cache;
      CcdKernel kernel;
      kernel.max_supports = budget;
      const SignedPair r = kernel.pair(s.a, s.b, s.b_in_a, 1, cache);
      if (budget < 2) CHECK(r.status == PairStatus::failed);
    }
}
