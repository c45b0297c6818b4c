#include "scenes.hpp"

#include "catch.hpp"
#include "stages.hpp"

namespace determinism_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

auto contact_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}};
}

/// Eight bodies of all shapes, thrown on each other around `at`, two of them jointed. The same numbers in any order.
template <class Loop>
std::vector<RigidBodies::Handle> add_pile(Loop& loop, const Vec3& at, const ConvexHull& hull) {
  auto& set = rigid_bodies(loop);
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  const Shape shapes[] = {Box{1, 0.6, 0.8}, Sphere{0.4}, Capsule{0.2, 0.8}, Cylinder{0.4, 0.5}, hull,
                          Box{0.5, 0.5, 2}, Sphere{0.3}, Box{1, 1, 0.2}};
  std::vector<RigidBodies::Handle> handles;
  for (int i = 0; i < 8; ++i) {
    const double x = draw(random), y = draw(random), vx = draw(random), w = draw(random);
    handles.push_back(set.add({.position = at + Vec3(0.4 * x, 0.4 * y, 1 + 0.9 * i),
                               .velocity = {vx, 0, -1},
                               .angular_velocity = {w, vx, 1},
                               .mass = 0.5 + i,
                               .shape = shapes[i]}));
  }
  loop.add(BallJoint::Item{anchor(set, handles[5], {0, 0, 1}), anchor(set, handles[6], {0, 0, -0.5})});
  return handles;
}

/// All bits of the state of some bodies, as one number (FNV-1a).
template <class Set>
std::uint64_t hash(const Set& set, const std::vector<RigidBodies::Handle>& handles) {
  std::uint64_t sum = 14695981039346656037ull;
  const auto add = [&](const double* x, int count) {
    for (int k = 0; k < count; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, &x[k], 8);
      sum = (sum ^ bits) * 1099511628211ull;
    }
  };
  for (const auto body : handles) {
    add(set.position(body).data(), 3);
    add(set.orientation(body).coeffs().data(), 4);
    add(set.velocity(body).data(), 3);
    add(set.angular_velocity(body).data(), 3);
  }
  return sum;
}

}  // namespace

TEST_CASE("the same scene gives the same bits, step by step, for ten thousand steps") {
  const ConvexHull hull = cube_of_points(0.7);
  auto first = contact_loop(), second = contact_loop();
  for (auto* loop : {&first, &second}) rigid_bodies(*loop).add_fixed(HalfSpace{});
  const auto a = add_pile(first, Vec3::Zero(), hull), b = add_pile(second, Vec3::Zero(), hull);
  int different = 0;
  for (int n = 0; n < 10000; ++n) {
    first.step(h);
    second.step(h);
    different += hash(rigid_bodies(first), a) != hash(rigid_bodies(second), b);
  }
  REQUIRE(different == 0);
}

// Until a step is solved again: then the impulses of both piles go through the world's axes once more, and last bits may change.
TEST_CASE("a far pile, added later or before, changes no bit of a pile") {
  const ConvexHull hull = cube_of_points(0.7);
  auto alone = contact_loop(), later = contact_loop(), before = contact_loop();
  for (auto* loop : {&alone, &later, &before}) rigid_bodies(*loop).add_fixed(HalfSpace{});
  const auto a = add_pile(alone, Vec3::Zero(), hull), b = add_pile(later, Vec3::Zero(), hull);
  add_pile(later, {50, 20, 3}, hull);
  add_pile(before, {50, 20, 3}, hull);
  const auto c = add_pile(before, Vec3::Zero(), hull);
  int islands = 0, n = 0;
  bool was_solved_again = false;
  const auto is_solved_again = [](auto& loop) { return loop.data().contact_cache.solves > 0; };
  for (; n < 1000; ++n) {
    alone.step(h);
    islands = std::max(islands, int(later.step(h).islands));
    before.step(h);
    CAPTURE(n);
    was_solved_again = was_solved_again || is_solved_again(later) || is_solved_again(before);
    if (was_solved_again && hash(rigid_bodies(alone), a) != hash(rigid_bodies(later), b)) break;
    if (was_solved_again && hash(rigid_bodies(alone), a) != hash(rigid_bodies(before), c)) break;
    REQUIRE(hash(rigid_bodies(alone), a) == hash(rigid_bodies(later), b));
    REQUIRE(hash(rigid_bodies(alone), a) == hash(rigid_bodies(before), c));
  }
  REQUIRE(n >= 50);
  REQUIRE(islands >= 2);
}

TEST_CASE("a law whose items went leaves no row and no bit behind, as one that never had any") {
  const ConvexHull hull = cube_of_points(0.7);
  const Vec3 far(50, 20, 1000), hook(50, 20, 1001);  // it falls for longer than this takes
  AnimationLoop never{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}, DistanceJoint{}}};
  auto went = never.clone();
  std::vector<RigidBodies::Handle> piles[2];
  int k = 0;
  RigidBodies::Handle bob;
  for (auto* loop : {&never, &went}) {
    rigid_bodies(*loop).add_fixed(HalfSpace{});
    piles[k++] = add_pile(*loop, Vec3::Zero(), hull);
    bob = rigid_bodies(*loop).add({.position = far, .mass = 1.0, .shape = Sphere{0.1}});
  }
  const auto rope = went.add(DistanceJoint::Item{.a = anchor(rigid_bodies(went), bob), .b = world_anchor(hook), .length = 1});
  for (int n = 0; n < 200; ++n) {
    if (n == 50) went.remove(rope);
    const int rows = never.step(h).rows, of_rope = went.step(h).rows - rows;
    CAPTURE(n);
    REQUIRE(of_rope == (n < 50 ? 1 : 0));
    REQUIRE(hash(rigid_bodies(never), piles[0]) == hash(rigid_bodies(went), piles[1]));
  }
}

TEST_CASE("the stages called one by one give the bits of a step") {
  const ConvexHull hull = cube_of_points(0.7);
  auto whole = contact_loop(), parts = contact_loop();
  for (auto* loop : {&whole, &parts}) rigid_bodies(*loop).add_fixed(HalfSpace{});
  const auto a = add_pile(whole, Vec3::Zero(), hull), b = add_pile(parts, Vec3::Zero(), hull);
  for (int n = 0; n < 300; ++n) {
    const StepReport report = whole.step(h);
    step_by_stages(parts, h);
    REQUIRE(hash(rigid_bodies(whole), a) == hash(rigid_bodies(parts), b));
    REQUIRE(parts.report().sweeps == report.sweeps);
    REQUIRE(parts.report().residual == report.residual);
  }
}

TEST_CASE("the problem of a step, solved apart from the loop, gives the loop's impulses to the bit") {
  auto loop = contact_loop();
  add_stack(rigid_bodies(loop), 5, Box{1, 1, 1});
  loop.step(h);  // the first step starts from zero impulses
  const auto solved = loop.problem();
  auto fresh = loop.problem();
  for (auto& x : fresh.rows.pool<0>().lambda) x.setZero();
  const SolveReport report = solve(fresh, AcceleratedGaussSeidel{});
  REQUIRE(report.sweeps == loop.report().sweeps);
  REQUIRE(fresh.rows.pool<0>().items() == 20);
  for (Index i = 0; i < 20; ++i) REQUIRE(fresh.rows.pool<0>().lambda[i] == solved.rows.pool<0>().lambda[i]);
}

}  // namespace determinism_tests
