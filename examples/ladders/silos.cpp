// HC-30: grains that run out of a hopper.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/compliance/cheaper.hpp>

#include <cmath>
#include <vector>

namespace ladders {

namespace {

constexpr double d = 0.1;  ///< of a grain, m

struct Hopper {
  int count;       ///< of grains
  double opening;  ///< D/d, a square hole's side
  double width;    ///< of the square hopper / d
  double seconds = 5;
  double effort = 1;  ///< 10: a tenth of the tolerance, and ten times the sweeps
  bool are_cubes = false;
  double h = 1. / 240;  ///< s
};

/// What ran out a second, of the time after the first second, and how much the grains overlapped.
struct Flow {
  double grains_a_second = 0;
  Seen seen;
};

/// A hopper with a flat bottom and a square hole in it, filled in layers that fall and run out at once. A
/// grain that has fallen by 3 d goes back to above where the top layer began, at 2 m/s, so that the heap
/// stays as high as it is.
template <class... Parts>
Flow drain(Ladder& ladder, const Hopper& hopper, const Parts&... parts) {
  const AcceleratedSweeps solver{.tolerance = 1e-3 / hopper.effort,
                                 .max_iterations = int(100 * hopper.effort)};
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, solver, parts...};
  auto& set = bodies<RigidBodies>(loop.world());
  const double width = hopper.width * d, hole = hopper.opening * d, rim = 0.5 * (width - hole);
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1., 1.}) {
      const Vec3 n = -side * unit_axis(axis), at = 0.5 * side * (hole + rim) * unit_axis(axis);
      set.add_fixed(HalfSpace{n}, 0.5 * width * side * unit_axis(axis));
      set.add_fixed(axis == 0 ? Shape(Box{rim, width, d}) : Shape(Box{hole, rim, d}),
                    at - Vec3(0, 0, 0.5 * d));
    }
  const double pitch = 1.1 * d;
  const int edge = int(width / pitch);
  const auto place = [&](int i) {
    const double wobble = 0.04 * d * std::sin(12.9 * i);
    return Vec3(pitch * (i % edge - 0.5 * (edge - 1)) + wobble,
                pitch * (i / edge % edge - 0.5 * (edge - 1)) - wobble, 0);
  };
  std::vector<RigidBodies::Handle> grains;
  for (int i = 0; i < hopper.count; ++i)
    grains.push_back(set.add({.position = place(i) + Vec3(0, 0, pitch * (i / edge / edge) + 0.6 * d),
                              .mass = 1e-3,
                              .shape = hopper.are_cubes ? Shape(Box{d, d, d}) : Shape(Sphere{0.5 * d})}));
  const double top = pitch * ((hopper.count - 1) / edge / edge + 1) + 2.6 * d;
  int out = 0, next = 0;
  const double seconds = ladder.is_quick() ? 40 * hopper.h : hopper.seconds;
  Flow flow;
  flow.seen = run(ladder, loop, seconds, hopper.h, [&](int step) {
    for (const auto& grain : grains) {
      if (set.position(grain).z() > -3 * d) continue;
      set.place(grain, place(next++) + Vec3(0, 0, top), Quat::Identity());
      set.set_velocity(grain, {0, 0, -2});
      out += (step + 1) * hopper.h > 1;
    }
  });
  flow.grains_a_second = out / (seconds - 1);
  return flow;
}

Marks overlaps(const Flow& flow) {
  return {{"mean overlap / diameter", flow.seen.last_overlap / d, 0.01, 1e-3},
          {"largest overlap of the run / diameter", flow.seen.penetration / d, 0.1, 0.01},
          {"grains a second", flow.grains_a_second, unbounded, unbounded}};
}

}  // namespace

// Beverloo's law: W ∝ (D − k d)^(5/2), k = 1.4; the exponent is that between the smallest hole and the
// largest.
void hopper(Ladder& ladder) {
  double first = 0, last = 0;
  for (const double opening : {4., 5., 6.5})
    ladder.rung(format("1000 spheres, hole of %g diameters", opening), [&]() -> Marks {
      const Flow flow = drain(ladder, {.count = 1000, .opening = opening, .width = 12});
      Marks marks = overlaps(flow);
      last = flow.grains_a_second;
      if (opening == 4) first = last;
      const double exponent = std::log(last / first) / std::log((opening - 1.4) / (4 - 1.4));
      if (opening == 6.5)
        marks.push_back({"exponent of Beverloo's law, off 2.5", std::abs(exponent - 2.5), 0.2, 0.2});
      return marks;
    });
  ladder.rung("hole of 6.5 diameters, a tenth of the tolerance", [&]() -> Marks {
    const Flow flow = drain(ladder, {.count = 1000, .opening = 6.5, .width = 12, .effort = 10});
    Marks marks = overlaps(flow);
    marks.push_back({"change of the flow", std::abs(flow.grains_a_second / last - 1), unbounded, 0.03});
    return marks;
  });
}

void hopper_of_many(Ladder& ladder) {
  ladder.rung("10 000 spheres, hole of 10 diameters", [&] {
    return overlaps(drain(ladder, {.count = 10000, .opening = 10, .width = 26, .seconds = 2}));
  });
}

// What falls at up to 4 m/s goes 0.08 d in a step of 1/480 s and pushes others into what is as far: a margin
// of d/10 sees it. A cube then has up to 26 neighbours with four contacts each, all coupled: those go without
// W.
void hopper_of_cubes(Ladder& ladder) {
  const auto rung = [&](const char* difficulty, Hopper hopper) {
    hopper.seconds = 2, hopper.are_cubes = true, hopper.h = 1. / 480;
    ladder.rung(difficulty, [&] {
      return overlaps(drain(ladder, hopper, NativeCollision{.margin = 0.1 * d}, CheaperCompliance{}));
    });
  };
  rung("1000 cubes, hole of 8 diameters", {.count = 1000, .opening = 8, .width = 16});
  rung("10 000 cubes, hole of 10 diameters", {.count = 10000, .opening = 10, .width = 26});
}

}  // namespace ladders
