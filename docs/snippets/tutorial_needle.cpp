// Tutorial: a needle in a driven hand is pushed against a leaning plate; it bends and slides.
// prints: the hand feels 0\.07[0-9] N, the needle is bent by 7\.[45][0-9] mm
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, Weld{}},
                     ImplicitEuler{.rayleigh_mass = 5, .rayleigh_stiffness = 1e-3},
                     Recorder{"Needle", "150 mm of steel against a plate."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& rods = bodies<Rods>(loop.world());

  const auto needle = rods.add({.points = straight_line({0, 0, 0}, {0.15, 0, 0}, 15),
                                .section = round_section(0.3e-3),
                                .young = 2e11,
                                .density = 7800,
                                .contact_radius = 0.3e-3});

  const double lean = 20 * M_PI / 180;
  rigid.add_fixed(Box{0.02, 0.2, 0.2}, {0.162, 0, 0}, exponential(Vec3(0, lean, 0)));

  const auto hand = rigid.add({.position = {-0.01, 0, 0}, .shape = Sphere{0.005}, .motion = Motion::kinematic});
  const auto grip = loop.add(Weld::Item{anchor_at(rigid, hand, {0, 0, 0}), anchor(rods, rods.node(needle, 0))});

  const double h = 1e-3;
  for (int n = 0; n < 2000; ++n) {  // 4 mm in the first second, then it holds
    rigid.move_to(hand, {-0.01 + std::min(0.004, 0.004 * n * h), 0, 0});
    loop.step(h);
  }

  double bend = 0;
  for (Index k = 0; k <= 15; ++k) bend = std::max(bend, rods.position(rods.node(needle, k)).tail<2>().norm());
  const Vec3 pull = reaction(loop, grip).force;
  const Vec3 tip = rods.position(rods.node(needle, 15));
  for (const auto& c : loop.contacts())
    std::printf("plate: %.4f N, %s\n", c.impulse.norm() / h, c.is_sliding ? "slides" : "sticks");
  std::printf("tip at (%.1f, %.1f, %.1f) mm\n", 1e3 * tip.x(), 1e3 * tip.y(), 1e3 * tip.z());
  std::printf("the hand feels %.3f N, the needle is bent by %.2f mm\n", pull.norm(), 1e3 * bend);

  Recording recording = loop.get<Recorder>().recording();
  recording.bodies.back() = recorded_particle(1e-3);  // the last node begins no segment and would be a ball of 3 cm
  write_replay_page("needle.html", "Needle", std::vector{recording});
}
