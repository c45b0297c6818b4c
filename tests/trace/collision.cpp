/// Around detection: meshes, compounds, filters; who sleeps or is switched off; who listens.
#include <delassus/activity/sleeping.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/listeners/convergence_record.hpp>
#include <delassus/listeners/double_buffer.hpp>

#include <type_traits>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

/// The stages that it hears, as one number below 2⁵³.
struct Heard {
  using plays = role::Listener;
  using listens = ListensToAll;
  double all = 0;
  template <class Stage>
  void after(Stage, const auto&) {
    if (std::is_same_v<Stage, stage::Begin>) all = 0;
    all = all * 13 + weight(std::type_identity<listens>{}, Stage{});
  }
  template <class... All, class Stage>
  static double weight(std::type_identity<Listens<All...>>, Stage) {
    constexpr int weights[]{5, 6, 9, 11, 7, 4, 5, 5, 7, 7, 4};
    int k = 0, at = 0;
    ((at = std::is_same_v<All, Stage> ? k : at, ++k), ...);
    return weights[at];
  }
};

auto on_hills() {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     WithFilter{WithCompounds{WithMeshes{NativeCollision{}}}},
                     ConvergenceRecord{true},
                     DoubleBuffer{},
                     Heard{}};
  auto& set = rigid_of(loop);
  auto& compounds = loop.template get<WithFilter<WithCompounds<WithMeshes<NativeCollision>>>>().backend;
  std::vector<double> heights;
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i) heights.push_back(0.1 * std::sin(1.3 * i) * std::cos(1.7 * j));
  set.add_fixed(compounds.backend.add(HeightField(9, 9, 0.5, 0.5, heights)));
  const std::vector<CompoundPart> parts{{.shape = Sphere{0.15}, .position = {-0.2, 0, 0}},
                                        {.shape = Box{0.2, 0.2, 0.2}, .position = {0.2, 0, 0}}};
  const Compound dumbbell(parts);
  const auto a = set.add({.position = {0.2, 0.1, 0.5},
                          .velocity = {0.5, 0, 0},
                          .mass = dumbbell.mass(),
                          .inertia = dumbbell.inertia(),
                          .shape = compounds.add(dumbbell)});
  // Both overlap and are held together: the filter lets them.
  const auto b = set.add({.position = {0.2, 0.1, 0.75}, .mass = 100.0, .shape = Sphere{0.2}});
  loop.add(BallJoint::Item{anchor(set, a, {0, 0, 0.15}), anchor(set, b, {0, 0, -0.1})});
  set.add({.position = {-0.4, -0.3, 0.6}, .velocity = {0, 0.6, 0}, .mass = 50.0, .shape = Sphere{0.2}});
  return loop;
}

/// Of the listeners: rows and forces, the stages, and the problem that another thread would read.
void look_at_listeners(const auto& loop, const auto& f) {
  double forces = 0, work = 0;
  for (const auto& row : loop.template get<ConvergenceRecord>().rows())
    forces += std::abs(row.force) * (1 + row.row);
  auto& channel = loop.template channel<DoubleBuffer>();
  channel.fetch();
  each_item(channel.front().problem, [&](const auto& d, const auto& lambda) { work += d.dot(lambda); });
  f(forces), f(work), f(loop.template get<Heard>().all);
}

/// Two boxes that fall asleep on a floor that moves later, and a ball that wakes them.
template <class Activity>
auto with_activity() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}, Activity{}};
  auto& set = rigid_of(loop);
  set.add({.position = {0, 0, -0.5}, .shape = Box{20, 20, 1}, .motion = Motion::kinematic});
  for (int k = 0; k < 2; ++k)
    set.add({.position = {0, 0, 0.25 + 0.5 * k}, .mass = 1.0, .shape = Box{0.5, 0.5, 0.5}});
  set.add({.position = {-2.8, 0, 0.2},
           .velocity = {2.4, 0, 0},
           .angular_velocity = {0, 12, 0},
           .mass = 1.0,
           .shape = Sphere{0.2}});
  const auto bob = set.add({.position = {0, 3.1, 1}, .mass = 1.0, .shape = Sphere{0.1}});
  loop.add(BallJoint::Item{anchor(set, bob, {0, 0, 0.5}), world_anchor({0, 3.1, 1.5})});
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("collision");
  all.add("meshes_compounds_filter_listeners", {.h = 0.01}, on_hills, Nobody{},
          [](const auto& loop, const auto& f) { look_at_listeners(loop, f); });
  all.add("sleeping", {.is_redundant = true}, with_activity<Sleeping>, [](auto& loop, int n) {
    auto& set = rigid_of(loop);
    if (n >= 120) set.move_to(set.handle(0), {0.002 * (n - 119), 0, -0.5});
  });
  all.add("switched_off_and_on", {.is_redundant = true}, with_activity<HandPicked>, [](auto& loop, int n) {
    auto& set = rigid_of(loop);
    if (n == 4) loop.switch_off(set.handle(2));
    if (n == 8) loop.switch_off(set.handle(4));
    if (n == 40) loop.switch_on(set.handle(2));
    if (n == 110) loop.switch_on(set.handle(4));
  });
  return all.main(argc, argv);
}
