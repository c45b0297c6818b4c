// Each joint between the world (end a) and a body (end b): which way its free axes count, and what it carries.
// prints: Hinge: b turned by \+0\.50 rad, b_x = \(\+0\.88, \+0\.48, \+0\.00\)
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

void show(const char* joint, auto scene) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{BallJoint{}, Hinge{}, Slider{}, Cylindrical{}, Universal{}, Weld{}, DistanceJoint{},
                                 Motor<Turn>{}, Limit<Turn>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity.setZero();
  std::printf("%s: ", joint);
  scene(loop, rigid, rigid.add({.mass = 1.0, .shape = Box{0.4, 0.4, 0.4}}));
}
void run(auto& loop) { for (int i = 0; i < 100; ++i) loop.step(0.01); }
void print(const char* what, const Vec3& x) { std::printf("%s = (%+.2f, %+.2f, %+.2f)\n", what, x.x(), x.y(), x.z()); }

int main() {
  const Vec3 none = Vec3::Zero();
  show("BallJoint", [&](auto& loop, auto& rigid, auto body) {
    const auto ball = loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(rigid, body)});
    for (int i = 0; i < 100; ++i) rigid.apply_force(body, {10, 0, 0}), loop.step(0.01);
    print("b is pulled by 10 N along x, the force on a", reaction(loop, ball).force);
  });
  show("Hinge", [&](auto& loop, auto& rigid, auto body) {
    const Anchor a = world_anchor({0, 0, 0}), b = anchor(rigid, body);
    loop.add(Hinge::Item{a, b});
    rigid.set_velocity(body, none, {0, 0, 0.5}), run(loop);
    std::printf("b turned by %+.2f rad, ", Turn::value({a, b, loop.world()}));
    print("b_x", rigid.orientation(body) * Vec3(1, 0, 0));
  });
  show("Slider", [&](auto& loop, auto& rigid, auto body) {
    const Quat along_x = frame_along({1, 0, 0});  // a_z points along x of the world
    const Anchor a = world_anchor({0, 0, 0}, along_x), b = anchor(rigid, body, none, along_x);
    loop.add(Slider::Item{a, b});
    rigid.set_velocity(body, {0.2, 0, 0}), run(loop);
    std::printf("b is at %+.2f m\n", Slide::value({a, b, loop.world()}));
  });
  show("Cylindrical", [&](auto& loop, auto& rigid, auto body) {
    const Anchor a = world_anchor({0, 0, 0}), b = anchor(rigid, body);
    loop.add(Cylindrical::Item{a, b});
    rigid.set_velocity(body, {0, 0, 0.1}, {0, 0, -0.3}), run(loop);
    const JointFrames frames(a, b, loop.world());
    std::printf("b is at %+.2f m, turned by %+.2f rad\n", Slide::value(frames), Turn::value(frames));
  });
  show("Universal", [&](auto& loop, auto& rigid, auto body) {
    loop.add(Universal::Item{world_anchor({0, 0, 0}), anchor(rigid, body)});
    rigid.set_velocity(body, none, {0.3, 0.2, 0.4}), loop.step(0.01);
    print("set going at (+0.30, +0.20, +0.40), b turns at", rigid.angular_velocity(body));
  });
  show("Weld", [&](auto& loop, auto& rigid, auto body) {
    const auto weld = loop.add(Weld::Item{world_anchor({0, 0, 0}), anchor(rigid, body)});
    for (int i = 0; i < 100; ++i) rigid.apply_torque(body, {0, 0, 3}), loop.step(0.01);
    print("b is turned by 3 N·m about z, the moment on a", reaction(loop, weld).moment);
  });
  show("DistanceJoint", [&](auto& loop, auto& rigid, auto body) {
    const auto rod = loop.add(DistanceJoint::Item{.a = world_anchor({0, 0, 1}), .b = anchor(rigid, body), .length = 1});
    for (int i = 0; i < 100; ++i) rigid.apply_force(body, {0, 0, -10}), loop.step(0.01);
    std::printf("b hangs with 10 N, impulse / h = %+.2f N\n", loop.impulse(rod)[0] / 0.01);
  });
  show("Limit and Motor", [&](auto& loop, auto& rigid, auto body) {
    const Anchor a = world_anchor({0, 0, 0}), b = anchor(rigid, body);
    loop.add(Hinge::Item{a, b});
    const auto motor = loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 1, .max_force = 2});
    const auto limit = loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.5, .upper = 0.25});
    run(loop);
    std::printf("b stops at %+.2f rad, moments %+.2f and %+.2f N·m\n", loop.item(limit).position,
                loop.impulse(motor)[0] / 0.01, loop.impulse(limit)[1] / 0.01);
  });
}
