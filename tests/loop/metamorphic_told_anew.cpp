#include "metamorphic.hpp"

#include "catch.hpp"

namespace metamorphic_told_anew_tests {

using namespace metamorphic;
using metamorphic::Scene;  // scenes has one too

namespace {

// Each solve is good to 1e-13 of the largest velocity of its island (some 10 m/s); masses that differ by e²
// spread that to some 1e-11 in a velocity, and twenty steps of a scene whose neighbours part by less than 2 %
// a step add it up to 1e-9.
constexpr int steps = 20;
constexpr double told_anew = 1e-9;

Scene moved(Scene scene, const Quat& turn, const Vec3& by) {
  for (RigidBody& b : scene.bodies) {
    b.position = turn * b.position + by;
    b.orientation = turn * b.orientation;
    b.velocity = turn * b.velocity;
    b.angular_velocity = turn * b.angular_velocity;
  }
  for (Link& link : scene.links)
    if (link.a < 0) link.local_a = turn * link.local_a + by;
  scene.gravity = turn * scene.gravity;
  scene.normal = turn * scene.normal;
  scene.offset += scene.normal.dot(by);
  return scene;
}

State moved(State state, const Quat& turn, const Vec3& by) {
  for (std::size_t k = 0; k < state.x.size(); ++k) {
    state.x[k] = turn * state.x[k] + by;
    state.q[k] = turn * state.q[k];
    state.v[k] = turn * state.v[k];
    state.w[k] = turn * state.w[k];
  }
  return state;
}

/// y → −y: vectors lose the sign of y, turns and spins (which are of the other parity) those of x and z.
Vec3 mirrored(const Vec3& x) { return {x[0], -x[1], x[2]}; }
Vec3 mirrored_spin(const Vec3& w) { return {-w[0], w[1], -w[2]}; }
Quat mirrored(const Quat& q) { return {q.w(), -q.x(), q.y(), -q.z()}; }

}  // namespace

TEST_CASE("a scene that is turned and shifted, gravity with it, moves as the scene does") {
  std::size_t contacts = 0;
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    const Quat turn = exponential<double>(Vec3(0.3 * seed, -1, 0.5));
    const Vec3 by(1, -2, 0.5 * seed);
    const State usual = run(scene, steps);
    CAPTURE(seed);
    contacts += usual.contacts;
    REQUIRE(difference(moved(usual, turn, by), run(moved(scene, turn, by), steps)) <= told_anew);
  }
  REQUIRE(contacts >= 3 * seeds());  // they are scenes of contacts; a single one may have thrown its bodies up
}

// v + u is rounded to 1e-16 of 100 m/s in every step.
TEST_CASE("a scene without ground that drifts as a whole moves as it does at rest") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    Scene scene = draw(seed, false);
    scene.links.erase(scene.links.begin());  // the one that holds on to the world
    Scene drifting = scene;
    const Vec3 drift(3, -7, 100);
    for (RigidBody& b : drifting.bodies) b.velocity += drift;
    State seen = run(drifting, steps);
    for (std::size_t k = 0; k < seen.x.size(); ++k) {
      seen.x[k] -= steps * scene.h * drift;
      seen.v[k] -= drift;
    }
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), seen) <= told_anew);
  }
}

TEST_CASE("the order in which bodies and joints are added changes nothing beyond the solver's tolerance") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene reversed = scene;
    const int last = int(scene.bodies.size()) - 1;
    std::reverse(reversed.bodies.begin(), reversed.bodies.end());
    std::reverse(reversed.links.begin(), reversed.links.end());
    for (Link& link : reversed.links) {
      if (link.a >= 0) link.a = last - link.a;
      link.b = last - link.b;
    }
    State seen = run(reversed, steps);
    for (auto* array : {&seen.x, &seen.v, &seen.w}) std::reverse(array->begin(), array->end());
    std::reverse(seen.q.begin(), seen.q.end());
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), seen) <= told_anew);
  }
}

TEST_CASE("which end of a joint is called a and which b changes nothing") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene swapped = scene;
    for (Link& link : swapped.links)
      if (link.a >= 0) std::swap(link.a, link.b), std::swap(link.local_a, link.local_b);
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), run(swapped, steps)) <= told_anew);
  }
}

// Powers of ten are not exact in binary: every number starts with another last bit. A solve for which momentum was not enough
// may leave more than the rest: of 5400 runs one did, 2.4e-9 after 856 sweeps and 40 factorizations, the cause is not known.
TEST_CASE(
    "lengths, masses and times a thousand times larger or smaller give the same motion in their units") {
  unsigned apart = 0;
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    const State usual = run(scene, steps);
    for (int combination = 0; combination < 27; ++combination) {
      const double a = std::pow(10.0, 3 * (combination % 3 - 1)),
                   b = std::pow(10.0, 3 * (combination / 3 % 3 - 1)),
                   c = std::pow(10.0, 3 * (combination / 9 - 1));
      Scene other = scene;
      for (RigidBody& body : other.bodies) {
        body.position *= a;
        body.velocity *= a / c;
        body.angular_velocity *= 1 / c;
        body.mass = b * *body.mass;
        for (double& size : body.shape.size) size *= a;
      }
      for (Link& link : other.links) link.local_a *= a, link.local_b *= a;
      other.gravity *= a / (c * c);
      other.offset *= a;
      other.h *= c;
      other.push_out *= a / c;
      State seen = run(other, steps);
      for (std::size_t k = 0; k < seen.x.size(); ++k) {
        seen.x[k] *= 1 / a;
        seen.v[k] *= c / a;
        seen.w[k] *= c;
      }
      CAPTURE(seed, a, b, c);
      const bool is_hard = usual.hard_solves + seen.hard_solves > 0;
      REQUIRE(difference(usual, seen) <= (is_hard ? 10 * told_anew : told_anew));
      apart += difference(usual, seen) > told_anew;
    }
  }
  REQUIRE(apart <= 1 + seeds() / 100);
}

TEST_CASE("joints added twice move their bodies as once") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene twice = scene;
    twice.links.insert(twice.links.end(), scene.links.begin(), scene.links.end());
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), run(twice, steps)) <= told_anew);
  }
}

TEST_CASE("a body far away changes no bit of a random scene") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene more = scene;
    more.bodies.push_back(
        {.position = {500, 300, 900}, .velocity = {1, 2, 3}, .mass = 1e4, .shape = Sphere{2}});
    State seen = run(more, 2 * steps);
    for (auto* array : {&seen.x, &seen.v, &seen.w}) array->pop_back();
    seen.q.pop_back();
    CAPTURE(seed);
    REQUIRE(difference(run(scene, 2 * steps), seen) == 0);
  }
}

TEST_CASE("the mirror image of a scene moves as its mirror image") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene other = scene;
    for (RigidBody& b : other.bodies) {
      b.position = mirrored(b.position);
      b.velocity = mirrored(b.velocity);
      b.angular_velocity = mirrored_spin(b.angular_velocity);
      b.orientation = mirrored(b.orientation);
    }
    for (Link& link : other.links)
      link.local_a = mirrored(link.local_a), link.local_b = mirrored(link.local_b);
    other.gravity = mirrored(scene.gravity);
    other.normal = mirrored(scene.normal);
    State seen = run(other, steps);
    for (std::size_t k = 0; k < seen.x.size(); ++k) {
      seen.x[k] = mirrored(seen.x[k]);
      seen.v[k] = mirrored(seen.v[k]);
      seen.w[k] = mirrored_spin(seen.w[k]);
      seen.q[k] = mirrored(seen.q[k]);
    }
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), seen) <= told_anew);
  }
}

// Every product of two quaternion components is the same for q and −q.
TEST_CASE("a quaternion of the other sign changes no bit") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    Scene other = scene;
    for (RigidBody& b : other.bodies)
      b.orientation = Quat(-b.orientation.w(), -b.orientation.x(), -b.orientation.y(), -b.orientation.z());
    CAPTURE(seed);
    REQUIRE(difference(run(scene, steps), run(other, steps)) == 0);
  }
}

}  // namespace metamorphic_told_anew_tests
