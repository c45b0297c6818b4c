#include <delassus/io/recorder.hpp>

#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "cloth_scenes.hpp"

namespace recorder_tests {

using namespace delassus;

TEST_CASE("the edges of soft bodies are drawn once each, those at the border of a sheet too") {
  using Sheets = Cloth<Corotational>;
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{Sheets{}, Soft{}}, ImplicitEuler{}, Recorder{"Soft", "A sheet and a cube."}};
  bodies<Sheets>(loop.world()).add({.mesh = soft_scenes::square(3, 1e-3)});
  bodies<Soft>(loop.world()).add({.mesh = soft_scenes::cube(1)});
  loop.step(0.01);
  const auto& frames = loop.get<Recorder>().recording().frames;
  REQUIRE(frames.size() == 1);
  // 4 rows of 3 along each axis and 9 diagonals; 12 of the cube and one diagonal a face.
  CHECK(frames[0].lines.size() == 12 + 12 + 9 + 12 + 6);
}

}  // namespace recorder_tests
