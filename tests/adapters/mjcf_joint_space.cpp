// The joint spaces of the machines of other projects that MJCF files describe.
#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"
#include "model/there_and_back.hpp"

#include <cstdlib>
#include <filesystem>

namespace mjcf_joint_space_tests {

using namespace delassus;

TEST_CASE("forward of inverse dynamics gives the accelerations of 23 MJCF files back") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: no models of other projects are read");
    return;
  }
  const MjcfOptions options{
      .files = {std::string(folder) + "/mjcf/mujoco"}};  // treadmill has a model of there
  int count = 0;
  for (const char* of : {"dm_control", "mujoco"})
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(folder) / "mjcf" / of)) {
      const std::string file = entry.path().string();
      if (entry.path().extension() != ".xml") continue;
      CAPTURE(file);
      const ThereAndBack worst = there_and_back(read_mjcf(file, options), 1);
      ++count;
      CHECK(worst.acceleration <= 1e-9);
      CHECK(worst.q <= 1e-10);
      CHECK(worst.v <= 1e-10);
      CHECK(worst.gap <= 1e-12);
    }
  CHECK(count == 23);
}

}  // namespace mjcf_joint_space_tests
