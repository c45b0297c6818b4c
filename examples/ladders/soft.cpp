// HC-19, HC-20, HC-40: elements inside out, materials that keep their volume, rigid bodies on soft ones.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/find_rest.hpp>
#include <delassus/fem/hexahedral_fem.hpp>
#include <delassus/fem/soft_invariants.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <random>

namespace ladders {

// A cube of 48 tetrahedra without gravity whose nodes start anywhere; 10 s.
void inverted_elements(Ladder& ladder) {
  const char* starts[] = {"swollen",   "one node through", "inside out", "flat",
                          "in a line", "in a point",       "anywhere"};
  for (int start = 0; start < 7; ++start)
    ladder.rung(starts[start], [&]() -> Marks {
      using Soft = TetrahedralFem<Corotational>;
      AnimationLoop loop{World{Soft{}}, ImplicitEuler{.rayleigh_mass = 4}};
      auto& soft = bodies<Soft>(loop.world());
      soft.gravity.setZero();
      const auto cube =
          soft.add({.mesh = box_mesh({1, 1, 1}, {2, 2, 2}), .elasticity = {.young = 1e4, .poisson = 0.3}});
      std::mt19937 random(4);
      const auto draw = [&] { return double(random()) / 4294967296.0; };
      for (Index k = 0; k < soft.node_count(cube); ++k) {
        const auto node = soft.node(cube, k);
        const Vec3 p = soft.position(node);
        Vec3 any;
        for (int i = 0; i < 3; ++i) any[i] = draw();
        const bool is_middle = (p - Vec3(0.5, 0.5, 0.5)).norm() < 0.2;
        const Vec3 places[] = {1.5 * p,
                               is_middle ? Vec3(0.5, 0.5, 1.6) : p,
                               {p[0], p[1], -p[2]},
                               {p[0], p[1], 0},
                               {p[0], 0, 0},
                               {0, 0, 0},
                               any};
        soft.place(node, places[start]);
      }
      const double first = energy(loop);
      double last = first, rise = -first;
      run(ladder, loop, ladder.is_quick() ? 1 : 10, 0.01, [&](int) {
        const double now = energy(loop);
        rise = most(rise, now - last);
        last = now;
      });
      return {{"elastic energy left / at the start", soft.elastic_energy() / first, 1,
               ladder.is_quick() ? 1 : 1e-6},
              {"largest rise of energy in a step / at the start", rise / first, 1e-6, 1e-12}};
    });
}

// 1 × 0.1 × 0.1 m in 20 × 2 × 2 elements, E = 1 MPa, bent by 0.01 N at its end: Timoshenko's deflection
// P L³/3EI + P L/(5/6 G A).
void incompressible(Ladder& ladder) {
  for (const double nu : {0.3, 0.45, 0.49, 0.499, 0.4999})
    ladder.rung(format("Poisson's ratio %g", nu), [&]() -> Marks {
      using Soft = HexahedralFem<Corotational>;
      const double E = 1e6, load = 0.01, side = 0.1;
      Soft soft;
      soft.gravity.setZero();
      const auto beam = soft.add(
          {.mesh = hexahedral_box({1, side, side}, {20, 2, 2}), .elasticity = {.young = E, .poisson = nu}});
      soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9; });
      std::vector<Index> end;
      for (Index k = 0; k < soft.node_count(beam); ++k)
        if (soft.position(soft.node(beam, k)).x() > 1 - 1e-9) end.push_back(k);
      double weights = 0;  // a node's share of the end face: corners 1, edges 2, the middle 4
      const auto share = [&](Index k) {
        const Vec3 x = soft.position(soft.node(beam, k));
        const auto inner = [&](double y) { return std::abs(y / side - 0.5) < 0.25 ? 2. : 1.; };
        return inner(x.y()) * inner(x.z());
      };
      std::vector<double> part;
      for (const Index k : end) part.push_back(share(k)), weights += part.back();
      double before = 0, tip = 0;
      for (const Index k : end) before += soft.position(soft.node(beam, k)).z() / double(end.size());
      for (int n = 0; n < 4; ++n) {
        soft.factor({.mass = 0, .stiffness = 1});
        std::vector<Vec3> x(soft.blocks(), Vec3::Zero());
        soft.add_forces(x);
        for (std::size_t i = 0; i < end.size(); ++i)
          x[std::size_t(soft.node(beam, end[i]).index)].z() -= load * part[i] / weights;
        soft.solve(x);
        for (Index b = 0; b < soft.blocks(); ++b) soft.displace(b, x[std::size_t(b)]);
      }
      for (const Index k : end) tip += soft.position(soft.node(beam, k)).z() / double(end.size());
      const double section = side * side, second = section * section / 12;
      const double timoshenko = load / (3 * E * second) + load / (5. / 6 * E / (2 * (1 + nu)) * section);
      return {{"tip against Timoshenko", std::abs((before - tip) / timoshenko - 1), unbounded, 0.05}};
    });
}

namespace {

/// Poisson's ratio, and what squeezing its cube takes: the force (N), and the share of its volume that goes.
/// Limits of HexahedralFem with 6, 12 and 24 elements a side, whose differences shrink 2.3 times (edges of
/// bonded plates are singular). Those of QuadraticTetrahedralFem, six a cell, with 6 and 12 are the same
/// within 0.1 %.
struct Squeeze {
  double nu, force, lost;
};

// A cube of 1 m, E = 1 MPa, 12 elements a side, between two plates to which it is bonded and of which one
// comes nearer by 0.1 m. Elements that cannot bulge without a change of volume lock: they push back too hard.
template <class Soft>
void climb_squeezed(Ladder& ladder, const auto& mesh_of) {
  const Index side = ladder.is_quick() ? 6 : 12;
  for (const auto& [nu, force, lost] : {Squeeze{0.45, 128.7e3, 1.702e-2},
                                        {0.49, 135.6e3, 3.65e-3},
                                        {0.499, 137.4e3, 3.75e-4},
                                        {0.4999, 137.6e3, 3.7e-5}})
    ladder.rung(format("Poisson's ratio %g", nu), [&, nu = nu, force = force, lost = lost]() -> Marks {
      Soft soft;
      soft.gravity.setZero();
      const auto cube = soft.add(
          {.mesh = mesh_of({1, 1, 1}, {side, side, side}), .elasticity = {.young = 1e6, .poisson = nu}});
      soft.fix(cube, [](const Vec3& x) { return x.z() < 1e-9 || x.z() > 1 - 1e-9; });
      for (Index k = 0; k < soft.node_count(cube); ++k) {
        const auto node = soft.node(cube, k);
        soft.place(node, soft.position(node).cwiseProduct(Vec3(1, 1, 0.9)));
      }
      const RestReport report = find_rest(soft);
      soft.factor({.mass = 1});
      double push = 0, volume_now = 0;
      soft.each_mesh([&](Index, Index, const auto& body) {
        auto now = body.mesh();
        for (std::size_t k = 0; k < now.points.size(); ++k) {
          now.points[k] = soft.pose(body.blocks()[k]).position;
          if (body.mesh().points[k].z() < 1e-9) push -= body.force()[k].z();
        }
        for (Index e = 0; e < Index(now.cells().size()); ++e) volume_now += volume(now, e);
      });
      return {{"force against finer meshes", std::abs(push / force - 1), unbounded, 0.05},
              {"volume lost against finer meshes", std::abs(1 - volume_now - lost), unbounded, 1e-3},
              {"not at rest", double(report.status != Status::converged), 1, 0}};
    });
}

}  // namespace

void squeezed(Ladder& ladder) { climb_squeezed<HexahedralFem<StableNeoHookean>>(ladder, hexahedral_box); }
void squeezed_tetrahedra(Ladder& ladder) {
  climb_squeezed<TetrahedralFem<StableNeoHookean>>(
      ladder, [](const Vec3& size, const std::array<Index, 3>& cells) { return box_mesh(size, cells); });
}

// A rigid box of r kg on a soft cube of 1 kg on the ground: what the ground carries.
void rigid_on_soft(Ladder& ladder) {
  for (const double r : {1e-3, 1e-2, 0.1, 1., 10., 100., 1e3})
    ladder.rung(format("%g kg on 1 kg", r), [&]() -> Marks {
      using Soft = HexahedralFem<Corotational>;
      AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                         ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.01},
                         AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000}};
      auto& rigid = bodies<RigidBodies>(loop.world());
      auto& soft = bodies<Soft>(loop.world());
      const auto ground = rigid.add_fixed(HalfSpace{});
      soft.add({.mesh = hexahedral_box({1, 1, 1}, {2, 2, 2}),
                .elasticity = {.young = 1e6, .poisson = 0.3},
                .density = 1,
                .position = {0, 0, 0.01},
                .contact_radius = 0.01});
      rigid.add({.position = {0.5, 0.5, 1.02 + 0.25}, .mass = r, .shape = Box{1.5, 1.5, 0.5}});
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.5 : 10, frame);
      double force = 0;
      for (const ContactResult& c : loop.contacts()) {
        if (c.record.a.set == 0 && c.record.a.block == ground.index) force += c.impulse.z() / frame;
        if (c.record.b.set == 0 && c.record.b.block == ground.index) force -= c.impulse.z() / frame;
      }
      return {{"error of the ground's force", std::abs(force / ((1 + r) * g) - 1), 0.05, 1e-3},
              {"speed at the end (m/s)", top_speed(loop), 0.1, 1e-3},
              energy_mark(seen, (1 + r) * g)};
    });
}

// A soft cube of 1 kg, 0.1 m, between two rigid fingers of r kg that are pushed on it with 20 N each, for 10
// s: friction 0.5 holds up to twice its weight.
void soft_grip(Ladder& ladder) {
  for (const double r : {1., 0.1, 1e-2, 1e-3, 10., 100., 1e3})
    ladder.rung(format("fingers of %g kg", r), [&]() -> Marks {
      using Soft = HexahedralFem<Corotational>;
      AnimationLoop loop{World{RigidBodies{}, Soft{}},
                         Constraints{Contact{Coulomb{.friction = 0.5}}, Slider{}},
                         ImplicitEuler{.rayleigh_stiffness = 0.01},
                         AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000}};
      auto& rigid = bodies<RigidBodies>(loop.world());
      auto& soft = bodies<Soft>(loop.world());
      const double push = 20, h = 0.01, side = 0.1, young = 5e4, nu = 0.3;
      const double squeeze = push / (young * side);  // F L/(E A), m
      const auto cube = soft.add({.mesh = hexahedral_box({side, side, side}, {3, 3, 3}),
                                  .elasticity = {.young = young, .poisson = nu},
                                  .density = 1000,
                                  .contact_radius = 0.002});
      const Vec3 stretch = Vec3(-1, nu, nu) * squeeze / side, middle_of(side / 2, side / 2, side / 2);
      for (Index k = 0; k < soft.node_count(cube); ++k) {
        const Vec3 x = soft.position(soft.node(cube, k));
        soft.place(soft.node(cube, k), x + stretch.cwiseProduct(x - middle_of));
      }
      const Quat along = frame_along({1, 0, 0});
      RigidBodies::Handle finger[2];
      for (const int k : {0, 1}) {
        const Vec3 at(k ? 0.112 - squeeze / 2 : squeeze / 2 - 0.012, 0.05, 0.05);
        finger[k] = rigid.add({.position = at, .mass = r, .shape = Box{0.02, 0.12, 0.12}});
        loop.add(Slider::Item{world_anchor(at, along), anchor_at(rigid, finger[k], at, along)});
      }
      const auto height = [&] {
        double sum = 0;
        for (Index k = 0; k < soft.node_count(cube); ++k) sum += soft.position(soft.node(cube, k)).z();
        return sum / soft.node_count(cube);
      };
      const double until = ladder.is_quick() ? 2 : 10, start = height();
      double middle = 0;
      const auto press = [&] {
        for (const int k : {0, 1}) rigid.apply_force(finger[k], {k ? -push : push, 0, 0});
      };
      press();
      run(ladder, loop, until, h, [&](int n) {
        press();
        if ((n + 1) * h <= until / 2) middle = height();
      });
      Vec3 held = Vec3::Zero();
      double pressed = 0;
      for (const ContactResult& c : loop.contacts()) {
        const bool is_b = c.record.b.set == 1;
        held += (is_b ? 1 : -1) * c.impulse / h;
        pressed += std::abs(c.impulse.x()) / h / 2;
      }
      return {{"error of the force that holds it", std::abs(held.z() / g - 1), 0.05, 1e-3},
              {"error of the fingers' force", std::abs(pressed / push - 1), 0.05, 1e-3},
              {"fallen (m)", start - height(), 0.05, 0.01},
              {"creep (m/s)", std::abs(middle - height()) / (until / 2), 1e-3, 1e-6}};
    });
}

}  // namespace ladders
