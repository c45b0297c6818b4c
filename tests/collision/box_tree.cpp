#include "catch.hpp"
#include "collision/boxes.hpp"

#include <delassus/collision/box_tree.hpp>

#include <algorithm>
#include <random>
#include <vector>

namespace box_tree_tests {

using namespace delassus;
using namespace samples;

static_assert(BroadPhase<BoxTree> && TaggedBroadPhase<BoxTree>);

namespace {

std::vector<CandidatePair> ask(BoxTree& tree, const std::vector<Aabb>& boxes) {
  std::vector<CandidatePair> pairs;
  tree.find(boxes, pairs);
  return pairs;
}

Vec3 any(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

}  // namespace

TEST_CASE("the tree finds every pair once and sorted, while boxes move, come, go, grow and vanish") {
  for (const double speed : {0.0, 0.01, 0.3, 20.0}) {
    std::mt19937 random(1);
    std::vector<Aabb> boxes;
    BoxTree tree;
    for (int step = 0; step < 120; ++step) {
      if (step % 10 == 0) boxes.resize(std::size_t(50 + 30 * (step % 40) / 10));
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Vec3 move = speed * any(random);
        if (boxes[i].is_empty()) {
          const Vec3 centre = 4 * any(random), half = Vec3::Constant(0.6) + 0.5 * any(random);
          boxes[i] = Aabb(centre - half, centre + half);
        } else if (i % 17 == std::size_t(step % 17)) {
          boxes[i] = Aabb();
        } else if (i % 29 == std::size_t(step % 29)) {
          boxes[i] = Aabb(boxes[i].min(), boxes[i].max() + Vec3::Ones());
        } else {
          boxes[i] = Aabb(boxes[i].min() + move, boxes[i].max() + move);
        }
      }
      CHECK(ask(tree, boxes) == brute_force(boxes));
    }
  }
}

TEST_CASE("boxes with names are recognised wherever they stand, and those that do not move are no pairs") {
  struct Named {
    Aabb box;
    BoxTag tag;
  };
  std::mt19937 random(2);
  std::vector<Named> bodies;
  std::uint32_t next = 0;
  BoxTree tree;
  for (int step = 0; step < 300; ++step) {
    // Some come, some go, some begin or cease to move, and the order changes now and then.
    for (int k = 0; k < 1 + 40 * (step == 0); ++k) {
      const Vec3 centre = 3 * any(random);
      bodies.push_back({Aabb(centre - 0.4 * Vec3::Ones(), centre + 0.4 * Vec3::Ones()),
                        {.key = (next++ * 7919u) % 10007u, .is_movable = next % 3 != 0}});
    }
    if (bodies.size() > 90) bodies.erase(bodies.begin() + 5, bodies.begin() + 25);
    if (step % 9 == 0) std::shuffle(bodies.begin(), bodies.end(), random);
    if (step % 5 == 0) bodies[3].tag.is_movable = !bodies[3].tag.is_movable;
    std::vector<Aabb> boxes;
    std::vector<BoxTag> tags;
    for (Named& body : bodies) {
      const Vec3 move = body.tag.is_movable ? Vec3(0.05 * any(random)) : Vec3::Zero();
      body.box = Aabb(body.box.min() + move, body.box.max() + move);
      boxes.push_back(body.box);
      tags.push_back(body.tag);
    }
    std::vector<CandidatePair> pairs, expected;
    tree.find(boxes, tags, pairs);
    for (const CandidatePair& p : brute_force(boxes))
      if (tags[p.i].is_movable || tags[p.j].is_movable) expected.push_back(p);
    CHECK(pairs == expected);
  }
}

TEST_CASE("boxes that only touch are a pair, and a pair of nothing is none") {
  BoxTree tree;
  CHECK(ask(tree, {}).empty());
  const std::vector<Aabb> boxes{Aabb(Vec3::Zero(), Vec3::Ones()), Aabb(Vec3::UnitX(), Vec3(2, 1, 1)), Aabb(),
                                Aabb(Vec3(2.1, 0, 0), Vec3(3, 1, 1))};
  CHECK(ask(tree, boxes) == std::vector<CandidatePair>{{0, 1}});
  CHECK(ask(tree, {Aabb(), Aabb()}).empty());
  CHECK(ask(tree, boxes) == std::vector<CandidatePair>{{0, 1}});
}

TEST_CASE("a step after a long history gives the pairs of a fresh tree") {
  std::mt19937 random(3);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 200; ++i) {
    const Vec3 centre = 4 * any(random);
    boxes.push_back(Aabb(centre - 0.5 * Vec3::Ones(), centre + 0.5 * Vec3::Ones()));
  }
  BoxTree old;
  for (int step = 0; step < 100; ++step) {
    for (Aabb& box : boxes) {
      const Vec3 move = 0.2 * any(random);
      box = Aabb(box.min() + move, box.max() + move);
    }
    ask(old, boxes);
  }
  BoxTree fresh, copy = old;
  CHECK(ask(old, boxes) == ask(fresh, boxes));
  CHECK(ask(copy, boxes) == ask(fresh, boxes));
}

}  // namespace box_tree_tests
