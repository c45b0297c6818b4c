// Rolling, sliding and leaning bodies against their closed forms.
#include "scenes.hpp"

#include "catch.hpp"

#include <initializer_list>

namespace closed_form_contacts_tests {

using namespace scenes;

namespace {

constexpr double degree = EIGEN_PI / 180;
const Mat3 unit = Mat3::Identity();

/// A loop whose contacts have the friction `mu` and the restitution `e`, solved to rounding.
auto scene(double mu, double e = 0) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = mu}, e}}},
                       AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 20000}};
}
using Scene = decltype(scene(0));

RigidBodies& set_of(Scene& loop) { return bodies<RigidBodies>(loop.world()); }

/// Weight along a floor that leans by `angle` about y; the floor itself is z < 0.
Vec3 weight_on_slope(double angle) { return g * Vec3(std::sin(angle), 0, -std::cos(angle)); }

/// A round body of 1 kg and inertia share · R² about y, on a slope; its velocity and rate after a second.
struct Rolled {
  double speed, rate;
};
Rolled roll(double angle, double mu, double radius, double share, const Shape& shape, const Quat& turn) {
  auto loop = scene(mu);
  auto& set = set_of(loop);
  set.gravity = weight_on_slope(angle);
  set.add_fixed(HalfSpace{});
  const auto body = set.add({.position = {0, 0, radius},
                             .orientation = turn,
                             .mass = 1.0,
                             .inertia = Mat3(share * radius * radius * unit),
                             .shape = shape});
  for (int n = 0; n < 100; ++n) loop.step(0.01);
  return {set.velocity(body).x(), set.angular_velocity(body).y()};
}
Rolled roll(double angle, double mu, double radius, double share) {
  return roll(angle, mu, radius, share, Sphere{radius}, Quat::Identity());
}
Rolled roll_cylinder(double angle, double mu, double radius, double share) {
  return roll(angle, mu, radius, share, Cylinder{radius, 3 * radius},
              Quat(Eigen::AngleAxisd(90 * degree, Vec3::UnitX())));
}

}  // namespace

// a = g sin α/(1 + share) while it rolls; constant forces, so that steps add nothing. The solver ends at
// 1e-13 of the speeds, a hundred times.
TEST_CASE("balls, cylinders and hoops roll down a slope with the acceleration of their inertia") {
  CHECK(roll(15 * degree, 0.5, 0.05, 0.4).speed == Approx(1.81358202318266).epsilon(1e-9));
  CHECK(roll_cylinder(30 * degree, 0.5, 0.05, 0.5).speed == Approx(3.27).epsilon(1e-9));
  CHECK(roll_cylinder(30 * degree, 0.9, 0.05, 0.9999999).speed == Approx(9.81 / 2 / 1.9999999).epsilon(1e-9));
}

TEST_CASE("a ball on a steep slope slips with mu g cos a, and turns by the moment of its friction") {
  const Rolled ball = roll(45 * degree, 0.2, 0.05, 0.4);
  CHECK(ball.speed == Approx(5.54937401875202).epsilon(1e-9));
  CHECK(ball.rate == Approx(69.3671752344003).epsilon(1e-9));
}

// 2/7 of the tangent, 0.0765569121231779 at 15°: a millionth more and the ball rolls, a millionth less and
// it slips by 3.5 times that share of its speed: 1e-6 · g sin α · 3.5 · 1 s / 2.
TEST_CASE("the friction at which a ball begins to slip is two sevenths of the tangent, to a millionth") {
  const double edge = 0.0765569121231779, R = 0.05;
  const Rolled rolls = roll(15 * degree, edge * (1 + 1e-6), R, 0.4);
  const Rolled slips = roll(15 * degree, edge * (1 - 1e-6), R, 0.4);
  CHECK(std::abs(rolls.speed - R * rolls.rate) <= 1e-9);
  CHECK(slips.speed - R * slips.rate == Approx(3.5 * g * edge * std::cos(15 * degree) * 1e-6).epsilon(1e-3));
}

namespace {

struct Shot {
  double rolls_at, way;  ///< s and m, of the first step that rolls
  Vec3 velocity;
  double turned;     ///< the largest angle between the slip and what it was at first
  double off_curve;  ///< m, the farthest from the parabola
};
/// A ball of 1 kg with v and ω on a level floor, μ = 0.2, until it rolls.
Shot shoot(const Vec3& v, const Vec3& omega, double h) {
  const double R = 0.03;
  auto loop = scene(0.2);
  auto& set = set_of(loop);
  set.add_fixed(HalfSpace{});
  const auto ball = set.add(
      {.position = {0, 0, R}, .velocity = v, .angular_velocity = omega, .mass = 1.0, .shape = Sphere{R}});
  const auto slip = [&] {
    return Vec3(set.velocity(ball) + set.angular_velocity(ball).cross(Vec3(0, 0, -R)));
  };
  const Vec3 first = slip().normalized(), pull = -0.2 * g * first;
  Shot shot{};
  for (int n = 1;; ++n) {
    REQUIRE(n < 100000);
    loop.step(h);
    if (slip().norm() <= 1e-9) {
      shot.rolls_at = n * h, shot.way = set.position(ball).head<2>().norm(),
      shot.velocity = set.velocity(ball);
      return shot;
    }
    shot.turned = std::max(shot.turned, slip().normalized().cross(first).norm());
    // x = v t − μ g s t²/2 with the velocity of the end of each step: n (n + 1) in the place of n².
    const Vec3 on_curve = Vec3(0, 0, R) + n * h * v + 0.5 * n * (n + 1.0) * h * h * pull;
    shot.off_curve = std::max(shot.off_curve, (set.position(ball) - on_curve).norm());
  }
}

}  // namespace

// v − μ g t = 2/5 R ω meet at t* = 2 v/(7 μ g); v falls linearly, so the sum over steps is off by h/2 times
// what was lost, and the step in which rolling begins by one more.
TEST_CASE("a ball that is pushed slides, and rolls with five sevenths of its speed when and where it must") {
  const double h = 1e-4;
  const Shot shot = shoot({5, 0, 0}, Vec3::Zero(), h);
  CHECK(shot.velocity.x() == Approx(25.0 / 7).epsilon(1e-9));
  CHECK((shot.rolls_at >= 0.72811999417504 && shot.rolls_at <= 0.72811999417504 + h));
  CHECK(std::abs(shot.way - 3.12051426075017) <= h * (0.5 * 10.0 / 7 + 25.0 / 7));
  CHECK(shot.turned <= 1e-9);
}

// v_f = (5 v + 2 R ω × e)/7 whatever happened between; the slip keeps its direction, the ball runs a
// parabola.
TEST_CASE(
    "backspin and side spin: the slip keeps its direction, and the ball its momentum about the contact") {
  const Vec3 v(5, 0, 0);
  for (const Vec3& omega : {Vec3(0, -50, 0), Vec3(0, -400, 0), Vec3(120, -200, 30)}) {
    const Shot shot = shoot(v, omega, 1e-3);
    const Vec3 expected = (5 * v + 2 * 0.03 * omega.cross(Vec3(0, 0, 1))) / 7;
    CAPTURE(omega.transpose(), shot.turned);
    CHECK((shot.velocity - expected).norm() <= 1e-9);
    CHECK(shot.turned <= 1e-6);
    CHECK(shot.off_curve <= 1e-9);
  }
}

// λ = (1 + e) v/(1/m + (L/2 cos θ)²/I), one impulse below the end; the ends of the capsule are L apart, so
// that its radius has no moment.
TEST_CASE("a falling rod that strikes with one end leaves with the impulse of its closed form") {
  struct Case {
    double angle, e, lambda, v, omega;
  };
  for (const auto& [angle, e, lambda, v, omega] :
       {Case{30 * degree, 0.5, 6.0 / 13, -7.0 / 13, 2.398224195}, {45 * degree, 1, 0.8, -0.2, 3.394112550}}) {
    auto loop = scene(0, e);
    auto& set = set_of(loop);
    set.gravity.setZero();
    set.add_fixed(HalfSpace{});
    const double r = 0.01;
    const auto rod = set.add({.position = {0, 0, 0.5 * std::sin(angle) + r},
                              .orientation = frame_along({std::cos(angle), 0, -std::sin(angle)}),
                              .velocity = {0, 0, -1},
                              .mass = 1.0,
                              .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-4).asDiagonal()),
                              .shape = Capsule{r, 1}});
    loop.step(1e-6);
    CAPTURE(angle, set.velocity(rod).transpose());
    REQUIRE(loop.contacts().size() == 1);
    CHECK(std::abs(loop.contacts()[0].impulse.norm() - lambda) <= 1e-10);
    CHECK(std::abs(set.velocity(rod).z() - v) <= 1e-10);
    CHECK(std::abs(set.angular_velocity(rod).norm() - omega) <= 1e-8);  // the reference has ten digits
  }
}

namespace {

/// A rod of 1 kg and 1 m at `angle` from the floor, its upper end at a wall x = 0 or, without one, at its own
/// mirror image; how fast it moves after 0.1 s.
double leans(double angle, double mu_floor, double mu_top, bool at_wall) {
  auto loop = scene(mu_floor);
  auto& materials = loop.materials();
  const Index rod_like = materials.add({.friction = 1}), floor = materials.add({.friction = 1}),
              wall = materials.add({.friction = 1});
  materials.set_pair(rod_like, floor, {.friction = mu_floor});
  materials.set_pair(rod_like, wall, {.friction = mu_top});
  materials.set_pair(rod_like, rod_like, {.friction = mu_top});
  auto& set = set_of(loop);
  const double r = 1e-4, reach = std::cos(angle);
  RigidBody ground{.shape = HalfSpace{}, .motion = Motion::fixed, .material = floor};
  set.add(ground);
  if (at_wall)
    set.add({.orientation = frame_along({1, 0, 0}),
             .shape = HalfSpace{},
             .motion = Motion::fixed,
             .material = wall});
  std::vector<RigidBodies::Handle> rods;
  for (const double side : {1., -1.}) {
    if (side < 0 && at_wall) break;
    rods.push_back(set.add({.position = {side * (0.5 * reach + r), 0, 0.5 * std::sin(angle) + r},
                            .orientation = frame_along({-side * reach, 0, std::sin(angle)}),
                            .mass = 1.0,
                            .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-4).asDiagonal()),
                            .shape = Capsule{r, 1},
                            .material = rod_like}));
  }
  for (int n = 0; n < 100; ++n) loop.step(1e-3);
  return set.velocity(rods[0]).norm();
}

}  // namespace

// tan θ = (1 − μ_f μ_w)/(2 μ_f). A tenth of a degree below, the rod slides by about 0.002 · g · 0.1 s; above,
// it stands, but for what its radius and the first step give.
TEST_CASE("a ladder stands down to the angle of its frictions, to a tenth of a degree") {
  struct Case {
    double floor, wall, angle;
  };
  for (const auto& [floor, wall, angle] :
       {Case{0.5, 0, 45}, {0.5, 0.5, 36.869897645844}, {0.3, 0.2, 57.4499965078066}}) {
    const double slides = leans((angle - 0.1) * degree, floor, wall, true);
    const double stands = leans((angle + 0.1) * degree, floor, wall, true);
    CAPTURE(angle, slides, stands);
    CHECK(slides >= 2e-4);
    CHECK(stands <= 1e-6);
  }
}

// Each card leans on its mirror image, which pushes level: μ = ½ cot θ.
TEST_CASE("two cards stand against each other from a friction of half the cotangent on, to two per cent") {
  for (const double angle : {60., 65., 70.}) {
    const double edge = 0.5 / std::tan(angle * degree);
    const double slides = leans(angle * degree, 0.98 * edge, 0.5, false);
    const double stands = leans(angle * degree, 1.02 * edge, 0.5, false);
    CAPTURE(angle, slides, stands);
    CHECK(slides >= 2e-4);
    CHECK(stands <= 1e-6);
  }
}

// A = m g sin α cos α/(M + m sin²α), a_rel = (M + m) g sin α/(M + m sin²α), N = m M g cos α/(M + m sin²α).
TEST_CASE("a block on a wedge that slides away: both accelerations and the force between them") {
  auto loop = scene(0);
  auto& set = set_of(loop);
  set.add_fixed(HalfSpace{});
  const double angle = 30 * degree, t = std::tan(angle);
  std::vector<Vec3> corners;  // 4 m long, its slope rises along −x
  for (const double y : {-1., 1.})
    for (const Vec3& p : {Vec3(-2, y, 0), Vec3(2, y, 0), Vec3(-2, y, 4 * t)}) corners.push_back(p);
  const Vec3 centre = Vec3(-2. / 3, 0, 4 * t / 3);
  const auto wedge = set.add({.position = centre, .mass = 2.0, .shape = ConvexHull(corners)});
  const Vec3 down(std::cos(angle), 0, -std::sin(angle)), out(std::sin(angle), 0, std::cos(angle));
  const auto block = set.add({.position = Vec3(-0.5, 0, 2.5 * t) + 0.1 * out,
                              .orientation = exponential<double>({0, angle, 0}),
                              .mass = 1.0,
                              .shape = Box{0.2, 0.2, 0.2}});
  const double h = 1e-3;
  loop.step(h);
  const double wedge_speed = set.velocity(wedge).x(),
               along = (set.velocity(block) - set.velocity(wedge)).dot(down);
  double force = 0;
  for (const ContactResult& c : loop.contacts())
    if (std::abs(c.record.normal.x()) > 0.1) force += c.impulse.norm() / h;
  CHECK(-wedge_speed / h == Approx(1.88793538025008).epsilon(1e-8));
  CHECK(along / h == Approx(6.54).epsilon(1e-8));
  CHECK(force == Approx(7.5517415210003).epsilon(1e-8));
}

// Pressed from both sides level, the faces push the wedge out along its axis with tan of half its angle, and
// friction holds with μ. A tenth of a degree is 2e-3 of the force.
TEST_CASE(
    "a wedge between two jaws slips out from the half angle of its friction on, to a tenth of a degree") {
  const double mu = 0.3;
  for (const double off : {-0.1, 0.1}) {
    const double half = std::atan(mu) + off * degree, t = std::tan(half);
    auto loop = scene(mu);
    auto& set = set_of(loop);
    set.gravity.setZero();
    std::vector<Vec3> corners;  // narrow above, 2 m high, 2 m wide in the middle
    for (const double y : {-1., 1.})
      for (const double z : {-1., 1.})
        for (const double side : {-1., 1.}) corners.push_back({side * (1 - t * z), y, z});
    const auto wedge =  // its centre of mass is t/3 below the middle
        set.add({.position = {0, 0, -t / 3}, .mass = 1.0, .shape = ConvexHull(corners)});
    std::vector<RigidBodies::Handle> jaws;
    for (const double side : {-1., 1.})
      jaws.push_back(set.add({.position = side * Vec3(1 + 0.2 / std::cos(half), 0, 0),
                              .orientation = exponential<double>({0, -side * half, 0}),
                              .mass = 10.0,
                              .shape = Box{0.4, 0.5, 0.5}}));
    for (int n = 0; n < 10; ++n) {
      for (const int k : {0, 1}) set.apply_force(jaws[std::size_t(k)], Vec3(k ? -100. : 100., 0, 0));
      loop.step(1e-3);
    }
    CAPTURE(off, set.velocity(wedge).transpose());
    if (off > 0)
      CHECK(set.velocity(wedge).norm() >= 1e-3);
    else
      CHECK(set.velocity(wedge).norm() <= 1e-9);
  }
}

}  // namespace closed_form_contacts_tests
