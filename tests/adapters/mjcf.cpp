#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"

namespace mjcf_tests {

using namespace delassus;
using Catch::Matchers::Contains;

namespace {

/// `inside` is what stands within <mujoco>.
Model read_text(const std::string& inside, const MjcfOptions& options = {}) {
  return parse_mjcf("<mujoco>" + inside + "</mujoco>", "text.xml", options);
}
/// A body that moves freely, with these parts.
Model read_body(const std::string& parts, const std::string& before = "") {
  return read_text(before + "<worldbody><body name='b'><freejoint/>" + parts + "</body></worldbody>");
}
Approx near(double x) { return Approx(x).epsilon(1e-12).margin(1e-14); }

constexpr double pi = 3.14159265358979323846;

}  // namespace

TEST_CASE("a text becomes a machine: bodies in order, joints on them, geoms of the world") {
  const Model m = parse_mjcf(
      "<mujoco model='two'><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='a' pos='0 0 "
      "1'><joint "
      "name='x' type='slide' axis='2 0 0'/><joint name='z' range='-90 45'/><geom type='box' size='.1 .2 "
      ".3'/><body "
      "name='c'><geom size='.1'/></body></body></worldbody></mujoco>",
      "two.xml");
  CHECK(m.name == "two");
  REQUIRE(m.bodies.size() == 2);
  CHECK(m.bodies[0].name == "a");
  CHECK(m.bodies[0].joints == std::vector<Index>{0, 1});
  CHECK(m.bodies[1].parent == 0);
  CHECK(m.bodies[1].joints.empty());
  CHECK(m.joints[0].kind == model::JointKind::slide);
  CHECK(m.joints[0].axis == Vec3(1, 0, 0));
  CHECK(!m.joints[0].is_limited);
  CHECK(m.joints[1].lower == near(-pi / 2));
  CHECK(m.joints[1].upper == near(pi / 4));
  REQUIRE(m.geometries.size() == 3);
  CHECK(m.geometries[0].body == -1);
  CHECK(std::holds_alternative<model::Plane>(m.geometries[0].shape));
  CHECK(m.bodies[0].mass == near(1000 * 0.2 * 0.4 * 0.6));
  CHECK(std::get<Box>(m.geometries[1].shape).z == near(0.6));
  CHECK(m.time_step == 0.002);
  CHECK(m.gravity == Vec3(0, 0, -9.81));
  CHECK(m.skipped.empty());
}

TEST_CASE("a class gives what an element does not say, and classes within it what they do not change") {
  const Model m = read_text(
      "<default><geom density='10'/><default class='a'><geom type='box' size='1 1 1'/><default "
      "class='c'><geom "
      "density='20'/></default></default></default><worldbody><body childclass='a'><freejoint/><geom/><frame "
      "childclass='c'><geom pos='3 0 0'/></frame><geom class='main' size='1' pos='6 0 "
      "0'/></body></worldbody>");
  REQUIRE(m.geometries.size() == 3);
  CHECK(std::holds_alternative<Box>(m.geometries[1].shape));
  CHECK(std::holds_alternative<Sphere>(m.geometries[2].shape));
  CHECK(m.bodies[0].mass == near(80 + 160 + 10 * 4 * pi / 3));
}

TEST_CASE("angles are degrees unless the compiler says radian, of a hinge and a ball alone") {
  const std::string joints =
      "<worldbody><body><joint type='slide' range='-1 1' ref='.5'/><joint range='0 1' ref='.5' "
      "springref='1'/><geom "
      "size='.1'/></body><body><joint type='ball' range='0 1'/><geom size='.1'/></body></worldbody>";
  for (const bool in_radians : {false, true}) {
    const double unit = in_radians ? 1 : pi / 180;
    const Model m = read_text((in_radians ? "<compiler angle='radian'/>" : "") + joints);
    CHECK(m.joints[0].upper == 1);
    CHECK(m.joints[0].reference == 0.5);
    CHECK(m.joints[1].upper == near(unit));
    CHECK(m.joints[1].reference == near(0.5 * unit));
    CHECK(m.joints[1].spring_reference == near(unit));
    CHECK(m.joints[2].upper == near(unit));
  }
}

TEST_CASE("Euler's angles turn about axes that turn along, or about fixed ones in capitals") {
  // x by 90° and then z by 90°. Along: e_x goes to R_x R_z e_x = R_x e_y = e_z. Fixed: R_z R_x e_x = e_y.
  const auto turned = [](const char* sequence) {
    const Model m = read_body("<geom type='box' size='1 1 1' euler='90 90 0'/>",
                              std::string("<compiler eulerseq='") + sequence + "'/>");
    return Vec3(m.geometries[0].pose.rotation * Vec3(1, 0, 0));
  };
  CHECK(norm(Vec3(turned("xzy") - Vec3(0, 0, 1))) < 1e-15);
  CHECK(norm(Vec3(turned("XZY") - Vec3(0, 1, 0))) < 1e-15);
}

TEST_CASE("limits hold where there is a range, unless the compiler or the joint says otherwise") {
  const std::string joint = "<worldbody><body><joint range='0 1' ";
  const std::string rest = "/><geom size='.1'/></body></worldbody>";
  CHECK(read_text(joint + rest).joints[0].is_limited);
  CHECK(!read_text(joint + "limited='false'" + rest).joints[0].is_limited);
  CHECK_THROWS_WITH(read_text("<compiler autolimits='false'/>" + joint + rest),
                    Contains("text.xml:1: joint has range but not limited"));
  CHECK(read_text("<compiler autolimits='false'/>" + joint + "limited='true'" + rest).joints[0].is_limited);
  CHECK_THROWS_WITH(read_text("<worldbody><body><joint limited='true'/><geom size='1'/></body></worldbody>"),
                    Contains("must rise"));
}

TEST_CASE("what joints have beside is read in the units of their axis") {
  const Model m = read_text(
      "<worldbody><body gravcomp='.5'><joint damping='1' armature='2' frictionloss='3' stiffness='4' pos='.1 "
      ".2 .3' "
      "actuatorfrcrange='-5 5'/><geom size='.1'/></body><body name='k' mocap='true'/></worldbody>");
  const model::Joint& j = m.joints[0];
  CHECK(j.damping == 1);
  CHECK(j.armature == 2);
  CHECK(j.friction_loss == 3);
  CHECK(j.stiffness == 4);
  CHECK(j.effort == 5);
  CHECK(j.point == Vec3(0.1, 0.2, 0.3));
  CHECK(m.bodies[0].gravity_compensation == 0.5);
  CHECK(m.bodies[1].is_kinematic);
}

TEST_CASE("contact numbers of geoms: friction, freedoms, filters, priority, the motion of a surface") {
  const Model m = read_text(
      "<worldbody><geom type='box' size='1 1 1' friction='.5 .1' condim='6' contype='2' conaffinity='-1' "
      "priority='3' "
      "surfacevel='1 2 3 4 5 6'/><geom size='1' condim='1' contype='-2147483648'/></worldbody>");
  const model::Geometry& g = m.geometries[0];
  CHECK(g.friction == 0.5);
  CHECK(g.spinning_friction == 0.1);
  CHECK(g.rolling_friction == 0.0001);
  CHECK(g.contact_freedoms == 6);
  CHECK(g.type == 2u);
  CHECK(g.affinity == 0xffffffffu);
  CHECK(g.priority == 3);
  CHECK(g.surface_velocity == Vec3(1, 2, 3));
  CHECK(g.surface_spin == Vec3(4, 5, 6));
  CHECK(m.geometries[1].contact_freedoms == 1);
  CHECK(m.geometries[1].type == 0x80000000u);  // the last bit alone
}

TEST_CASE("flags leave out what they switch off") {
  const auto with = [](const std::string& flag) {
    return read_text(
        "<option gravity='1 2 3' timestep='.01'><flag " + flag +
        "='disable'/></option><worldbody><body><joint name='j' range='0 1' damping='1' frictionloss='1' "
        "stiffness='1'/><geom size='1'/></body></worldbody><equality><joint joint1='j'/></equality>");
  };
  CHECK(with("warmstart").gravity == Vec3(1, 2, 3));
  CHECK(with("warmstart").time_step == 0.01);
  CHECK(with("gravity").gravity == Vec3(0, 0, 0));
  CHECK(!with("contact").contacts);
  CHECK(with("filterparent").parents_collide);
  CHECK(!with("limit").joints[0].is_limited);
  CHECK(with("frictionloss").joints[0].friction_loss == 0);
  CHECK(with("spring").joints[0].stiffness == 0);
  CHECK(with("damper").joints[0].damping == 0);
  CHECK(with("equality").couplings.empty());
  const Model none = with("constraint");
  CHECK((!none.contacts && !none.joints[0].is_limited && none.couplings.empty() &&
         none.joints[0].damping == 1));
}

TEST_CASE("what is left out is named with file and line, and refused where `strict` is set") {
  const std::string text =
      "<mujoco>\n<option density='1'/>\n<worldbody>\n<body><joint margin='.1' solreflimit='.1 1'/><geom "
      "size='1' "
      "solref='.1 1'/>\n<geom type='sdf' mesh='x'/></body></worldbody>\n<sensor><clock/></sensor></mujoco>";
  const Model m = parse_mjcf(text, "a.xml");
  CHECK_THAT(m.skipped,
             Catch::Matchers::UnorderedEquals(std::vector<std::string>{
                 "a.xml:2: density: there is no fluid", "a.xml:4: margin: a limit acts where it is reached",
                 "a.xml:4: solreflimit, and all solref and solimp of this file: contacts, limits and "
                 "equalities are rigid here",
                 "a.xml:5: a geom of type sdf is left out", "a.xml:6: sensors: nothing measures here"}));
  CHECK_THROWS_WITH(parse_mjcf(text, "a.xml", {.strict = true}), Contains("a.xml:6: sensors"));
}

TEST_CASE("rendering is of no account, even under `strict`") {
  const Model m = read_text(
      "<visual><global fovy='3'/></visual><statistic extent='1'/><asset><texture name='t' type='2d' "
      "builtin='flat' width='1' "
      "height='1'/><material name='m' texture='t'/></asset><worldbody><light pos='0 0 1'/><camera "
      "pos='0 0 1'/><geom size='1' rgba='1 0 0 1' material='m'/></worldbody><custom><numeric name='n' "
      "data='1 2'/></custom>",
      {.strict = true});
  CHECK(m.geometries.size() == 1);
}

}  // namespace mjcf_tests
