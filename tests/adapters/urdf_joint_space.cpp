// The joint spaces of the machines of other projects that URDF files describe.
#include <delassus/adapters/urdf.hpp>

#include "catch.hpp"
#include "model/there_and_back.hpp"

#include <cstdlib>
#include <filesystem>

namespace urdf_joint_space_tests {

using namespace delassus;

TEST_CASE("forward of inverse dynamics gives the accelerations of 17 URDF files back") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: the files of other projects are left out");
    return;
  }
  int count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(folder) / "urdf")) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".urdf") continue;
    CAPTURE(file);
    Model m;
    try {
      m = read_urdf(file);
    } catch (const InvalidArgument&) {
      continue;  // urdf_models.cpp has the reasons
    }
    ++count;
    for (const Base base : {Base::as_file, Base::fixed}) {
      const ThereAndBack worst = there_and_back(m, 1, base);
      CHECK(worst.acceleration <= 1e-9);
      CHECK(worst.q <= 1e-10);
      CHECK(worst.v <= 1e-10);
      CHECK(worst.gap <= 1e-12);
    }
  }
  CHECK(count == 17);
}

}  // namespace urdf_joint_space_tests
