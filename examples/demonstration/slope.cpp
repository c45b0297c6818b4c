// Blocks of different friction on one slope: below tan θ they slip as the parabola says, above it they stay.
#include "measure.hpp"

#include <array>
#include <numbers>

namespace demonstration {

namespace {

constexpr double angle = 20 * std::numbers::pi / 180;
constexpr std::array frictions{0.1, 0.2, 0.3, 0.4, 0.5};  // tan 20° = 0.364

/// How far symplectic Euler takes a block down the slope in `t` seconds of steps h, m.
double slide(double friction, double t, double h) {
  return 0.5 * 9.81 * std::max(0.0, std::sin(angle) - friction * std::cos(angle)) * t * (t + h);
}

}  // namespace

Scene slope(bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.25 : 6, before_floor = 1.5;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, AcceleratedGaussSeidel{.tolerance = 1e-6},
                     StepTime{}, Stopwatch{},
                     Recorder{"Slope", "Friction 0.1 to 0.5 on a slope of 20°, whose tangent is 0.364: three blocks "
                                       "slip, two stay. Orange impulses slide, blue ones stick."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const Quat tilt(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  const Vec3 down = tilt * Vec3::UnitX(), normal = tilt * Vec3::UnitZ();
  const Index ground = loop.materials().add({.friction = 0.5});
  rigid.add({.shape = HalfSpace{normal}, .motion = Motion::fixed, .material = ground});
  const Index floor = loop.materials().add({.friction = 0.6});
  rigid.add({.shape = HalfSpace{Vec3::UnitZ(), -1.6}, .motion = Motion::fixed, .material = floor});
  const std::size_t first = 2;  // the blocks come after the two half-spaces
  std::vector<Vec3> starts;
  for (std::size_t k = 0; k < frictions.size(); ++k) {
    const Index material = loop.materials().add({.friction = frictions[k]});
    loop.materials().set_pair(ground, material, {.friction = frictions[k]});
    loop.materials().set_pair(floor, material, {.friction = 0.6});
    starts.push_back(0.2 * normal + 0.9 * (double(k) - 2) * Vec3::UnitY());
    rigid.add({.position = starts[k],
                                .orientation = tilt,
                                .mass = 10,
                                .shape = Box{0.6, 0.6, 0.4},
                                .material = material});
  }
  Scene scene = measure(loop, "native", h, seconds, watch);

  double error = 0;
  for (const RecordedFrame& frame : scene.recording.frames)
    for (std::size_t k = 0; k < frictions.size() && frame.time < before_floor; ++k) {
      const double gone = down.dot(frame.poses[first + k].position - starts[k]);
      error = std::max(error, std::abs(gone - slide(frictions[k], frame.time, h)));
    }
  scene.expect_below(1e3 * error, 0.1, "the distance from the parabola before the floor", "mm");
  scene.expect_below(1e3 * scene.max_penetration, 6, "the largest penetration", "mm");
  return scene;
}

}  // namespace demonstration
