// A pendulum on a post, read from a URDF: what became of its links and joints.
// prints: post on the world, arm turns on post, hand is a place on arm, 1 left out
#include <delassus/adapters/urdf.hpp>

#include <cstdio>
#include <string>

using namespace delassus;

const std::string text = R"(<robot name="pendulum">
  <link name="world"/>
  <link name="post"><inertial><mass value="5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="arm"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="hand"/>
  <joint name="foot" type="fixed"><parent link="world"/><child link="post"/></joint>
  <joint name="swing" type="continuous"><parent link="post"/><child link="arm"/></joint>
  <joint name="grip" type="fixed"><parent link="arm"/><child link="hand"/><origin xyz="0 0 -1"/></joint>
  <transmission name="drive"/>
</robot>)";

int main() {
  UrdfOptions options{.base = Base::as_file, .meshes = "/opt/robots"};
  options.packages["hand_description"] = "/home/me/hand";
  const Model machine = parse_urdf(text, "pendulum.urdf", options);  // or read_urdf("pendulum.urdf", options)

  for (const std::string& what : machine.skipped) std::fprintf(stderr, "%s\n", what.c_str());

  const model::Body &post = machine.bodies[0], &arm = machine.bodies[1];
  const model::Site& hand = machine.sites[1];
  std::printf("%s on the %s, %s turns on %s, %s is a place on %s, %zu left out\n", post.name.c_str(),
              post.parent < 0 && post.joints.empty() ? "world" : "air", arm.name.c_str(),
              machine.bodies[std::size_t(arm.parent)].name.c_str(), hand.name.c_str(),
              machine.bodies[std::size_t(hand.body)].name.c_str(), machine.skipped.size());
  return 0;
}
