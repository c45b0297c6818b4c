// Two pendulums on a string, read from MJCF: what became of the copies, and what was left out.
// prints: arm0 and arm1, 2 hinges, a string between them, left out: pendulums.xml:11: sensors: nothing measures here
#include <delassus/adapters/mjcf.hpp>

#include <cstdio>
#include <string>

using namespace delassus;

const std::string text = R"(<mujoco>
  <default><geom type="capsule" size=".02" fromto="0 0 0 0 0 -1"/></default>
  <worldbody>
    <replicate count="2" offset="1 0 0">
      <body name="arm" pos="0 0 2"><joint name="swing" axis="0 1 0" damping=".1"/><geom/><site name="end" pos="0 0 -1"/></body>
    </replicate>
  </worldbody>
  <tendon>
    <spatial name="string" range="0 1.5"><site site="end0"/><site site="end1"/></spatial>
  </tendon>
  <sensor><jointpos joint="swing0"/></sensor>
</mujoco>)";

int main() {
  MjcfOptions options{.files = {"/opt/robots"}};
  const Model machine = parse_mjcf(text, "pendulums.xml", options);  // or read_mjcf("pendulums.xml", options)

  for (const std::string& what : machine.skipped) std::fprintf(stderr, "%s\n", what.c_str());

  std::printf("%s and %s, %zu hinges, a %s between them, left out: %s\n", machine.bodies[0].name.c_str(),
              machine.bodies[1].name.c_str(), machine.joints.size(), machine.tendons[0].name.c_str(),
              machine.skipped[0].c_str());
  return 0;
}
