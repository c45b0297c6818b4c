// Tutorial: two fingers lift a box; the forces of their contacts are compared with the closed form.
// prints: grip 20\.0000 and 20\.0000 N, friction 9\.8100 N
#include <delassus/delassus.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, Slider{}, Motor<Slide>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-9}, Recorder{"Gripper", "Two fingers lift a box of 1 kg."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.05}, .mass = 1.0, .shape = Box{0.1, 0.1, 0.1}});
  const auto hand = rigid.add({.position = {0, 0, 0.2}, .motion = Motion::kinematic});

  RigidBodies::Handle finger[2];
  for (int k = 0; k < 2; ++k) {
    const double side = k == 0 ? -1 : 1;
    const Vec3 at(0.08 * side, 0, 0.06);
    const Quat inwards = frame_along({-side, 0, 0});
    finger[k] = rigid.add({.position = at, .mass = 0.2, .shape = Box{0.02, 0.06, 0.06}});
    const Anchor a = anchor_at(rigid, hand, at, inwards), b = anchor_at(rigid, finger[k], at, inwards);
    loop.add(Slider::Item{a, b});
    loop.add(Motor<Slide>::Item{.a = a, .b = b, .speed = 0.1, .max_force = 20});
  }

  const double h = 2e-3, mass = 1, g = 9.81;
  struct Forces { double grip[2] = {0, 0}, friction = 0; };  // N
  const auto read = [&] {
    Forces f;
    for (const auto& c : loop.contacts()) {
      const bool box_is_b = rigid.handle(c.record.b.block) == box;
      const auto other = rigid.handle((box_is_b ? c.record.a : c.record.b).block);
      const Vec3 on_box = (box_is_b ? 1 : -1) * c.impulse / h;  // c.impulse is what b received from a
      for (int k = 0; k < 2; ++k)
        if (other == finger[k]) f.grip[k] += c.impulse.dot(c.record.normal) / h, f.friction += on_box.z();
    }
    return f;
  };

  const auto height = [](double time) {
    const double t = std::clamp(time - 0.5, 0., 1.);
    return 0.2 * t * t * (3 - 2 * t);
  };
  double speed = 0, worst = 0;
  for (int n = 0; n < 1500; ++n) {  // 0.5 s to grip, 1 s to lift, 1.5 s to hold
    const double from = height(n * h), to = height((n + 1) * h);
    rigid.move_to(hand, {0, 0, 0.2 + to});
    loop.step(h);
    const double acceleration = ((to - from) / h - speed) / h;
    speed = (to - from) / h;
    if (from > 0) worst = std::max(worst, std::abs(read().friction - mass * (g + acceleration)));
  }

  for (const auto& c : loop.contacts())
    std::printf("at (%.2f, %.2f, %.2f) m: %.3f N along the normal\n", c.record.point().x(), c.record.point().y(),
                c.record.point().z(), c.impulse.dot(c.record.normal) / h);
  const Forces f = read();
  std::printf("box at %.4f m, %s\n", rigid.position(box).z(), name(loop.report().status));
  std::printf("grip %.4f and %.4f N, friction %.4f N\n", f.grip[0], f.grip[1], f.friction);
  std::printf("friction in lift and hold: off m (g + a) by at most %.0e N\n", worst);

  write_replay_page("gripper.html", "Gripper", std::vector{loop.get<Recorder>().recording()});
}
