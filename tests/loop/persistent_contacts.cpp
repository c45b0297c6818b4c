#include "scenes.hpp"

#include "catch.hpp"

#include <vector>

namespace persistent_contacts_tests {

using namespace scenes;

namespace {

/// What names a contact, and the frame of its friction.
struct Name {
  std::uint64_t pair;
  std::uint32_t feature;
  bool operator==(const Name&) const = default;
};

template <class Loop>
std::vector<Name> names(const Loop& loop) {
  std::vector<Name> list;
  for (const ContactResult& c : loop.contacts()) list.push_back({c.record.pair, c.record.feature});
  return list;
}

/// Steps of the last 500 of 600 in which a contact came, went or changed its name.
int restless_steps(const Shape& shape) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}};
  add_stack(rigid_bodies(loop), 5, shape);
  int changes = 0;
  std::vector<Name> before;
  for (int i = 0; i < 600; ++i) {
    loop.step(1.0 / 60);
    std::vector<Name> now = names(loop);
    if (i >= 100) changes += now != before;
    before = std::move(now);
  }
  CHECK(before.size() == 20);
  return changes;
}

}  // namespace

TEST_CASE("a stack of five at rest keeps every contact and its name") {
  CHECK(restless_steps(Box{1, 1, 1}) == 0);
  CHECK(restless_steps(cube_of_points()) == 0);
  CHECK(restless_steps(Cylinder{0.5, 1}) == 0);
}

// A force F at half the height h tips a cylinder at F h/2 = m g r; an octagon inside the rim gives way at
// cos 22.5° = 0.924 of that, the square of four of its corners at 0.707. 0.85 lies between: the four that
// carry must be found, and kept.
TEST_CASE("a cylinder pushed to 0.85 of what tips it stands still on four contacts, whatever the direction") {
  for (const double angle : {0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 2.0, 4.0}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 2}}}};
    auto& rigid = rigid_bodies(loop);
    rigid.add_fixed(HalfSpace{});
    const auto column = rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Cylinder{0.5, 1}});
    const Vec3 push = 0.85 * rigid.gravity.norm() * Vec3(std::cos(angle), std::sin(angle), 0);
    int changes = 0;
    std::vector<Name> before;
    for (int i = 0; i < 300; ++i) {
      rigid.apply_force(column, push);
      loop.step(1.0 / 60);
      std::vector<Name> now = names(loop);
      if (i >= 150) changes += now != before;
      before = std::move(now);
    }
    CAPTURE(angle);
    CHECK(changes == 0);
    CHECK(before.size() == 4);
    CHECK(rigid.angular_velocity(column).norm() < 1e-4);
    CHECK(rigid.orientation(column).toRotationMatrix()(2, 2) >
          1 - 1e-6);  // 1.4e-3 rad; the witness comes at 1.7e-4
  }
}

TEST_CASE("the frame of friction turns no more than its normal does, on floors, ceilings, slopes and walls") {
  // Where the frame does not jump, its derivative by n is below 2/(1 + n_z)² + 2: 34 at most.
  for (const Vec3& n :
       {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(-0.6, 0.8, 0), Vec3(0.6, 0, -0.8)})
    for (int k = 0; k < 12; ++k) {
      const Vec3 noise = 1e-9 * Vec3(std::sin(k), std::cos(3 * k), std::sin(5 * k + 1));
      const Mat3 frame = contact_frame(n), turned = contact_frame((n + noise).normalized());
      CHECK((frame - turned).cwiseAbs().maxCoeff() < 1e-7);
      CHECK((turned * turned.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
      CHECK(turned.determinant() == Approx(1).epsilon(1e-14));
    }
}

}  // namespace persistent_contacts_tests
