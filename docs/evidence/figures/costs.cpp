// What substeps, friction laws, scalar types and numbers of bodies cost: four diagrams of docs/evidence/study.md.
// Takes a folder, docs/evidence/study say.
#include <delassus/adapters/posix.hpp>
#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/csv.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/study/diagram.hpp>
#include <delassus/study/sweep.hpp>
#include <delassus/study/tables.hpp>

#include <cmath>
#include <cstdio>
#include <string>

using namespace delassus;

namespace {

std::string folder;

void draw(const char* file, const Study& study, double budget) {
  write_diagram(folder + "/" + file + ".svg", study, {.budget = budget});
  write_csv(folder + "/" + file + ".csv", runs_table(study));
  std::printf("%s\n", file);
  print(front_table(study));
}

/// 64 sweeps a step, in one step or in several.
struct Split {
  int substeps;
  int sweeps() const { return 64 / substeps; }
  std::string code() const { return "Split{" + std::to_string(substeps) + "}"; }
};

/// Five boxes, the top one a hundred times as heavy, stand for 5 s.
void substeps() {
  const auto scene = [](const Split& split, auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       GaussSeidel{.tolerance = 0, .max_iterations = split.sweeps()},
                       Substeps{split.substeps}, policies...};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    for (int k = 0; k < 5; ++k)
      rigid.add({.position = {0, 0, 0.5 + k}, .mass = k == 4 ? 100. : 1., .shape = Box{1, 1, 1}});
    return loop;
  };
  const auto top = [](const auto& loop) { return loop.world().template set<0>().pose(5).position; };
  draw("substeps",
       sweep(scene,
             Combinations{Choices{Split{1}, Split{2}, Split{4}, Split{8}, Split{16}, Split{32}, Split{64}},
                          Choices{Baumgarte{}, SoftContact{}}},
             {.name = "64 sweeps a step, split into substeps", .duration = 5, .steps = {1. / 60}},
             Measures{Compared{"place of the top box", "m", top, [](double) { return Vec3(0, 0, 4.5); }},
                      penetration()},
             References<>{}, ThreadClock{}),
       1e-2);
}

struct Heading {
  double degrees;
  std::string code() const { return "Heading{" + std::to_string(int(degrees)) + "}"; }
};

/// A block at 5 m/s under several angles with the axes of a pyramid: the way until it stops.
void friction() {
  const double v0 = 5, mu = 0.3, slower = mu * 9.81;
  const auto scene = [=](const auto& law, const Heading& heading) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    const double angle = heading.degrees * EIGEN_PI / 180;
    rigid.add({.position = {0, 0, 0.1},
               .velocity = {v0 * std::cos(angle), v0 * std::sin(angle), 0},
               .mass = 1.0,
               .shape = Box{1, 1, 0.2}});
    return loop;
  };
  const auto way = [](const auto& loop) {
    const Vec3 x = loop.world().template set<0>().pose(1).position;
    return std::hypot(x.x(), x.y());
  };
  const auto exact = [=](double t) {
    const double s = std::min(t, v0 / slower);
    return v0 * s - 0.5 * slower * s * s;
  };
  draw("friction",
       sweep(scene,
             Combinations{Choices{Coulomb{.friction = mu}, Pyramid{.friction = mu}},
                          Choices{Heading{0}, Heading{15}, Heading{30}, Heading{45}}},
             {.name = "Round cone and pyramid",
              .duration = 2,
              .steps = {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001}},
             Measures{Compared{"way", "m", way, exact}}, References<>{}, ThreadClock{}),
       1e-2);
}

struct Double {
  using Set = RigidBodies;
  std::string code() const { return "Double{}"; }
};
struct Single {
  using Set = RigidBodiesF;
  std::string code() const { return "Single{}"; }
};

/// A rod on a pivot, let go level, after one period: it is where it was.
void scalars() {
  const double period = 1.93333485437325;
  const auto scene = [](auto scalar, auto... policies) {
    using Set = typename decltype(scalar)::Set;
    AnimationLoop loop{World{Set{}}, Constraints{BallJoint{}}, policies...};
    auto& rigid = bodies<Set>(loop.world());
    const auto rod = rigid.add(
        {.position = {0.5, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
    loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(rigid, rod, {-0.5, 0, 0})});
    return loop;
  };
  const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(0).position; };
  StudyPlan plan{.name = "Float and double", .duration = period, .outputs = 1};
  for (const int n : {50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000}) plan.steps.push_back(period / n);
  draw("scalars",
       sweep(scene,
             Combinations{Choices{Double{}, Single{}}, Choices{ImplicitMidpoint{}},
                          Choices{PositionProjection{.rate = 1}}},
             plan,
             Measures{Compared{"place after one period", "m", place, [](double) { return Vec3(0.5, 0, 0); }}},
             References<>{}, ThreadClock{}),
       1e-3);
}

struct Links {
  int count;
  std::string code() const { return "Links{" + std::to_string(count) + "}"; }
};

/// A chain whose end weighs a hundred links, pulled aside by a tenth of a radian, for half a second, its
/// joints held to 1e-6 of a link by all.
void sizes() {
  const auto scene = [](const Links& links, auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const Vec3 along(std::sin(0.1), 0, -std::cos(0.1));
    const Quat turn = frame_along(along);
    Anchor end = world_anchor({0, 0, 0});
    for (int k = 0; k <= links.count; ++k) {
      const double mass = k < links.count ? 1 : 100;
      const auto link = rigid.add({.position = (k + 0.5) * along,
                                   .orientation = turn,
                                   .mass = mass,
                                   .inertia = Mat3(mass * Vec3(1. / 12, 1. / 12, 1e-2).asDiagonal())});
      loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, -0.5})});
      end = anchor(rigid, link, {0, 0, 0.5});
    }
    return loop;
  };
  const auto count = [](const auto& loop) { return double(loop.world().template set<0>().blocks()); };
  draw("sizes",
       sweep(scene,
             Combinations{Choices{Links{10}, Links{30}, Links{100}, Links{300}, Links{1000}},
                          Choices{NewtonMidpoint{}}},
             {.name = "Bodies against time", .duration = 0.5, .steps = {1. / 60}, .outputs = 1},
             Measures{Compared{"bodies", "", count, [](double) { return 0.; }}, joint_drift()},
             References<>{}, ThreadClock{}),
       1e4);
}

}  // namespace

int main(int arguments, char** argument) {
  if (arguments != 2) return std::puts("figure_costs <folder>"), 2;
  folder = argument[1];
  substeps();
  friction();
  scalars();
  sizes();
}
