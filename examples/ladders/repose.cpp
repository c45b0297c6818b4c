// HC-30: the angle of a heap that was poured, and the load on the floor of a silo.
#include "rows.hpp"
#include "watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace ladders {

namespace {

constexpr double d = 0.1;       ///< of a grain, m
constexpr double h = 1. / 240;  ///< s

AcceleratedSweeps sweeps(double effort) {
  return {.tolerance = 1e-3 / effort, .max_iterations = int(100 * effort)};
}

Marks overlaps(const Seen& seen) {
  return {{"mean overlap / diameter", seen.last_overlap / d, 0.01, 1e-3},
          {"largest overlap of the run / diameter", seen.penetration / d, 0.1, 0.01}};
}

/// Square layers of grains, each let go at 1 m/s just above the highest grain there is: until the next one
/// comes it goes by more than its own height.
struct Rain {
  static constexpr int steps = 29;  ///< between layers, 0.12 s

  int layers;
  int edge;              ///< grains along a layer's side
  double pitch;          ///< of them, m
  double variation = 0;  ///< of the diameters, ±
  std::vector<RigidBodies::Handle> grains{};
  int fallen = 0;

  double seconds() const { return layers * steps * h; }

  void fall(RigidBodies& set, int step) {
    if (step % steps != 0 || fallen == layers) return;
    double top = 0;
    for (const auto& grain : grains) top = std::max(top, set.position(grain).z());
    for (int i = 0; i < edge * edge; ++i) {
      const int count = fallen * edge * edge + i;
      const double wobble = 0.04 * d * std::sin(12.9 * count);
      const double size = d * (1 + variation * std::sin(7.1 * count));
      grains.push_back(set.add({.position = {pitch * (i % edge - 0.5 * (edge - 1)) + wobble,
                                             pitch * (i / edge - 0.5 * (edge - 1)) - wobble, top + 1.2 * d},
                                .velocity = {0, 0, -1},
                                .mass = 1e-3 * std::pow(size / d, 3),
                                .shape = Sphere{0.5 * size}}));
    }
    ++fallen;
  }
};

/// The slope of a cone about the z axis through the highest grains of squares as wide as a grain, by least
/// squares of z = a − b r over r from `from` to `to`, degrees.
double flank(const RigidBodies& set, const std::vector<RigidBodies::Handle>& grains, double from, double to) {
  std::map<std::pair<int, int>, Vec3> highest;
  for (const auto& grain : grains) {
    const Vec3 at = set.position(grain);
    const double r = std::hypot(at.x(), at.y());
    if (r < from || r > to) continue;
    const std::pair square{int(std::floor(at.x() / d)), int(std::floor(at.y() / d))};
    Vec3& top = highest.try_emplace(square, at).first->second;
    if (at.z() > top.z()) top = at;
  }
  double n = 0, r = 0, z = 0, rr = 0, rz = 0;
  for (const auto& [square, at] : highest) {
    const double out = std::hypot(at.x(), at.y());
    n += 1, r += out, z += at.z(), rr += out * out, rz += out * at.z();
  }
  return std::atan((r * z - n * rz) / (n * rr - r * r)) * 180 / std::numbers::pi;
}

struct Heap {
  double angle = 0, later = 0;  ///< degrees, four seconds after the last grains fell, and six
  Seen seen;
};

/// A thousand equal spheres poured on a disc that is rough with half sunk ones, 22 d wide; what falls off it
/// is taken away.
template <class Law>
Heap pour(Ladder& ladder, const Law& law, double effort) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}}, sweeps(effort)};
  auto& set = bodies<RigidBodies>(loop.world());
  constexpr double radius = 11 * d;
  for (int i = 0; 0.55 * d * std::sqrt(i) < radius; ++i) {
    const double r = 0.55 * d * std::sqrt(i + 0.5), turn = i * std::numbers::pi * (3 - std::sqrt(5.));
    set.add_fixed(Sphere{0.5 * d}, {r * std::cos(turn), r * std::sin(turn), -0.5 * d});
  }
  Rain rain{.layers = 40, .edge = 5, .pitch = 1.1 * d};
  const double poured = rain.seconds();
  const auto angle = [&] { return flank(set, rain.grains, 2.5 * d, radius - d); };
  Heap heap;
  heap.seen = run(ladder, loop, ladder.is_quick() ? 0.7 : poured + 6, h, [&](int step) {
    rain.fall(set, step);
    std::erase_if(rain.grains, [&](const auto& grain) {
      const bool is_gone = set.position(grain).z() < -3 * d;
      if (is_gone) loop.remove(grain);
      return is_gone;
    });
    if (step + 1 == std::lround((poured + 4) / h)) heap.angle = angle();
  });
  heap.later = angle();
  return heap;
}

/// N, the means of the time in which the floor sinks.
struct Load {
  double floor = 0, walls = 0;  ///< upwards on the grains
  double weight = 0;            ///< of them
  Seen seen;
};

/// A silo of 5 d by 5 d with rough walls, filled with spheres of 0.9 to 1.1 d. Poured grains press more on
/// the floor than they weigh, [ReverseJanssen]: they hang on the walls only once they have slid down these.
/// So the floor sinks slowly, [FloorPressure], by 0.3 d a second: by 0.15 d, and then by 0.9 d of which the
/// loads are.
Load fill(Ladder& ladder, int layers, double effort) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, sweeps(effort)};
  auto& set = bodies<RigidBodies>(loop.world());
  constexpr double width = 5 * d;
  const auto floor = set.add(
      {.position = {0, 0, -d}, .shape = Box{2 * width, 2 * width, 2 * d}, .motion = Motion::kinematic});
  std::vector<Index> walls;
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1., 1.}) {
      const Vec3 n = -side * unit_axis(axis);
      walls.push_back(set.add_fixed(HalfSpace{n}, 0.5 * width * side * unit_axis(axis)).index);
    }
  Rain rain{.layers = layers, .edge = 4, .pitch = 1.2 * d, .variation = 0.1};
  const double filled = rain.seconds() + 0.5;
  double samples = 0;
  Load load;
  load.seen = run(ladder, loop, ladder.is_quick() ? 0.7 : filled + 3.5, h, [&](int step) {
    rain.fall(set, step);
    if (step * h > filled) set.set_velocity(floor, {0, 0, -0.3 * d});
    if (!ladder.is_quick() && step * h < filled + 0.5) return;
    ++samples;
    load.floor += force_from(loop, floor.index);
    for (const Index wall : walls) load.walls += force_from(loop, wall);
  });
  for (const auto& grain : rain.grains) load.weight += set.mass(grain) * g;
  load.floor /= samples, load.walls /= samples;
  return load;
}

/// Janssen's: W_s (1 − exp(−W/W_s)) of grains that weigh W, where W_s is the plateau. In weights his law has
/// no other constant: W_s is what the grains weigh in a height of a/(4 μ K).
double janssen(double weight, double plateau) { return plateau * (1 - std::exp(-weight / plateau)); }

/// The plateau with the least squares of what loads miss of Janssen's, N.
double plateau_of(const std::array<Load, 3>& loads) {
  double best = 0, least = unbounded;
  for (int k = 1; k <= 1000; ++k) {
    const double plateau = 1e-3 * k * loads.back().weight;
    double sum = 0;
    for (const Load& load : loads) sum += std::pow(load.floor - janssen(load.weight, plateau), 2);
    if (sum < least) least = sum, best = plateau;
  }
  return best;
}

}  // namespace

// A sphere in the hollow of three that touch each other rolls out over two of them once these are tilted by
// arctan(1/√8) = 19.5° towards their gap, of all directions by 23.8° in the mean, whatever the friction, if
// it is enough. So poured spheres lie at about that, [AlbertEtAl1997]; marks allow two degrees, by which
// slopes differ from avalanche to avalanche, and five. At a tolerance of 1e-3 m/s a flank of 7.5 d may creep
// by 2 mm in two seconds, which is 0.15°.
void repose(Ladder& ladder) {
  double usual = 0;
  const auto rung = [&](const std::string& difficulty, const auto& law, double effort, const auto& judge) {
    ladder.rung(difficulty, [&]() -> Marks {
      const Heap heap = pour(ladder, law, effort);
      Marks marks = overlaps(heap.seen);
      marks.push_back({"angle of the flank (degrees)", heap.later, unbounded, unbounded});
      if (ladder.is_quick()) return marks;
      marks.push_back({"its change in 2 s of rest (degrees)", std::abs(heap.later - heap.angle), 1, 0.15});
      marks.push_back(judge(heap.later));
      return marks;
    });
  };
  rung("1000 spheres", Coulomb{.friction = 0.5}, 1, [&](double angle) -> Mark {
    usual = angle;
    return {"degrees outside of 19.5 to 23.8", most(most(0, 19.5 - angle), angle - 23.8), 5, 2};
  });
  rung("friction 0.1 in place of 0.5", Coulomb{.friction = 0.1}, 1, [&](double angle) -> Mark {
    return {"degrees missing to two less", most(0, angle - usual + 2), 1, 0};
  });
  rung("a tenth of the tolerance", Coulomb{.friction = 0.5}, 10, [&](double angle) -> Mark {
    return {"change by it (degrees)", std::abs(angle - usual), 5, 2};
  });
  rung("rolling friction of a twentieth of d", RollingCoulomb{.friction = 0.5, .rolling_friction = 0.05 * d},
       1, [&](double angle) -> Mark {
         return {"degrees missing to two more", most(0, usual + 2 - angle), 1, 0};
       });
}

// Nine layers of 16 grains are a width high. A plateau is under a half of the grains' weight where one λ is
// under three widths; loads in so narrow a silo, with some 25 grains on its floor, come and go while it
// sinks, so that the mean of 3 s is good to a tenth.
void silo(Ladder& ladder) {
  std::array<Load, 3> loads{};
  // Momentum of what sinks at 0.3 d/s may differ by that much between the two ends of 3 s: 1e-3 of the
  // weight.
  const auto marks_of = [&](const Load& load) {
    Marks marks = overlaps(load.seen);
    marks.push_back({"load on the floor / weight", load.floor / load.weight, unbounded, unbounded});
    const double off = std::abs((load.floor + load.walls) / load.weight - 1);
    if (!ladder.is_quick()) marks.push_back({"floor and walls, off the weight", off, 1e-2, 1e-3});
    return marks;
  };
  for (const int widths : {2, 4, 6})
    ladder.rung(format("filled to %d widths", widths), [&] {
      const Load& load = loads[std::size_t(widths / 2 - 1)] = fill(ladder, 9 * widths, 1);
      Marks marks = marks_of(load);
      if (widths < 6) return marks;
      const double plateau = plateau_of(loads);
      double off = 0;
      for (const Load& other : loads) off = most(off, std::abs(other.floor - janssen(other.weight, plateau)));
      marks.push_back({"worst of three loads off Janssen's / plateau", off / plateau, 0.2, 0.1});
      marks.push_back({"grown by the last third / plateau",
                       std::abs(loads[2].floor - loads[1].floor) / plateau, 0.2, 0.1});
      marks.push_back({"plateau / weight", plateau / loads[2].weight, 0.5, 1. / 3});
      return marks;
    });
  ladder.rung("2 widths, a tenth of the tolerance", [&] {
    const Load load = fill(ladder, 18, 10);
    Marks marks = marks_of(load);
    marks.push_back({"change of the load", std::abs(load.floor / loads.front().floor - 1), 0.2, 0.1});
    return marks;
  });
}

}  // namespace ladders
