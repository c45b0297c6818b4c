// Joints in a loop: impulses between free bodies keep momentum however far from done the solve is, ends that
// lack a frame are refused, and poses in which rows vanish leave finite motion.
#include <delassus/delassus.hpp>

#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "catch.hpp"

namespace joint_ends_tests {

using namespace delassus;

namespace {

struct Draw {
  std::mt19937 random;
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {number(), number(), number()}; }
  Quat turn() { return Quat(number(), number(), number(), number()).normalized(); }
};

/// The same loop for all of them, one law at a time.
auto loop_of_joints(int sweeps) {
  AnimationLoop loop{
      World{RigidBodies{}, Particles{}},
      Constraints{Weld{}, Hinge{}, Slider{}, Cylindrical{}, Universal{}, Planar{}, PointOnLine{}},
      MatrixFreeCompliance{}, GaussSeidel{.tolerance = 0, .max_iterations = sweeps}};
  bodies<RigidBodies>(loop.world()).gravity.setZero();
  return loop;
}

/// f(law) for every joint.
template <class F>
void each_law(F&& f) {
  f(Weld{}), f(Hinge{}), f(Slider{}), f(Cylindrical{}), f(Universal{}), f(Planar{}), f(PointOnLine{});
}

}  // namespace

TEST_CASE("joints keep momentum and angular momentum of free bodies after any number of sweeps") {
  each_law([](auto law) {
    for (const int sweeps : {1, 3, 50})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        auto loop = loop_of_joints(sweeps);
        auto& rigid = bodies<RigidBodies>(loop.world());
        Draw draw{std::mt19937(seed)};
        std::vector<RigidBodies::Handle> body;
        for (int i = 0; i < 4; ++i)
          body.push_back(rigid.add({.position = draw.vector(),
                                    .orientation = draw.turn(),
                                    .velocity = draw.vector(),
                                    .angular_velocity = draw.vector(),
                                    .mass = 1.5 + draw.number(),
                                    .shape = Box{1, 2, 3}}));
        for (int i = 0; i < 4; ++i)  // a ring of joints far from closed
          loop.add(
              typename decltype(law)::Item{anchor(rigid, body[i], draw.vector(), draw.turn()),
                                           anchor(rigid, body[(i + 1) % 4], draw.vector(), draw.turn())});
        Vec3 P = Vec3::Zero(), L = Vec3::Zero();
        double scale = 0;
        const auto add = [&](double sign) {
          for (const auto& b : body) {
            const Mat3 R = rigid.orientation(b).toRotationMatrix();
            const Vec3 p = rigid.mass(b) * rigid.velocity(b), x = rigid.position(b),
                       l = x.cross(p) +
                           R * (rigid.inertia(b.index) * (R.transpose() * rigid.angular_velocity(b)));
            P += sign * p;
            L += sign * l;
            scale += p.norm() + l.norm();
          }
        };
        add(-1);
        loop.step(0.01);
        add(1);
        CAPTURE(typeid(law).name(), sweeps, seed, scale);
        // 8 ends of 6 rows, each rounded to 2^-53 of impulses that may cancel to a tenth of their size.
        CHECK(P.norm() <= 1e-13 * scale);
        CHECK(L.norm() <= 1e-13 * scale);
      }
  });
}

TEST_CASE("a joint refuses an end without the orientation it needs") {
  auto loop = loop_of_joints(1);
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& points = bodies<Particles>(loop.world());
  const Anchor body = anchor(rigid, rigid.add({.mass = 1.0, .shape = Sphere{1}}));
  const Anchor point = anchor(points, points.add({.mass = 1.0}));
  const auto refuses = [&](auto law, const std::string& name) {
    using Item = typename decltype(law)::Item;
    const std::string tail = " end needs an orientation; a particle has none";
    CHECK_THROWS_WITH(loop.add(Item{point, body}), "delassus: " + name + ": its first" + tail);
    if constexpr (!std::is_same_v<decltype(law), PointOnLine>)
      CHECK_THROWS_WITH(loop.add(Item{body, point}), "delassus: " + name + ": its second" + tail);
  };
  refuses(Weld{}, "Weld");
  refuses(Hinge{}, "Hinge");
  refuses(Slider{}, "Slider");
  refuses(Cylindrical{}, "Cylindrical");
  refuses(Universal{}, "Universal");
  refuses(Planar{}, "Planar");
  refuses(PointOnLine{}, "PointOnLine");
  CHECK_NOTHROW(loop.add(PointOnLine::Item{body, point}));
}

// A row that vanishes has no direction, and near there it asks for any rate: nothing may come of it but speed
// and a status.
TEST_CASE("a joint in a singular pose leaves finite motion") {
  each_law([](auto law) {
    for (const double angle : {std::numbers::pi / 2, -std::numbers::pi / 2, std::numbers::pi})
      for (int axis = 0; axis < 3; ++axis) {
        auto loop = loop_of_joints(20);
        auto& rigid = bodies<RigidBodies>(loop.world());
        const auto body = rigid.add({.orientation = exponential<double>(angle * unit_axis(axis)),
                                     .mass = 1.0,
                                     .shape = Box{1, 1, 1}});
        loop.add(typename decltype(law)::Item{world_anchor(Vec3::Zero()), anchor(rigid, body)});
        for (int n = 0; n < 100; ++n) {
          const StepReport report = loop.step(0.01);
          REQUIRE(report.quarantined == 0);
          REQUIRE(is_finite(rigid.position(body)));
          REQUIRE(is_finite(rigid.angular_velocity(body)));
        }
      }
  });
}

}  // namespace joint_ends_tests
