// What every joint owes: H is the derivative of φ in every pose, and its rank is what the joint takes away.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/cylindrical.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/planar.hpp>
#include <delassus/constraints/joints/point_on_line.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/constraints/joints/universal.hpp>
#include <delassus/constraints/joints/weld.hpp>

#include <algorithm>
#include <numbers>
#include <type_traits>
#include <vector>

#include "catch.hpp"
#include "constraints/poses.hpp"

namespace joints_tests {

using namespace delassus;
using namespace poses;

namespace {

constexpr double pi = std::numbers::pi;

template <class Law>
constexpr bool takes_particle = std::is_same_v<Law, PointOnLine>;

template <class Law>
double difference_of(Scene& scene, const typename Law::Item& item) {
  const Written<Law> rows({}, item, scene.world);
  return difference<Law::rows>(scene, rows.H, [&] { return Written<Law>({}, item, scene.world).phi; });
}

template <class Law>
int rank(const Mat<Law::rows, coordinates>& H) {
  const auto values = Eigen::JacobiSVD<Eigen::MatrixXd>(H).singularValues().eval();
  int rank = 0;
  // Singular values of these are above 0.1 or rounding of numbers below 4.
  for (Index k = 0; k < Index(values.size()); ++k) rank += values[k] > 1e-12;
  return rank;
}

/// Two ends of rigid bodies 0 and 1 whose frames b is turned against a by `turn`; points at random.
template <class Law>
typename Law::Item turned(Scene& scene, const Quat& turn) {
  auto& rigid = scene.set<RigidBodies>();
  const Quat a = scene.turn();
  Anchor first = anchor_at(rigid, scene.rigid[0], scene.vector(), a),
         second = anchor_at(rigid, scene.rigid[1], scene.vector(), a * turn);
  scene.world.resolve(first, "end");
  scene.world.resolve(second, "end");
  return {first, second};
}

/// 0 and 90° and 180° about every axis of the frame, where rows are lost and signs turn.
std::vector<Quat> singular_turns() {
  std::vector<Quat> out{Quat::Identity()};
  for (const double angle : {pi / 2, -pi / 2, pi})
    for (int k = 0; k < 3; ++k) out.push_back(exponential<double>(angle * unit_axis(k)));
  return out;
}

}  // namespace

// The difference's own error is that of `difference`: coordinates below 4 m, their third derivatives alike.
TEMPLATE_TEST_CASE("H of a joint is the derivative of its violation, in every pose", "", Weld, Hinge, Slider,
                   Cylindrical, Universal, Planar, PointOnLine) {
  each_pair([](int a, int b, Scene& scene) {
    if (a == 2 || a == 3 || (b == 2 && !takes_particle<TestType>)) return;
    const typename TestType::Item item{scene.end(a, scene.turn()), scene.end(b, scene.turn())};
    CHECK(difference_of<TestType>(scene, item) <= 1e-8);
  });
}

TEMPLATE_TEST_CASE(
    "H of a joint is the derivative of its violation where its axes are at right angles or opposite", "",
    Weld, Hinge, Slider, Cylindrical, Universal, Planar, PointOnLine) {
  for (const Quat& turn : singular_turns())
    for (unsigned seed = 1; seed <= 5; ++seed) {
      Scene scene(seed);
      CHECK(difference_of<TestType>(scene, turned<TestType>(scene, turn)) <= 1e-8);
    }
}

TEMPLATE_TEST_CASE("a closed joint takes away as many motions as it has rows", "", Weld, Hinge, Slider,
                   Cylindrical, Universal, Planar, PointOnLine) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    auto& rigid = scene.set<RigidBodies>();
    const Vec3 point = scene.vector();
    const Quat frame = scene.turn();
    typename TestType::Item item{anchor_at(rigid, scene.rigid[0], point, frame),
                                 anchor_at(rigid, scene.rigid[1], point, frame)};
    scene.world.resolve(item.a, "first");
    scene.world.resolve(item.b, "second");
    const Written<TestType> rows({}, item, scene.world);
    CHECK(rows.phi.norm() <= 1e-14);  // sines and lengths of numbers below 4
    CHECK(rank<TestType>(rows.H) == TestType::rows);
  }
}

// A body that moves against the other along the joint's free axes: no row sees it.
TEST_CASE("the free axes of a joint are those it names") {
  Scene scene(3);
  auto& rigid = scene.set<RigidBodies>();
  const Vec3 point = scene.vector(), arm = point - rigid.position(scene.rigid[1]);
  const Quat frame = scene.turn();
  const auto rates = [&](auto law, int axis, bool turns) {
    using Law = decltype(law);
    typename Law::Item item{anchor_at(rigid, scene.rigid[0], point, frame),
                            anchor_at(rigid, scene.rigid[1], point, frame)};
    scene.world.resolve(item.a, "first");
    scene.world.resolve(item.b, "second");
    const Written<Law> rows(law, item, scene.world);
    const Vec3 e = frame * unit_axis(axis);
    Vec<6> v = Vec<6>::Zero();
    if (turns)
      v << arm.cross(e), e;  // about the axis through the joint's point
    else
      v.head<3>() = e;
    return (rows.H.template middleCols<6>(6) * v).norm();
  };
  // {joint, which of x y z are free to move, to turn}
  const auto check = [&](auto law, std::vector<int> slides, std::vector<int> turns) {
    for (int k = 0; k < 3; ++k) {
      const bool may_slide = std::count(slides.begin(), slides.end(), k),
                 may_turn = std::count(turns.begin(), turns.end(), k);
      CHECK((rates(law, k, false) <= 1e-14) == may_slide);
      CHECK((rates(law, k, true) <= 1e-14) == may_turn);
    }
  };
  check(Weld{}, {}, {});
  check(Hinge{}, {}, {2});
  check(Slider{}, {2}, {});
  check(Cylindrical{}, {2}, {2});
  check(Universal{}, {}, {0, 1});
  check(Planar{}, {0, 1}, {2});
  check(PointOnLine{}, {2}, {0, 1, 2});
}

}  // namespace joints_tests
