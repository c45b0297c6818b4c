// A law whose items own memory, and whose memory between sweeps does: a rope over pins.
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include <string>
#include <vector>

#include "catch.hpp"

namespace owning_items_tests {

using namespace delassus;

namespace {

/// φ = the way from a over the pins to b − length ≤ 0, λ ≤ 0.
struct RopeOverPins {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};
  static constexpr auto refines = refine::prepare;
  struct Item {
    Anchor a, b;
    double length = 0;
    std::vector<Vec3> pins;
    std::string name;

    void memory(auto& archive) {
      archive(a, b, length, pins);
      std::vector<char> letters(name.begin(), name.end());
      archive(letters);
      name.assign(letters.begin(), letters.end());
    }
  };
  template <class T>
  struct Memory {
    std::vector<T> impulses;  ///< of the sweeps of this step
  };

  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 a = world.point(item.a), b = world.point(item.b);
    const Vec3 after_a = item.pins.empty() ? b : item.pins.front(), before_b = item.pins.empty() ? a : item.pins.back();
    double way = (after_a - a).norm();
    for (std::size_t k = 1; k < item.pins.size(); ++k) way += (item.pins[k] - item.pins[k - 1]).norm();
    if (!item.pins.empty()) way += (b - before_b).norm();
    row.end(item.a, a).along(0, (a - after_a).normalized());
    row.end(item.b, b).along(0, (b - before_b).normalized());
    row.phi(0, way - item.length);
  }
  template <class W, class T>
  void prepare(const W&, Memory<T>& memory) const {
    memory.impulses.clear();
  }
  template <class T>
  Vec<1, T> solve_local(const Item&, const Mat<1, 1, T>& W, const Vec<1, T>& b, Memory<T>& memory) const {
    const Vec<1, T> lambda(std::min(T(0), -b[0] / W(0, 0)));
    memory.impulses.push_back(lambda[0]);
    return lambda;
  }
};

constexpr double h = 1e-3;

/// Weights that hang on ropes of 3 m over pins at (1, 0, 2) and (2, 0, 2), from walls at x = 0.
struct Hoist {
  AnimationLoop<World<RigidBodies>, Constraints<RopeOverPins>> loop{World{RigidBodies{}}, Constraints{RopeOverPins{}}};
  std::vector<RigidBodies::Handle> weights;

  RigidBodies& set() { return bodies<RigidBodies>(loop.world()); }
  auto hang(double y, const std::string& name) {
    weights.push_back(set().add({.position = {2, y, 1}, .mass = 2.0, .shape = Sphere{0.1}}));
    return loop.add(RopeOverPins::Item{world_anchor({0, y, 2}), anchor(set(), weights.back()), 3.0,
                                       {Vec3(1, y, 2), Vec3(2, y, 2)}, name});
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n) loop.step(h);
  }
  double height(int i) { return set().position(weights[i])[2]; }
};

const std::string long_name = "a rope whose name is too long to lie within the string itself";

}  // namespace

static_assert(std::is_same_v<ArrayOrVector<RopeOverPins::Item>, std::vector<RopeOverPins::Item>>);
static_assert(std::is_same_v<ArrayOrVector<BallJoint::Item>, Array<BallJoint::Item>>);

TEST_CASE("a law whose items own memory holds what hangs on it, however many are added") {
  Hoist hoist;
  for (int i = 0; i < 20; ++i) hoist.hang(i, long_name + std::to_string(i));
  hoist.run(200);
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    REQUIRE(hoist.height(i) == Approx(1.0).margin(1e-3));  // it fell 0.2 m without its rope
  }
}

TEST_CASE("an item that owns memory is taken out, and its place taken by another") {
  Hoist hoist;
  const auto first = hoist.hang(0, long_name);
  hoist.hang(1, "short");
  hoist.run(100);
  hoist.loop.remove(first);
  hoist.run(100);
  CHECK(hoist.height(0) < 0.96);  // 0.049 m of free fall
  CHECK(hoist.height(1) == Approx(1.0).margin(1e-3));
  const auto next = hoist.hang(2, long_name + ", again");
  CHECK(hoist.loop.constraint<RopeOverPins>(0).generation == next.generation);
  CHECK(hoist.loop.item(next).name == long_name + ", again");
  hoist.run(100);
  CHECK(hoist.height(2) == Approx(1.0).margin(1e-3));
}

TEST_CASE("a copy of a loop has items of its own") {
  Hoist hoist;
  hoist.hang(0, long_name);
  hoist.run(50);
  Hoist copy{hoist.loop.clone(), hoist.weights};
  hoist.run(100);
  {
    const Hoist gone{copy.loop.clone(), copy.weights};
  }
  copy.run(100);
  CHECK(copy.height(0) == hoist.height(0));
}

TEST_CASE("a checkpoint keeps what items own") {
  Hoist hoist, other;
  for (int i = 0; i < 3; ++i) hoist.hang(i, long_name);
  hoist.run(50);
  const std::vector<char> bytes = checkpoint(hoist.loop);
  hoist.run(50);
  restore(other.loop, bytes);
  for (int i = 0; i < 3; ++i) other.weights.push_back(other.set().handle(i));
  const auto& item = other.loop.item(other.loop.constraint<RopeOverPins>(2));
  CHECK(item.name == long_name);
  CHECK(item.pins.size() == 2);
  other.run(50);
  for (int i = 0; i < 3; ++i) CHECK(other.height(i) == hoist.height(i));
}

}  // namespace owning_items_tests
