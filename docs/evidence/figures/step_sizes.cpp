// Takes a file. Runs four scenes under `ErrorControlled` and draws the size of every inner step. From the root of the tree:
//
//   g++ -std=c++20 -O2 -DNDEBUG -Iinclude -isystem /usr/include/eigen3 docs/evidence/figures/step_sizes.cpp
//   -o step_sizes && ./step_sizes docs/tutorials/pictures/step_sizes.svg
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/study/inner/log_axis.hpp>
#include <delassus/study/inner/svg.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

using namespace delassus;

namespace {

/// The end and the size of each inner step, s.
class StepSizes {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Advance>;
  std::vector<std::pair<double, double>> steps;

  void after(stage::Advance, const auto& step) {  // of the second of two halves
    const double size = 2 * step.step_size(), end = (steps.empty() ? 0 : steps.back().first) + size;
    steps.push_back({end, size});
  }
};

struct Panel {
  std::string title;
  double seconds;
  std::vector<std::pair<double, double>> steps;
};

/// Runs a scene and keeps what its StepSizes saw.
Panel run(std::string title, double seconds, auto loop) {
  for (double t = 0; t < seconds - 1e-9; t += 0.05) loop.step(0.05);
  return {std::move(title), seconds, loop.template get<StepSizes>().steps};
}

constexpr ErrorControlled kept{.accuracy = 1e-3, .max_step = 0.05};
constexpr AcceleratedGaussSeidel sweeps{.tolerance = 1e-8};

/// It turns about the axis of middle inertia, which it leaves and comes back to again and again.
auto top() {
  AnimationLoop loop{World{RigidBodies{}}, ImplicitMidpoint{}, kept, StepSizes{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  set.add({.angular_velocity = {0.01, 10, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1, 2, 3).asDiagonal())});
  return loop;
}

auto rod() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.7}}}, ImplicitMidpoint{},
                     PositionProjection{}, sweeps, kept, StepSizes{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 1}, .orientation = Quat(Eigen::AngleAxisd(1.1, Vec3::UnitY())), .mass = 1.0, .shape = Capsule{0.05, 0.8}});
  return loop;
}

auto ragdoll() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}}, WithFilter{NativeCollision{}},
                     ImplicitMidpoint{}, PositionProjection{}, sweeps, kept, StepSizes{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto trunk = set.add({.position = {0, 0, 1.5}, .velocity = {1, 0.3, 0}, .angular_velocity = {0.5, 1, 0}, .mass = 40.0, .shape = Box{0.2, 0.3, 0.6}});
  const auto limb = [&](const Vec3& joint, double width, double length, double mass) {
    const auto part = set.add({.position = joint + Vec3(0, 0, length / 2), .velocity = {1, 0.3, 0}, .mass = mass, .shape = Box{width, width, std::abs(length)}});
    loop.add(BallJoint::Item{anchor_at(set, trunk, joint), anchor_at(set, part, joint)});
  };
  limb({0, 0, 1.82}, 0.15, 0.25, 4);
  for (const double side : {-1., 1.}) {
    limb({0, 0.24 * side, 1.75}, 0.08, -0.6, 3);
    limb({0, 0.1 * side, 1.18}, 0.12, -0.6, 10);
  }
  return loop;
}

auto door() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}}, ImplicitMidpoint{}, PositionProjection{}, sweeps, kept,
                     StepSizes{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto leaf = set.add({.position = {0.45, 0, 1}, .angular_velocity = {0, 0, 2}, .mass = 20.0, .shape = Box{0.9, 0.04, 2}});
  set.set_velocity(leaf, Vec3(0, 0.9, 0));
  const Anchor post = world_anchor({0, 0, 1}), edge = anchor_at(set, leaf, {0, 0, 1});
  loop.add(Hinge::Item{post, edge});
  loop.add(Limit<Turn>::Item{.a = post, .b = edge, .lower = 0, .upper = 1.2, .restitution = 0.4});
  return loop;
}

constexpr const char* style = R"css(
svg{font:13px system-ui,sans-serif;background:#fff}text{fill:#1f2328}.small{font-size:12px;fill:#59636e}.title{font-weight:600}
.grid{stroke:#e3e7eb}.frame{fill:none;stroke:#8c959f}.steps{fill:none;stroke:#0072b2;stroke-width:1.6}
@media(prefers-color-scheme:dark){svg{background:#0d1117}text{fill:#e6edf3}.small{fill:#9198a1}.grid{stroke:#262c36}.steps{stroke:#58a6ff}}
)css";

std::string drawing(const std::vector<Panel>& panels) {
  const double width = 900, height = 520, wide = 330, high = 150;
  inner::Svg svg(width, height);
  svg.text(20, 26, "The size of each inner step, by the time of the scene", "title");
  svg.text(20, 46, "Accuracy 1e-3, largest step 50 ms.", "small");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Panel& panel = panels[k];
    const double left = 90 + double(k % 2) * 430, top = 90 + double(k / 2) * 225;
    const inner::LogAxis size(1e-6, 0.05, top + high, top);
    const auto at = [&](double t) { return left + wide * t / panel.seconds; };
    svg.text(left, top - 10, panel.title + ": " + std::to_string(panel.steps.size()) + " steps in " + inner::number_text(panel.seconds, 3) + " s", "title");
    for (const double decade : size.decades()) {
      svg.line(left, size.at(decade), left + wide, size.at(decade), "grid");
      svg.text(left - 8, size.at(decade) + 4, inner::with_prefix(decade, "s"), "small", "end");
    }
    svg.rectangle(left, top, wide, high, "frame");
    for (double t = 0; t <= panel.seconds; t += panel.seconds / 4) svg.text(at(t), top + high + 18, inner::number_text(t, 3) + " s", "small", "middle");
    std::vector<std::pair<double, double>> points;
    for (const auto& [end, h] : panel.steps) points.push_back({at(end - h), size.at(h)}), points.push_back({at(end), size.at(h)});
    svg.polyline(points, "steps");
  }
  return svg.text_of("The size of each inner step of a top, a rod, a ragdoll and a door", "Four panels, time against step size.", style);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fputs("step_sizes FILE.svg\n", stderr), 2;
  const std::vector<Panel> panels{run("A top", 10, top()), run("A rod that bounces", 4, rod()), run("A ragdoll that is dropped", 4, ragdoll()),
                                  run("A door that slams", 2, door())};
  for (const Panel& panel : panels) std::printf("%s: %zu steps\n", panel.title.c_str(), panel.steps.size());
  inner::write_file(arguments[1], drawing(panels));
}
