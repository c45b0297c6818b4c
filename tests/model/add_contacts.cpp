// Contacts of a machine: whom its shapes meet by types and affinities, with what friction, and height fields.
#include "model/used_contacts.hpp"

#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/model/add.hpp>

#include "catch.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace add_contacts_tests {

using namespace delassus;
using Catch::Contains;

namespace {

template <class Backend = NativeCollision>
auto loop_of(double friction = 0.5, Backend backend = {}) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}, backend};
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  return loop;
}
/// Adds a free ball of 0.5 m at x.
model::Geometry& add_ball(Model& model, double x) {
  const std::string name = std::to_string(model.bodies.size());
  model::Joint joint;
  joint.name = name, joint.kind = model::JointKind::free;
  model::Body body;
  body.name = name, body.mass = 1, body.inertia = 0.1 * identity<Mat3>();
  body.pose.position = {x, 0, 0}, body.joints = {Index(model.joints.size())};
  model::Geometry ball;
  ball.name = name, ball.shape = Sphere{0.5}, ball.body = Index(model.bodies.size());
  model.joints.push_back(joint), model.bodies.push_back(body), model.geometries.push_back(ball);
  return model.geometries.back();
}
/// And a shape of the world there.
model::Geometry& add_post(Model& model, double x) {
  model::Geometry post;
  post.name = "post " + std::to_string(model.geometries.size()), post.shape = Sphere{0.5};
  post.pose.position = {x, 0, 0};
  model.geometries.push_back(post);
  return model.geometries.back();
}
auto detect(auto& loop) {
  stage::begin(loop.data(), 1e-4);
  stage::detect(loop.data());
  return used_contacts(loop);
}

}  // namespace

// Two balls that overlap, of each kind: they meet where the type of one meets the affinity of the other.
TEST_CASE("shapes meet by type and affinity, of bodies and of the world") {
  for (unsigned code = 0; code < 256; ++code)
    for (const bool in_world : {false, true}) {
      const unsigned type = code & 3, affinity = code >> 2 & 3, other_type = code >> 4 & 3,
                     other_affinity = code >> 6;
      Model model;
      model.name = "two";
      model::Geometry& one = add_ball(model, 0);
      one.type = type, one.affinity = affinity;
      model::Geometry& other = in_world ? add_post(model, 0.8) : add_ball(model, 0.8);
      other.type = other_type, other.affinity = other_affinity;
      auto loop = loop_of();
      CHECK(add(loop, model).left_out.empty());
      CAPTURE(type, affinity, other_type, other_affinity, in_world);
      CHECK(detect(loop).size() == ((type & other_affinity) || (other_type & affinity) ? 1 : 0));
    }
}

// They count as type 1 and affinity 1.
TEST_CASE("a body of the loop meets shapes that type 1 meets") {
  for (const unsigned type : {0u, 1u, 2u})
    for (const unsigned affinity : {0u, 1u, 2u}) {
      Model model;
      model::Geometry& ball = add_ball(model, 0);
      ball.type = type, ball.affinity = affinity;
      auto loop = loop_of();
      RigidBody before, after;
      before.position = {0.8, 0, 0}, before.mass = 1, before.shape = Sphere{0.5};
      after = before, after.position = {-0.8, 0, 0};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add(before);
      add(loop, model);
      set.add(after);
      CAPTURE(type, affinity);
      CHECK(detect(loop).size() == (type == 1 || affinity == 1 ? 2 : 0));
    }
}

// Type 1 without affinity: of one machine they pass through each other. Those of two count for each other as
// type 1 and affinity 1.
TEST_CASE("machines of one kind of shapes keep their own groups") {
  Model model;
  for (const double x : {0., 0.8}) {
    model::Geometry& ball = add_ball(model, x);
    ball.type = 1, ball.affinity = 0;
  }
  auto loop = loop_of();
  add(loop, model);
  CHECK(detect(loop).empty());
  add(loop, model, Pose{{0, 0.8, 0}, identity<Mat3>()});
  CHECK(detect(loop).size() == 2);  // each ball with that of the other machine beside it
}

TEST_CASE("a body whose shapes differ in what they meet is named") {
  Model model;
  add_ball(model, 0);
  model::Geometry second = model.geometries[0];
  second.name = "sensor", second.type = 0, second.affinity = 2, second.pose.position = {0, 0, 1};
  model.geometries.push_back(second);
  auto loop = loop_of(0.5, WithCompounds{NativeCollision{}});
  const Machine machine = add(loop, model);
  REQUIRE(machine.left_out.size() == 1);
  CHECK_THAT(machine.left_out[0], Contains("types and affinities of any of them"));
}

TEST_CASE("more kinds of shapes than groups are named") {
  Model model;
  for (unsigned k = 2; k < 50; ++k) add_ball(model, 2 * k).type = k;
  auto loop = loop_of();
  const Machine machine = add(loop, model);
  REQUIRE(machine.left_out.size() == 1);
  CHECK_THAT(machine.left_out[0],
             Contains("19 kinds of types and affinities have no group left"));  // 48 of 29
}

// The larger one of equal priority, or that of the higher; no friction where neither slides. Restitution too.
TEST_CASE("a contact has the friction of its two shapes, if it is asked for") {
  struct Case {
    double one, other;
    int priority, freedoms, other_freedoms;
    double want;
  };
  for (const Case& c :
       {Case{0.3, 0.7, 0, 3, 3, 0.7}, Case{0.3, 0.7, 1, 3, 3, 0.3}, Case{0.3, 0.7, -1, 3, 3, 0.7},
        Case{0.3, 0.3, 0, 3, 3, 0.3}, Case{0.3, 0.7, 0, 1, 3, 0.7}, Case{0.3, 0.7, 0, 1, 1, 0},
        Case{0.3, 0.7, 1, 1, 3, 0}, Case{0, 0, 0, 3, 3, 0}}) {
    Model model;
    model::Geometry& one = add_ball(model, 0);
    one.friction = c.one, one.priority = c.priority, one.contact_freedoms = c.freedoms;
    model::Geometry& other = add_post(model, 0.8);
    other.friction = c.other, other.contact_freedoms = c.other_freedoms;
    CAPTURE(c.one, c.other, c.priority, c.freedoms, c.other_freedoms);
    auto loop = loop_of(0.11);
    CHECK(add(loop, model, {}, Base::as_file, {.surfaces = false}).left_out.empty());
    const auto found = detect(loop);
    REQUIRE(found.size() == 1);
    CHECK(found.begin()->second.friction == Approx(c.want));

    auto plain = loop_of(0.11);
    const Machine machine = add(plain, model);
    REQUIRE(machine.left_out.size() == 1);
    CHECK_THAT(machine.left_out[0], Contains("all contacts have the law of the loop"));
    CHECK(detect(plain).begin()->second.friction == 0.11);
  }
}

// Balls of type 0 and affinity 0 in one place: of three, the two that a pair names.
TEST_CASE("shapes of a contact pair meet whatever their types say") {
  for (const bool in_world : {false, true}) {
    Model model;
    for (const double x : {0., 0.4, 0.8}) {
      model::Geometry& ball = in_world && x == 0.8 ? add_post(model, x) : add_ball(model, x);
      ball.type = 0, ball.affinity = 0;
    }
    model.pairs.push_back({.geometry = 2, .other = 0, .friction = 0.35});
    auto loop = loop_of(0.11);
    CHECK(add(loop, model, {}, Base::as_file, {.surfaces = false}).left_out.empty());
    const auto found = detect(loop);
    REQUIRE(found.size() == 1);
    CHECK(found.begin()->second.gap == Approx(-0.2));
    CHECK(found.begin()->second.friction == Approx(0.35));
  }
}

// The pair's own friction in place of the larger of 0.3 and 0.7, and none where it does not slide. Types that
// meet anyway take no group: 50 pairs are more than there are.
TEST_CASE("a contact pair has its own friction") {
  for (const int freedoms : {1, 3}) {
    Model model;
    for (Index k = 0; k < 50; ++k) {
      add_ball(model, 3 * k).friction = 0.3, add_ball(model, 3 * k + 0.8).friction = 0.7;
      model.pairs.push_back(
          {.geometry = 2 * k, .other = 2 * k + 1, .contact_freedoms = freedoms, .friction = 0.1});
    }
    auto loop = loop_of(0.11);
    CHECK(add(loop, model, {}, Base::as_file, {.surfaces = false}).left_out.empty());
    const auto found = detect(loop);
    REQUIRE(found.size() == 50);
    for (const auto& [pair, contact] : found) CHECK(contact.friction == Approx(freedoms == 1 ? 0 : 0.1));

    auto plain = loop_of(0.11);
    const Machine machine = add(plain, model);
    REQUIRE(machine.left_out.size() == 2);
    CHECK_THAT(machine.left_out[1], Contains("its 50 contact pairs have the friction of the loop's law"));
  }
}

TEST_CASE("a contact pair whose bodies never meet is named") {
  Model model;
  add_ball(model, 0), add_ball(model, 0.8);
  model.excludes.push_back({1, 0});
  model.pairs.push_back({.geometry = 0, .other = 1});
  auto loop = loop_of(0.5, WithFilter{NativeCollision{}});
  const Machine machine = add(loop, model, {}, Base::as_file, {.surfaces = false});
  REQUIRE(machine.left_out.size() == 1);
  CHECK_THAT(machine.left_out[0], Contains("the contact pair of geometries '0' and '1' does not act"));
  CHECK(detect(loop).empty());
}

// tan 20° = 0.36: a block of friction 0.4 stays on a slope, one of 0.3 slides by g (sin − μ cos) t²/2.
TEST_CASE("blocks of one machine slide as their own friction says") {
  Model model;
  const double slope = 20 * M_PI / 180;
  const double lengths[] = {0.4, 0.3};
  for (int k = 0; k < 2; ++k) {
    model::Geometry& block = add_ball(model, 0);
    block.shape = Box{0.4, 0.4, 0.2}, block.friction = lengths[k];
    model.bodies[std::size_t(k)].pose.position = {0, double(k), 0.1};
  }
  model::Geometry& ground = add_post(model, 0);
  ground.shape = model::Plane{}, ground.friction = 0.1;
  auto loop = loop_of();
  const Machine machine = add(loop, model, {}, Base::as_file, {.surfaces = false});
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = {9.81 * std::sin(slope), 0, -9.81 * std::cos(slope)};
  for (int n = 0; n < 1000; ++n) loop.step(1e-3);
  CHECK(std::abs(pose_of(set, machine, 0).position[0]) < 1e-3);
  const double way = 9.81 * (std::sin(slope) - 0.3 * std::cos(slope)) / 2;
  CHECK(pose_of(set, machine, 1).position[0] == Approx(way).epsilon(2e-3));  // a step of its speed
}

// z = 0.3 x − 0.2 y over 2 m by 5 m, turned and lifted: a ball whose middle is half its radius above it.
TEST_CASE("a height field of the world is met where it is") {
  Model model;
  model::HeightField field;
  field.name = "slope", field.columns = 5, field.rows = 4, field.half_x = 1, field.half_y = 2.5,
  field.base = 1;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 5; ++column)
      field.heights.push_back(0.3 * (-1 + column * 0.5) - 0.2 * (-2.5 + row * 5. / 3));
  model.height_fields = {field};
  model::Geometry& ball = add_ball(model, 0);
  ball.shape = Sphere{0.1};
  model::Geometry& ground = add_post(model, 0);
  const Pose place{{3, 1, 2}, rotation_matrix(unit(Quat(0.8, 0.1, -0.2, 0.3)))};
  ground.shape = model::FieldOf{0}, ground.pose = place;
  const Vec3 up = Vec3(-0.3, 0.2, 1) / std::sqrt(0.3 * 0.3 + 0.2 * 0.2 + 1);
  model.bodies[0].pose.position = place.to_world(Vec3(Vec3(0.35, -1.9, 0.3 * 0.35 + 0.2 * 1.9) + 0.05 * up));
  auto loop = loop_of(0.5, WithMeshes{NativeCollision{}});
  CHECK(add(loop, model).left_out.empty());
  const auto found = detect(loop);
  REQUIRE(found.size() == 1);
  CHECK(found.begin()->second.gap == Approx(-0.05).margin(1e-9));

  auto bare = loop_of();
  const Machine machine = add(bare, model);
  REQUIRE(machine.left_out.size() == 1);
  CHECK_THAT(machine.left_out[0], Contains("meets nothing; put WithMeshes{...}"));
  CHECK(detect(bare).empty());
}

}  // namespace add_contacts_tests
