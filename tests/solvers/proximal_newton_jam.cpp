#include <delassus/delassus.hpp>
#include <delassus/solvers/proximal_newton.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

namespace proximal_newton_jam_tests {

using namespace delassus;

// A wedge of 20° is pressed into a groove of as many by a hundred times its weight, and then drawn at along
// the groove. With friction 0.5 > tan 10° it jams: its loads are not unique, and it goes in by what the
// tolerance left, which no finite load drives out. Newton's method then takes λ to no end. A solve that
// misses the tolerance keeps no λ whose Σ w λ² is more than 100 times that of its start, which is the last
// step's: √100 times the loads.
TEST_CASE("loads of a jammed wedge do not run away under Newton's method") {
  for (const int draw : {0, 7, 15, 23, 29}) {  // which way rounding takes is another for each
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       ProximalNewton{.tolerance = 1e-8}};
    auto& set = bodies<RigidBodies>(loop.world());
    const double half = 10 * std::numbers::pi / 180, depth = 0.5, wide = depth * std::tan(half), g = 9.81;
    for (const double side : {-1., 1.})
      set.add_fixed(HalfSpace{Vec3(-side * std::cos(half), 0, std::sin(half))});
    std::vector<Vec3> corners;
    for (const double y : {-0.2, 0.2})
      for (const double side : {-1., 1.}) {
        corners.push_back({0.2 * side * wide, y, 0.2 * depth});
        corners.push_back({side * wide, y, depth});
      }
    const ConvexHull hull(corners);
    const auto wedge = set.add({.position = hull.centroid(), .mass = 1 + 1e-9 * draw, .shape = hull});
    const auto largest = [&] {
      double most = 0;
      for (const ContactResult& contact : loop.contacts()) most = std::max(most, contact.impulse.norm());
      return most;
    };
    double before = 0;
    for (int step = 0; step < 75; ++step) {
      set.apply_force(wedge, step < 60 ? Vec3(0, 0, -100 * g) : Vec3(0, 10, 0));
      loop.step(1.0 / 60);
      if (step >= 60) {
        CAPTURE(draw, step);
        CHECK(largest() <= 10 * before);
        // It is held: what moves it goes on by the tolerance's share of 10 N s at most.
        CHECK(set.velocity(wedge).norm() < 1e-6);
      }
      before = largest();
    }
    CHECK(before > 0);
  }
}

}  // namespace proximal_newton_jam_tests
