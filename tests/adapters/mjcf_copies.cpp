#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"
#include "scratch_path.hpp"

#include <filesystem>
#include <fstream>

namespace mjcf_copies_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

Model read_text(const std::string& inside) {
  return parse_mjcf("<mujoco>" + inside + "</mujoco>", "text.xml");
}
void check_at(const Vec3& a, const Vec3& b) {
  CAPTURE(transposed(a), transposed(b));
  CHECK(norm(Vec3(a - b)) < 1e-14);
}
std::vector<std::string> names_of(const auto& all) {
  std::vector<std::string> names;
  for (const auto& x : all) names.push_back(x.name);
  return names;
}
using Words = std::vector<std::string>;

/// Files of a folder that goes with its scope.
struct Folder {
  std::filesystem::path path = scratch_path("mjcf_copies");
  Folder() { std::filesystem::create_directories(path / "parts"); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const char* name, const std::string& text) const { std::ofstream(path / name) << text; }
  Model read(const char* name, const MjcfOptions& options = {}) const {
    return read_mjcf((path / name).string(), options);
  }
};

}  // namespace

TEST_CASE("a frame moves what stands within it: bodies, geoms, sites and the axes of joints") {
  const Model m = read_text(
      "<worldbody><frame pos='1 0 0' euler='0 0 90'><frame pos='1 0 0'><geom size='.1' pos='1 0 0'/><body "
      "pos='0 1 0'><frame "
      "euler='0 90 0'><joint axis='1 0 0' pos='0 0 1'/><site pos='0 0 1'/></frame><geom "
      "size='.1'/></body></frame></frame></worldbody>");
  check_at(m.geometries[0].pose.position, {1, 2, 0});
  check_at(m.bodies[0].pose.position, {0, 1, 0});
  check_at(Vec3(m.bodies[0].pose.rotation * Vec3(1, 0, 0)), {0, 1, 0});
  // A quarter turn about y takes x to −z and z to x.
  check_at(m.joints[0].axis, {0, 0, -1});
  check_at(m.joints[0].point, {1, 0, 0});
  check_at(m.sites[0].pose.position, {1, 0, 0});
}

TEST_CASE(
    "replicate makes copies, each turned and moved on from the one before, with a number behind each name") {
  const Model m = read_text(
      "<worldbody><replicate count='3' offset='1 0 0' euler='0 0 90' sep='-'><body name='b'><joint "
      "name='j'/><geom name='g' "
      "size='.1'/></body></replicate></worldbody>");
  CHECK(names_of(m.bodies) == Words{"b-0", "b-1", "b-2"});
  CHECK(names_of(m.joints) == Words{"j-0", "j-1", "j-2"});
  // 1 along x; then, turned by 90°, 1 along y.
  check_at(m.bodies[1].pose.position, {1, 0, 0});
  check_at(m.bodies[2].pose.position, {1, 1, 0});
  check_at(Vec3(m.bodies[2].pose.rotation * Vec3(1, 0, 0)), {-1, 0, 0});
  const Model many = read_text("<worldbody><replicate count='10'><body name='b'/></replicate></worldbody>");
  CHECK(many.bodies[7].name == "b07");  // of 10 the number has two digits
}

TEST_CASE("what refers to copies is copied with them, also where it refers to what stands around them") {
  const Model m = read_text(
      "<worldbody><site name='o'/><geom name='floor' type='plane' size='1 1 1'/><replicate count='2'><site "
      "name='a'/><replicate "
      "count='2' sep='_'><body name='b'><joint "
      "name='j' type='slide'/><geom name='g' size='.1'/><site "
      "name='s'/></body></replicate></replicate></worldbody><tendon><spatial "
      "name='t'><site site='a'/><site site='s'/></spatial><fixed name='f'><joint joint='j' "
      "coef='1'/></fixed><spatial "
      "name='w'><site site='o'/><site site='a'/></spatial></tendon><actuator><motor "
      "name='m' tendon='f'/><motor name='one' joint='j_10'/></actuator><contact><pair geom1='floor' "
      "geom2='g'/><exclude body1='b' "
      "body2='world'/></contact>");
  CHECK(names_of(m.bodies) == Words{"b_00", "b_10", "b_01", "b_11"});
  // Copy by copy: the outer one's own, then those of the inner ones.
  CHECK(names_of(m.tendons) ==
        Words{"w0", "t_00", "f_00", "t_10", "f_10", "w1", "t_01", "f_01", "t_11", "f_11"});
  CHECK(m.sites[std::size_t(m.tendons[3].sites[0])].name == "a0");
  CHECK(m.sites[std::size_t(m.tendons[3].sites[1])].name == "s_10");
  CHECK(names_of(m.actuators) == Words{"one", "m_00", "m_10", "m_01", "m_11"});
  CHECK(m.joints[std::size_t(m.actuators[0].target)].name == "j_10");
  CHECK(m.pairs.size() == 4);
  CHECK(m.excludes.size() == 4);
}

TEST_CASE("a part of the model is attached again, with its classes and what refers to it") {
  const Model m = read_text(
      "<default><default class='c'><geom type='box' size='1 1 1'/></default></default><worldbody><body "
      "name='p' "
      "childclass='c' pos='0 0 5'><body name='arm' pos='1 0 0'><joint name='j'/><geom/></body></body><frame "
      "pos='0 3 0'><attach "
      "body='arm' prefix='x_'/></frame></worldbody><equality><joint joint1='j'/></equality>");
  CHECK(names_of(m.bodies) == Words{"p", "arm", "x_arm"});
  check_at(m.bodies[2].pose.position, {1, 3, 0});  // its own place, in the frame
  CHECK(std::holds_alternative<Box>(m.geometries[1].shape));
  CHECK(m.couplings.size() == 2);
  CHECK(m.joints[std::size_t(m.couplings[1].joint)].name == "x_j");
}

TEST_CASE(
    "an attached model brings its units, classes, meshes, tendons, actuators and keys, under a prefix") {
  const Folder folder;
  folder.write(
      "parts/arm.xml",
      "<mujoco model='arm'><compiler angle='radian'/><option timestep='.1'/><default><joint "
      "damping='7'/></default><asset><mesh "
      "name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><geom name='ground' size='1'/><body "
      "name='a' pos='0 0 "
      "2'><joint name='j' range='0 1'/><geom type='mesh' mesh='m'/><body name='tip'><joint name='k'/><geom "
      "size='.1'/></body></body><body name='other'><joint name='l'/><geom "
      "size='1'/></body></worldbody><tendon><fixed "
      "name='t'><joint joint='j' coef='1'/></fixed><fixed name='u'><joint joint='l' "
      "coef='1'/></fixed></tendon><actuator><motor "
      "name='pull' tendon='t'/></actuator><keyframe><key name='up' qpos='1 2 3' "
      "ctrl='4'/></keyframe></mujoco>");
  folder.write(
      "part.xml",
      "<mujoco><asset><model name='m' file='parts/arm.xml'/></asset><worldbody><body name='own'><joint "
      "name='q' ref='90'/><geom size='1'/></body><frame pos='1 0 0'><attach model='m' body='a' "
      "prefix='l_'/></frame><frame "
      "pos='2 0 0'><attach model='m' body='a' prefix='r_'/></frame></worldbody></mujoco>");
  const Model m = folder.read("part.xml");
  CHECK(names_of(m.bodies) == Words{"own", "l_a", "l_tip", "r_a", "r_tip"});
  check_at(m.bodies[3].pose.position, {2, 0, 2});
  CHECK(m.joints[1].upper == 1);
  CHECK(m.joints[1].damping == 7);
  CHECK(m.joints[0].damping == 0);
  CHECK(m.meshes.size() == 1);
  CHECK(names_of(m.tendons) == Words{"l_t", "r_t"});
  CHECK(names_of(m.actuators) == Words{"l_pull", "r_pull"});
  CHECK(m.time_step == 0.002);
  CHECK(m.keyframes.empty());    // it has numbers for three joints, and the part has two
  CHECK(m.skipped.size() == 2);  // that key, and the option
  folder.write(
      "whole.xml",
      "<mujoco><asset><model file='parts/arm.xml'/></asset><worldbody><body name='own'><joint name='q' "
      "ref='90'/><geom size='1'/></body><attach model='arm' prefix='x_'/></worldbody></mujoco>");
  const Model whole = folder.read("whole.xml");
  CHECK(whole.geometries[0].name == "x_ground");
  REQUIRE(whole.keyframes.size() == 1);
  CHECK(whole.keyframes[0].name == "x_up");
  CHECK(whole.keyframes[0].q == std::vector<double>{whole.joints[0].reference, 1, 2, 3});
  CHECK(whole.keyframes[0].control == std::vector<double>{4});
}

TEST_CASE("included files stand in place of include, in any section, and name their own lines") {
  const Folder folder;
  folder.write("main.xml",
               "<mujoco><include file='parts/defaults.xml'/><worldbody><body><include "
               "file='parts/body.xml'/></body></worldbody></mujoco>");
  folder.write(
      "parts/defaults.xml",
      "<mujocoinclude>\n<default><geom density='3'/></default>\n<include file='more.xml'/></mujocoinclude>");
  folder.write("parts/more.xml", "<x><option gravity='0 0 1'/></x>");
  folder.write("parts/body.xml", "<x>\n<joint name='j'/>\n<geom size='1' condim='2'/></x>");
  CHECK_THROWS_WITH(folder.read("main.xml"), Contains("body.xml:3: condim 2"));
  folder.write("parts/body.xml", "<x><joint name='j'/><geom size='1'/></x>");
  const Model m = folder.read("main.xml");
  CHECK(m.joints[0].name == "j");
  CHECK(m.bodies[0].mass == Approx(4 * 3.14159265358979));
  CHECK(m.gravity == Vec3(0, 0, 1));
}

TEST_CASE("files that include or attach themselves are refused, alone and in circles") {
  const Folder folder;
  folder.write("self.xml", "<mujoco>\n<include file='self.xml'/></mujoco>");
  CHECK_THROWS_WITH(folder.read("self.xml"), Contains("self.xml:2: the file 'self.xml' is included already"));
  folder.write("a.xml", "<mujoco><include file='b.xml'/></mujoco>");
  folder.write("b.xml", "<mujoco>\n\n<include file='parts/../a.xml'/></mujoco>");
  CHECK_THROWS_WITH(folder.read("a.xml"), Contains("b.xml:3: the file 'parts/../a.xml' is included already"));
  folder.write("c.xml", "<mujoco><asset><model name='d' file='d.xml'/></asset></mujoco>");
  folder.write("d.xml", "<mujoco><asset>\n<model name='c' file='c.xml'/></asset></mujoco>");
  CHECK_THROWS_WITH(folder.read("c.xml"),
                    Contains("d.xml:2: the model file 'c.xml' has itself among its assets"));
  CHECK_THROWS_WITH(read_text("<worldbody><body name='a'><attach body='a' prefix='x'/></body></worldbody>"),
                    Contains("text.xml:1: what is attached holds this attach itself"));
  CHECK_THROWS_WITH(read_text("<include file='nowhere.xml'/>"),
                    Contains("text.xml:1: the file 'nowhere.xml' to include is not found"));
}

}  // namespace mjcf_copies_tests
