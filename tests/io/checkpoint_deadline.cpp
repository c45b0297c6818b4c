#include "scenes.hpp"

#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"

namespace checkpoint_deadline_tests {

using namespace scenes;

namespace {

/// Time all but stands until a look that jumps over the deadline.
struct JumpingClock {
  int* looks;
  int jump;
  double now() const { return ++*looks >= jump ? 1.0 : 1e-9 * *looks; }
};

auto stack_until(int* looks, int jump) {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       WithDeadline{AcceleratedGaussSeidel{.tolerance = 1e-14}, 0.5, JumpingClock{looks, jump}}};
}

}  // namespace

// Newton's method comes to nothing in the first step, so that the second passes it over: a loop that did not know of the first
// would begin it.
TEST_CASE("restored, a loop with a deadline goes on bit for bit, what came to nothing before it and all") {
  int looks = 0, jump = 40, begun = 0;
  for (; begun == 0 && jump < 1000; ++jump) {
    auto loop = stack_until(&looks, jump);
    add_stack(rigid_bodies(loop), 70, Box{1, 1, 1}, 1e-3);
    looks = 0;
    loop.step(1.0 / 60);
    begun = loop.island_reports()[0].factorizations;
  }
  auto loop = stack_until(&looks, jump + 3);
  add_stack(rigid_bodies(loop), 70, Box{1, 1, 1}, 1e-3);
  begun = 0;
  int passed_over = 0;
  for (int n = 0; n < 12; ++n) {
    auto restored = stack_until(&looks, jump + 3);
    restore(restored, checkpoint(loop));
    looks = 0;
    REQUIRE(loop.step(1.0 / 60).status == Status::deadline);
    looks = 0;
    restored.step(1.0 / 60);
    const int mine = loop.island_reports()[0].factorizations;
    (mine > 0 ? begun : passed_over) += 1;
    CAPTURE(n);
    REQUIRE(restored.island_reports()[0].factorizations == mine);
    REQUIRE(state_hash(loop) == state_hash(restored));
  }
  REQUIRE(begun > 0);
  REQUIRE(passed_over > begun);
}

}  // namespace checkpoint_deadline_tests
