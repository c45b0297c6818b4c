// HC-04, HC-26, HC-28, HC-29: what stands, and what shall fall in order.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>

namespace ladders {

namespace {

auto standing_loop(double friction) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}},
                       ProximalNewton{}};
}

/// Boxes on each other, each up to 1 % of its size off the one below, for 60 s.
template <class Solver>
void climb_stack(Ladder& ladder, const Solver& solver) {
  for (const int count : {10, 20, 50, 100})
    ladder.rung(format("%d boxes", count), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, solver};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto ground = set.add_fixed(HalfSpace{});
      RigidBodies::Handle top;
      for (int k = 0; k < count; ++k)
        top = set.add({.position = {0.01 * std::sin(7. * k), 0.01 * std::cos(5. * k), 0.5 + k},
                       .mass = 1.0,
                       .shape = Box{1, 1, 1}});
      const Vec3 start = set.position(top);
      const double until = ladder.is_quick() ? 1 : 60;
      double late = 0;
      const Seen seen = run(ladder, loop, until, frame, [&](int n) {
        if (n * frame > std::min(10., 0.5 * until)) late = most(late, top_speed(loop));
      });
      return {{"drift of the top (m)", (set.position(top) - start).norm(), 0.5, 1e-2},
              {"speed after 10 s (m/s)", late, 1e-3, 1e-3},
              {"penetration / size", seen.penetration, unbounded, 1e-3},
              {"error of the ground's force", std::abs(force_from(loop, ground.index) / (count * g) - 1),
               unbounded, 1e-4},
              energy_mark(seen, count * g)};
    });
}

}  // namespace

// Rows of unit boxes a finger's breadth apart, each on two of the row below, for 10 s.
void pyramid(Ladder& ladder) {
  for (const int base : {10, 20, 50, 100})
    ladder.rung(format("%d boxes wide", base), [&]() -> Marks {
      auto loop = standing_loop(0.6);
      auto& set = bodies<RigidBodies>(loop.world());
      const auto ground = set.add_fixed(HalfSpace{});
      RigidBodies::Handle top;
      for (int row = 0; row < base; ++row)
        for (int k = 0; k < base - row; ++k)
          top = set.add(
              {.position = {1.02 * (k + 0.5 * row), 0, 0.5 + row}, .mass = 1.0, .shape = Box{1, 1, 1}});
      const Vec3 start = set.position(top);
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.3 : 10, frame);
      const double weight = 0.5 * base * (base + 1) * g;
      return {{"drift of the top (m)", (set.position(top) - start).norm(), 0.5, 1e-2},
              {"speed at the end (m/s)", top_speed(loop), 1e-3, 1e-3},
              {"penetration / size", seen.penetration, unbounded, 1e-3},
              {"error of the ground's force", std::abs(force_from(loop, ground.index) / weight - 1),
               unbounded, 1e-4},
              energy_mark(seen, weight)};
    });
}

void stack(Ladder& ladder) { climb_stack(ladder, AcceleratedGaussSeidel{}); }
void stack_newton(Ladder& ladder) { climb_stack(ladder, ProximalNewton{}); }

// Cards of 100 × 60 × 1 mm: tents of two at 65 degrees, storey on storey, a level card between two tents'
// ridges.
void card_house(Ladder& ladder) {
  for (const int storeys : {1, 2, 3, 5, 10})
    ladder.rung(format("%d storeys", storeys), [&]() -> Marks {
      auto loop = standing_loop(0.5);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      const double a = 0.05, b = 0.0005, angle = 65 * 3.14159265358979 / 180, c = std::cos(angle),
                   s = std::sin(angle);
      const double half = a * c + b * s, rise = a * s + b * c;  // of a leaning card's bounding box
      const double spacing = 4 * half + 1e-4;
      double floor = 0;
      std::vector<RigidBodies::Handle> cards;
      for (int storey = 0; storey < storeys; ++storey) {
        const int tents = storeys - storey;
        for (int k = 0; k < tents; ++k)
          for (const double side : {-1., 1.}) {
            // The card's length is its x axis; it leans to the middle of its tent.
            const Quat turn(std::cos(0.5 * angle), 0, side * std::sin(0.5 * angle), 0);
            cards.push_back(
                set.add({.position = {spacing * (k + 0.5 * storey) + side * half, 0, floor + rise},
                         .orientation = turn,
                         .density = 800.,
                         .shape = Box{2 * a, 0.06, 2 * b}}));
          }
        for (int k = 0; k + 1 < tents; ++k)
          cards.push_back(set.add({.position = {spacing * (k + 0.5 + 0.5 * storey), 0, floor + 2 * rise + b},
                                   .density = 800.,
                                   .shape = Box{spacing - 1e-4, 0.06, 2 * b}}));
        floor += 2 * rise + 2 * b;
      }
      const RigidBodies::Handle top = cards.back();
      const Vec3 start = set.position(top);
      double top_at_one = 0;
      const double until = ladder.is_quick() ? 0.5 : 60;
      const Seen seen = run(ladder, loop, until, frame, [&](int n) {
        if (n == 60) top_at_one = set.position(top).z();
      });
      const double drop = (start - set.position(top)).z(),
                   mass = 800 * 0.1 * 0.06 * 0.001 * double(cards.size());
      return {{"drop of the top (m)", drop, 0.01, 0.01},
              {"creep of the top after 1 s (m)",
               ladder.is_quick() ? 0 : std::abs(top_at_one - set.position(top).z()), unbounded, 1e-6},
              energy_mark(seen, mass * g * floor)};
    });
}

namespace {

/// A line of dominoes of 1 × 0.5 × 0.2 m, 0.6 m apart; the first is pushed over. The wave's pace must not
/// depend on the step; five hundred are run once, against the pace of fifty.
template <class Solver>
void climb_dominoes(Ladder& ladder, const Solver& solver) {
  double pace_of_fifty = 0;
  for (const int count : {5, 15, 50, 500})
    ladder.rung(format("%d dominoes", count), [&]() -> Marks {
      int out_of_order = 0, standing = 0;
      // Seconds a domino, in steps of h.
      const auto pace = [&](double h) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}, solver};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        std::vector<RigidBodies::Handle> line;
        for (int k = 0; k < count; ++k)
          line.push_back(set.add({.position = {0.6 * k, 0, 0.5}, .mass = 1.0, .shape = Box{0.2, 0.5, 1}}));
        set.set_velocity(line[0], {0.75, 0, 0}, {0, 1.5, 0});
        std::vector<double> fell(std::size_t(count), -1);
        run(ladder, loop, 3 + 0.22 * count, h, [&](int n) {
          for (std::size_t k = 0; k < fell.size(); ++k)
            if (fell[k] < 0 && set.position(line[k]).z() < 0.45) fell[k] = (n + 1) * h;
        });
        for (std::size_t k = 0; k < fell.size(); ++k) {
          standing += fell[k] < 0;
          out_of_order += k > 0 && fell[k] <= fell[k - 1];
        }
        return (fell.back() - fell[1]) / (count - 2);
      };
      const double coarse = pace(frame), other = count <= 50 ? pace(frame / 4) : pace_of_fifty;
      if (count == 50) pace_of_fifty = coarse;
      return {{"dominoes that stand", double(standing), 0, 0},
              {"out of order", double(out_of_order), 0, 0},
              {count <= 50 ? "wave at h against h/4" : "wave against that of 50",
               std::abs(coarse / other - 1), unbounded, 1e-2}};
    });
}

}  // namespace

void dominoes(Ladder& ladder) { climb_dominoes(ladder, AcceleratedGaussSeidel{}); }
void dominoes_newton(Ladder& ladder) { climb_dominoes(ladder, ProximalNewton{}); }

// Blocks of 3 × 1 × 0.6, three a layer, every layer across the one below; a middle one is taken out.
void tower(Ladder& ladder) {
  for (const int layers : {3, 6, 12, 18})
    ladder.rung(format("%d layers of 3", layers), [&]() -> Marks {
      auto loop = standing_loop(0.5);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      std::vector<RigidBodies::Handle> blocks;
      for (int layer = 0; layer < layers; ++layer)
        for (int k = -1; k <= 1; ++k) {
          const bool across = layer % 2 == 1;
          const double at = 1.005 * k, z = 0.3 + 0.6 * layer;
          blocks.push_back(set.add({.position = across ? Vec3(at, 0, z) : Vec3(0, at, z),
                                    .density = 500.,
                                    .shape = across ? Box{1, 3, 0.6} : Box{3, 1, 0.6}}));
        }
      const double before = ladder.is_quick() ? 0.2 : 2;
      run(ladder, loop, before, frame);
      loop.remove(blocks[std::size_t(3 * (layers / 2) + 1)]);
      const Vec3 start = set.position(blocks.back());
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.3 : 60, frame);
      return {{"drift of the top (m)", (set.position(blocks.back()) - start).norm(), 0.1, 1e-3},
              energy_mark(seen, 500 * 1.8 * 3 * layers * g)};
    });
}

}  // namespace ladders
